"""The layers of a document: what they ask for, and in which order."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

from ._errors import MeshbrushWarning, MeshError
from .rasters import Bounds, Grid, grid_of, sampled
from .shapes import ShapesLike, as_path, geojson

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import Document as CoreDocument


#: A length: a number in world units, or a text with a unit, as in "40 km", "300 m" or "0.5 nmi".
Length: TypeAlias = "float | str"


def _depth() -> int:
    """Returns how many calls lie between the caller of this and a line outside of the package."""
    frame, depth = sys._getframe(1), 1
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        frame, depth = frame.f_back, depth + 1
    return depth


class Common(TypedDict, total=False):
    """What every layer can be given."""

    name: str
    visible: bool
    locked: bool
    combine: str
    mask: ShapesLike


class Layer:
    """A layer of a document. Its attributes can be set."""

    __slots__ = ("_document", "_number", "__weakref__")

    def __init__(self, document: CoreDocument, number: int) -> None:
        self._document = document
        self._number = number

    def _row(self) -> tuple[int, str, str, bool, bool, str]:
        for row in self._document.layers():
            if row[0] == self._number:
                return row
        raise MeshError("The layer is no longer in its document.")

    @property
    def name(self) -> str:
        """The name, which need not be the only one."""
        return self._row()[1]

    @name.setter
    def name(self, name: str) -> None:
        self._document.change_layer(self._number, {"name": name})

    @property
    def kind(self) -> str:
        """The kind, as in a recipe."""
        return self._row()[2]

    @property
    def visible(self) -> bool:
        """A hidden layer asks for nothing."""
        return self._row()[3]

    @visible.setter
    def visible(self, visible: bool) -> None:
        self._document.change_layer(self._number, {"visible": bool(visible)})

    @property
    def locked(self) -> bool:
        """A locked layer is not painted on."""
        return self._row()[4]

    @locked.setter
    def locked(self, locked: bool) -> None:
        self._document.change_layer(self._number, {"locked": bool(locked)})

    @property
    def combine(self) -> str:
        """How it is combined with the layers below: "finest", "floor" or "replace"."""
        return self._row()[5]

    @combine.setter
    def combine(self, combine: str) -> None:
        self._document.change_layer(self._number, {"combine": combine})

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Layer):
            return NotImplemented
        return self._document is other._document and self._number == other._number

    def __hash__(self) -> int:
        return hash((id(self._document), self._number))

    def remove(self) -> None:
        """Takes the layer out of its document."""
        self._document.remove_layer(self._number)

    def move_to(self, place: int) -> None:
        """Moves the layer to a place in the stack, counted from 0 at the bottom."""
        self._document.move_layer(self._number, place)

    def __repr__(self) -> str:
        _, name, kind, visible, _, combine = self._row()
        hidden = "" if visible else ", hidden"
        return f"<meshbrush.Layer “{name}”: {kind}, {combine}{hidden}>"


class Layers(Sequence[Layer]):
    """The layers of a document, from the bottom to the top. Each method adds one on top, and returns it.

    Each takes also `name`, `visible`, `locked`, `combine` ("finest", "floor" or "replace") and `mask`: a file of
    polygons, or polygons as for `Domain`. Keywords have the meaning that the keys of a recipe have.
    """

    def __init__(self, document: CoreDocument) -> None:
        self._document = document

    def add(self, kind: str, **keys: Any) -> Layer:
        """Adds a layer of any kind, with the keys that a recipe has for it."""
        return self._add(kind, keys, {})

    def _add(self, kind: str, keys: dict[str, Any], given: dict[str, Any]) -> Layer:
        mask = keys.pop("mask", None)
        if mask is not None:
            keys["mask_file"] = as_path(mask) or "mask.geojson"
            if as_path(mask) is None:
                given["mask.geojson"] = geojson(mask, "Polygon")
        if keys.get("name") is None:
            keys.pop("name", None)
        number, notes = self._document.add_layer({"kind": kind, **keys}, list(given.items()))
        for note in notes:
            warnings.warn(note, MeshbrushWarning, stacklevel=_depth())
        return Layer(self._document, number)

    def formula(self, formula: str | float, quantity: str = "diameter", **common: Unpack[Common]) -> Layer:
        """Adds a formula in `x`, `y`, `r` and `theta` for the target diameter, or for the risk. A number is one too."""
        text = formula if isinstance(formula, str) else repr(float(formula))
        return self._add("formula", {"formula": text, "quantity": quantity, **common}, {})

    def raster(
        self,
        values: Any,
        bounds: Bounds | None = None,
        *,
        reads: str | None = None,
        curve: Sequence[Sequence[Length]] | None = None,
        origin: str = "upper",
        crs: str | None = None,
        **common: Unpack[Common],
    ) -> Layer:
        """Adds values by pixel: an array with its bounds, a data array of xarray, a data set of rasterio, or a file.

        `reads` says that they are "risk", "diameter" or "error"; else `curve` is pairs of a value and the target diameter there.
        The first row of an array is the northern one, unless `origin` is "lower". NaN asks for nothing. Without bounds
        an array covers the rectangle of the domain. Bounds are world units; in a document with a projection they are
        longitudes and latitudes, or in the system `crs`, where
        "plane" is that of the document.
        """
        if (reads is None) == (curve is None):
            raise MeshError(
                'A raster needs what its values mean: reads="risk", reads="diameter", reads="error", or a curve, as in '
                "curve=[(0, 0.1), (50, 2)]."
            )
        keys = {"as": reads, "curve": curve, **common}
        return self._raster("raster", keys, values, bounds, origin, crs)

    def band(
        self,
        values: Any,
        between: Sequence[float],
        diameter: Length,
        bounds: Bounds | None = None,
        *,
        origin: str = "upper",
        crs: str | None = None,
        **common: Unpack[Common],
    ) -> Layer:
        """Adds one target diameter where values lie between two numbers. Values are as for `raster`."""
        keys = {"between": between, "diameter": diameter, **common}
        return self._raster("band", keys, values, bounds, origin, crs)

    def depth(
        self,
        values: Any,
        bounds: Bounds | None = None,
        *,
        size: str = "nothing",
        positive: str = "up",
        offset: float | None = None,
        depth_from: float | None = None,
        depth_to: float | None = None,
        period: float | None = None,
        triangles: float | None = None,
        smoothing: Length | None = None,
        time_step: float | None = None,
        courant: float | None = None,
        origin: str = "upper",
        crs: str | None = None,
        **common: Unpack[Common],
    ) -> Layer:
        """Adds depths of water, which nodes get in files, and sizes from them.

        `size` is "nothing", "wavelength" (`period`, `triangles`), "slope" (`triangles`, `smoothing`) or "courant"
        (`time_step`, `courant`). Values are as for `raster`; heights, unless `positive` is "down".
        """
        keys = {
            "size": size,
            "positive": positive,
            "offset": offset,
            "depth_from": depth_from,
            "depth_to": depth_to,
            "period": period,
            "triangles": triangles,
            "smoothing": smoothing,
            "time_step": time_step,
            "courant": courant,
            **common,
        }
        return self._raster("depth", keys, values, bounds, origin, crs)

    def surface(
        self,
        values: Any = None,
        bounds: Bounds | None = None,
        *,
        formula: str | None = None,
        within: float | None = None,
        at_most: int | None = None,
        norm: Literal["max", "l2", "h1"] | None = None,
        origin: str = "upper",
        crs: str | None = None,
        **common: Unpack[Common],
    ) -> Layer:
        """Adds a surface that the mesh is to be close to, with values linear over triangles.

        Either `within` is the largest error, and the mesh is the smallest one, or `at_most` is the largest number of
        triangles, and the error is the least. The error is the largest difference, or by `norm` the root mean square of
        the differences (`"l2"`) or of the differences of the gradient (`"h1"`). Values are as for `raster`; in their place a `formula` in x and y gives the
        surface. Files have the heights at the nodes, and `mesh.statistics` the errors.
        """
        keys = {"within": within, "at_most": at_most, "norm": norm, **common}
        if values is None:
            return self._add("surface", {"formula": formula, **keys}, {})
        if formula is not None:
            raise MeshError("A surface has values or a formula, not both.")
        return self._raster("surface", keys, values, bounds, origin, crs)

    def sample(
        self,
        function: Callable[[npt.NDArray[np.float64], npt.NDArray[np.float64]], Any],
        *,
        pixels: int = 1024,
        bounds: Bounds | None = None,
        reads: str = "diameter",
        **common: Unpack[Common],
    ) -> Layer:
        """Adds the values of a function of arrays x and y, sampled at the centres of pixels.

        There are `pixels` along the longer side of the bounds, or of the rectangle of the domain. The function is called
        for some rows at a time. A formula is exact; prefer it where there is one.
        """
        place = bounds if bounds is not None else self._document.options()["bounds"]
        grid = sampled(function, place, pixels)
        if bounds is None:
            grid = grid._replace(bounds=None)
        return self._grid("raster", {"as": reads, **common}, grid)

    def _raster(
        self, kind: str, keys: dict[str, Any], values: Any, bounds: Bounds | None, origin: str, crs: str | None
    ) -> Layer:
        path = as_path(values)
        if path is None:
            return self._grid(kind, keys, grid_of(values, bounds, origin, crs))
        if crs is not None:
            raise MeshError("crs is for arrays: a file says its coordinate system itself, or a .prj file beside it.")
        return self._add(kind, {"file": path, "bounds": bounds, **keys}, {})

    def _grid(self, kind: str, keys: dict[str, Any], grid: Grid) -> Layer:
        file = f"{keys.get('name') or 'array'}.npy".replace("/", "-")
        return self._add(kind, {"file": file, **keys}, {file: grid.data()})

    def threats(
        self,
        file: Any = None,
        *,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        range: npt.ArrayLike | None = None,  # noqa: A002
        peak: npt.ArrayLike = 1.0,
        law: str | Sequence[str] = "radar",
        **common: Unpack[Common],
    ) -> Layer:
        """Adds points of risk that falls with the distance, from a .csv file or from arrays: places, ranges, risks at
        the places, and the laws "radar", "gaussian" or "disc"."""
        if file is not None:
            return self._add("threats", {"file": as_path(file) or file, **common}, {})
        if x is None or y is None or range is None:
            raise MeshError("Threats need a file, or x, y and range.")
        columns = np.broadcast_arrays(*(np.atleast_1d(np.asarray(c, dtype=np.float64)) for c in (x, y, range, peak)))
        laws = np.broadcast_to(np.asarray(law, dtype=object), columns[0].shape)
        rows = zip(*(column.ravel().tolist() for column in columns), laws.ravel().tolist())
        threats = [dict(zip(("x", "y", "range", "peak", "law"), row)) for row in rows]
        return self._add("threats", {"threats": threats, **common}, {})

    def distance(
        self,
        to: ShapesLike = None,
        *,
        at_zero: Length,
        slope: float,
        range: Length | None = None,  # noqa: A002
        pieces: Sequence[str] | None = None,
        types: Sequence[str] | None = None,
        **common: Unpack[Common],
    ) -> Layer:
        """Adds a target diameter that grows with the distance to "outline", "coasts", a file, or shapes, where an array is
        points; or to the pieces of the boundary with some names or types."""
        keys = {"at_zero": at_zero, "slope": slope, "range": range, "pieces": pieces, "types": types, **common}
        if to is None:
            return self._add("distance", keys, {})
        if isinstance(to, str) and to in ("outline", "coasts"):
            return self._add("distance", {"to": to, **keys}, {})
        return self._along("distance", keys, to, "MultiPoint")

    def corridor(
        self,
        along: ShapesLike,
        *,
        width: Length,
        at_zero: Length,
        slope: float,
        range: Length | None = None,  # noqa: A002
        **common: Unpack[Common],
    ) -> Layer:
        """Adds a target diameter that grows with the distance to a strip along lines: a file, or shapes. An array is a
        line."""
        keys = {"width": width, "at_zero": at_zero, "slope": slope, "range": range, **common}
        return self._along("corridor", keys, along, "LineString")

    def _along(self, kind: str, keys: dict[str, Any], shapes: ShapesLike, arrays: str) -> Layer:
        path = as_path(shapes)
        if path is not None:
            return self._add(kind, {"file": path, **keys}, {})
        file = f"{keys.get('name') or 'shapes'}.geojson".replace("/", "-")
        return self._add(kind, {"file": file, **keys}, {file: geojson(shapes, arrays)})

    def straits(self, *, across: float, width_from: Length, width_to: Length, **common: Unpack[Common]) -> Layer:
        """Adds a number of triangles across straits of these widths."""
        keys = {"across": across, "width_from": width_from, "width_to": width_to, **common}
        return self._add("straits", keys, {})

    def feature_size(self, *, across: float, width_from: Length, width_to: Length, **common: Unpack[Common]) -> Layer:
        """Adds a number of triangles across the water between its shores and its middle."""
        keys = {"across": across, "width_from": width_from, "width_to": width_to, **common}
        return self._add("feature-size", keys, {})

    def lines(self, *, across: float = 1, **common: Unpack[Common]) -> Layer:
        """Adds triangles as small as edges along the lines of the document need: `across` of them across each gap."""
        return self._add("lines", {"across": across, **common}, {})

    def paint(self, quantity: str = "diameter", **common: Unpack[Common]) -> Layer:
        """Adds a layer for strokes of "diameter", "risk" or "error". A stroke adds one where there is none."""
        return self._add("paint", {"quantity": quantity, **common}, {})

    def __len__(self) -> int:
        return len(self._document.layers())

    def __iter__(self) -> Iterator[Layer]:
        return iter([Layer(self._document, row[0]) for row in self._document.layers()])

    def __getitem__(self, key: Any) -> Any:
        """Returns a layer by its place from the bottom, or the uppermost one of a name."""
        rows = self._document.layers()
        if isinstance(key, str):
            for row in reversed(rows):
                if row[1] == key:
                    return Layer(self._document, row[0])
            known = ", ".join(f"“{row[1]}”" for row in rows) or "none"
            raise KeyError(f"There is no layer “{key}”; there are {known}.")
        if isinstance(key, slice):
            return [Layer(self._document, row[0]) for row in rows[key]]
        return Layer(self._document, rows[key][0])

    def __delitem__(self, key: int | str) -> None:
        self[key].remove()

    def __repr__(self) -> str:
        return f"<meshbrush.Layers: {', '.join(f'“{row[1]}”' for row in self._document.layers()) or 'none'}>"
