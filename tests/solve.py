"""`meshbrush solve` against equations that are assembled and solved here, from the nodes and triangles of its file.

Called by tests/run with the program to test: solve.py PROGRAM. Needs numpy and meshio. Data are polynomials that every usual rule
integrates exactly, so the values at the nodes must be the same to 1e-10 of the largest.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np

MESHES = {
    "a square": ["--spacing", "0.2", "--target", "0.06 + 0.1*x"],
    "cells that are not square": ["--domain", "-1,0,2,1.3", "--spacing", "0.31", "--target", "0.1"],
    "a disc": ["--domain", "-1,-1,1,1", "--inside", "r < 0.9", "--spacing", "0.25", "--target", "0.12"],
    "an L": ["--domain", "-1,-1,1,1", "--inside", "not (x > 0 and y < 0)", "--spacing", "0.25", "--target", "0.02 + 0.2*r"],
    "a coarse grid": ["--spacing", "0.03", "--target", "1"],
}


class Data:
    """A problem: coefficients as functions, and conditions as (test of a place, kind, functions)."""

    def __init__(self, options, a, b, c, f, conditions):
        self.options, self.a, self.b, self.c, self.f, self.conditions = options, a, b, c, f, conditions


ONE = lambda p: np.ones(len(p))
PROBLEMS = {
    "values": Data(
        [["--source", "1+2*x-y"], ["--dirichlet", "all=x-3*y"]],
        ONE, None, 0.0, lambda p: 1 + 2 * p[:, 0] - p[:, 1],
        [(lambda p, box: True, "value", lambda p: p[:, 0] - 3 * p[:, 1])],
    ),
    "all kinds": Data(
        [["--diffusion", "3+x+y"], ["--reaction", "2"], ["--source", "4*y"], ["--convection", "3", "-1"],
         ["--robin", "all=2;1-y"], ["--dirichlet", "open north=1+x"], ["--neumann", "open west=y"]],
        lambda p: 3 + p[:, 0] + p[:, 1], (3.0, -1.0), 2.0, lambda p: 4 * p[:, 1],
        [
            (lambda p, box: abs(p[1] - box[3]) < 1e-9, "value", lambda p: 1 + p[:, 0]),
            (lambda p, box: abs(p[0] - box[0]) < 1e-9, "flux", (0.0, lambda p: p[:, 1])),
            (lambda p, box: True, "flux", (2.0, lambda p: 1 - p[:, 1])),
        ],
    ),
    "one side": Data(
        [["--diffusion", "0.001"], ["--reaction", "0.5"], ["--source", "x"], ["--robin", "all=0.25;x+y"]],
        lambda p: 0.001 * np.ones(len(p)), None, 0.5, lambda p: p[:, 0],
        [(lambda p, box: True, "flux", (0.25, lambda p: p[:, 0] + p[:, 1]))],
    ),
}


def boundary_edges(triangles):
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, count = np.unique(np.sort(edges, 1), axis=0, return_index=True, return_counts=True)
    return edges[first[count == 1]]


def solved(points, triangles, data):
    count = len(points)
    matrix, right = np.zeros((count, count)), np.zeros(count)
    corners = points[triangles]
    area = 0.5 * np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    # The gradients of barycentric coordinates, by inverting a 3 × 3 matrix.
    system = np.concatenate([corners, np.ones(corners.shape[:2] + (1,))], 2)
    gradients = np.linalg.inv(system)[:, :2, :].transpose(0, 2, 1)
    middle = corners.mean(1)
    between = [(corners[:, i] + corners[:, j]) / 2 for i, j in ((1, 2), (2, 0), (0, 1))]
    at_middles = [data.f(place) for place in between]
    for i in range(3):
        for j in range(3):
            entry = data.a(middle) * area * (gradients[:, i] * gradients[:, j]).sum(1)
            entry += data.c * area / (6 if i == j else 12)
            if data.b:
                entry += area / 3 * (gradients[:, j] @ np.array(data.b))
            np.add.at(matrix, (triangles[:, i], triangles[:, j]), entry)
        # The midpoints of the sides: a hat function is 1/2 at two of them.
        load = area / 3 * sum(0.5 * at_middles[k] for k in range(3) if k != i)
        np.add.at(right, triangles[:, i], load)
    box = [*points.min(0), *points.max(0)]
    fixed = {}
    for edge in boundary_edges(triangles):
        ends = points[edge]
        length = np.linalg.norm(ends[1] - ends[0])
        kind, rule = next(
            (kind, rule) for test, kind, rule in data.conditions if test(ends[0], box) and test(ends[1], box)
        )
        if kind == "value":
            fixed.update(zip(edge, rule(ends)))
            continue
        transfer, flux = rule
        # Simpson's rule.
        g = flux(np.array([ends[0], ends.mean(0), ends[1]]))
        right[edge] += length / 6 * np.array([g[0] + 2 * g[1], 2 * g[1] + g[2]])
        matrix[np.ix_(edge, edge)] += transfer * length / 6 * np.array([[2, 1], [1, 2]])
    held = np.array(sorted(fixed), dtype=int)
    values = np.zeros(count)
    values[held] = [fixed[node] for node in held]
    free = np.setdiff1d(np.arange(count), held)
    values[free] = np.linalg.solve(matrix[np.ix_(free, free)], right[free] - matrix[np.ix_(free, held)] @ values[held])
    return values


def main(program):
    checked = 0
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "u.vtu"
        for mesh_name, mesh_options in MESHES.items():
            for name, data in PROBLEMS.items():
                conditions, options = data.conditions, data.options
                if mesh_name == "a disc":
                    # It has one piece, and none of the sides.
                    conditions = [own for own in conditions if own[0](np.array([9.0, 9.0]), [0, 0, 1, 1])]
                    options = [group for group in options if "open " not in " ".join(group)]
                options = [word for group in options for word in group]
                command = [program, "solve", *mesh_options, *options, "-o", str(file), "--json"]
                answer = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
                found = meshio.read(file)
                points, triangles = found.points[:, :2], found.cells_dict["triangle"]
                assert len(points) == answer["nodes"]
                data = Data(options, data.a, data.b, data.c, data.f, conditions)
                expected = solved(points, triangles, data)
                values = found.point_data["u"]
                away = np.abs(values - expected).max() / max(1e-300, np.abs(expected).max())
                assert away < 1e-9, f"{mesh_name}, {name}: {away}"
                checked += 1
    print(f"{checked} solutions have the values of another assembly and a direct solver")


if __name__ == "__main__":
    main(sys.argv[1])
