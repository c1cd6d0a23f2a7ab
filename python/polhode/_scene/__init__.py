"""Scenes, the files that hold them, and recipes for many bodies."""
