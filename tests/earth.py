"""Checks meshes of seas against PROJ: where their nodes lie, and how long their edges are on the ellipsoid.

Usage: earth.py PROGRAM
"""

import json
import math
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from pyproj import CRS, Geod, Transformer

PROGRAM = Path(sys.argv[1]).resolve()
GEOD = Geod(ellps="WGS84")
# West, south, degrees of longitude and of latitude: from 75° S to 80° N, one across the antimeridian.
COASTS = {
    "Ross Sea": (170, -76, 15, 5),
    "Chile": (-76, -46, 4, 8),
    "Fiji": (176, -19, 7, 4),
    "Java Sea": (106, -7, 8, 4),
    "Guinea": (-2, -2, 9, 6),
    "Florida": (-83, 24, 5, 4),
    "Aegean": (22, 35, 6, 6),
    "Baltic": (16, 54, 8, 6),
    "Lofoten": (9, 66, 10, 4),
    "Svalbard": (10, 76, 20, 4),
}
PROJECTIONS = ["auto", "merc", "tmerc", "lcc", "stere"]
# Codes of the EPSG register in which a coast is exported.
CODES = {
    "Ross Sea": [3031, 32759],
    "Fiji": [32760, 32701],
    "Florida": [32617, 26917, 3395, 3857],
    "Aegean": [32635, 25835],
    "Baltic": [3034, 3006, 3067],
    "Svalbard": [3413, 3995, 25833],
}
# Those of them in which no mesh is made: not conformal on the ellipsoid.
NO_PLANES = [3857]
SPACING_M = 32_000
# Triangles of this share of the spacing of a coarse grid stay, so that their edges are as long as they may be.
TARGET_SHARE = 1 / 8


def ring(name, west, south, width, height):
    """A ragged ring in degrees."""
    rng = random.Random(name)
    points = []
    for n in range(120):
        angle = 2 * math.pi * n / 120
        radius = 0.32 + 0.13 * rng.random()
        lon, lat = west + width * (0.5 + radius * math.cos(angle)), south + height * (0.5 + radius * math.sin(angle))
        points.append([lon - 360 if lon > 180 else lon, lat])
    return points + points[:1]


def run(folder, *arguments):
    ran = subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True)
    return ran.returncode, ran.stderr, ran.stdout


def table(path, columns):
    lines = path.read_text().splitlines()
    rows = [line for line in lines if line.strip() and not line.startswith("#")]
    count = int(rows[0].split()[0])
    return np.array([row.split()[1 : 1 + columns] for row in rows[1 : 1 + count]], dtype=float)


def mesh_of(folder, projection, target_m, *output):
    mesh = ["mesh", "--region", "coast.geojson", "--projection", projection, "--spacing", f"{SPACING_M} m"]
    return run(folder, *mesh, "--target", f"{target_m!r} m", "--boundary", "fitted", *output)


def target_of(folder, projection):
    """Returns a target in metres that triangles in the plane of a projection have, or why there is no such mesh."""
    status, text, summary = mesh_of(folder, projection, 1e6, "--boundary-diameter", "1000 km", "--json")
    return (TARGET_SHARE * json.loads(summary)["spacing"], text) if status == 0 else (None, text)


def compare(name, system, degrees, plane, tolerance_m):
    """Fails where points of a plane are not where PROJ says."""
    to_plane = Transformer.from_crs(system.geodetic_crs, system, always_xy=True)
    off = np.abs(np.column_stack(to_plane.transform(degrees[:, 0], degrees[:, 1])) - plane).max()
    assert off < tolerance_m, f"{name} in {system.to_string()}: a node is {off} m from its place"
    return off


