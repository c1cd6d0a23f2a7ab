"""Derivatives of motions, and fits of bodies to measurements."""
