"""Solutions by finite elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .mesh import Mesh


@dataclass(frozen=True)
class Solution:
    """The solution of a problem on a mesh, and a bound of its error."""

    mesh: Mesh
    """The mesh: that of the document, or one that the error made."""
    u: npt.NDArray[np.float64]
    """The solution at the nodes, with shape (n,)."""
    bound: float
    """The energy error is at most this."""
    bounds: npt.NDArray[np.float64]
    """The part of each triangle, with shape (m,): their squares add up to that of `bound`, but for rounding."""
    reasons: list[str]
    """Why the bound is an estimate; empty where it is guaranteed."""
    error: float | None
    """The energy error, where `exact` says the solution."""
    energy_norm: float
    """The energy norm of u."""
    steps: int
    """How many steps the solver did."""
    mean_is_zero: bool
    """Whether the mean of u is set to 0, because nothing else determines it."""
    rounds: list[tuple[int, float]]
    """Triangles and bound of each mesh, from that of the document."""

    @property
    def guaranteed(self) -> bool:
        """Whether the bound is proved, up to rounding."""
        return not self.reasons

    @property
    def nodes(self) -> npt.NDArray[np.float64]:
        """The nodes of the mesh, with shape (n, 2)."""
        return self.mesh.nodes

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """The nodes of each triangle, anticlockwise, with shape (m, 3)."""
        return self.mesh.triangles
