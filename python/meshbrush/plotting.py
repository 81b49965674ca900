"""Pictures with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import MeshError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .mesh import Mesh


def plot(
    mesh: Mesh,
    *,
    ax: Axes | None = None,
    color: str | npt.ArrayLike | None = "level",
    edges: bool = True,
    boundary: bool = False,
    cmap: str = "viridis",
    colorbar: bool = False,
    linewidth: float = 0.3,
) -> Axes:
    """Draws a mesh, and returns the axes. `color` is "level", "h", None, or values at the nodes or triangles.

    `boundary` draws the pieces of the boundary with their names in a legend.
    """
    import matplotlib.pyplot as plt

    if ax is None:
        _, ax = plt.subplots()
    triangulation = mesh.to_triangulation()
    values = _values(mesh, color)
    line: dict[str, Any] = {"edgecolors": "k", "linewidth": linewidth} if edges else {}
    if values is None:
        ax.triplot(triangulation, color="k", linewidth=linewidth)
    elif len(values) == len(mesh.triangles):
        drawn = ax.tripcolor(triangulation, facecolors=values, cmap=cmap, **line)
    else:
        drawn = ax.tripcolor(triangulation, values, cmap=cmap, shading="gouraud")
        if edges:
            ax.triplot(triangulation, color="k", linewidth=linewidth)
    if colorbar and values is not None:
        ax.figure.colorbar(drawn, ax=ax)
    if boundary:
        _draw_boundary(mesh, ax)
    ax.set_aspect("equal")
    return ax


def _values(mesh: Mesh, color: Any) -> npt.NDArray[Any] | None:
    if color is None:
        return None
    if isinstance(color, str):
        if color not in ("level", "h"):
            raise MeshError(f'color: "{color}" is not possible here; write one of level, h, or give values.')
        return mesh.levels if color == "level" else mesh.h
    values = np.asarray(color)
    nodes, triangles = len(mesh.nodes), len(mesh.triangles)
    if values.shape not in ((nodes,), (triangles,)):
        raise MeshError(f"color: there are {values.size} values, for {nodes} nodes or {triangles} triangles.")
    return values


def _draw_boundary(mesh: Mesh, ax: Axes) -> None:
    from matplotlib.collections import LineCollection

    for number, (name, edges) in enumerate(mesh.boundary.items()):
        ax.add_collection(LineCollection(list(mesh.nodes[edges]), colors=f"C{number % 10}", label=name))
    ax.legend()
