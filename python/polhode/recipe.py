"""Recipes: many bodies drawn at random from a seed."""

from ._scene.recipe import Draw, Recipe, load_recipe, recipe_model

__all__ = ["Draw", "Recipe", "load_recipe", "recipe_model"]
