"""Grids of numbers from NumPy, xarray and rasterio."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._errors import MeshbrushWarning, MeshError
from .shapes import crs_text

#: x0, y0, x1, y1 in world units.
Bounds = Sequence[float]


class Grid(NamedTuple):
    """Values with their place."""

    values: npt.NDArray[Any]
    bounds: list[float] | None
    lowest_first: bool
    crs: str | None
    attributes: dict[str, str] = {}

    def data(self) -> dict[str, Any]:
        """Returns the grid as the compiled module takes it."""
        return self._asdict()


def grid_of(values: Any, bounds: Bounds | None, origin: str, crs: str | None) -> Grid:
    """Returns values with their place. `origin` is "upper" where the first row is the northern one, or "lower"."""
    if origin not in ("upper", "lower"):
        raise MeshError(f'origin: "{origin}" is not possible here; write one of upper, lower.')
    place = None if bounds is None else [float(side) for side in bounds]
    if place is not None and len(place) != 4:
        raise MeshError("bounds are four numbers, (x0, y0, x1, y1).")
    if hasattr(values, "dims") and hasattr(values, "coords"):
        grid = _of_xarray(values)
    elif hasattr(values, "read") and hasattr(values, "transform") and hasattr(values, "nodata"):
        grid = _of_rasterio(values)
    else:
        grid = Grid(_filled(values), None, origin == "lower", None)
    return grid._replace(bounds=place or grid.bounds, crs=crs or grid.crs)


def _filled(values: Any) -> npt.NDArray[Any]:
    """Returns numbers, with NaN where a masked array has none."""
    if isinstance(values, np.ma.MaskedArray):
        kind = values.dtype if values.dtype.kind == "f" else np.dtype(np.float32 if values.itemsize < 4 else np.float64)
        masked: Any = values.astype(kind)
        return np.asarray(masked.filled(np.nan))
    array = np.asarray(values)
    if array.dtype.kind == "b":
        return array.astype(np.uint8)
    if array.dtype == np.float16 or not array.dtype.isnative:
        return array.astype(np.float32 if array.dtype.itemsize <= 4 and array.dtype.kind == "f" else np.float64)
    return array


def _of_rasterio(dataset: Any) -> Grid:
    """Returns the first band of a data set with its scale, its offset and its unit."""
    names = [str(getattr(color, "name", color)) for color in dataset.colorinterp]
    if names[0] == "red":
        raise MeshError("This is a picture in colours, and its bands are no values: give an array, as dataset.read(2).")
    if len(names) - names.count("alpha") > 1:
        note = f"The data set has {len(names)} bands, and the first is read: give an array, as dataset.read(2), for another."
        warnings.warn(note, MeshbrushWarning, stacklevel=5)
    place = dataset.transform
    if place.b or place.d or place.a <= 0:
        raise MeshError("The data set is turned or mirrored: warp it first, for example with rasterio.vrt.WarpedVRT.")
    values = _filled(dataset.read(1, masked=True))
    scale, offset = dataset.scales[0], dataset.offsets[0]
    if (scale, offset) != (1.0, 0.0):
        values = values * scale + offset
    sides = sorted((place.f, place.f + place.e * dataset.height))
    bounds = [place.c, sides[0], place.c + place.a * dataset.width, sides[1]]
    return Grid(values, bounds, place.e > 0, crs_text(dataset.crs), {"units": dataset.units[0] or ""})


def _of_xarray(array: Any) -> Grid:
    """Returns a data array. Its place and what stands for no value come from rioxarray where that is in use."""
    array = array.squeeze(drop=True)
    if array.ndim != 2:
        raise MeshError(f"A raster has two dimensions, and this array has {array.ndim}: select one time or level first.")
    x_name, y_name = (_axis(array, names) for names in (("x", "lon", "longitude"), ("y", "lat", "latitude")))
    array = array.transpose(y_name, x_name)
    x, y = (np.asarray(array.coords[name].values, dtype=np.float64) for name in (x_name, y_name))
    values = _filled(array.values)
    if x[0] > x[-1]:
        x, values = x[::-1], values[:, ::-1]
    west, east = _ends(x, x_name)
    south, north = _ends(y, y_name)
    crs = None
    marks = [array.attrs.get("_FillValue"), array.attrs.get("missing_value")]
    if hasattr(array, "rio"):
        marks, crs = [array.rio.nodata, *marks], crs_text(array.rio.crs)
    for mark in marks:
        if mark is not None and not np.isnan(mark):
            values = np.where(values == mark, np.nan, values)
    scale, offset = array.attrs.get("scale_factor", 1.0), array.attrs.get("add_offset", 0.0)
    if (scale, offset) != (1.0, 0.0):
        # A data array that was opened without decoding has them.
        values = values * scale + offset
    known = {name: str(array.attrs[name]) for name in _ATTRIBUTES if name in array.attrs}
    return Grid(values, [west, min(south, north), east, max(south, north)], bool(y[0] < y[-1]), crs, known)


#: Attributes of the CF conventions that say what heights and depths are.
_ATTRIBUTES = ("units", "positive", "standard_name")


def _axis(array: Any, names: tuple[str, ...]) -> Any:
    for dim in array.dims:
        if str(dim).lower() in names or array.coords.get(dim, array).attrs.get("axis", "").lower() == names[0]:
            return dim
    raise MeshError(f"The dimensions {', '.join(map(str, array.dims))} say no place: rename them to x and y.")


def _ends(centres: npt.NDArray[np.float64], name: Any) -> tuple[float, float]:
    """Returns the outer edges of the first and the last pixel."""
    if centres.size < 2:
        raise MeshError(f"The axis {name} has one value, and two are needed to know the size of a pixel.")
    steps = np.diff(centres)
    step = (centres[-1] - centres[0]) / (centres.size - 1)
    if not np.allclose(steps, step, rtol=1e-3, atol=0):
        raise MeshError(f"The values of the axis {name} are not evenly spaced. Interpolate them first.")
    return float(centres[0] - 0.5 * step), float(centres[-1] + 0.5 * step)


def sampled(
    function: Callable[[npt.NDArray[np.float64], npt.NDArray[np.float64]], Any], bounds: Bounds, pixels: int
) -> Grid:
    """Returns the values of a function at the centres of pixels, `pixels` along the longer side."""
    if isinstance(pixels, bool) or not isinstance(pixels, (int, np.integer)) or pixels < 1:
        raise MeshError(f"pixels = {pixels!r}: write how many pixels there are along the longer side, from 1.")
    x0, y0, x1, y1 = (float(side) for side in bounds)
    side = max(x1 - x0, y1 - y0) / pixels
    columns, rows = (max(1, round(length / side)) for length in (x1 - x0, y1 - y0))
    x = x0 + (np.arange(columns) + 0.5) * ((x1 - x0) / columns)
    y = y0 + (np.arange(rows) + 0.5) * ((y1 - y0) / rows)
    values = np.empty((rows, columns), dtype=np.float32)
    tile = max(1, _TILE // columns)
    for first in range(0, rows, tile):
        xs, ys = np.meshgrid(x, y[first : first + tile])
        found = function(xs, ys)
        if found is None:
            raise MeshError("The function returns None: it must return the values at x and y, as numbers or an array.")
        values[first : first + tile] = np.broadcast_to(np.asarray(found, dtype=np.float64), xs.shape)
    return Grid(values, [x0, y0, x1, y1], True, None)


#: Pixels for which a function is called at once.
_TILE = 1 << 18


def sample(
    values: Any, points: npt.ArrayLike, bounds: Bounds | None = None, *, origin: str = "upper"
) -> npt.NDArray[np.float64]:
    """Returns the values of a grid at points with shape (p, 2), linear between the centres of pixels.

    Beyond the outermost centres, the value is that of the nearest one; outside the bounds, and beside pixels without a
    value, it is NaN. `values` and `bounds` are as for `Layers.raster`.
    """
    grid = grid_of(values, bounds, origin, None)
    if grid.bounds is None:
        raise MeshError("bounds are missing; give bounds=(x0, y0, x1, y1).")
    x0, y0, x1, y1 = grid.bounds
    rows = grid.values if grid.lowest_first else grid.values[::-1]
    at = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    inside = (at[:, 0] >= x0) & (at[:, 0] <= x1) & (at[:, 1] >= y0) & (at[:, 1] <= y1)
    column = _clipped((at[:, 0] - x0) / (x1 - x0), rows.shape[1])
    row = _clipped((at[:, 1] - y0) / (y1 - y0), rows.shape[0])
    low_c, low_r = column.astype(np.intp), row.astype(np.intp)
    high_c, high_r = np.minimum(low_c + 1, rows.shape[1] - 1), np.minimum(low_r + 1, rows.shape[0] - 1)
    share_c, share_r = column - low_c, row - low_r
    lower = (1 - share_c) * rows[low_r, low_c] + share_c * rows[low_r, high_c]
    upper = (1 - share_c) * rows[high_r, low_c] + share_c * rows[high_r, high_c]
    return np.asarray(np.where(inside, (1 - share_r) * lower + share_r * upper, np.nan), dtype=np.float64)


def _clipped(share: npt.NDArray[np.float64], count: int) -> npt.NDArray[np.float64]:
    return np.asarray(np.clip(np.nan_to_num(share) * count - 0.5, 0.0, count - 1.0))
