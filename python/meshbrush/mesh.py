"""A mesh as arrays."""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Mapping
from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import MeshbrushWarning, MeshError
from .progress import Progress, watching
from .shapes import as_path

if TYPE_CHECKING:
    import meshio
    import skfem
    from matplotlib.axes import Axes
    from matplotlib.tri import Triangulation

#: Names that files use for other data.
_TAKEN = ("target_diameter", "boundary", "level")


class Place(IntEnum):
    """Where a point lies."""

    OUTSIDE = 0
    INSIDE = 1
    EDGE = 2
    NODE = 3
    INVALID = 4


class Located(NamedTuple):
    """Where points lie."""

    triangle: npt.NDArray[np.int64]
    """The number of the triangle, the lowest of several; −1 outside."""
    weights: npt.NDArray[np.float64]
    """The barycentric coordinates in its corners, with shape (p, 3); NaN outside."""
    where: npt.NDArray[np.uint8]
    """The `Place`, as a number."""


class Why:
    """Why a triangle is in a mesh. Its text is sentences."""

    def __init__(self, sentences: str, answer: Mapping[str, Any]) -> None:
        self.text = sentences
        self.answer: dict[str, Any] = dict(answer)
        """All of it as data, with the keys of `meshbrush why --json`."""

    @property
    def triangle(self) -> int | None:
        """The number of the triangle; None where it was changed along the outline."""
        return self.answer.get("triangle")

    @property
    def cause(self) -> str:
        """"coarse", "rule", "compatibility" or "unneeded"."""
        return str(self.answer["cause"])

    @property
    def layer(self) -> str | None:
        """The name of the layer that asked for it, if one did."""
        demand: dict[str, Any] = self.answer.get("demand") or {}
        return demand.get("layer")

    @property
    def place(self) -> tuple[float, float] | None:
        """Where it was asked for."""
        demand: dict[str, Any] = self.answer.get("demand") or {}
        at = demand.get("from")
        return None if at is None else (at[0], at[1])

    @property
    def chain(self) -> list[dict[str, Any]]:
        """The triangles from the one that exceeds its target to the parent."""
        return list(self.answer["chain"])

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<meshbrush.Why: {self.text}>"


