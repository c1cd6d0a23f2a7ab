"""Basis of measurements: worker processes, the truth of a scene, and the machine."""
