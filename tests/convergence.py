"""Order of convergence of linear elements on exported meshes with curved outlines, and on an exactly nested sequence.

    pip install scikit-fem scipy meshio
    python tests/convergence.py target/release/meshbrush outline fitted sequence

Each problem is solved with scikit-fem on meshes of five sizes. Printed are the L2 errors and the orders of convergence: of the last
step, and on average. Not part of tests/run, because of the packages that it needs.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np
import scipy.sparse.linalg
import skfem
from skfem.helpers import dot, grad

SIZES = [1 / 8, 1 / 16, 1 / 32, 1 / 64, 1 / 128]
CORNERS = 4000  # of a circle, so that the polygon is a circle for all sizes

STIFFNESS = skfem.BilinearForm(lambda u, v, _: dot(grad(u), grad(v)))
MASS = skfem.BilinearForm(lambda u, v, _: u * v)


def disc():
    return [(math.cos(angle), math.sin(angle)) for angle in np.arange(CORNERS) * 2 * math.pi / CORNERS]


def curved_l():
    """An L whose left side is an arc of radius 2 that bulges out."""
    angles = np.linspace(math.asin(0.5), -math.asin(0.5), CORNERS // 2)
    arc = [(math.sqrt(3) - 2 * math.cos(angle), 1 + 2 * math.sin(angle)) for angle in angles]
    return [(2, 0), (2, 1), (1, 1), (1, 2), *arc]


def harmonic(x, y):
    return np.exp(x) * np.sin(y)


def flux_of_harmonic(w):
    x, y = w.x
    return np.exp(x) * (np.sin(y) * w.n[0] + np.cos(y) * w.n[1])


def solved_with_values(basis, load, values):
    boundary = basis.mesh.boundary_nodes()
    return skfem.solve(*skfem.condense(STIFFNESS.assemble(basis), load, x=values, D=boundary))


def solved_with_flux(basis, source, flux):
    sides = skfem.FacetBasis(basis.mesh, skfem.ElementTriP1(), intorder=4)
    load = skfem.LinearForm(lambda v, w: source(*w.x) * v).assemble(basis)
    load += skfem.LinearForm(lambda v, w: flux(w) * v).assemble(sides)
    matrix = STIFFNESS.assemble(basis) + MASS.assemble(basis)
    return scipy.sparse.linalg.spsolve(matrix.tocsc(), load)


def harmonic_values(basis):
    """-Δu = 0 with the values of a harmonic function at the boundary nodes."""
    return solved_with_values(basis, np.zeros(basis.N), harmonic(*basis.mesh.p)), harmonic


def harmonic_flux(basis):
    """-Δu + u = u₀ with the flux of a harmonic u₀ through the sides of the mesh."""
    return solved_with_flux(basis, harmonic, flux_of_harmonic), harmonic


def zero_on_circle(basis):
    """-Δu = 4 and u = 0 on the boundary of the mesh: 1 − r², if that is the circle."""
    load = skfem.LinearForm(lambda v, _: 4 * v).assemble(basis)
    return solved_with_values(basis, load, np.zeros(basis.N)), lambda x, y: 1 - x**2 - y**2


def flux_on_circle(basis):
    """-Δu + u = r² − 4 with the flux 2 through the boundary of the mesh: r², if that is the circle."""
    return solved_with_flux(basis, lambda x, y: x**2 + y**2 - 4, lambda _: 2.0), lambda x, y: x**2 + y**2


DOMAINS = {
    "disc": (disc, [harmonic_values, harmonic_flux, zero_on_circle, flux_on_circle]),
    "L with a curved side": (curved_l, [harmonic_values, harmonic_flux]),
}


def mesh_of(program, folder, outline, boundary, size):
    region, file = folder / "region.geojson", folder / "mesh.vtu"
    region.write_text(json.dumps({"type": "Polygon", "coordinates": [[*outline, outline[0]]]}))
    options = ["--spacing", "0.5", "--boundary", boundary, "--boundary-diameter", str(size), "--target", str(size)]
    command = [program, "mesh", "--region", str(region), *options, "-o", str(file)]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    read = meshio.read(file)
    points, triangles = read.points[:, :2].T, read.cells_dict["triangle"].T
    return skfem.MeshTri(np.ascontiguousarray(points), np.ascontiguousarray(triangles))


def nested(program, folder):
    """The graded meshes of `--sequence`: each has every node of the one before."""
    target = ["--target", "0.06+0.3*hypot(x-0.3,y-0.4)", "--gradation", "0.3", "--sequence", str(len(SIZES))]
    command = [program, "mesh", "--domain", "0,0,1,1", "--spacing", "0.25", *target, "-o", str(folder / "m.vtu")]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    for number in range(1, len(SIZES) + 1):
        read = meshio.read(folder / f"m_{number}.vtu")
        points, triangles = read.points[:, :2].T, read.cells_dict["triangle"].T
        yield skfem.MeshTri(np.ascontiguousarray(points), np.ascontiguousarray(triangles))


def sines(basis):
    """-Δu = 13π² sin 2πx sin 3πy, and u = 0 on the boundary of the square."""
    load = skfem.LinearForm(lambda v, w: 13 * np.pi**2 * product_of_sines(*w.x) * v).assemble(basis)
    return solved_with_values(basis, load, np.zeros(basis.N)), product_of_sines


def product_of_sines(x, y):
    return np.sin(2 * np.pi * x) * np.sin(3 * np.pi * y)


def print_sequence(program):
    with tempfile.TemporaryDirectory() as folder:
        bases = [skfem.Basis(m, skfem.ElementTriP1(), intorder=6) for m in nested(program, pathlib.Path(folder))]
    errors = [error(basis, sines) for basis in bases]
    orders = " ".join(f"{math.log2(before / after):.3f}" for before, after in zip(errors, errors[1:]))
    print(f"sequence of {bases[0].mesh.t.shape[1]} triangles and more: {' '.join(f'{e:.2e}' for e in errors)}; orders {orders}")


def error(basis, problem):
    solution, exact = problem(basis)
    squared = skfem.Functional(lambda w: (w["found"] - exact(*w.x)) ** 2)
    return math.sqrt(squared.assemble(basis, found=basis.interpolate(solution)))


def main():
    program, *treatments = sys.argv[1:]
    if "sequence" in treatments:
        treatments.remove("sequence")
        print_sequence(program)
    for boundary in treatments:
        for name, (outline, problems) in DOMAINS.items():
            errors = []
            for size in SIZES:
                with tempfile.TemporaryDirectory() as folder:
                    mesh = mesh_of(program, pathlib.Path(folder), outline(), boundary, size)
                basis = skfem.Basis(mesh, skfem.ElementTriP1(), intorder=4)
                errors.append([error(basis, problem) for problem in problems])
            orders = np.log2(np.array(errors))
            for k, problem in enumerate(problems):
                of_sizes = " ".join(f"{row[k]:.2e}" for row in errors)
                last, mean = orders[-2, k] - orders[-1, k], (orders[0, k] - orders[-1, k]) / (len(SIZES) - 1)
                print(f"{boundary}, {name}, {problem.__name__}: {of_sizes}; order {last:.2f}, mean {mean:.2f}")


if __name__ == "__main__":
    main()
