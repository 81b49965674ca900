"""Checks which part of the boundary is open in the files of solvers, against a search of its own in degrees.

Seas are cut by boxes of longitudes and latitudes, meshed in degrees or in the plane of a projection, and written in seven
formats: the open nodes are those of the boundary edges along the sides of the box, but beside nodes that the mesh could not
put onto the outline. Seas that no box cuts have none, and the program says so.

Usage: open_sea.py PROGRAM
"""

import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

PROGRAM = Path(sys.argv[1]).resolve()
PROJECTIONS = ["none", "auto", "metres", "merc", "tmerc", "lcc", "stere", "UTM"]
KINDS = ["box", "coast", "two coasts", "islands", "arc", "land"]
ROUNDS = 200 if os.environ.get("MESHBRUSH_LONG") else 24
FILES = ["a.14", "a.gr3", "a.2dm", "a.slf", "a.mesh", "a.ww3", "a.dat"]
# How far a node may be from a side, as a share of the box: edges in a plane follow the curve of a side.
ON_SIDE = 1e-5


def ragged(rng, at, radius, corners):
    angles = [2 * math.pi * n / corners for n in range(corners)]
    return [[at[0] + radius[0] * r * math.cos(a), at[1] + radius[1] * r * math.sin(a)] for a, r in ((a, 0.7 + 0.3 * rng.random()) for a in angles)]


def sea(rng, kind, west, south, width, height):
    """Returns the rings of a sea in degrees. Longitudes may exceed 180."""
    place = lambda x, y: [west + width * x, south + height * y]
    coast = [place(0.55 + 0.2 * math.sin(7 * t) + 0.02 * rng.random(), t) for t in np.linspace(0, 1, 30)]
    islands = [ragged(rng, place(0.2, 0.2 + 0.3 * n), [0.08 * width, 0.08 * height], 12) for n in range(2)]
    box = [place(0, 0), place(1, 0), place(1, 1), place(0, 1)]
    if kind == "box":
        return [box]
    if kind == "coast":
        return [[place(0, 0), *coast, place(0, 1)]]
    if kind == "two coasts":
        north = [place(x, 0.75 + 0.1 * math.sin(9 * x) + 0.02 * rng.random()) for x in np.linspace(1, 0, 25)]
        return [[place(0, 0), place(1, 0), *north]]
    if kind == "islands":
        return [[place(0, 0), *coast, place(0, 1)], *islands]
    if kind == "arc":
        arc = [place(0.5 - 0.45 * math.cos(t), 0.3 + 0.6 * math.sin(t)) for t in np.linspace(0, math.pi, 41)]
        shore = [place(0.95 - 0.9 * t, 0.3 - 0.2 * rng.random() * min(t, 1 - t)) for t in np.linspace(0.02, 0.98, 40)]
        return [[*arc, *shore]]
    return [ragged(rng, place(0.5, 0.5), [0.45 * width, 0.45 * height], 60)]


def projection_for(name, longitude, latitude):
    if name != "UTM":
        return name
    longitude = (longitude + 180) % 360 - 180
    return f"EPSG:{(32700 if latitude < 0 else 32600) + int((longitude + 180) // 6) + 1}"


def nodes_and_triangles(path):
    lines = path.read_text().splitlines()
    triangles, nodes = map(int, lines[1].split()[:2])
    places = np.array([line.split()[1:3] for line in lines[2 : 2 + nodes]], dtype=float)
    corners = [tuple(int(node) for node in line.split()[2:5]) for line in lines[2 + nodes : 2 + nodes + triangles]]
    return places, corners, lines[2 + nodes + triangles :]


def open_of_strings(path):
    rest = iter(nodes_and_triangles(path)[2])
    strings, _ = int(next(rest).split()[0]), next(rest)
    return {int(next(rest).split()[0]) for _ in range(strings) for _ in range(int(next(rest).split()[0]))}


def open_of_2dm(path):
    text = path.read_text()
    names = dict(re.findall(r"# nodestring (\d+): (.*)", text))
    found, nodes = set(), []
    for line in text.splitlines():
        if line.startswith("NS "):
            numbers = [int(number) for number in line.split()[1:]]
            ends = [n for n, number in enumerate(numbers) if number < 0]
            nodes += [abs(number) for number in numbers[: ends[0] + 1 if ends else None]]
            if ends:
                if names[str(numbers[-1])].startswith("open"):
                    found |= set(nodes)
                nodes = []
    return found


def open_of_cli(path):
    rows = [line.split() for line in path.read_text().splitlines()]
    return {int(row[11]) for row in rows if row[:3] == ["5", "4", "4"]}


def open_of_mike(path):
    lines = path.read_text().splitlines()
    count = int(lines[0].split()[2])
    rows = [line.split() for line in lines[1 : 1 + count]]
    return {int(row[0]) for row in rows if int(row[4]) > 1}


def open_of_ww3(path):
    lines = path.read_text().splitlines()
    start = lines.index("$Elements") + 2
    rows = [line.split() for line in lines[start : start + int(lines[start - 1])]]
    return {int(row[-1]) for row in rows if row[1] == "15"}


def open_of_fvcom(path):
    return {int(line.split()[1]) for line in path.read_text().splitlines()[1:]}