def compare_figures(name, plane, summary, degrees, triangles, lengths):
    """Fails where lengths and areas that the program says are not those on the ellipsoid."""
    equal_area = CRS.from_proj4("+proj=laea +lat_0={1} +lon_0={0} +ellps=WGS84".format(*degrees[len(degrees) // 2]))
    flat = np.column_stack(Transformer.from_crs(equal_area.geodetic_crs, equal_area, always_xy=True).transform(*degrees.T))
    a, b, c = (flat[triangles[:, n] - triangles.min()] for n in range(3))
    (p, q) = (b - a, c - a)
    area = 0.5 * np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()
    found = summary["statistics"]
    # Edges are straight in the plane, geodesics are a little shorter.
    off = [found["shortest_edge"] / lengths.min() - 1, found["longest_edge"] / lengths.max() - 1, summary["area"] / area - 1]
    assert all(-1e-8 < one < 1e-5 for one in off[:2]) and abs(off[2]) < 1e-4, f"{name} in {plane}: {off}"
    return max(map(abs, off))


def check_mesh(folder, name, projection, known):
    """Compares a mesh with PROJ, unless it is in a plane that is known, and returns its nodes and edges."""
    target_m, text = target_of(folder, projection)
    if target_m is None:
        # Some places do not suit some projections; one of `auto` does.
        assert projection != "auto", f"{name}: {text}"
        return 0, 0
    plane = re.search(r"in the plane (\+proj=.*? \+units=m)", text).group(1)
    if plane in known:
        return 0, 0
    known.add(plane)
    status, text, summary = mesh_of(folder, projection, target_m, "--json", "-o", "m.node")
    assert status == 0, text
    degrees, triangles = table(folder / "m.node", 2), table(folder / "m.ele", 3).astype(int)
    status, text, _ = mesh_of(folder, projection, target_m, "--out-crs", "plane", "-o", "p.node")
    assert status == 0, text
    is_code = projection.startswith("EPSG:")
    system, tolerance_m = (CRS.from_string(projection), 1e-3) if is_code else (CRS.from_proj4(plane), 1e-6)
    off = compare(name, system, degrees, table(folder / "p.node", 2), tolerance_m)
    sides = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    a, b = (degrees[end - triangles.min()] for end in np.unique(np.sort(sides), axis=0).T)
    lengths = GEOD.inv(a[:, 0], a[:, 1], b[:, 0], b[:, 1])[2]
    # Where the plane is true to scale, edges are as long as the target, but for rounding.
    over = int((lengths > target_m * (1 + 1e-9)).sum())
    figures = compare_figures(name, plane, json.loads(summary), degrees, triangles, lengths)
    print(f"{name:10} {projection:5} figures within {figures:.0e}, {len(degrees):7} nodes within {off:.0e} m, longest edge {lengths.max() / target_m:.6f} of its target")
    assert over == 0, f"{name} in {plane}: {over} edges are longer than {target_m} m on the ellipsoid"
    return len(degrees), len(lengths)


def check_codes(folder, name):
    """Compares exports in systems of the EPSG register with PROJ, and returns the number of nodes."""
    nodes = 0
    degrees = None
    for code in CODES.get(name, []):
        if degrees is None:
            target_m, _ = target_of(folder, "auto")
            mesh_of(folder, "auto", target_m, "--out-crs", "lonlat", "-o", "m.node")
            degrees = table(folder / "m.node", 2)
        status, text, _ = mesh_of(folder, "auto", target_m, "--out-crs", f"EPSG:{code}", "-o", "p.node")
        assert status == 0, text
        # The ellipsoids of ETRS89 and NAD83 differ by a tenth of a millimetre from WGS 84.
        off = compare(name, CRS.from_epsg(code), degrees, table(folder / "p.node", 2), 1e-3)
        print(f"{name:10} EPSG:{code} {len(degrees):5} nodes within {off:.0e} m")
        nodes += len(degrees)
    return nodes


def main():
    nodes = edges = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, place in COASTS.items():
            polygon = {"type": "Polygon", "coordinates": [ring(name, *place)]}
            (folder / "coast.geojson").write_text(json.dumps(polygon))
            known = set()
            codes = [f"EPSG:{code}" for code in CODES.get(name, []) if code not in NO_PLANES]
            for projection in PROJECTIONS + codes:
                counted = check_mesh(folder, name, projection, known)
                nodes, edges = nodes + counted[0], edges + counted[1]
            nodes += check_codes(folder, name)
    print(f"{nodes} nodes and {edges} edges agree with PROJ")
    assert nodes >= 1_000_000, "too few nodes were compared"


main()
