"""Films of motions: the frames, the solid that turns, the page and the writers."""
