"""Solutions by finite elements, against scikit-fem on the same mesh."""

from __future__ import annotations

import numpy as np
import pytest
import skfem
from skfem.helpers import dot, grad

import meshbrush as mb


def square() -> mb.Document:
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.2)
    document.layers.formula("0.04 + 0.1*x")
    return document


def test_values_at_nodes_are_those_of_scikit_fem() -> None:
    solution = square().solve(
        diffusion="2 + x", reaction=3, source="1 + y", dirichlet={"open west": "y"}, robin={"all": (2, "x")}
    )
    mesh = skfem.MeshTri(solution.nodes.T.copy(), solution.triangles.T.astype(np.int64))
    basis = skfem.Basis(mesh, skfem.ElementTriP1())
    sides = mesh.facets_satisfying(lambda x: x[0] > 1e-9, boundaries_only=True)
    rim = skfem.FacetBasis(mesh, skfem.ElementTriP1(), facets=sides)
    inside = skfem.BilinearForm(lambda u, v, w: (2 + w.x[0]) * dot(grad(u), grad(v)) + 3 * u * v)
    matrix = inside.assemble(basis) + skfem.BilinearForm(lambda u, v, _: 2 * u * v).assemble(rim)
    load = skfem.LinearForm(lambda v, w: (1 + w.x[1]) * v).assemble(basis)
    load += skfem.LinearForm(lambda v, w: w.x[0] * v).assemble(rim)
    held = np.flatnonzero(solution.nodes[:, 0] < 1e-9)
    values = np.zeros(len(solution.u))
    values[held] = solution.nodes[held, 1]
    expected = skfem.solve(*skfem.condense(matrix, load, x=values, D=held))
    assert np.abs(solution.u - expected).max() < 1e-10 * np.abs(expected).max()
    assert solution.guaranteed and solution.reasons == []
    assert np.isclose(np.linalg.norm(solution.bounds), solution.bound)


def test_the_mesh_follows_the_error() -> None:
    corner = mb.Document(mb.Domain.formula("not (x > 0 and y < 0)", (-1, -1, 1, 1)), spacing=0.25)
    problem = {
        "dirichlet": {"all": "r^(2/3)*sin(2/3*(if(theta<0, theta+2*pi, theta)))"},
        "exact": "r^(2/3)*sin(2/3*(if(theta<0, theta+2*pi, theta)))",
    }
    solution = corner.solve(at_most=2000, **problem)
    assert len(solution.triangles) <= 2000 and len(solution.rounds) > 5
    assert solution.rounds[0][0] == len(corner.mesh().triangles)
    bounds = [bound for _, bound in solution.rounds]
    assert bounds == sorted(bounds, reverse=True) and bounds[-1] < 0.3 * bounds[0]
    assert solution.reasons == ["a value on the boundary is not linear along its edges"]
    again = corner.solve(at_most=2000, threads=1, **problem)
    assert np.array_equal(again.u, solution.u) and again.mesh.fingerprint == solution.mesh.fingerprint


def test_bad_input_is_a_sentence() -> None:
    document = square()
    for keywords, sentence in [
        ({"source": 1}, "There is no solution"),
        ({"diffusion": "x - 0.5", "dirichlet": {"all": 0}}, "The diffusion is -0"),
        ({"dirichlet": {"open wst": 0}}, "open west"),
        ({"dirichlet": {"all": 0}, "within": 0.1, "at_most": 10}, "Give one of them"),
        ({"dirichlet": {"all": 0}, "within": -1.0}, "above 0"),
    ]:
        with pytest.raises(mb.MeshError, match=sentence):
            document.solve(**keywords)
    with pytest.raises(mb.FormulaError):
        document.solve(source="1 +", dirichlet={"all": 0})
