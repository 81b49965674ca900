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

    Of the polygons, only the part in `bounds` counts, where these are given: west, south, east and north in the coordinates
    of the shape, as in (-6, 47, -2, 49). In degrees the east may be less than the west, across 180°.
    """

    def __init__(self, shape: ShapesLike, bounds: Sequence[float] | None = None) -> None:
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
        if bounds is not None:
            self._tables["bounds"] = [float(side) for side in bounds]

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
    def sea(
        cls, land: ShapesLike, bounds: Sequence[float] | None = None, place: Sequence[float] | None = None
    ) -> Domain:
        """Returns the rectangle `bounds` less the land in it, which polygons or lines of coast give.

        `land` is a file, or shapes as for a domain; an array, or a list of arrays, is lines. Bounds are west, south, east
        and north in the coordinates of the land; without them the rectangle is one around the land. Lines are closed along
        the rectangle, and closed lines are islands. `place` is a place in the sea, where lines do not tell on which side it
        is. The sides of the rectangle are the open boundary.
        """
        path = as_path(land)
        domain = cls._of(land=path if path is not None else _MEMORY)
        if path is None:
            domain._given = [(_MEMORY, geojson(land, "LineString"))]
            if not (isinstance(land, dict) or hasattr(land, "__geo_interface__")):
                domain._tables["unit"] = "none"
        if bounds is not None:
            domain._tables["bounds"] = [float(side) for side in bounds]
        if place is not None:
            domain._tables["sea"] = [float(number) for number in place]
        return domain

    @classmethod
    def read(cls, path: Any) -> Domain:
        """Returns what the polygons of a file cover. The file is read when a document is made."""
        return cls._of(region=str(as_path(path) or path))

    @classmethod
    def formula(cls, inside: str, bounds: Sequence[float]) -> Domain:
        """Returns where a formula in `x`, `y`, `r` and `theta` is not 0, in the rectangle x0, y0, x1, y1.

        Nodes lie on the line where the formula becomes 0 or NaN. With `boundary="report"` the domain is made of the
        coarse triangles at whose three corners it is not 0.
        """
        return cls._of(bounds=[float(side) for side in bounds], inside=inside)

    def __repr__(self) -> str:
        shown = {key: value for key, value in self._tables.items() if value != _MEMORY}
        inside = ", ".join(f"{key}={value!r}" for key, value in shown.items())
        return f"<meshbrush.Domain {inside or 'of polygons'}>"