class Mesh:
    """A mesh. Its arrays are computed when they are first asked for, cannot be written, and are never copied.

    Nodes and triangles have the order and the numbers that they have in files, counted from 0.
    """

    def __init__(self, core: _core.Mesh) -> None:
        self._core = core

    @property
    def nodes(self) -> npt.NDArray[np.float64]:
        """x and y of each node in world units, with shape (n, 2)."""
        return self._core.nodes

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """The nodes of each triangle anticlockwise, with shape (m, 3); the first two are the ends of its longest edge."""
        return self._core.triangles

    @property
    def levels(self) -> npt.NDArray[np.uint8]:
        """How often the coarse triangle was halved to get each triangle."""
        return self._core.levels

    @property
    def neighbours(self) -> npt.NDArray[np.int64]:
        """The triangle opposite each corner, with shape (m, 3); −1 where there is none."""
        return self._core.neighbours

    @property
    def neighbors(self) -> npt.NDArray[np.int64]:
        """The same as `neighbours`."""
        return self._core.neighbours

    @property
    def h(self) -> npt.NDArray[np.float64]:
        """The target diameter at each node."""
        return self._core.h

    @property
    def boundary(self) -> dict[str, npt.NDArray[np.uint32]]:
        """The edges of each piece of the boundary, with shape (k, 2) and the domain on the left, in the order of
        markers."""
        return self._core.boundary

    @property
    def lines(self) -> dict[str, list[npt.NDArray[np.uint32]]]:
        """The nodes along each line of the document (`[[line]]` of a recipe), each with shape (k,): an array for each part
        of the line that is on edges without a gap. The array of a whole closed line ends with its first node. Lines of
        which no part is on edges are not in it; lines with one name share a list."""
        return self._core.lines

    @property
    def markers(self) -> dict[str, int]:
        """The number of each piece of the boundary in files."""
        return self._core.markers

    @property
    def fingerprint(self) -> str:
        """32 hexadecimal digits, equal for equal meshes: the `hash` of `meshbrush mesh --json`."""
        return self._core.fingerprint

    @property
    def statistics(self) -> dict[str, Any]:
        """The answer of `meshbrush mesh --json`, with its keys."""
        answer: dict[str, Any] = json.loads(self._core.summary())
        return answer

    def error_curve(
        self, most: int = 1_048_576, *, progress: Progress = None
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns the error from the surface against the number of triangles, of the smallest meshes and of uniform ones.

        Each array has shape (p, 2): triangles and the error by the norm of the topmost surface. No mesh has more than `most`
        triangles.
        """
        with watching(progress) as watch:
            least, uniform = self._core.error_curve(int(most), watch)
        return least, uniform

    def violations(self) -> int:
        """Returns how many rules the mesh breaks: 0, unless the program has a mistake."""
        return self._core.violations()

    def check(
        self,
        solver: str,
        *,
        crs: str | None = None,
        cells: str | None = None,
        values: Mapping[str, npt.ArrayLike] | None = None,
        quantities: list[str] | None = None,
        grids: list[dict[str, str]] | None = None,
        least_depth: float | None = None,
        depth_slope: float | None = None,
    ) -> dict[str, Any]:
        """Says where the mesh, as a file of a solver has it, breaks the rules of that solver.

        `solver` is adcirc, schism, swan, telemac, fvcom, ww3, delft3dfm, mike or modflow. The answer is that of `meshbrush
        check --json`: `violations` and `notes` are lists with `rule`, `place` in the coordinates of the file, `source` and
        `sentence`. `crs`, `cells`, `least_depth`, `depth_slope`, and the `depth` of `values`, `quantities` and `grids`, are
        as for `write`.
        """
        output = {"file": ""} | _node_data(quantities, grids, least_depth, depth_slope)
        answer, notes = self._core.check(output, solver, crs, cells, _named(values))
        for note in notes:
            warnings.warn(note, MeshbrushWarning, stacklevel=2)
        found: dict[str, Any] = json.loads(answer)
        return found

    def nodes_in(self, crs: str) -> npt.NDArray[np.float64]:
        """Returns the nodes of a mesh in the plane of a projection in other coordinates: "lonlat" or "EPSG:…"."""
        return self._core.nodes_in(crs)

    def locate(self, points: npt.ArrayLike) -> Located:
        """Finds the triangles around points with shape (p, 2), in world units."""
        triangle, where, weights = self._core.locate(_points(points))
        return Located(triangle, weights.reshape(-1, 3), where)

    def interpolate(self, values: npt.ArrayLike, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Returns values at the nodes, with shape (n,) or (n, k), linearly interpolated at points; NaN outside."""
        at_nodes = np.asarray(values, dtype=np.float64)
        count = self._core.counts[0]
        if at_nodes.ndim not in (1, 2) or at_nodes.shape[0] != count:
            shape = " × ".join(map(str, at_nodes.shape))
            raise MeshError(f"The values have the shape {shape}, and the mesh has {count} nodes.")
        found = self.locate(points)
        corners = self.triangles[np.maximum(found.triangle, 0)]
        equation = "pi,pi->p" if at_nodes.ndim == 1 else "pi,pik->pk"
        return np.asarray(np.einsum(equation, found.weights, at_nodes[corners]))

    def why(self, point: tuple[float, float] | npt.ArrayLike) -> Why:
        """Says why the triangle at a point is in the mesh."""
        x, y = np.asarray(point, dtype=np.float64)
        sentences, answer = self._core.why((float(x), float(y)))
        return Why(sentences, json.loads(answer))

    def write(
        self,
        path: Any,
        *,
        values: Mapping[str, npt.ArrayLike] | None = None,
        quantities: list[str] | None = None,
        grids: list[dict[str, str]] | None = None,
        least_depth: float | None = None,
        depth_slope: float | None = None,
        format: str | None = None,  # noqa: A002
        binary: bool = False,
        flat: bool = False,
        cells: str | None = None,
        crs: str | None = None,
        size: str | tuple[int, int] | None = None,
        dpi: float | None = None,
        edges: bool | None = None,
        colormap: str | None = None,
        color_by: str | None = None,
        light: bool | None = None,
        ground: str | None = None,
        furniture: str | None = None,
        view: str | None = None,
        azimuth: float | None = None,
        altitude: float | None = None,
        exaggeration: float | None = None,
        progress: Progress = None,
    ) -> list[str]:
        """Writes the mesh in the format of the ending, and returns the files.

        `values` are numbers at the nodes by their names, and `quantities` formulas, as in "depth = 20 - x"; solvers read
        `depth`. In a formula `depth` is that of layers of depths, as in "depth = max(depth, 3)". `grids` are means of pixels
        over the cells of nodes, as in {"name": "manning", "file": "landcover.tif", "table": "classes.csv"}; a grid of values
        has no table of classes. Nodes that are less deep than `least_depth`, in metres, are written with it, and depths are
        smoothed until no edge has an r-factor above `depth_slope`, as in 0.2. `format` names one that the ending does not.
        `cells` is "triangles" or "squares". `crs` is "plane", "lonlat" or "EPSG:…" for a mesh in the plane of a projection.
        With a surface the third coordinate of a node is its height, in formats that have one, and 0 where `flat`.

        For pictures, .png and .svg, are `size` in pixels, or as in "160mm" with `dpi`; `edges`; `colormap`; `color_by`, which
        colours the triangles by "target", "smallest_angle" or another overlay; `light`, or `ground` ("dark", "light",
        "white" or "transparent"); and `furniture`, as in "legend,axes" or "all". With `view="space"` a .png shows the mesh as a
        surface, with the heights of layers of surfaces or else of depths; see `picture`.
        """
        output = _look(as_path(path) or path, size, edges, colormap, light)
        output |= {"dpi": dpi, "color_by": color_by, "ground": ground, "furniture": furniture}
        output |= _space(view, azimuth, altitude, exaggeration)
        output |= _node_data(quantities, grids, least_depth, depth_slope)
        output.update(binary=bool(binary), flat=bool(flat), cells=cells)
        with watching(progress) as watch:
            files, notes = self._core.write(output, format, crs, _named(values), watch)
        for note in notes:
            warnings.warn(note, MeshbrushWarning, stacklevel=2)
        return [str(file) for file in files]

    def picture(
        self,
        *,
        size: str | tuple[int, int] | None = None,
        edges: bool | None = None,
        colormap: str | None = None,
        color_by: str | None = None,
        light: bool | None = None,
        ground: str | None = None,
        furniture: str | None = None,
        view: str | None = None,
        azimuth: float | None = None,
        altitude: float | None = None,
        exaggeration: float | None = None,
    ) -> npt.NDArray[np.uint8]:
        """Returns a picture with shape (height, width, 4): red, green, blue and alpha. It needs no other library.

        `color_by`, `ground` and `furniture` are as for `write`.
        With `view="space"` it shows the mesh as a surface. `azimuth` is the direction in which one looks, in degrees clockwise
        from the y axis, `altitude` how high the viewer stands above the horizon, 5 to 90 degrees, and `exaggeration` the
        factor for heights; without it relief has an eighth of the longer side of the domain.
        """
        look = _look("picture.png", size, edges, colormap, light)
        look |= {"color_by": color_by, "ground": ground, "furniture": furniture}
        return self._core.picture(look | _space(view, azimuth, altitude, exaggeration))

    def _repr_png_(self) -> bytes:
        return self._core.png(_look("picture.png", (800, 600), self._core.counts[1] < 20_000, None, True))

    def plot(self, **options: Any) -> Axes:
        """Draws the mesh with matplotlib: see `meshbrush.plotting.plot`."""
        from .plotting import plot

        return plot(self, **options)

    def to_meshio(self) -> meshio.Mesh:
        """Returns a mesh of meshio, with the pieces of the boundary and the lines as sets and as physical groups."""
        from .converters import to_meshio

        return to_meshio(self)

    def to_skfem(self) -> skfem.MeshTri:
        """Returns a mesh of scikit-fem, whose boundaries have the names of the pieces and of the lines."""
        from .converters import to_skfem

        return to_skfem(self)

    def to_triangulation(self) -> Triangulation:
        """Returns a triangulation of matplotlib."""
        from .converters import to_triangulation

        return to_triangulation(self)

    def to_dolfinx(self, comm: Any) -> Any:
        """Returns mesh, facet tags and the marker of each name for dolfinx (0.10). Rank 0 gives the arrays."""
        from .converters import to_dolfinx

        return to_dolfinx(self, comm)

    def to_firedrake(self, comm: Any = None) -> Any:
        """Returns a mesh of firedrake, whose boundary ids are the markers."""
        from .converters import to_firedrake

        return to_firedrake(self, comm)

    def __len__(self) -> int:
        return self._core.counts[1]

    def __repr__(self) -> str:
        nodes, triangles = self._core.counts
        return f"<meshbrush.Mesh: {triangles} triangles, {nodes} nodes, fingerprint {self.fingerprint[:8]}…>"

    def __reduce__(self) -> NoReturn:
        raise TypeError("A mesh is not pickled: pickle its document, which makes it again, or write it to a file.")


def _points(points: npt.ArrayLike) -> npt.NDArray[np.float64]:
    array = np.asarray(points, dtype=np.float64)
    if array.shape == (0,):
        array = array.reshape(0, 2)
    if array.ndim == 1 and array.size == 2:
        array = array.reshape(1, 2)
    if array.ndim != 2:
        raise MeshError(f"Points have the shape (p, 2), and this array has {array.ndim} dimensions.")
    return array


def _named(values: Mapping[str, npt.ArrayLike] | None) -> list[tuple[str, npt.NDArray[np.float64]]]:
    return [(_valid(name), np.ascontiguousarray(v, dtype=np.float64)) for name, v in (values or {}).items()]


def _valid(name: str) -> str:
    if not re.fullmatch("[A-Za-z_][A-Za-z0-9_]*", name):
        raise MeshError(f"values: the name “{name}” cannot be used: write letters, digits and underscores.")
    if name in _TAKEN:
        raise MeshError(f"values: the name {name} is taken. Give another one, as in depth.")
    return name


def _look(
    file: Any,
    size: str | tuple[int, int] | None,
    edges: bool | None,
    colormap: str | None,
    light: bool | None,
) -> dict[str, Any]:
    if isinstance(size, (tuple, list)):
        size = f"{size[0]}x{size[1]}"
    elif isinstance(size, int):
        size = str(size)
    return {"file": file, "size": size, "edges": edges, "colormap": colormap, "light": light}


def _node_data(
    quantities: list[str] | None,
    grids: list[dict[str, str]] | None,
    least_depth: float | None,
    depth_slope: float | None,
) -> dict[str, Any]:
    return {
        "quantities": list(quantities or []),
        "grids": _grids(grids),
        "least_depth": least_depth,
        "depth_slope": depth_slope,
    }


def _grids(grids: list[dict[str, str]] | None) -> list[dict[str, Any]]:
    return [{key: as_path(value) or value for key, value in grid.items()} for grid in grids or []]


def _space(
    view: str | None, azimuth: float | None, altitude: float | None, exaggeration: float | None
) -> dict[str, Any]:
    return {"view": view, "azimuth": azimuth, "altitude": altitude, "exaggeration": exaggeration}
