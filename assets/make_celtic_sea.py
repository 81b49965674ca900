#!/usr/bin/env python3
"""Writes the coast and the depths of the example of the Celtic Sea. See README.md here."""

import json
import pathlib
import struct
import sys
import zlib

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


def packed(values):
    """Returns rows as 16-bit numbers less the one before, packed."""
    pairs = ((row, [0, *row[:-1]]) for row in values)
    steps = [(a - b) % 65536 for row, before in pairs for a, b in zip(row, before)]
    return zlib.compress(struct.pack(f"<{len(steps)}H", *steps), 9)


def write_depths(west, north, values, file):
    """Writes a GeoTIFF of longitudes and latitudes (EPSG:4326) with one value at each node."""
    strip = packed(values)
    step = 1 / STEPS
    keys = [1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 2, 2048, 0, 1, 4326]
    entries = [
        (256, "H", [len(values[0])]),
        (257, "H", [len(values)]),
        (258, "H", [16]),
        (259, "H", [8]),  # Deflate
        (262, "H", [1]),
        (273, "I", [8]),
        (277, "H", [1]),
        (278, "H", [len(values)]),
        (279, "I", [len(strip)]),
        (317, "H", [2]),  # differences along rows
        (339, "H", [1]),
        (33550, "d", [step, step, 0.0]),
        (33922, "d", [0.0, 0.0, 0.0, west, north, 0.0]),
        (34735, "H", keys),
    ]
    strip += b"\0" * (len(strip) % 2)
    directory, data = [struct.pack("<H", len(entries))], b""
    behind = 8 + len(strip) + 2 + 12 * len(entries) + 4
    for tag, kind, numbers in entries:
        value = struct.pack(f"<{len(numbers)}{kind}", *numbers)
        if len(value) > 4:
            place, data = struct.pack("<I", behind + len(data)), data + value
        else:
            place = value.ljust(4, b"\0")
        directory.append(struct.pack("<HHI", tag, {"H": 3, "I": 4, "d": 12}[kind], len(numbers)) + place)
    head = struct.pack("<2sHI", b"II", 42, 8 + len(strip))
    file.write_bytes(head + strip + b"".join(directory) + struct.pack("<I", 0) + data)


def main():
    coast, grid = sys.argv[1:]
    write_coast(sea(json.loads(pathlib.Path(coast).read_text())), FOLDER / "celtic_sea.geojson")
    (grid,) = rdata.read_rda(grid).values()
    write_depths(*depths(grid), FOLDER / "celtic_sea_depths.tif")


main()
