"""A document: domain, layers, limits and paint."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import MeshbrushWarning, MeshError
from .domain import Domain
from .layers import Layers, Length, _depth
from .mesh import Mesh, Why
from .paths import Path
from .progress import Progress, watching
from .shapes import ShapesLike, as_path, each_shape, geojson
from .solution import Solution
from .window import View, edited, shown

#: A formula in x and y, or a number.
Formula = str | float

#: The options by the table of a recipe that has them.
_TABLES = {
    "domain": (
        *("boundary", "boundary_diameter", "parts", "keep_pinches", "improve_boundary", "unit", "crs", "projection", "splits", "open"),
        *("contour", "positive", "smallest_island", "smallest_inlet", "outside_nodata"),
    ),
    "mesh": ("spacing", "rule", "max_triangles", "max_level", "max_memory"),
    "limits": ("h_min", "h_risk", "h_max", "shape", "gradation"),
}


#: Options that belong to the domain, and are not changed later.
_OF_DOMAIN = {
    *("unit", "crs", "projection", "splits", "open"),
    *("contour", "positive", "smallest_island", "smallest_inlet", "outside_nodata"),
}


def _tables(options: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Returns options as the tables of a recipe."""
    values = dict(options)
    memory = values.get("max_memory")
    if isinstance(memory, (int, np.integer)):
        values["max_memory"] = f"{int(memory)} B"
    values.update({key: _whole(values[key]) for key in ("max_triangles", "max_level") if key in values})
    return {table: {key: values[key] for key in keys if key in values} for table, keys in _TABLES.items()}


#: Where the open boundary is, in the memory.
_OPEN = "open.geojson"


def _openings(value: Any, given: list[tuple[str, Any]]) -> list[Any]:
    """Returns where the boundary is open as a recipe has it. Shapes go into `given`."""
    if (path := as_path(value)) is not None:
        return [path]
    is_box = isinstance(value, (list, tuple)) and len(value) == 4
    if is_box and all(isinstance(side, (int, float, np.number)) for side in value):
        return [[float(side) for side in value]]
    if isinstance(value, (list, tuple)) and not _is_ring(value):
        return [entry for one in value for entry in _openings(one, given)]
    name = f"{len(given)}-{_OPEN}"
    given.append((name, geojson(value, "Polygon")))
    return [name]


def _is_ring(value: Sequence[Any]) -> bool:
    """Whether these are points with two coordinates each."""
    return all(isinstance(at, (list, tuple, np.ndarray)) and len(at) == 2 for at in value)


def _whole(count: Any) -> Any:
    """Returns a count that was written as 1e6 as an integer."""
    return int(count) if isinstance(count, float) and count.is_integer() else count


def _warn(notes: Sequence[str]) -> None:
    for note in notes:
        warnings.warn(note, MeshbrushWarning, stacklevel=_depth())


