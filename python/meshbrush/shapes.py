"""Points, lines and polygons of other libraries, as the text of a GeoJSON file."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._errors import MeshError

#: What stands for shapes: a file, GeoJSON, an object with `__geo_interface__`, a ring or rings of points.
ShapesLike = Any


def as_path(value: object) -> str | None:
    """Returns the path that a value is, if it is one."""
    if isinstance(value, (str, os.PathLike)):
        path = os.fspath(value)
        return path if isinstance(path, str) else os.fsdecode(path)
    return None


def each_shape(shapes: Any) -> list[ShapesLike]:
    """Returns shapes one by one: those of a list, or what stands for shapes itself."""
    is_one = as_path(shapes) is not None or isinstance(shapes, dict) or hasattr(shapes, "__geo_interface__")
    return [shapes] if is_one or _points(shapes) is not None else list(shapes)


def geojson(shapes: ShapesLike, kind: str) -> bytes:
    """Returns shapes as GeoJSON. Arrays are `kind`: "Polygon", "LineString" or "MultiPoint"."""
    found = _geo_interface(shapes)
    if found is None:
        found = _of_arrays(shapes, kind)
    return json.dumps(found, default=str).encode()


def _geo_interface(shapes: ShapesLike) -> dict[str, Any] | None:
    interface = getattr(shapes, "__geo_interface__", None)
    if interface is not None:
        return _with_crs(_plain(dict(interface)), getattr(shapes, "crs", None))
    if isinstance(shapes, dict) and "type" in shapes:
        return shapes
    if isinstance(shapes, (list, tuple)) and shapes and all(hasattr(s, "__geo_interface__") for s in shapes):
        return {"type": "GeometryCollection", "geometries": [s.__geo_interface__ for s in shapes]}
    return None


#: Properties of features that are names.
_NAMES = ("name", "NAME", "Name", "title", "id")


def _plain(interface: dict[str, Any]) -> dict[str, Any]:
    """Returns features with their names only: other properties may be dates, or numbers that no JSON has."""
    if interface.get("type") == "FeatureCollection":
        return {"type": "FeatureCollection", "features": [_plain(dict(f)) for f in interface.get("features", ())]}
    if interface.get("type") == "Feature":
        own = interface.get("properties") or {}
        names = {key: own[key] for key in _NAMES if isinstance(own.get(key), (str, int, np.integer))}
        texts = {key: name if isinstance(name, str) else str(name) for key, name in names.items()}
        return {"type": "Feature", "properties": texts, "geometry": interface.get("geometry")}
    return interface


def crs_text(crs: Any) -> str | None:
    """Returns the code of a coordinate system of pyproj or rasterio, or its well-known text where it has none."""
    epsg = crs.to_epsg() if hasattr(crs, "to_epsg") else None
    if epsg is not None:
        return f"EPSG:{epsg}"
    text = crs.to_wkt() if crs is not None and hasattr(crs, "to_wkt") else None
    return text or None


def _with_crs(interface: dict[str, Any], crs: Any) -> dict[str, Any]:
    """Adds the coordinate system, which GeoJSON of geopandas does not have."""
    text = crs_text(crs)
    if text is not None and "crs" not in interface:
        interface["crs"] = {"type": "name", "properties": {"name": text}}
    return interface


def _of_arrays(shapes: ShapesLike, kind: str) -> dict[str, Any]:
    whole = _points(shapes)
    if kind == "MultiPoint":
        if whole is None:
            raise MeshError("Points are rows of two numbers, as in [(0, 0), (1, 2)].")
        return {"type": kind, "coordinates": whole.tolist()}
    parts = [whole] if whole is not None else _lists_of_points(shapes)
    if kind == "LineString":
        return {"type": "MultiLineString", "coordinates": [part.tolist() for part in parts]}
    return {"type": "Polygon", "coordinates": [_closed(part) for part in parts]}


def _lists_of_points(shapes: ShapesLike) -> list[np.ndarray[Any, Any]]:
    if isinstance(shapes, (Sequence, np.ndarray)) and len(shapes) > 0:
        parts = [_points(part) for part in shapes]
        if all(part is not None for part in parts):
            return [part for part in parts if part is not None]
    raise MeshError(
        "These are no shapes: give a file, GeoJSON, an object with __geo_interface__ (shapely, geopandas), one ring of "
        "points with two coordinates each, or a list of rings, the outer one first."
    )


def _points(values: Any) -> np.ndarray[Any, Any] | None:
    try:
        points = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    if points.ndim != 2 or points.shape[1] != 2:
        return None
    if not np.isfinite(points).all():
        raise MeshError("Both coordinates of a point must be finite.")
    return points


def _closed(ring: np.ndarray[Any, Any]) -> list[list[float]]:
    points: list[list[float]] = ring.tolist()
    if points and points[0] != points[-1]:
        points.append(points[0])
    return points
