#!/usr/bin/env python3
"""Writes the coast and the depths of the example of the Celtic Sea. See README.md here."""

import json
import pathlib
import sys

import geotiff
import rdata
from shapely.geometry import Polygon, box
from shapely.ops import unary_union

FOLDER = pathlib.Path(__file__).parent
# Longitudes and latitudes of the frame of the coast: a little more than the domain of the example.
FRAME = (-7, 47.3, 0, 52)
# Steps of the grid of depths per degree.
STEPS = 60


def land(topology):
    """Returns the polygons of a TopoJSON topology."""
    (sx, sy), (tx, ty) = topology["transform"]["scale"], topology["transform"]["translate"]
    arcs = []
    for steps in topology["arcs"]:
        x = y = 0
        arc = []
        for dx, dy in steps:
            x, y = x + dx, y + dy
            arc.append((x * sx + tx, y * sy + ty))
        arcs.append(arc)

    def ring(numbers):
        """An arc with the number -1 - n is arc n, backwards; each begins where the one before it ends."""
        points = []
        for number in numbers:
            arc = arcs[number] if number >= 0 else arcs[~number][::-1]
            points += arc[1:] if points else arc
        return points

    for geometry in topology["objects"]["land"]["geometries"]:
        polygons = [geometry["arcs"]] if geometry["type"] == "Polygon" else geometry["arcs"]
        for outer, *holes in polygons:
            polygon = Polygon(ring(outer), [ring(hole) for hole in holes])
            yield polygon if polygon.is_valid else polygon.buffer(0)


def sea(topology):
    """Returns the frame less the land: its largest connected part."""
    frame = box(*FRAME)
    parts = frame.difference(unary_union([polygon.intersection(frame) for polygon in land(topology)]))
    return max(getattr(parts, "geoms", [parts]), key=lambda part: part.area)


def write_coast(polygon, file):
    rings = [[[round(x, 4), round(y, 4)] for x, y in ring.coords] for ring in [polygon.exterior, *polygon.interiors]]
    geometry = {"type": "Polygon", "coordinates": rings}
    file.write_text(json.dumps(geometry, separators=(",", ":")) + "\n")


def depths(grid):
    """Returns west, north and rows from the north of whole metres of water in the frame, 0 on land."""
    west, south, east, north = (round(side * STEPS) for side in FRAME)
    of = {name: [round(float(value) * STEPS) for value in grid.coords[name].values] for name in grid.dims}
    columns = [n for n, lon in enumerate(of[grid.dims[0]]) if west - 1 <= lon <= east + 1]
    rows = [n for n, lat in enumerate(of[grid.dims[1]]) if south - 1 <= lat <= north + 1]
    values = [[max(0, -int(grid.values[x, y])) for x in columns] for y in reversed(rows)]
    return of[grid.dims[0]][columns[0]] / STEPS, of[grid.dims[1]][rows[-1]] / STEPS, values


def main():
    coast, grid = sys.argv[1:]
    write_coast(sea(json.loads(pathlib.Path(coast).read_text())), FOLDER / "celtic_sea.geojson")
    (grid,) = rdata.read_rda(grid).values()
    west, north, values = depths(grid)
    geotiff.write(west, north, 1 / STEPS, values, FOLDER / "celtic_sea_depths.tif")


main()
