"""Where to mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .shapes import ShapesLike, as_path, geojson

_MEMORY = "domain.geojson"


class Domain:
    """The domain of a mesh: a rectangle, or a part of it given by polygons or a formula.

    `shape` is a file of polygons (GeoJSON, shapefile or GeoPackage), GeoJSON as a dictionary, an object with
    `__geo_interface__` such as a geometry of shapely or a table of geopandas, one ring of points with shape (n, 2), or a
    list of rings, the outer one first. Names of polygons come from the property `name` of their features.
    """

    def __init__(self, shape: ShapesLike) -> None:
        path = as_path(shape)
        if isinstance(shape, Domain):
            self._tables, self._given = dict(shape._tables), list(shape._given)
        elif path is not None:
            self._tables, self._given = {"region": path}, []
        else:
            self._tables = {"region": _MEMORY}
            self._given = [(_MEMORY, geojson(shape, "Polygon"))]
            if not (isinstance(shape, dict) or hasattr(shape, "__geo_interface__")):
                # Nobody says that the numbers of an array are degrees, though they can be.
                self._tables["unit"] = "none"

    _tables: dict[str, Any]
    _given: list[tuple[str, Any]]

    @classmethod
    def _of(cls, **tables: Any) -> Domain:
        domain = cls.__new__(cls)
        domain._tables, domain._given = tables, []
        return domain

    @classmethod
    def rectangle(cls, x0: float, y0: float, x1: float, y1: float) -> Domain:
        """Returns the rectangle with these sides, in world units."""
        return cls._of(bounds=[float(x0), float(y0), float(x1), float(y1)])

    @classmethod
    def read(cls, path: Any) -> Domain:
        """Returns what the polygons of a file cover. The file is read when a document is made."""
        return cls._of(region=str(as_path(path) or path))

    @classmethod
    def formula(cls, inside: str, bounds: Sequence[float]) -> Domain:
        """Returns where a formula in `x`, `y`, `r` and `theta` is not 0, in the rectangle x0, y0, x1, y1.

        It is made of the coarse triangles at whose three corners the formula is not 0: `spacing` decides how near its
        boundary is.
        """
        return cls._of(bounds=[float(side) for side in bounds], inside=inside)

    def __repr__(self) -> str:
        shown = {key: value for key, value in self._tables.items() if value != _MEMORY}
        inside = ", ".join(f"{key}={value!r}" for key, value in shown.items())
        return f"<meshbrush.Domain {inside or 'of polygons'}>"
