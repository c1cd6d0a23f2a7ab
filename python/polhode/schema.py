"""The schema of scene files: `scene_model()` checks the content of one, and gives its JSON Schema."""

from ._scene.files import load_body, load_scene, make_scene, scene_model

__all__ = ["load_body", "load_scene", "make_scene", "scene_model"]
