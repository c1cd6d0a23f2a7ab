"""A picture says of each curve its variables, its right-hand side and where the budget stopped it, as the JSON does."""

import html
import json
import re

import numpy as np
import pytest

import polhode as ph
from polhode.charts import pictures
from polhode.charts.candidate import CLOSED, EULER, OWN, SEPARATRIX, Candidate, tolerances
from polhode.charts.candidates import candidates
from polhode.charts.measure import measure
from polhode.charts.results import document

pytest.importorskip("matplotlib")
SCENE = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=np.linspace(0, 1, 5), name="words")
NAMES = ("FreeMotion", "taylor", "rk45", "plan")


def slow(scene):
    """A program whose runs take longer than any budget, from the second setting on."""
    rk45 = next(c for c in candidates(False) if c.name == "rk45").start(scene)

    def run(value, limit):
        if value < 1e-4:
            from polhode.charts.candidate import Failure

            raise Failure(f"not done within {limit} s")
        return rk45(value, limit)

    return run


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    taking_part = [c for c in candidates(False) if c.name in NAMES]
    taking_part.append(Candidate("Slow one", "peer", "a test", tolerances(3, 9, 3), slow, lambda scene: "",
                                 right_hand_side="in Python"))
    result = measure(SCENE, "words", taking_part, 4.0, lambda text: None)
    folder = tmp_path_factory.mktemp("words")
    (svg,) = [path for path in pictures.work_precision(result, folder) if path.suffix == ".svg"]
    found = re.findall(r"<text.*?</text>", svg.read_text(), re.S)
    texts = [html.unescape(re.sub("<[^>]+>", "", part)) for part in found]
    return json.loads(json.dumps(document([result], 4.0, [], False)))["scenes"][0], " ".join(" ".join(texts).split())


def listed(words, head):
    """The names behind a head in the picture."""
    found = re.search(rf"{re.escape(head)} (.*?)(?:;|\.)(?: |$)", words)
    return set(found[1].split(", ")) if found else set()


def test_the_picture_says_what_the_json_says(made):
    scene, words = made
    about = scene["candidates"]
    assert {about[name]["variables"] for name in ("taylor", "rk45", "FreeMotion")} == {SEPARATRIX, EULER, CLOSED}
    for variables in (SEPARATRIX, EULER):
        names = {name for name, one in about.items() if one["variables"] == variables}
        assert names and listed(words, f"In {variables}:") == names
    elsewhere = {name for name, one in about.items() if one["right_hand_side"] != OWN}
    assert elsewhere == {"Slow one"} == listed(words, "Right-hand side in Python:")
    stopped = {f"{name} at {one['stopped_at']}" for name, one in about.items() if one["stopped_at"]}
    assert stopped == {"Slow one at 1e-03"} == listed(words, "The budget stopped")


def test_every_candidate_says_its_variables():
    for scene in ("S1", "S3", "S5", "S7"):
        scene = ph.Scene.load(scene)
        for candidate in candidates():
            assert candidate.variables(scene) in (EULER, SEPARATRIX, CLOSED) and candidate.right_hand_side