READERS = {
    **{"a.14": open_of_strings, "a.gr3": open_of_strings, "a.2dm": open_of_2dm, "a.cli": open_of_cli},
    **{"a.mesh": open_of_mike, "a.ww3": open_of_ww3, "a_obc.dat": open_of_fvcom},
}
# In these, an edge is open if both nodes are: nodes of land of one edge stay closed.
BY_NODES = {"a.cli", "a.mesh", "a_obc.dat"}


def boundary_edges(triangles):
    sides = Counter()
    for a, b, c in triangles:
        for edge in ((a, b), (b, c), (c, a)):
            sides[edge if edge[::-1] not in sides else edge[::-1]] += 1
    return [edge for edge, count in sides.items() if count == 1]


def search(places, triangles, box):
    """Returns the nodes of boundary edges along the sides of a box in degrees, and those of land of one edge."""
    west, south, width, height = box
    boundary = boundary_edges(triangles)
    x, y = ((places[:, 0] - west + 180) % 360 - 180) / width, (places[:, 1] - south) / height
    on = np.array([abs(y) < ON_SIDE, abs(x - 1) < ON_SIDE, abs(y - 1) < ON_SIDE, abs(x) < ON_SIDE])
    is_open = lambda edge: bool((on[:, edge[0] - 1] & on[:, edge[1] - 1]).any())
    found = {node for edge in boundary if is_open(edge) for node in edge}
    single = {node for edge in boundary if not is_open(edge) and set(edge) <= found for node in edge}
    return found, single


def near_gaps(places, triangles, rings, box):
    """Returns the boundary nodes that the mesh could not put onto the outline, and their neighbours along the boundary."""
    boundary = boundary_edges(triangles)
    nodes = np.array(sorted({node for edge in boundary for node in edge}))
    west, south, width, height = box
    scaled = lambda at: np.stack([((at[:, 0] - west + 180) % 360 - 180) / width, (at[:, 1] - south) / height], 1)
    at, least = scaled(places[nodes - 1]), np.full(len(nodes), np.inf)
    for ring in map(scaled, map(np.array, rings)):
        for start, along in zip(ring[:-1], np.diff(ring, axis=0)):
            share = np.clip((at - start) @ along / (along @ along), 0, 1)
            least = np.minimum(least, np.hypot(*(at - start - share[:, None] * along).T))
    off = set(nodes[least > ON_SIDE].tolist())
    assert len(off) < 0.04 * len(nodes), f"{len(off)} of {len(nodes)} nodes are not on the outline"
    return off | {node for edge in boundary if off & set(edge) for node in edge}


def check(folder, rng, number):
    kind, name = KINDS[number % len(KINDS)], PROJECTIONS[number // len(KINDS) % len(PROJECTIONS)]
    height = 10 ** rng.uniform(-1.5, 0.7)
    south = rng.uniform(-75, 80 - height) if name != "UTM" else rng.uniform(-75, 78 - height)
    width = min(height / math.cos(math.radians(south + height / 2)) * rng.uniform(0.7, 1.4), 5.5 if name == "UTM" else 40)
    west = rng.choice([rng.uniform(-175, 175 - width), rng.uniform(-width, 0) + 180 if name != "none" else 3.0])
    if name == "UTM":
        west = 6 * math.floor(west / 6) + 0.5 * (6 - width)
    if name == "lcc" and abs(south + height / 2) < 1:
        name = "merc"  # a conformal conic shows one side of the equator only
    rings = sea(rng, kind, west, south, width, height)
    rings = [[[x - 360 if x > 180 else x, y] for x, y in [*ring, ring[0]]] for ring in rings]
    (folder / "sea.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": rings}))
    projection = projection_for(name, west + width / 2, south)
    metres = 111e3 * max(height, width * math.cos(math.radians(south + height / 2)))
    size = f"{max(width, height) / 8}" if name == "none" else f"{metres / 8:.0f} m"
    command = [PROGRAM, "mesh", "--region", "sea.geojson", "--projection", projection, "--spacing", size, "--out-crs", "lonlat"]
    if name == "none":
        command = command[:-2]
    ran = subprocess.run([*command, *(part for file in FILES for part in ("-o", file))], cwd=folder, capture_output=True, text=True)
    told = f"{number}: {kind}, {projection}, {west} {south} {width} {height}\n{ran.stderr}"
    assert ran.returncode == 0, told
    places, triangles, _ = nodes_and_triangles(folder / "a.14")
    expected, single = search(places, triangles, (west, south, width, height))
    if kind in ("arc", "land"):
        expected = set()
        assert "open boundary" in ran.stderr, told
    else:
        assert expected, told
    gaps = near_gaps(places, triangles, rings, (west, south, width, height))
    for file, reader in READERS.items():
        difference = (reader(folder / file) ^ expected) - gaps
        where = [(node, node in expected, (places[node - 1] - (west, south)) / (width, height)) for node in sorted(difference)[:5]]
        assert not difference or (file in BY_NODES and difference <= single), f"{told}\n{file}: {where}"
    return len(expected)


def main():
    rng, nodes = random.Random(11), 0
    with tempfile.TemporaryDirectory() as name:
        for number in range(ROUNDS):
            nodes += check(Path(name), rng, number if ROUNDS > 48 else 2 * number + number // 3 % 2)
    print(f"{ROUNDS} seas, {nodes} open nodes in each of {len(READERS)} formats")


main()
