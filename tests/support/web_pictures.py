"""Tries the playground in a headless Chromium without a network, from its single file, and takes pictures of it.

    python tests/support/web_pictures.py build/web/playground.html build/web/pictures
"""

from __future__ import annotations

import sys
from pathlib import Path

from browser import Browser

WIDTHS = (1400, 1280, 390)
OUTSIDE = """[...document.querySelectorAll('fieldset')]
  .flatMap(box => [...box.querySelectorAll('input, select, output')]
  .filter(field => field.getBoundingClientRect().right > box.getBoundingClientRect().right - 1)
  .map(field => field.id || 'output')).join(' ')"""
LETTERS = """(() => { const c = document.getElementById('errors');   // of the chart, in pixels of the page
  return parseFloat(c.getContext('2d').font) * c.getContext('2d').getTransform().a * c.clientWidth / c.width; })()"""
PIXELS = """(() => { const c = document.getElementById('body');
  return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((h, x) => (31 * h + x) | 0, 7); })()"""
AT = """(t => { const slider = document.getElementById('time'); slider.value = t;
  slider.dispatchEvent(new Event('input')); })"""
SET = """((id, value, event = 'input') => { const field = document.getElementById(id); field.value = value;
  field.dispatchEvent(new Event(event)); })"""
NEXT = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))"


def try_page(page: Path, width: int, theme: str, folder: Path) -> list[str]:
    """Return what is wrong."""
    wrong = []

    def check(holds: bool, text: str) -> None:
        if not holds:
            wrong.append(text)

    with Browser(page.resolve().as_uri(), width=width, height=900, phone=width < 600) as browser:
        browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
        browser.wait("document.body.dataset.ready === 'yes'")
        browser.run("document.getElementById('play').click()")   # the clock stands
        browser.wait("document.getElementById('other').textContent !== ''")   # the stepping methods are there
        seen = []
        for time in (0.01, 0.11, 0.01):
            browser.run(f"{AT}({time})"), browser.run(NEXT)
            seen.append(browser.run(PIXELS))
        check(seen[0] != seen[1], "the body looks the same at two times")
        check(seen[0] == seen[2], "the body looks different at the same time")
        browser.run(f"{AT}(0.5)"), browser.run(NEXT)
        browser.picture(folder / f"playground-{theme}-{width}.png", whole=True)
        cost = min(browser.run(f"{SET}('w2', {7 + k / 10}), playground.state.cost") for k in range(5))
        check(cost < 16, f"2401 states take {cost} ms")
        browser.run(f"{SET}('a', 0.02), {SET}('w2', '1e300')")
        check(not browser.run("document.getElementById('refusal').hidden"), "a refusal is not shown")
        browser.run(f"{SET}('a', 0.7), {SET}('w2', 7)"), browser.run(NEXT)
        check(browser.run("document.getElementById('refusal').hidden"), "the page does not live on after a refusal")
        check("w2=7" in browser.run("location.hash"), "the link does not hold the scene")
        check("[times]" in browser.run("playground.sceneText()"), "no scene.toml")
        for preset in ("top", "wheel", "disk", "brake"):
            browser.run(f"{SET}('preset', '{preset}')"), browser.run(NEXT)
            check(browser.run("document.getElementById('refusal').hidden"), f"{preset} is refused")
        check('kind = "formula"' in browser.run("playground.sceneText()"), "the scene file has no torque")
        browser.run(f"{SET}('torque', '-omgea', 'change')")
        refusal = browser.run("document.getElementById('refusal').textContent")
        check("omgea" in refusal, "a misspelt torque is not refused")
        browser.run(f"{SET}('torque', '', 'change')"), browser.run(NEXT)
        check(browser.run("document.getElementById('refusal').hidden"), "a wrong torque stays")
        check(not browser.run(OUTSIDE), f"fields stick out of their box: {browser.run(OUTSIDE)}")
        check(browser.run(LETTERS) >= 12, f"the chart's letters are {browser.run(LETTERS):.1f} pixels high")
        check(browser.run("document.documentElement.scrollWidth") <= width, f"wider than {width} pixels")
        outside = [asked for asked in browser.requests if not asked.startswith(("file:", "data:", "about:", "blob:"))]
        return wrong + [f"asks for {asked}" for asked in outside] + browser.errors


def main(page: str, folder: str) -> int:
    """Try every width and theme; 1 if something is wrong."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    status = 0
    for width in WIDTHS:
        for theme in ("light", "dark"):
            for text in try_page(Path(page), width, theme, target):
                print(f"playground, {theme}, {width} pixels: {text}")
                status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
