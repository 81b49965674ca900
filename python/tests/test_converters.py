"""Meshes of other libraries: boundaries keep their names, and solvers converge."""

from __future__ import annotations

import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import meshbrush as mb
from coasts import bay, feature

skfem = pytest.importorskip("skfem")


def named_square(diameter: float) -> mb.Mesh:
    names = {(0, 0.5): "inflow", (1, 0.5): "outflow", (0.5, 0): "bottom", (0.5, 1): "top"}
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25, h_max=diameter, names=names)
    document.layers.formula(f"{diameter}*(0.5 + 0.5*hypot(x - 0.3, y - 0.4))")
    return document.mesh()


def error_of_poisson(mesh: mb.Mesh) -> float:
    """Solves −Δu = f with two boundaries of each kind, and returns the error in L²."""
    from skfem.helpers import dot, grad

    def exact(x: Any) -> Any:
        return np.sin(2 * x[0]) * np.cosh(x[1]) + x[1] ** 2

    converted = mesh.to_skfem()
    assert sorted(converted.boundaries) == ["bottom", "inflow", "outflow", "top"]
    basis = skfem.Basis(converted, skfem.ElementTriP1())

    @skfem.BilinearForm
    def stiffness(u: Any, v: Any, _: Any) -> Any:
        return dot(grad(u), grad(v))

    @skfem.LinearForm
    def load(v: Any, w: Any) -> Any:
        return (3 * np.sin(2 * w.x[0]) * np.cosh(w.x[1]) - 2) * v

    @skfem.LinearForm
    def flux(v: Any, w: Any) -> Any:
        slope = np.array([2 * np.cos(2 * w.x[0]) * np.cosh(w.x[1]), np.sin(2 * w.x[0]) * np.sinh(w.x[1]) + 2 * w.x[1]])
        return dot(slope, w.n) * v

    matrix, right = stiffness.assemble(basis), load.assemble(basis)
    for name in ("bottom", "outflow"):
        right = right + flux.assemble(skfem.FacetBasis(converted, basis.elem, facets=converted.boundaries[name]))
    fixed = basis.get_dofs({"inflow", "top"})
    values = exact(basis.doflocs)
    solution = skfem.solve(*skfem.condense(matrix, right, x=values, D=fixed))

    @skfem.Functional
    def squared(w: Any) -> Any:
        return (w["u"] - exact(w.x)) ** 2

    fine = skfem.Basis(converted, basis.elem, intorder=5)
    return float(np.sqrt(squared.assemble(fine, u=fine.interpolate(solution))))


def test_poisson_converges_with_second_order() -> None:
    errors = [error_of_poisson(named_square(diameter)) for diameter in (0.2, 0.1, 0.05)]
    ratios = [a / b for a, b in zip(errors, errors[1:])]
    assert min(ratios) > 3.3, (errors, ratios)


def test_named_facets_are_those_of_the_coast() -> None:
    mesh = mb.Document(feature(bay()), boundary="outline", boundary_diameter=0.1).mesh()
    converted = mesh.to_skfem()
    assert set(converted.boundaries) == set(mesh.boundary) and len(mesh.boundary) == 3
    found = np.sort(np.concatenate([converted.boundaries[name] for name in mesh.boundary]))
    assert np.array_equal(found, np.sort(converted.boundary_facets()))
    for name, edges in mesh.boundary.items():
        ends = converted.facets[:, converted.boundaries[name]]
        assert np.array_equal(np.sort(ends.T, axis=0), np.sort(np.sort(edges, axis=1), axis=0)), name


