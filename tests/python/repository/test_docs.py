"""Links in the documents lead somewhere, and the examples of the homework run."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import polhode as ph

ROOT = Path(__file__).parents[3]
PAGES = sorted(page for places in ("*.md", "docs/**/*.md", "scenes/**/*.md", "tests/**/*.md")
               for page in ROOT.glob(places))


def anchors(text):
    headings = re.findall(r"^#+ (.+)$", text, flags=re.M)
    keys = re.findall(r"^@\w+\{(\w+),", (ROOT / "docs/references.bib").read_text(), flags=re.M)
    if text.startswith("# Bibliography"):
        return set(keys)
    slugs = {re.sub(r"[^\w\- ]", "", h.lower()).strip().replace(" ", "-") for h in headings}
    return slugs | set(re.findall(r'<a id="([^"]+)">', text))


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_local_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", page.read_text(), flags=re.S)):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), f"{target}: no such file"
        assert not anchor or anchor in anchors(file.read_text()), f"{target}: no such heading"


def test_the_bibliography_names_each_work_once():
    works = (ROOT / "docs/references.bib").read_text()
    keys = re.findall(r"^@\w+\{(\w+),$", works, flags=re.M)
    assert len(keys) > 30 and len(set(keys)) == len(keys) == works.count("\n@") + works.startswith("@")
    fields = re.findall(r"^  keywords  = \{([\w-]+)\},$", works, flags=re.M)
    shown = re.findall(r'keywords % "([\w-]+)"', (ROOT / "docs/bibliography.md").read_text())
    assert len(fields) == len(keys) and set(fields) == set(shown), "each work stands under one heading"


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / page).read_text(), flags=re.S)


def has_python(page):
    return re.search(r"^```(?:\{code-cell\} )?python$", page.read_text(), flags=re.M)


@pytest.mark.parametrize("page", [page for page in PAGES if "docs" in page.parts and has_python(page)
                                  and page.name != "ensemble.md"],   # it has a recipe, and a test of its own
                         ids=lambda p: str(p.relative_to(ROOT / "docs")))
def test_the_python_examples_of_a_page_run_in_their_order(page, tmp_path, monkeypatch):
    text, names = page.read_text(), {}
    if "matplotlib" in text:
        pytest.importorskip("matplotlib").use("agg")
        import matplotlib.pyplot

        monkeypatch.setattr(matplotlib.pyplot, "show", lambda: matplotlib.pyplot.close("all"))
    for entry in ROOT.iterdir():   # pages read files of the project, and write others
        (tmp_path / entry.name).symlink_to(entry)
    monkeypatch.chdir(tmp_path)
    for block in re.findall(r"^```(?:\{code-cell\} )?python\n(.*?)^```", text, flags=re.S | re.M):
        exec(compile(block, str(page), "exec"), names)


@pytest.mark.parametrize("path", sorted((ROOT / "docs/gallery").glob("*.py")), ids=lambda path: path.stem)
def test_a_program_of_the_gallery_draws(path):
    plt = pytest.importorskip("matplotlib.pyplot")
    assert max(map(len, path.read_text().splitlines())) <= 80
    plt.switch_backend("agg")
    names = {"__name__": "gallery"}
    exec(compile(path.read_text().replace("plt.show()", ""), str(path), "exec"), names)
    assert len(plt.get_fignums()) == 1 and plt.gcf().axes
    plt.close("all")


USER_PAGES = [page for page in PAGES if page.name == "README.md" or "docs" in page.parts
              and not {"results", "codes"} & set(page.parts)]


@pytest.mark.parametrize("page", USER_PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_code_fits_on_the_page(page):
    """80 columns of code, and one formula a line, so that nothing is cut on a screen of usual width."""
    text = page.read_text()
    code = re.findall(r"^```(?:\{code-cell\} )?(?:python|cpp|c|toml)\n(.*?)^```", text, flags=re.S | re.M)
    assert not [line for block in code for line in block.splitlines() if len(line) > 80]
    assert not [formula for formula in re.findall(r"\$\$(.*?)\$\$", text, flags=re.S) if "quad" in formula]


def test_the_examples_of_ensembles_run_with_the_recipe_of_the_page(tmp_path, monkeypatch):
    for name in ("pandas", "xarray"):
        pytest.importorskip(name)
    recipe, sweep, _ = blocks("docs/ensemble.md", "toml")
    (tmp_path / "mine.toml").write_text(recipe.replace("count = 2000", "count = 200"))
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks("docs/ensemble.md", "python"):
        exec(compile(block, "docs/ensemble.md", "exec"), names)
    assert names["run"].done == 50 and names["states"].omega.shape == (23, 61, 3)
    rotors = "[[rotors]]\naxis = [0.0, 0.0, 1.0]\nmomentum = 0.0\n"
    (tmp_path / "swept.toml").write_text(recipe.replace("[times]", f"{rotors}[times]") + sweep)
    assert ph.ensemble("swept.toml", executor=0, count=2).summary["omega"].mean.shape == (6, 61)


@pytest.mark.parametrize("page", ["docs/scene.md", "docs/reference_scenes.md"])
def test_the_scene_files_of_the_pages_load(page, tmp_path):
    (block,) = blocks(page, "toml")
    (tmp_path / "scene.toml").write_text(block)
    assert ph.Scene.load(tmp_path / "scene.toml").times.size in (201, 501)


def test_the_refusal_of_a_wrong_key_is_the_one_shown(tmp_path):
    (toml,), (shown,) = blocks("docs/scene.md", "toml"), blocks("docs/scene.md", "text")
    (tmp_path / "S5.toml").write_text(toml.replace("weight =", "weigth ="))
    with pytest.raises(ph.InvalidInput) as refused:
        ph.Scene.load(tmp_path / "S5.toml")
    assert str(refused.value).removeprefix(f"{tmp_path}/") == shown.strip()


def test_the_names_of_scipys_rotation_that_are_left_out_are_listed():
    theirs = pytest.importorskip("scipy.spatial.transform").Rotation
    missing = {name for name in dir(theirs) if not name.startswith("_") and not hasattr(ph.Rotation, name)}
    page = (ROOT / "docs/attitude.md").read_text()
    (listed,) = re.findall(r"^- `Rotation` lacks these names of SciPy's: (.*)\.$", page, flags=re.M)
    assert missing == set(re.findall(r"`(\w+)`", listed))


def test_the_readmes_python_example_needs_no_extra(tmp_path):
    (block,) = blocks("README.md", "python")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = {re.match(r"[\w-]+", name)[0] for names in project["optional-dependencies"].values() for name in names}
    hidden = sorted(name.replace("-", "_") for name in extras)
    assert "typer" in hidden and "scipy" in hidden and "pydantic" not in hidden
    program = f"import sys\nsys.modules.update(dict.fromkeys({hidden!r}))\n{block}"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 0 and done.stdout.count("\n") == 2, done.stderr


def test_the_readme_is_short():
    assert len([line for line in (ROOT / "README.md").read_text().splitlines() if line.strip()]) <= 40
