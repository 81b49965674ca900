"""Checks the sea beside land against Shapely: domains that are a box less polygons or lines of coast.

The land is islands and mainlands, most of it far from the box, as polygons or as lines in pieces, on any side of 180°. The
area of the sea and the lengths of its open sides and of its coasts are those of the box less the land.

Usage: land.py PROGRAM
"""

import json
import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from shapely import affinity
from shapely.geometry import LineString, Polygon, box, mapping
from shapely.ops import linemerge, unary_union

PROGRAM = Path(sys.argv[1]).resolve()
ROUNDS = 400 if os.environ.get("MESHBRUSH_LONG") else 32
KINDS = ["polygons", "polygons cut at 180°", "lines with land on the left", "lines of any direction", "islands", "both"]


def ragged(rng, at, radius, corners=24):
    angles = [2 * math.pi * n / corners for n in range(corners)]
    place = lambda a: radius * (0.6 + 0.4 * rng.random())
    return Polygon([(at[0] + r * math.cos(a), at[1] + r * math.sin(a)) for a, r in ((a, place(a)) for a in angles)])


def land_around(rng, frame, kind):
    """Returns disjoint polygons of land: islands in the frame, mainlands over its sides, and others far away."""
    west, south, east, north = frame.bounds
    width, height = east - west, north - south
    size = min(width, height)
    place = lambda x, y: (west + width * x, south + height * y)
    islands = [ragged(rng, place(0.3 + 0.2 * n, rng.uniform(0.4, 0.6)), 0.07 * size) for n in range(3)]
    far = [ragged(rng, place(rng.choice([-2, 3]), rng.uniform(0, 1)), 0.3 * size) for _ in range(3)]
    if kind == "islands":
        return [*islands, *far]
    sides = rng.sample([(0, 0.5), (1, 0.5), (0.5, 0), (0.5, 1), (0, 0)], rng.randint(1, 3))
    mainlands = [ragged(rng, place(*side), 0.3 * size, 40) for side in sides]
    lakes = [ragged(rng, polygon.centroid.coords[0], 0.05 * size, 7) for polygon in mainlands[:1]]
    joined = unary_union(mainlands)
    if not kind.startswith("polygons"):
        # The line around a lake would be one around an island.
        joined = unary_union([Polygon(part.exterior) for part in getattr(joined, "geoms", [joined])])
    islands = [island for island in islands if island.distance(joined) > 0.01 * size]
    if kind.startswith("polygons"):
        joined = joined.difference(lakes[0])
    return [*islands, *getattr(joined, "geoms", [joined]), *far]


def wrapped(at):
    return ((at[0] + 180) % 360 - 180, at[1])


def split_at_antimeridian(polygon):
    """Returns the parts on both sides of 180°, as RFC 7946 has them."""
    for turn in (-360, 0, 360):
        moved = affinity.translate(polygon.intersection(box(-180 + turn, -90, 180 + turn, 90)), -turn)
        yield from (part for part in getattr(moved, "geoms", [moved]) if part.area > 0)


def pieces(rng, ring):
    """Returns a ring in up to four lines that begin where others end."""
    cuts = sorted(rng.sample(range(len(ring) - 1), rng.randint(1, 4)))
    ends = [*cuts[1:], cuts[0] + len(ring) - 1]
    around = [*ring[:-1], *ring]
    return [around[start : end + 1] for start, end in zip(cuts, ends)]


def shapes(rng, kind, land):
    """Returns the geometries of a file of the land."""
    if kind == "polygons cut at 180°":
        return [mapping(part) for polygon in land for part in split_at_antimeridian(polygon)]
    if kind == "polygons":
        return [{"type": "Polygon", "coordinates": [[wrapped(at) for at in ring.coords] for ring in (p.exterior, *p.interiors)]} for p in land]
    lines, polygons = [], [] if kind != "both" else [land[0]]
    for polygon in land[len(polygons) :]:
        # Land is to the left.
        ring = list(polygon.exterior.coords)[:: 1 if polygon.exterior.is_ccw else -1]
        for line in [ring] if kind == "islands" else pieces(rng, ring):
            lines.append(line[::-1] if kind in ("lines of any direction", "islands") and rng.random() < 0.5 else line)
    rng.shuffle(lines)
    file = [{"type": "LineString", "coordinates": [wrapped(at) for at in line]} for line in lines]
    return file + shapes(rng, "polygons", polygons)


def mesh(folder, *options):
    ran = subprocess.run([PROGRAM, "mesh", *options, "--json"], cwd=folder, capture_output=True, text=True)
    return ran.returncode, ran.stdout, ran.stderr


def close(a, b, share=1e-6):
    return abs(a - b) <= share * max(abs(a), abs(b), 1e-3)


