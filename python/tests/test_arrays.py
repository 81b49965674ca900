"""The arrays of a mesh, checked by code that knows nothing of the mesher."""

from __future__ import annotations

import gc
from pathlib import Path

import numpy as np
import pytest

import meshbrush as mb
from coasts import bay


@pytest.fixture(scope="module", params=["rectangle", "outline"])
def mesh(request: pytest.FixtureRequest) -> mb.Mesh:
    if request.param == "rectangle":
        document = mb.Document(mb.Domain.rectangle(0, 0, 2, 1), spacing=0.2)
    else:
        document = mb.Document(bay(), boundary="outline", boundary_diameter=0.05)
    document.layers.formula("0.02 + 0.2*hypot(x - 0.1, y - 0.5)")
    return document.mesh()


def areas(mesh: mb.Mesh) -> np.ndarray:
    a, b, c = (mesh.nodes[mesh.triangles[:, corner]] for corner in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def test_triangles_run_anticlockwise_and_fill_the_boundary(mesh: mb.Mesh) -> None:
    assert mesh.nodes.dtype == np.float64 and mesh.triangles.dtype == np.uint32
    assert np.all(areas(mesh) > 0)
    assert mesh.triangles.max() == len(mesh.nodes) - 1
    # Green's formula over the boundary.
    edges = np.concatenate(list(mesh.boundary.values()))
    a, b = mesh.nodes[edges[:, 0]], mesh.nodes[edges[:, 1]]
    assert 0.5 * np.sum(a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]) == pytest.approx(areas(mesh).sum(), rel=1e-12)
    assert mesh.statistics["area"] == pytest.approx(areas(mesh).sum(), rel=1e-12)


def test_neighbours_and_boundary_follow_from_the_triangles(mesh: mb.Mesh) -> None:
    owners: dict[tuple[int, int], list[int]] = {}
    for number, corners in enumerate(mesh.triangles.tolist()):
        for i in range(3):
            owners.setdefault(tuple(sorted((corners[i - 1], corners[i - 2]))), []).append(number)
    opposite = np.full((len(mesh.triangles), 3), -1)
    for number, corners in enumerate(mesh.triangles.tolist()):
        for i in range(3):
            others = [o for o in owners[tuple(sorted((corners[i - 1], corners[i - 2])))] if o != number]
            opposite[number, i] = others[0] if others else -1
    assert np.array_equal(mesh.neighbours, opposite) and mesh.neighbors is not None
    single = sorted(edge for edge, around in owners.items() if len(around) == 1)
    named = sorted(tuple(sorted(edge)) for part in mesh.boundary.values() for edge in part.tolist())
    assert named == single
    assert list(mesh.boundary) == list(mesh.markers) and list(mesh.markers.values()) == sorted(mesh.markers.values())


def test_arrays_are_lent_and_cannot_be_written(mesh: mb.Mesh) -> None:
    for name in ("nodes", "triangles", "levels", "neighbours", "h"):
        first, second = getattr(mesh, name), getattr(mesh, name)
        assert first.__array_interface__["data"] == second.__array_interface__["data"], name
        assert not first.flags.writeable and not first.flags.owndata and first.flags.c_contiguous, name
        with pytest.raises(ValueError):
            first[0] = 0
        with pytest.raises(ValueError):
            first.setflags(write=True)
    with pytest.raises(ValueError):
        next(iter(mesh.boundary.values()))[0] = 0


def test_memory_lives_as_long_as_an_array() -> None:
    nodes = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.01).mesh().nodes
    gc.collect()
    fill = [np.full(len(nodes) * 2, 7.0) for _ in range(20)]
    assert nodes.min() == 0 and nodes.max() == 1 and len(fill) == 20


def test_levels_and_targets(mesh: mb.Mesh) -> None:
    a, b = mesh.nodes[mesh.triangles[:, 0]], mesh.nodes[mesh.triangles[:, 1]]
    longest = np.hypot(*(b - a).T)
    target = 0.02 + 0.2 * np.hypot(mesh.nodes[:, 0] - 0.1, mesh.nodes[:, 1] - 0.5)
    expected = np.minimum(target, mesh.h.max())
    assert np.allclose(mesh.h, expected, rtol=1e-3)
    spacing = mesh.statistics["spacing"]
    whole = mesh.statistics["levels"]
    assert np.bincount(mesh.levels, minlength=len(whole)).tolist() == whole
    if "region_area" not in mesh.statistics:
        assert np.allclose(longest, spacing * np.sqrt(2) * 2.0 ** (-mesh.levels.astype(int) / 2), rtol=0.06)
        corner_targets = target[mesh.triangles].min(axis=1)
        assert np.all(longest <= corner_targets * (1 + 1e-9))


WALLS = """
[mesh]
spacing = 0.1

[[layer]]
kind = "formula"
quantity = "diameter"
formula = "0.04"

[[line]]
name = "wall"
points = [[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]

[[line]]
name = "ring"
points = [[0.2, 0.7], [0.4, 0.7], [0.3, 0.85]]
closed = true

[[line]]
name = "wall"
points = [[0.8, -0.2], [0.8, 0.2]]

[[line]]
name = "elsewhere"
points = [[3, 3], [4, 4]]
"""


def test_lines_are_runs_of_nodes_along_edges(tmp_path: Path) -> None:
    (tmp_path / "walls.toml").write_text(WALLS)
    mesh = mb.open(tmp_path / "walls.toml").mesh()
    lines = mesh.lines
    assert list(lines) == ["wall", "ring"] and [len(runs) for runs in lines.values()] == [2, 1]
    sides = {tuple(sorted((c[i], c[i - 1]))) for c in mesh.triangles.tolist() for i in range(3)}
    for runs in lines.values():
        for run in runs:
            assert run.dtype == np.uint32 and len(run) > 4 and not run.flags.writeable
            assert all(tuple(sorted(ends)) in sides for ends in zip(run.tolist(), run[1:].tolist()))
    first, second = (mesh.nodes[run] for run in lines["wall"])
    assert first[[0, -1]] == pytest.approx(np.array([[0.2, 0.3], [0.7, 0.75]]), abs=1e-8)
    assert second[:, 0] == pytest.approx(0.8, abs=1e-8) and second[[0, -1], 1] == pytest.approx([0, 0.2], abs=1e-8)
    (ring,) = lines["ring"]
    assert ring[0] == ring[-1] and len(set(ring.tolist())) == len(ring) - 1
    x, y = mesh.nodes[ring].T
    assert 0.5 * abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) == pytest.approx(0.5 * 0.2 * 0.15, abs=1e-8)
    # The converters have them beside the boundary.
    edges = {name: sum(len(run) - 1 for run in runs) for name, runs in lines.items()}
    pytest.importorskip("skfem")
    found = mesh.to_meshio()
    assert {name: len(found.cell_sets[name][1]) for name in edges} == edges
    assert np.all(mesh.nodes[found.cells_dict["line"][found.cell_sets["ring"][1]]][:, :, 1] >= 0.7 - 1e-8)
    facets = mesh.to_skfem().boundaries
    assert {name: len(facets[name]) for name in edges} == edges and len(facets) == len(mesh.boundary) + 2
