"""What polhode asks of its process: one copy of the package, the main interpreter, imports that end before a fork."""

from __future__ import annotations

import os
import sys
from importlib import import_module

from . import _core  # refuses a subinterpreter

# What calls import when they first need it. Its locks are looked at before a fork.
LATE = frozenset({"polhode", "numpy", "pydantic", "pydantic_core", "difflib", "pathlib", "ctypes", "rich"})


def require_one_copy(home: str) -> None:
    """Refuse a second copy: the compiled core exists once in a process, and belongs to the copy that came first."""
    first = _core._first_home(home)
    if first != home or "polhode._core.torques" not in sys.modules:
        raise ImportError(f"polhode is imported twice in one process, from {first} and from {home}: its compiled core "
                          "is there once. Use one copy in sys.path, and keep its modules in sys.modules")


def finish_imports() -> None:
    """Wait for modules that other threads import: in a forked child their locks would stay shut."""
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] in LATE and getattr(getattr(module, "__spec__", None), "_initializing", False):
            import_module(name)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=finish_imports)
