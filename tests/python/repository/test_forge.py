"""The files of a forge run what runs here, and all files name one version."""

import json
import pathlib
import re

import pytest

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))
TARGETS = set(re.findall(r"^([a-z0-9-]+):", (ROOT / "Makefile").read_text(), flags=re.M))


def load(path):
    return pytest.importorskip("yaml").safe_load(path.read_text())


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_runs_make_and_the_scripts_alone(path):
    made = load(path)
    assert made["permissions"] == {"contents": "read"}
    for job in made["jobs"].values():
        assert job["timeout-minutes"] <= 350
        targets = job.get("strategy", {}).get("matrix", {}).get("target", [])
        assert set(targets) <= TARGETS
        for step in job["steps"]:
            if "uses" in step:   # pinned, with its version beside it
                assert re.fullmatch(r"actions/[a-z-]+@[0-9a-f]{40}", step["uses"])
                assert re.search(re.escape(step["uses"]) + r" # v\d+\.\d+\.\d+", path.read_text())
                continue
            command = step["run"].split()
            if command[0] == "make":
                assert command[1] in TARGETS or (command[1] == '"$TARGET"' and targets)
            else:
                assert command[0].startswith(".ci/") and (ROOT / command[0]).stat().st_mode & 0o100


def test_forms_ask_for_what_repeats_a_fault():
    fault = load(ROOT / ".github/ISSUE_TEMPLATE/fault.yml")
    assert "polhode.build_info()" in fault["body"][-1]["attributes"]["description"]
    wish = load(ROOT / ".github/ISSUE_TEMPLATE/wish.yml")
    (page,) = re.findall(r"docs/\S+\.md", wish["body"][0]["attributes"]["value"])
    assert (ROOT / page).exists()


def test_every_file_names_one_version():
    version = ph.__version__
    assert json.loads((ROOT / "codemeta.json").read_text())["version"] == version
    assert json.loads((ROOT / ".zenodo.json").read_text())["version"] == version
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert re.search(rf"^## {re.escape(version)} \(", (ROOT / "CHANGELOG.md").read_text(), flags=re.M)
