"""Recipes: many bodies drawn from a seed rather than written down."""

from ._scene.recipe import Draw, Recipe, load_recipe, recipe_model

__all__ = ["Draw", "Recipe", "load_recipe", "recipe_model"]
