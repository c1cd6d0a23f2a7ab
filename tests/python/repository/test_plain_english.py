"""What users read from the code is plain English: at most 25 words a sentence, and none of a few private idioms."""

import inspect
import re
import types

import prose
import pytest
import typer

import polhode as ph
from polhode._scene.scene import scene_folder
from polhode.cli.app import app

IDIOM = re.compile(r"\b(nobody|loose run|at the door|by itself|whatever|asked for|anyhow|hand(s|ed)? over)\b",
                   re.IGNORECASE)
MODULES = (ph, ph.inertia, ph.shapes, ph.torques, ph.mesh, ph.elliptic, ph.charts, ph.atlas, ph.report, ph.recipe,
           ph.schema)


def find_faults(texts):
    """The sentences of {place: text} that are too long, formulas apart, and the idioms."""
    found = []
    for place, text in texts.items():
        found += [(place, words, sentence) for words, sentence in prose.count(text).sentences
                  if words > prose.LONG and " = " not in sentence]
        found += [(place, idiom[0]) for idiom in IDIOM.finditer(text)]
    return found


def public_objects():
    """(name, object) of every public object, and of the public members of classes."""
    for module in MODULES:
        for name in getattr(module, "__all__", [name for name in vars(module) if not name.startswith("_")]):
            value = getattr(module, name)
            if isinstance(value, types.ModuleType) or not getattr(value, "__module__", "").startswith("polhode"):
                continue
            yield f"{module.__name__}.{name}", value
            if isinstance(value, type):
                yield from ((f"{module.__name__}.{name}.{key}", member) for key, member in vars(value).items()
                            if not key.startswith("_"))


def summaries():
    """The first paragraph of each docstring; pybind11 puts a signature before it."""
    documented = [*((module.__name__, module) for module in MODULES), *public_objects()]
    paragraphs = {name: (inspect.getdoc(value) or "").split("\n\n") for name, value in documented}
    return {name: next((part for part in parts if "->" not in part), "") for name, parts in paragraphs.items()}


def helps():
    """The help of each command and of its options."""
    group = typer.main.get_command(app)
    found = {"polhode": group.help}
    for name, command in group.commands.items():
        found[name] = command.help
        found |= {f"{name} {option.name}": getattr(option, "help", None) or "" for option in command.params}
    return found


def records():
    """The descriptions of methods, closed forms and torques, and the needs of methods."""
    found = {record["name"]: record["doc"] for record in [*ph.methods(), *ph.torques.records()]}
    found |= {form["name"]: form["doc"] for form in ph._core.closed_forms()}
    return found | {f"{record['name']} needs": record["needs"] for record in ph.methods()}


def make_plans():
    """Plans of the reference scenes, and of scenes about which the planner says more."""
    for file in sorted(scene_folder().glob("*.toml")):
        for accuracy in (1e-6, 1e-14):
            yield ph.plan(ph.Scene.load(str(file)), accuracy, certify=accuracy > 1e-12)
    steady = ph.Scene(inertia=(1, 2, 3), omega=(0, 1, 0), times=[0, 1])
    yield ph.plan(steady)
    yield ph.plan(steady.replace(omega=(0, 0, 0)))
    yield ph.plan(steady.replace(omega=(1e-9, 5, 1e-9), times=[1000]), method="taylor", certify=False)
    yield ph.plan(ph.Scene(inertia=(2, 2, 2), omega=(1, 2, 3), times=[1]))
    damping = ph.torques.Damping((100, 50, 100 / 3))
    yield ph.plan(ph.Scene(inertia=(1, 2, 2.5), omega=(30, 60, 90), torques=[damping], times=[0, 50, 100]))
    yield ph.plan(ph.Scene(inertia=(1, 2, 3), omega=(1, 2, 3), torques=[damping], times=[0, 1], want="omega"))
    window = ph.torques.During(ph.torques.Constant((0.1, 0, 0)), [(10, 20)])
    for inertia in ((1, 2, 3), (1, 1, 2)):
        yield ph.plan(ph.Scene(inertia=inertia, omega=(1, 2, 3), torques=[window], times=[0, 30]))


@pytest.mark.parametrize("collect", [summaries, helps, records])
def test_sentences_about_the_code_are_short_and_plain(collect):
    texts = collect()
    assert len(texts) > 30 and not find_faults(texts)


def test_reasons_of_plans_are_short_and_plain():
    found = {}
    for plan in make_plans():
        texts = (*plan.reasons, *(record.reason for record in plan.left_out),
                 *(candidate.why_not for candidate in plan.candidates))
        found |= {f"{plan.scene.name} {plan.accuracy:g}: {text}": text for text in texts}
    assert len(found) > 100 and not find_faults(found)


def test_messages_are_short_and_plain():
    """In a message a semicolon ends a sentence."""
    options = [{"accuracy": 1e-6}, {"accuracy": 1e-15}, {"accuracy": 1e-6, "certify": False}, {"rtol": 1e-3},
               {"rtol": 1e-20}, {"accuracy": 1e-6, "max_steps": 3}]
    found = set()
    for name in ("S1", "S4", "S5", "S7", "S9"):
        scene = ph.Scene.load(name)
        short = scene.replace(times=scene.times[:20])
        found |= {part for chosen in options for part in ph.solve(short, **chosen).message.split("; ")}
    assert len(found) > 8 and not find_faults({text: text for text in found})


def test_a_long_sentence_and_an_idiom_are_found():
    assert len(find_faults({"long": "It is " + "very " * 25 + "long.", "idiom": "Nobody asked for it."})) == 3