class Document:
    """What to mesh, and how fine: a domain, layers and limits. Everything can be changed and undone.

    `domain` is a `Domain`, or what `Domain` takes. Lengths are in world units, which are those of the domain's
    coordinates, or metres with a `projection` ("auto", "EPSG:32635", …). They may be texts with a unit, as in
    `h_min="300 m"`: a region on the Earth is then meshed in metres.

    `spacing` is the longest side of a coarse cell; `h_min`, `h_max` and `h_risk` limit the target diameter, and
    `gradation` its growth by unit of length. `boundary` is "outline", "fitted" or "report", with triangles of the
    diameter `boundary_diameter` along the outline. `names` and `types` are names and types of the piece of the boundary
    at a point, as in {(24.5, 37.9): "harbour"}. `open` says where the boundary is open: "frame", "depth>50", a box (west,
    south, east, north), polygons, or a list of these. Where the domain is a file with a grid of heights, `contour` is the depth
    of its shore; with `outside_nodata`, the domain is where the grid has values. `rule` is "area" or "vertex". Other keywords are those of a recipe.
    """

    def __init__(
        self,
        domain: Domain | ShapesLike,
        *,
        name: str = "Untitled",
        spacing: Length | None = None,
        h_min: Length | None = None,
        h_max: Length | None = None,
        h_risk: Length | None = None,
        shape: float | None = None,
        gradation: float | None = None,
        boundary: str | None = None,
        boundary_diameter: Length | None = None,
        parts: str | float | None = None,
        keep_pinches: bool | None = None,
        improve_boundary: bool | None = None,
        unit: str | None = None,
        crs: str | None = None,
        projection: str | None = None,
        names: Mapping[tuple[float, float], str] | None = None,
        types: Mapping[tuple[float, float], str] | None = None,
        splits: Sequence[tuple[float, float]] | None = None,
        open: Any = None,
        contour: float | None = None,
        positive: str | None = None,
        smallest_island: float | str | None = None,
        smallest_inlet: Length | None = None,
        outside_nodata: bool | None = None,
        rule: str | None = None,
        max_triangles: int | None = None,
        max_level: int | None = None,
        max_memory: str | int | None = None,
    ) -> None:
        known = locals()
        options = {key: known[key] for keys in _TABLES.values() for key in keys if known[key] is not None}
        of = domain if isinstance(domain, Domain) else Domain(domain)
        tables = _tables(options)
        tables["domain"] = {**of._tables, **tables["domain"]}
        if projection not in (None, "none") and unit is None:
            tables["domain"].pop("unit", None)
        tables["domain"]["names"] = [{"at": list(at), "name": word} for at, word in (names or {}).items()]
        tables["domain"]["types"] = [{"at": list(at), "type": word} for at, word in (types or {}).items()]
        given = list(of._given)
        if open is not None:
            tables["domain"]["open"] = _openings(open, given)
        core, notes, without_effect = _core.Document.new(tables, given, name)
        self._take(core, notes)
        _warn(without_effect)

    def _take(self, core: _core.Document, notes: Sequence[str] = ()) -> None:
        self._core = core
        self._lock = threading.Lock()
        self._mesh: tuple[int, Mesh] | None = None
        self.notes: list[str] = list(notes)
        """What a person should know about domain and files, a sentence each."""

    @classmethod
    def _of(cls, core: _core.Document, notes: Sequence[str] = ()) -> Document:
        document = cls.__new__(cls)
        document._take(core, notes)
        return document

    @property
    def layers(self) -> Layers:
        """The layers, from the bottom to the top; its methods add some."""
        return Layers(self._core)

    @property
    def options(self) -> dict[str, Any]:
        """The options as they are, with those that were not given."""
        return self._core.options()

    def set(self, **options: Any) -> None:
        """Changes options of the mesh: those that are lengths, limits and words, with the names of `Document`."""
        known = {key for keys in _TABLES.values() for key in keys} - _OF_DOMAIN
        for key in options:
            if key not in known:
                raise TypeError(f"There is no option {key} to change; the options are {', '.join(sorted(known))}.")
        self._core.set(_tables(options))
        self._forget_mesh()

    def _forget_mesh(self) -> None:
        with self._lock:
            self._mesh = None

    def mesh(self, *, progress: Progress = None, threads: int | None = None, fresh: bool = False) -> Mesh:
        """Returns the mesh of the document as it is.

        It is that of `meshbrush mesh` for the same document, with the same fingerprint. After `update` it is the mesh
        that follows the document, with the numbers of one that is made from scratch, which `fresh` asks for. Nodes
        and triangles are numbered along a curve through the domain: neighbours have near numbers. `progress` is True,
        or a function of the stage and of what is done. Ctrl+C ends the work, and leaves the document as it was.
        """
        with watching(progress, threads) as watch:
            revision = self._core.revision()
            with self._lock:
                if self._mesh is not None and self._mesh[0] == revision and not fresh:
                    return self._mesh[1]
            made = self._core.mesh(watch, fresh)
            mesh = Mesh(made)
            with self._lock:
                self._mesh = (revision, mesh)
        _warn(made.notes())
        return mesh

    def update(self, *, progress: Progress = None, threads: int | None = None) -> _core.Change:
        """Brings the mesh up to date where it is, as the window does, and says what that changed."""
        with watching(progress, threads) as watch:
            change = self._core.update(watch)
        self._forget_mesh()
        return change

    def repair(self, solver: str, *, progress: Progress = None, threads: int | None = None) -> tuple[int, int]:
        """Adds layers that have triangles bisected once more where the mesh breaks a rule of a solver, as one edit.

        Returns how many triangles are bisected, and how many places are left, where smaller triangles do not help;
        `Mesh.check` lists these. `undo` takes the layers away.
        """
        with watching(progress, threads) as watch:
            bisected, left = self._core.repair(solver, watch)
        self._forget_mesh()
        return bisected, left

    def cut_strips(self, solver: str, *, progress: Progress = None, threads: int | None = None) -> tuple[int, int]:
        """Cuts strips off the domain in which its frame runs along a coast, with one or two triangles between them, as one edit.

        Returns how many strips were cut off, and how many are left: a strip that joins two parts of the sea stays.
        `Mesh.check` lists these among its notes. `undo` brings the strips back.
        """
        with watching(progress, threads) as watch:
            cut, left = self._core.cut_strips(solver, watch)
        self._forget_mesh()
        return cut, left

    def why(self, point: tuple[float, float] | npt.ArrayLike) -> Why:
        """Says why the triangle at a point is in the mesh."""
        return self.mesh().why(point)

    def path(
        self,
        start: Sequence[float],
        goal: Sequence[float],
        *,
        via: Sequence[Sequence[float]] = (),
        length_weight: float | None = None,
        risk_weight: float | None = None,
        cost: str | None = None,
        keep_out: ShapesLike | Sequence[ShapesLike] = (),
        clearance: Length | None = None,
        within: float | None = None,
        progress: Progress = None,
        threads: int | None = None,
    ) -> Path:
        """Returns the path of least cost between places in world units, and bounds of the least cost.

        The cost by unit of length is `length_weight` + `risk_weight` · risk, or the formula `cost` of x, y and risk.
        `keep_out` are polygons that it does not enter: a file, or what else stands for shapes, or several of these; and `clearance` is its least distance from them and from the
        outline. With `within`, as 0.01, the bounds are narrowed to that share.
        """
        weights = {"length_weight": length_weight, "risk_weight": risk_weight, "cost": cost, "clearance": clearance}
        places = np.asarray([start, *via, goal], dtype=np.float64)
        regions = [as_path(region) or geojson(region, "Polygon") for region in each_shape(keep_out)]
        mesh = self.mesh(threads=threads)
        with watching(progress, threads) as watch:
            points, figures, stops, note = mesh._core.path(places, weights, regions, within, watch)
        least, lower, upper, length, risk, highest = figures
        return Path(points, least, lower, upper, length, risk, highest, stops, note)

    def solve(
        self,
        *,
        diffusion: Formula = 1,
        convection: tuple[Formula, Formula] | None = None,
        reaction: Formula = 0,
        source: Formula = 0,
        dirichlet: Mapping[str, Formula] | None = None,
        neumann: Mapping[str, Formula] | None = None,
        robin: Mapping[str, tuple[Formula, Formula]] | None = None,
        exact: Formula | None = None,
        within: float | None = None,
        at_most: int | None = None,
        progress: Progress = None,
        threads: int | None = None,
    ) -> Solution:
        """Solves −∇·(a∇u) + b·∇u + c u = f on the mesh by linear finite elements, and bounds the energy error.

        Coefficients are numbers or formulas in x and y; conditions are by the name of a piece of the boundary, of which
        "all" stands for those without one of their own: u (`dirichlet`), a ∂u/∂n (`neumann`), α and g of
        a ∂u/∂n + α u = g (`robin`). Lengths are world units, or metres on the Earth. With `within`, triangles are
        bisected until the bound of the energy error is at most that; with `at_most`, as long as there are no more. The
        mesh of the document stays what it is.
        """
        table = {
            "diffusion": diffusion,
            "reaction": reaction,
            "source": source,
            "convection": None if convection is None else list(convection),
            "dirichlet": dict(dirichlet or {}),
            "neumann": dict(neumann or {}),
            "robin": {name: list(pair) for name, pair in (robin or {}).items()},
            "exact": exact,
        }
        table = {key: value for key, value in table.items() if value is not None}
        mesh = self.mesh(threads=threads)
        with watching(progress, threads) as watch:
            other, u, bounds, figures, reasons, rounds = mesh._core.solve(table, within, at_most, watch)
        bound, error, norm, steps, mean_is_zero = figures
        solved = mesh if other is None else Mesh(other)
        return Solution(solved, u, bound, bounds, reasons, error, norm, steps, mean_is_zero, rounds)

    def stroke(self, brush: Brush) -> Stroke:
        """Returns a stroke, for `with`: one edit, which an error undoes."""
        return Stroke(self._core, brush)

    def undo(self) -> bool:
        """Undoes the last edit. Returns whether there was one."""
        return self._core.undo()

    def redo(self) -> bool:
        """Redoes the edit that was undone last. Returns whether there was one."""
        return self._core.redo()

    def save(self, path: Any) -> None:
        """Writes a project (.meshbrush), which the window opens, or a recipe (.toml) with files beside it."""
        self._core.save(_path(path))

    def edit(self) -> Document | None:
        """Opens the window on a copy, waits until it is closed, and returns what was saved; None for nothing."""
        saved = edited(self._core.to_bytes(), self.options["name"])
        return None if saved is None else Document._of(_core.Document.of_bytes(saved))

    def show(self) -> View:
        """Opens the window on a copy, and does not wait."""
        return shown(self)

    def to_world(self, lonlat: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Returns longitudes and latitudes with shape (p, 2) in the plane of the document, which has a projection."""
        return self._core.to_world(np.asarray(lonlat, dtype=np.float64).reshape(-1, 2))

    def __repr__(self) -> str:
        return repr(self._core)

    def __getstate__(self) -> bytes:
        return self._core.to_bytes()

    def __setstate__(self, state: bytes) -> None:
        self._take(_core.Document.of_bytes(state))


@dataclass(frozen=True)
class Brush:
    """A round brush, in world units: it paints a target `diameter`, a `risk` from 0 to 1, the largest `error` from
    surfaces, in their unit, or erases.

    With a projection, the radius is metres on the Earth at the first point of the stroke. Lengths may be texts with a
    unit, as in "500 m".

    `hardness` is the share of the radius with the full effect, and `strength` the share of the way to it. `change` says
    which diameters it changes: to "finer" ones only, to "coarser", or "any".
    """

    radius: Length
    diameter: Length | None = None
    risk: float | None = None
    error: float | None = None
    erase: bool = False
    hardness: float = 0.5
    strength: float = 1.0
    change: str = "finer"
    mirror_x: float | None = None
    mirror_y: float | None = None

    def _medium(self) -> tuple[str, Length]:
        amounts = (self.diameter, self.risk, self.error)
        if sum(amount is not None for amount in amounts) + self.erase != 1:
            raise MeshError("A brush has one of diameter, risk, error and erase=True.")
        for key, value in (("hardness", self.hardness), ("strength", self.strength)):
            if not 0 <= value <= 1:
                raise MeshError(f"{key}: {value} cannot be used: it lies from 0 to 1.")
        if self.diameter is not None:
            return "diameter", self.diameter
        if self.error is not None:
            return "error", float(self.error)
        return ("risk", float(self.risk)) if self.risk is not None else ("eraser", 0.0)


class Stroke:
    """A stroke of a brush: all lines and points within one `with` are joined, and are one edit."""

    def __init__(self, core: _core.Document, brush: Brush) -> None:
        self._core, self._brush = core, brush
        self._begun = False

    def line(self, points: npt.ArrayLike) -> None:
        """Paints a line through points with shape (k, 2), on from the end of the stroke so far."""
        brush = self._brush
        quantity, value = brush._medium()
        self._core.paint(
            np.asarray(points, dtype=np.float64).reshape(-1, 2),
            quantity,
            value,
            brush.change,
            brush.radius,
            brush.hardness,
            brush.strength,
            (brush.mirror_x, brush.mirror_y),
            self._begun,
        )
        self._begun = True

    def dot(self, point: npt.ArrayLike) -> None:
        """Paints at a point."""
        self.line(np.asarray(point, dtype=np.float64).reshape(1, 2))

    def __enter__(self) -> Stroke:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._core.end_stroke(kind is None)


def open(path: Any) -> Document:  # noqa: A001
    """Opens a project (.meshbrush) or a recipe (.toml)."""
    name = _path(path)
    if name.lower().endswith(".toml"):
        return read_recipe(name)
    return Document._of(_core.Document.read_project(name))


def read_recipe(path: Any) -> Document:
    """Reads a recipe and the files that it names. Its outputs are not written."""
    core, notes, without_effect = _core.Document.read_recipe(_path(path))
    _warn(without_effect)
    return Document._of(core, notes)


def _path(path: Any) -> str:
    name = as_path(path)
    if name is None:
        raise TypeError(f"A path is a text or an os.PathLike, not {type(path).__name__}.")
    return name
