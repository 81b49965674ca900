"""Meshes a terrain within errors, beside martini and delatin: python benches/terrain.py PROGRAM GRID.asc

Needs numpy, pymartini and pydelatin. All mesh the same 257 × 257 heights at the lower left of the grid, and the true error of
each mesh is found here, at every height: the largest difference from the plane of the triangle that it is in. *Honest* is the
largest parameter of martini whose mesh is within the error. Prints the table of docs/comparison.md.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from pydelatin import Delatin
from pymartini import Martini

SIDE = 257
ERRORS = (50, 20, 10, 5, 1)


def heights_of(file):
    """Returns the heights of a grid of ESRI, the lowest row first."""
    lines = pathlib.Path(file).read_text().split("\n", 6)
    grid = np.array(lines[6].split(), dtype=np.float32)
    columns, rows = int(lines[0].split()[1]), int(lines[1].split()[1])
    return grid.reshape(rows, columns)[::-1][:SIDE, :SIDE].copy()


def true_error(nodes, triangles, heights):
    """Returns the largest difference of a height from the triangle that it is in. Nodes are columns and rows."""
    worst = 0.0
    at_node = heights[nodes[:, 1], nodes[:, 0]].astype(float)
    for a, b, c in triangles:
        p, q, r = nodes[a], nodes[b], nodes[c]
        low, high = np.minimum(np.minimum(p, q), r), np.maximum(np.maximum(p, q), r)
        y, x = np.mgrid[low[1] : high[1] + 1, low[0] : high[0] + 1]
        cross = lambda u, v: (v[0] - u[0]) * (y - u[1]) - (v[1] - u[1]) * (x - u[0])
        whole = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        parts = [part / whole for part in (cross(q, r), cross(r, p), cross(p, q))]
        inside = np.logical_and.reduce([part >= -1e-12 for part in parts])
        plane = sum(part * at_node[n] for part, n in zip(parts, (a, b, c)))
        difference = np.abs(plane - heights[low[1] : high[1] + 1, low[0] : high[0] + 1])[inside]
        worst = max(worst, difference.max(initial=0.0))
    return worst


def ours(program, heights, error, folder):
    """Returns nodes, triangles and seconds of refinement."""
    rows = "\n".join(" ".join(f"{height:g}" for height in row) for row in heights[::-1])
    header = f"ncols {SIDE}\nnrows {SIDE}\nxllcorner -0.5\nyllcorner -0.5\ncellsize 1\n"
    pathlib.Path(folder, "grid.asc").write_text(header + rows + "\n")
    command = [program, "mesh", "--surface", "grid.asc", "--max-error", str(error), "--spacing", str(SIDE - 1)]
    said = subprocess.run([*command, "-o", "m.2dm", "--json"], cwd=folder, check=True, capture_output=True, text=True)
    text = pathlib.Path(folder, "m.2dm").read_text().splitlines()
    rows = lambda word: [line.split()[2:5] for line in text if line.startswith(word)]
    nodes = np.rint(np.array(rows("ND "), dtype=float)[:, :2]).astype(int)
    return nodes, np.array(rows("E3T "), dtype=int) - 1, json.loads(said.stdout)["seconds"]


def martini(heights, error):
    """Returns nodes, triangles and seconds of martini with its parameter."""
    start = time.perf_counter()
    tile = Martini(SIDE).create_tile(np.ascontiguousarray(heights))
    vertices, triangles = tile.get_mesh(error)
    seconds = time.perf_counter() - start
    return vertices.reshape(-1, 2).astype(int), triangles.reshape(-1, 3), seconds


def honest_martini(heights, error):
    """Returns martini's mesh of the largest parameter, to a hundredth, whose true error is within the error."""
    low, high = 0.0, float(error)
    while high - low > 0.01 * error:
        middle = 0.5 * (low + high)
        nodes, triangles, _ = martini(heights, middle)
        low, high = (middle, high) if true_error(nodes, triangles, heights) <= error else (low, middle)
    return martini(heights, low)


def delatin(heights, error):
    """Returns nodes, triangles and seconds of delatin."""
    start = time.perf_counter()
    mesh = Delatin(heights, max_error=error)
    seconds = time.perf_counter() - start
    columns, rows = np.rint(mesh.vertices[:, :2]).astype(int).T
    # Its rows count from the top.
    return np.column_stack([columns, SIDE - 1 - rows]), mesh.triangles, seconds


def main(program, grid):
    heights = heights_of(grid)
    print("| error | made by | triangles | true error | s |\n|---:|---|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for error in ERRORS:
            for name, make in (
                ("Meshbrush", lambda: ours(program, heights, error, folder)),
                ("martini", lambda: martini(heights, error)),
                ("martini, honest", lambda: honest_martini(heights, error)),
                ("delatin", lambda: delatin(heights, error)),
            ):
                nodes, triangles, seconds = make()
                found = true_error(nodes, triangles, heights)
                print(f"| {error} | {name} | {len(triangles):,} | {found:.2f} | {seconds:.3f} |", flush=True)


if __name__ == "__main__":
    main(str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2])
