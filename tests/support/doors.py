"""The public callables of polhode, for tests that must name each of them."""

import importlib
import types

MODULES = ("polhode", *(f"polhode.{name}" for name in ("elliptic", "formula", "inertia", "measured", "mesh", "shapes",
                                                      "torques", "recipe", "report", "schema", "charts", "atlas")))


def public():
    """Return name -> callable: functions, classes, and the public methods of classes as 'Class.method'."""
    found, seen = {}, set()
    for path in MODULES:
        module = importlib.import_module(path)
        prefix = path.removeprefix("polhode").removeprefix(".")
        for name in getattr(module, "__all__", None) or [name for name in dir(module) if not name.startswith("_")]:
            door = getattr(module, name)
            own = str(getattr(door, "__module__", "")).startswith("polhode")
            if isinstance(door, types.ModuleType) or not callable(door) or not own or id(door) in seen:
                continue
            seen.add(id(door))
            full = f"{prefix}.{name}" if prefix else name
            found[full] = door
            if isinstance(door, type):
                found |= {f"{full}.{part}": getattr(door, part) for base in door.__mro__
                          if base is door or base.__name__.startswith("_") for part in vars(base)
                          if not part.startswith("_") and callable(getattr(door, part))}
                if "__call__" in vars(door):
                    found[f"{full}.__call__"] = door.__call__
    return found