def check(folder, rng, number):
    kind = KINDS[number % len(KINDS)]
    height = 10 ** rng.uniform(-1, 0.7)
    width, south = height * rng.uniform(0.8, 1.5), rng.uniform(-70, 65)
    west = rng.uniform(178 - width, 180) if number % 2 or "180" in kind else rng.uniform(-170, 170 - 2 * width)
    frame = box(west, south, west + width, south + height)
    land = land_around(rng, frame, kind)
    sea = frame.difference(unary_union(land))
    features = [{"type": "Feature", "properties": {}, "geometry": shape} for shape in shapes(rng, kind, land)]
    (folder / "land.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    east = west + width - (360 if west + width > 180 and rng.random() < 0.5 else 0)
    bounds = f"--bounds={west},{south},{east},{south + height}"
    options = ["--land", "land.geojson", bounds, "--spacing", f"{max(width, height) / 8}", "--parts", "all"]
    code, out, error = mesh(folder, *options)
    told = f"{number}: {kind}, {bounds}\n{error}"
    assert code == 0, told
    answer = json.loads(out)
    assert close(answer["region_area"], sea.area), f"{told}\n{answer['region_area']} for {sea.area}"
    # The same part of a larger sea.
    around = affinity.scale(frame, 3, 2).intersection(box(-400, -90, 400, 90)).difference(unary_union(land))
    parts = [part for polygon in getattr(around, "geoms", [around]) for part in split_at_antimeridian(polygon)]
    (folder / "sea.geojson").write_text(json.dumps({"type": "GeometryCollection", "geometries": [mapping(part) for part in parts]}))
    code, out, error = mesh(folder, "--region", "sea.geojson", *options[2:])
    assert code == 0, f"{told}\n{error}"
    assert close(json.loads(out)["region_area"], sea.area), f"{told}\nas a region: {json.loads(out)['region_area']} for {sea.area}"
    boundary = unary_union([sea.boundary])
    on_frame = boundary.intersection(frame.boundary.buffer(1e-9 * width)).length
    lengths = {kind: sum(piece["length"] for piece in answer["boundary"] if piece["type"] == kind) for kind in ("open", "land", "island")}
    assert close(lengths["open"], on_frame, 0.02), f"{told}\n{lengths} for {on_frame}"
    # The mesh cuts corners of coasts.
    assert 0.8 < (lengths["land"] + lengths["island"]) / (boundary.length - on_frame) < 1.001, f"{told}\n{lengths} for {boundary.length}"
    metres = [*options[:3], "--projection", "auto", "--spacing", f"{111e3 * max(width, height) / 8:.0f} m", "--parts", "all"]
    code, out, error = mesh(folder, *metres)
    assert code == 0, f"{told}\n{error}"
    # A coarse mesh can miss what is shorter than its triangles.
    long = {(piece["name"], piece["type"]) for piece in answer["boundary"] if piece["length"] > 0.2 * height}
    found = {(piece["name"], piece["type"]) for piece in json.loads(out)["boundary"]}
    assert long <= found, f"{told}\n{long - found}"
    return len(answer["boundary"])


def check_sentences(folder):
    """Lines that do not part land from water are named, and so is land that is elsewhere."""
    line = lambda *points: {"type": "LineString", "coordinates": points}
    box_of = ["--bounds=0,0,1,1", "--spacing", "0.2"]
    for shape, expected in [
        (line([-1, 0.5], [0.25, 0.75]), "end inside the frame, at 0.25, 0.75"),
        (line([3, 3], [4, 4]), "none of the land lies in the frame"),
        ({"type": "MultiLineString", "coordinates": [[[-1, 0.3], [2, 0.3]], [[-1, 0.6], [2, 0.6]]]}, "name a place in the sea"),
        (mapping(box(-1, -1, 2, 2)), "covers the whole frame"),
    ]:
        (folder / "land.geojson").write_text(json.dumps(shape))
        code, _, error = mesh(folder, "--land", "land.geojson", *box_of)
        assert (code != 0 and expected.lower() in error.lower()) or (expected.startswith("name a") and code == 0), f"{code} {error}"
    (folder / "plane.geojson").write_text(json.dumps(mapping(box(0, 0, 900, 700))))
    code, _, error = mesh(folder, "--region", "plane.geojson", "--bounds=100,0,50,10", "--spacing", "5")
    assert code != 0 and "the east of the bounds, 50, is less than their west, 100" in error, f"{code} {error}"
    code, out, _ = mesh(folder, "--land", "land.geojson", *box_of, "--sea", "0.5,0.5")
    assert code != 0, out


def main():
    seed = int(os.environ.get("MESHBRUSH_SEED", "1"))
    with tempfile.TemporaryDirectory() as folder:
        rng = random.Random(seed)
        found = sum(check(Path(folder), rng, number) for number in range(ROUNDS))
        check_sentences(Path(folder))
    print(f"{ROUNDS} seas beside land: area, open sides and coasts of {found} pieces are those of Shapely")


main()
