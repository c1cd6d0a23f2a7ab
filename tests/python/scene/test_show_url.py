"""Addresses of scenes on the playground: the words are those that the page reads, with all digits."""

import re
from pathlib import Path
from urllib.parse import parse_qs

import numpy as np
import pytest

import polhode as ph

ROOT = Path(__file__).parents[3]
BODY = ph.Scene(inertia=(0.2, 0.4, 0.52), omega=(0.1, 5, 1 / 3), times=[0.0, 1.0])


def words(url):
    page, _, rest = url.partition("#")
    return page, {name: value for name, (value,) in parse_qs(rest, strict_parsing=True).items()}


def numbers(text):
    return [float(part) for part in text.split(",")]


def test_the_words_hold_the_scene():
    turn = ph.Rotation.from_euler("ZXZ", (0.3, 0.5, 0.1))
    scene = BODY.replace(attitude=turn, rotors=[ph.Rotor((0, 0, -1), momentum=0.3)], torques=[
        ph.torques.Gravity(2.0, (0, 0, 0.4)), ph.torques.Formula(text="-0.1 * omega * norm(omega)")])
    page, found = words(scene.show_url("site/playground.html"))
    assert page == "site/playground.html" and numbers(found["moments"]) == [0.2, 0.4, 0.52]
    assert np.array_equal(numbers(found["attitude"]), scene.attitude)
    assert [float(found[f"w{k}"]) for k in (1, 2, 3)] == [0.1, 5, 1 / 3]
    assert (float(found["weight"]), float(found["arm"]), float(found["wheel"])) == (2.0, 0.4, -0.3)
    typed, state = ph.torques.Formula(text=found["torque"]), (0.0, (0.1, -2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    wanted, values = BODY.replace(torques=[scene.torques[1]]), BODY.replace(torques=[typed]).torque(*state)
    assert np.array_equal(values, wanted.torque(*state))
    program = (ROOT / "web/page/app.js").read_text()
    fields = set(re.findall(r'"(\w+)"', re.search(r"const FIELDS = \[(.*?)\]", program, re.S)[1]))
    assert set(found) <= fields | {"torque", "moments", "attitude"}
    assert all(f'id === "{name}"' in program for name in ("torque", "moments", "attitude"))


@pytest.mark.parametrize(("changes", "why"), [
    ({"inertia": [[2, 0.1, 0], [0.1, 2.2, 0], [0, 0, 3]]}, "principal axes"), ({"t0": 1.0}, "t0"),
    ({"torques": [ph.torques.Gravity(2.0, (0.1, 0, 0.4))]}, "axis c"),
    ({"torques": [ph.torques.Constant((0, 0, 1))]}, "one weight"),
    ({"torques": [ph.torques.Formula(text="-k * omega", k=0.1)]}, "without parameters"),
    ({"rotors": [ph.Rotor((1, 0, 0), momentum=0.3)]}, "axis c"),
    ({"rotors": [ph.Rotor((0, 0, 1), momentum=0.1), ph.Rotor((0, 0, 1), momentum=0.2)]}, "one held rotor"),
])
def test_what_the_page_has_no_fields_for_is_refused(changes, why):
    with pytest.raises(ph.InvalidInput, match=f"show_url: must have .*{why}"):
        BODY.replace(**changes).show_url()
