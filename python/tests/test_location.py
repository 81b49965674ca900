"""A million points: where the module says that they lie, by code of its own; and the table of the command line."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest

import meshbrush as mb
from coasts import bay
from conftest import run_program


def document() -> mb.Document:
    made = mb.Document(bay(), boundary="outline", boundary_diameter=0.03)
    made.layers.formula("0.01 + 0.1*hypot(x - 0.1, y - 0.5)")
    return made


def inside(rings: list[np.ndarray], points: np.ndarray) -> np.ndarray:
    """Returns whether points lie within an odd number of rings."""
    odd = np.zeros(len(points), dtype=bool)
    x, y = points.T
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0)):
            crosses = (ay > y) != (by > y)
            with np.errstate(divide="ignore", invalid="ignore"):
                odd ^= crosses & (x < ax + (y - ay) * (bx - ax) / (by - ay))
    return odd


def test_a_million_points() -> None:
    mesh = document().mesh()
    points = np.random.default_rng(11).uniform(-1.3, 1.3, (1_000_000, 2))
    found = mesh.locate(points)
    has = found.triangle >= 0
    # By the corners alone: the weights give the point back, and none is negative.
    corners = mesh.nodes[mesh.triangles[found.triangle[has]]]
    again = np.einsum("pi,pij->pj", found.weights[has], corners)
    assert np.abs(again - points[has]).max() < 1e-9
    assert found.weights[has].min() > -1e-9 and np.allclose(found.weights[has].sum(axis=1), 1)
    assert np.isnan(found.weights[~has]).all() and np.all(found.where[~has] == mb.Place.OUTSIDE)
    # Where no triangle is, the boundary of the mesh does not go around the point.
    loops = rings_of(mesh)
    sample = np.random.default_rng(12).choice(len(points), 20_000, replace=False)
    assert np.array_equal(inside(loops, points[sample]), has[sample])
    # A linear function is interpolated exactly.
    values = mesh.interpolate(3 * mesh.nodes[:, 0] - mesh.nodes[:, 1], points)
    assert np.allclose(values[has], 3 * points[has, 0] - points[has, 1]) and np.isnan(values[~has]).all()
    both = mesh.interpolate(mesh.nodes, points[:100])
    assert both.shape == (100, 2) and np.allclose(both[has[:100]], points[:100][has[:100]])


def rings_of(mesh: mb.Mesh) -> list[np.ndarray]:
    """Returns the boundary as closed rings."""
    follows: dict[int, list[int]] = {}
    for part in mesh.boundary.values():
        for a, b in part.tolist():
            follows.setdefault(a, []).append(b)
    rings = []
    while follows:
        start = node = next(iter(follows))
        ring = []
        while node in follows:
            ring.append(node)
            after = follows[node].pop()
            if not follows[node]:
                del follows[node]
            node = after
        assert node == start
        rings.append(mesh.nodes[ring])
    return rings


def test_the_table_of_the_command_line(tmp_path: Path) -> None:
    made = document()
    made.save(tmp_path / "bay.meshbrush")
    mesh = made.mesh()
    points = np.concatenate([np.random.default_rng(13).uniform(-1.1, 1.1, (2000, 2)), mesh.nodes[:50]])
    text = "\n".join(f"{x!r},{y!r}" for x, y in points.tolist())
    (tmp_path / "points.csv").write_text(f"x,y\n{text}\n")
    table = run_program("locate", "--project", "bay.meshbrush", "--points", "points.csv", cwd=tmp_path)
    rows = list(csv.DictReader(io.StringIO(table)))
    found = mesh.locate(points)
    words = {"outside": 0, "inside": 1, "edge": 2, "vertex": 3, "invalid": 4}
    assert [words[row["where"]] for row in rows] == found.where.tolist()
    assert [int(row["triangle"] or -1) for row in rows] == found.triangle.tolist()
    zeta = np.array([[float(row[f"zeta{n}"] or "nan") for n in (1, 2, 3)] for row in rows])
    assert np.array_equal(zeta, found.weights, equal_nan=True)


def test_points_of_other_shapes() -> None:
    mesh = mb.Document(mb.Domain.rectangle(0, 0, 1, 1)).mesh()
    assert mesh.locate((0.3, 0.4)).triangle.shape == (1,)
    assert mesh.locate(np.empty((0, 2))).weights.shape == (0, 3)
    square = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25).mesh()
    middles = (square.nodes[square.triangles[:, 0]] + square.nodes[square.triangles[:, 1]]) / 2
    assert (square.locate(middles).where == mb.Place.EDGE).all() and (square.locate(square.nodes).where == mb.Place.NODE).all()
    assert mesh.locate([[0.5, np.nan]]).where.tolist() == [mb.Place.INVALID]
    assert mesh.locate(np.array([[1, 1], [0, 2]], dtype=np.float32)[:, ::-1]).triangle[1] == -1
    for wrong in (np.zeros((3, 3)), np.zeros((2, 2, 2)), np.zeros(3)):
        with pytest.raises(mb.MeshError, match="two coordinates|dimensions"):
            mesh.locate(wrong)
    with pytest.raises(mb.MeshError, match="nodes"):
        mesh.interpolate([1.0, 2.0], [[0.5, 0.5]])
