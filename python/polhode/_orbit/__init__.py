"""Orbits: the paths of the centre of mass."""
