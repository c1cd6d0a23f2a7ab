"""What the tests of stores and engines share."""

import ensembles
import pytest


@pytest.fixture(scope="module")
def recipe(tmp_path_factory):
    return ensembles.write(tmp_path_factory.mktemp("recipe"), ensembles.DRIVEN)


@pytest.fixture(scope="module")
def whole_store(recipe):
    """A store of the recipe, made undisturbed by this process."""
    import polhode as ph

    out = recipe.parent / "whole.zarr"
    ph.ensemble(recipe, out=out, executor=0)
    return out
