"""Films of motions: the frames, the solid that rotates, the page and the writers."""
