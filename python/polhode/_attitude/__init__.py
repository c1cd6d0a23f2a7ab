"""Rotations, and the rates of their Euler angles."""
