"""Whether the parts of a picture lie within it and apart from each other, as a reader sees them."""


def boxes(figure):
    """The boxes in pixels of the panels with their words, of the figure's own words and of its legends."""
    figure.canvas.draw()
    found = {f"panel {i}": axes.get_tightbbox() for i, axes in enumerate(figure.axes) if axes.get_visible()}
    found |= {text.get_text(): text.get_window_extent() for text in figure.texts if text.get_text()}
    return found | {f"legend {i}": legend.get_window_extent() for i, legend in enumerate(figure.legends)}


def check(figure, slack=1.0):
    """Everything lies within the figure, and no part covers another; `slack` in pixels."""
    found, whole = boxes(figure), figure.bbox
    for name, box in found.items():
        assert box.x0 >= -slack and box.y0 >= -slack, name
        assert box.x1 <= whole.x1 + slack and box.y1 <= whole.y1 + slack, name
    names = list(found)
    for i, name in enumerate(names):
        for other in names[:i]:
            a, b = found[name], found[other]
            across = min(a.x1, b.x1) - max(a.x0, b.x0)
            up = min(a.y1, b.y1) - max(a.y0, b.y0)
            assert across <= slack or up <= slack, (name, other)