def test_meshio_keeps_names(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    mesh = mb.Document(feature(bay()), boundary="outline", boundary_diameter=0.1).mesh()
    converted = mesh.to_meshio()
    assert converted.points.shape == (len(mesh.nodes), 2)
    for name, edges in mesh.boundary.items():
        assert np.array_equal(converted.cells_dict["line"][converted.cell_sets[name][1]], edges)
    # Through a file of meshio, and in a file of our own.
    meshio.write(tmp_path / "a.vtu", converted)
    read = meshio.read(tmp_path / "a.vtu")
    assert np.array_equal(read.cells_dict["triangle"], mesh.triangles)
    assert np.array_equal(read.cell_data_dict["level"]["triangle"], mesh.levels)
    read = meshio.read(mesh.write(tmp_path / "b.msh")[0])
    markers = {name: int(value[0]) for name, value in read.field_data.items() if value[1] == 1}
    assert markers == {name: int(value[0]) for name, value in converted.field_data.items() if value[1] == 1}
    assert markers == mesh.markers and set(mesh.markers) <= set(read.cell_sets)


def test_plots_are_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    mesh = mb.Document(feature(bay()), boundary="outline", boundary_diameter=0.1).mesh()
    _, axes = plt.subplots()
    assert mesh.plot(ax=axes, color="level", boundary=True, colorbar=True) is axes
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == list(mesh.boundary)
    for color in ("h", None, mesh.nodes[:, 0], mesh.levels):
        mesh.plot(color=color, edges=color is None)
        plt.close("all")
    with pytest.raises(mb.MeshError, match="level, h"):
        mesh.plot(color="depth")
    with pytest.raises(mb.MeshError, match="3 values"):
        mesh.plot(color=[1, 2, 3])
    assert mesh.to_triangulation().triangles.shape == (len(mesh), 3)


def test_dolfinx_gets_keywords_and_names(monkeypatch: pytest.MonkeyPatch) -> None:
    """dolfinx has no small wheel: a stand-in with the keywords of 0.10 says what it is given."""
    given: dict[str, Any] = {}

    def create_mesh(*, comm: Any, cells: Any, e: Any, x: Any) -> Any:
        given.update(cells=cells, x=x, e=e)
        topology = types.SimpleNamespace(create_connectivity=lambda *dims: given.setdefault("dims", []).append(dims))
        return types.SimpleNamespace(topology=topology)

    def tags(mesh: Any, dim: int, entities: Any, values: Any) -> Any:
        return types.SimpleNamespace(dim=dim, entities=entities, values=values)

    modules = {
        "basix": types.ModuleType("basix"),
        "basix.ufl": types.SimpleNamespace(element=lambda *a, **k: (a, k)),
        "ufl": types.SimpleNamespace(Mesh=lambda element: element),
        "dolfinx": types.SimpleNamespace(
            mesh=types.SimpleNamespace(create_mesh=create_mesh, meshtags_from_entities=tags),
            io=types.SimpleNamespace(distribute_entity_data=lambda mesh, dim, entities, values: (entities, values)),
            graph=types.SimpleNamespace(adjacencylist=lambda entities: entities),
        ),
    }
    modules["basix"].ufl = modules["basix.ufl"]  # type: ignore[attr-defined]
    for name, module in modules.items():
        monkeypatch.setitem(sys.modules, name, module)
    mesh = named_square(0.3)
    _, facets, markers = mesh.to_dolfinx(types.SimpleNamespace(rank=0))
    assert given["cells"].dtype == np.int64 and given["x"].flags.writeable and given["x"].shape[1] == 2
    assert markers == mesh.markers and facets.name == "boundary" and facets.dim == 1
    for name, edges in mesh.boundary.items():
        assert np.array_equal(facets.entities[facets.values == markers[name]], edges)
    mesh.to_dolfinx(types.SimpleNamespace(rank=1))
    assert given["cells"].shape == (0, 3) and given["x"].shape == (0, 2)


def test_firedrake_gets_labels(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor has firedrake: a stand-in for its plex notes the labels."""
    labels: dict[tuple[int, ...], int] = {}

    class Plex:
        def createLabel(self, name: str) -> None:  # noqa: N802
            assert name == "Face Sets"

        def getDepthStratum(self, depth: int) -> tuple[int, int]:  # noqa: N802
            return 1000, 2000

        def getJoin(self, points: list[int]) -> Any:  # noqa: N802
            return np.array([points[0] * 100_000 + points[1]])

        def setLabelValue(self, name: str, point: int, value: int) -> None:  # noqa: N802
            labels[divmod(point, 100_000)] = value

    inner = types.SimpleNamespace(plex_from_cell_list=lambda dim, cells, points, comm: Plex())
    module = types.SimpleNamespace(COMM_WORLD=None, mesh=inner, Mesh=lambda plex: plex)
    monkeypatch.setitem(sys.modules, "firedrake", module)
    monkeypatch.setitem(sys.modules, "firedrake.mesh", inner)
    mesh = named_square(0.3)
    mesh.to_firedrake()
    for name, edges in mesh.boundary.items():
        assert {labels[(a + 1000, b + 1000)] for a, b in edges.tolist()} == {mesh.markers[name]}
