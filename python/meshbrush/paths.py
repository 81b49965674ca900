"""Paths of least cost."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class Path(NamedTuple):
    """A path, and how far from the best it can be."""

    points: npt.NDArray[np.float64]
    """From the start to the goal in world units, with shape (k, 2)."""
    cost: float
    """What it costs."""
    lower: float
    """No path costs less."""
    upper: float
    """It costs no more: so the best costs no more."""
    length: float
    """Its length in world units."""
    risk: float
    """The integral of the risk over the length."""
    highest_risk: float
    """The highest risk on the way."""
    stops: list[int]
    """The numbers of the start, the places on the way and the goal in `points`."""
    note: str | None
    """Why no narrower interval was proved, where one was asked for."""
