"""Other programs to compare with: one file for each, and its name in this list.

A peer's file has `NAME`, `INSTALL` (how to get it), `found() -> str` (its version, or "" when it is not there) and
`candidates()`. Each runs at the best settings its makers document.
"""

from __future__ import annotations

from types import ModuleType

from ..candidate import Candidate
from . import heyoka, mujoco, numbalsoda, odeint, orekit, scipy, sundials

PEERS: tuple[ModuleType, ...] = (scipy, heyoka, odeint, numbalsoda, sundials, mujoco, orekit)


def here() -> dict[str, str]:
    """The peers that are there, with their versions."""
    return {peer.NAME: version for peer in PEERS if (version := peer.found())}


def missing() -> dict[str, str]:
    """The peers that are not there, and how to get each."""
    return {peer.NAME: peer.INSTALL for peer in PEERS if not peer.found()}


def candidates() -> list[Candidate]:
    """Return all candidates of the peers that are there."""
    return [candidate for peer in PEERS if peer.found() for candidate in peer.candidates()]
