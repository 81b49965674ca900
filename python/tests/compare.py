"""Compares mesh generators on one sea and one size function: python python/tests/compare.py PATH_OF_WHEEL [NAME=REQUIREMENT ...]

The Aegean Sea of `assets` in a plane with kilometres, with its 65 islands, and h = min(20, 1 + 0.2 d) km at the distance d from the
boundary. Each package is installed by pip into a fresh environment, imported, and makes the mesh in a process of its own. A package
that is not on PyPI can be given as a folder (`oceanmesh=../oceanmesh`). Prints a table with the numbers of docs/comparison.md.

Not part of any test: it downloads 150 MB.
"""

from __future__ import annotations

import inspect
import json
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
NEAR, SLOPE, FAR = 1.0, 0.2, 20.0
# A right-angled triangle has hypotenuses of h; generators of nearly equilateral triangles aim at edges of h.
EQUILATERAL = math.sqrt(3) / 4


def sea() -> dict[str, Any]:
    """Returns rings in kilometres, the outer one first, a name of each, and a point in each hole."""
    polygon = json.loads((ROOT / "assets/aegean_sea.geojson").read_text())
    while polygon["type"] != "Polygon":
        polygon = polygon["features"][0]["geometry"] if "features" in polygon else polygon["geometry"]
    scale = (111.32 * math.cos(math.radians(38)), 110.99)
    rings = [[[(x - 25.5) * scale[0], (y - 38) * scale[1]] for x, y in ring[:-1]] for ring in polygon["coordinates"]]
    return {"rings": rings, "names": ["outer", *(f"island {n}" for n in range(1, len(rings)))]}


# Each of these makes the mesh with one package: what a user would write. They return nodes, triangles, and names or numbers of
# edges of the boundary.


def meshbrush(rings, names, near, slope, far):
    import meshbrush as mb

    document = mb.Document(rings, boundary="outline", boundary_diameter=near, h_max=far, names=dict(zip(map(tuple, (ring[0] for ring in rings)), names)))
    document.layers.distance("outline", at_zero=near, slope=slope)
    mesh = document.mesh()
    return mesh.nodes, mesh.triangles, {name: edges for name, edges in mesh.boundary.items()}


def gmsh(rings, names, near, slope, far):
    import gmsh
    import numpy as np

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    geo, mesh, curves = gmsh.model.geo, gmsh.model.mesh, []
    for ring in rings:
        points = [geo.addPoint(x, y, 0) for x, y in ring]
        curves.append([geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])])
    geo.addPlaneSurface([geo.addCurveLoop(lines) for lines in curves])
    geo.synchronize()
    for name, lines in zip(names, curves):
        gmsh.model.addPhysicalGroup(1, lines, name=name)
    mesh.field.add("Distance", 1)
    mesh.field.setNumbers(1, "CurvesList", sum(curves, []))
    mesh.field.add("Threshold", 2)
    for key, value in {"InField": 1, "SizeMin": near, "SizeMax": far, "DistMin": 0, "DistMax": (far - near) / slope}.items():
        mesh.field.setNumber(2, key, value)
    mesh.field.setAsBackgroundMesh(2)
    for source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
    mesh.generate(2)
    tags, places, _ = mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=int)
    row[tags.astype(int)] = np.arange(len(tags))
    triangles = row[mesh.getElementsByType(2)[1].astype(int)].reshape(-1, 3)
    groups = gmsh.model.getPhysicalGroups(1)
    return places.reshape(-1, 3)[:, :2], triangles, {gmsh.model.getPhysicalName(*group): [] for group in groups}


def distance_to(rings, near):
    """Returns a function of points: the distance to points along all rings."""
    import numpy as np
    from scipy.spatial import cKDTree

    dense = []
    for ring in map(np.array, rings):
        for a, b in zip(ring, np.roll(ring, -1, axis=0)):
            count = max(1, math.ceil(np.hypot(*(b - a)) / (near / 8)))
            dense.append(a + (b - a) * (np.arange(count) / count)[:, None])
    tree = cKDTree(np.concatenate(dense))
    return lambda points: tree.query(points)[0]


def segments_and_holes(rings):
    """Returns vertices, segments, the number of the ring of each, and a point in each hole."""
    import numpy as np
    from shapely.geometry import Polygon

    vertices, segments, markers = np.concatenate([np.array(ring) for ring in rings]), [], []
    first = 0
    for number, ring in enumerate(rings):
        segments += [(first + n, first + (n + 1) % len(ring)) for n in range(len(ring))]
        markers += [number + 1] * len(ring)
        first += len(ring)
    holes = [Polygon(ring).representative_point().coords[0] for ring in rings[1:]]
    return vertices, segments, markers, holes


def triangle(rings, names, near, slope, far):
    import numpy as np
    import triangle

    distance = distance_to(rings, near)
    vertices, segments, markers, holes = segments_and_holes(rings)
    given = {"vertices": vertices, "segments": segments, "segment_markers": markers, "holes": holes}
    mesh = triangle.triangulate(given, "pq28")
    while True:
        corners = mesh["vertices"][mesh["triangles"]]
        h = np.minimum(far, near + slope * distance(corners.mean(axis=1)))
        (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        largest = EQUILATERAL * h**2
        if not (0.5 * np.abs(ax * by - ay * bx) > largest).any():
            break
        mesh["triangle_max_area"] = largest
        mesh = triangle.triangulate(mesh, "prq28a")
    found = set(mesh["vertex_markers"].ravel().tolist()) - {0}
    return mesh["vertices"], mesh["triangles"], {number: [] for number in found}


def meshpy(rings, names, near, slope, far):
    import numpy as np
    from meshpy import triangle as meshpy_triangle

    distance = distance_to(rings, near)
    vertices, segments, markers, holes = segments_and_holes(rings)

    def is_too_large(corners, area):
        center = [sum(corner[n] for corner in corners) / 3 for n in range(2)]
        h = min(far, near + slope * float(distance(center)))
        return bool(area > EQUILATERAL * h**2)

    info = meshpy_triangle.MeshInfo()
    info.set_points(vertices.tolist())
    info.set_facets(segments, facet_markers=markers)
    info.set_holes(holes)
    mesh = meshpy_triangle.build(info, min_angle=28, refinement_func=is_too_large, generate_faces=True)
    return np.array(mesh.points), np.array(mesh.elements), {number: [] for number in set(mesh.facet_markers) - {0}}


def jigsawpy(rings, names, near, slope, far):
    import jigsawpy
    import numpy as np

    distance = distance_to(rings, near)
    vertices, segments, markers, _ = segments_and_holes(rings)
    options, shape, sizes, mesh = jigsawpy.jigsaw_jig_t(), jigsawpy.jigsaw_msh_t(), jigsawpy.jigsaw_msh_t(), jigsawpy.jigsaw_msh_t()
    shape.mshID, shape.ndims = "euclidean-mesh", 2
    shape.vert2 = np.array([(tuple(place), 0) for place in vertices], dtype=shape.VERT2_t)
    shape.edge2 = np.array([(edge, marker) for edge, marker in zip(segments, markers)], dtype=shape.EDGE2_t)
    sizes.mshID, sizes.ndims = "euclidean-grid", 2
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    sizes.xgrid, sizes.ygrid = (np.linspace(a, b, math.ceil((b - a) / (near / 2))) for a, b in zip(low, high))
    x, y = np.meshgrid(sizes.xgrid, sizes.ygrid)
    sizes.value = np.minimum(far, near + slope * distance(np.column_stack([x.ravel(), y.ravel()]))).reshape(x.shape)
    options.hfun_scal, options.hfun_hmax, options.hfun_hmin, options.mesh_dims = "absolute", float("inf"), 0.0, 2
    options.verbosity = 0
    jigsawpy.lib.jigsaw(options, shape, mesh, None, sizes)
    kept = set(mesh.edge2["IDtag"].tolist()) - {0}
    return mesh.vert2["coord"], mesh.tria3["index"], {number: [] for number in kept}


def oceanmesh(rings, names, near, slope, far):
    import geopandas
    import numpy as np
    import oceanmesh as om
    from shapely.geometry import Polygon, box

    with tempfile.TemporaryDirectory() as folder:
        low, high = np.min(rings[0], axis=0) * 1000, np.max(rings[0], axis=0) * 1000
        water = Polygon(np.array(rings[0]) * 1000)
        land = box(*low, *high).difference(water)
        islands = [Polygon(np.array(ring) * 1000) for ring in rings[1:]]
        parts = [*getattr(land, "geoms", [land]), *islands]
        file = Path(folder) / "land.shp"
        geopandas.GeoDataFrame(geometry=parts, crs=32635).to_file(file)
        region = om.Region((low[0], high[0], low[1], high[1]), crs=32635)
        shore = om.Shoreline(str(file), region, near * 1000, smooth_shoreline=False, refinements=0, minimum_area_mult=0.01)
        domain = om.signed_distance_function(shore)
        sizes = om.distance_sizing_function(shore, rate=slope, max_edge_length=far * 1000, crs=32635)
        points, cells = om.generate_mesh(domain, sizes)
        points, cells = om.make_mesh_boundaries_traversable(points, cells)
        points, cells = om.delete_faces_connected_to_one_face(points, cells)
        points, cells = om.laplacian2(points, cells)
    return points / 1000, cells, {}


MESHERS = [meshbrush, gmsh, triangle, meshpy, jigsawpy, oceanmesh]
# What the code above imports besides the package, and how its boundary is known.
MORE = {"gmsh": "numpy", "triangle": "scipy shapely", "meshpy": "numpy scipy shapely", "jigsawpy": "scipy shapely"}


def run(name: str, file: str) -> None:
    """Makes the mesh with one package, and saves it with the times and the figures that need its size function."""
    import numpy as np

    given, mesher = sea(), globals()[name]
    arguments = (given["rings"], given["names"], NEAR, SLOPE, FAR)
    begun, cpu = time.perf_counter(), time.process_time()
    nodes, triangles, boundary = mesher(*arguments)
    seconds, cpu = time.perf_counter() - begun, time.process_time() - cpu
    is_named = bool(boundary) and all(isinstance(key, str) for key in boundary)
    summary = {"seconds": seconds, "cpu": cpu, "names": "names" if is_named else "numbers" if boundary else "none", "kinds": len(boundary)}
    np.savez(file, nodes=nodes, triangles=np.asarray(triangles, dtype=np.int64))
    Path(file).with_suffix(".json").write_text(json.dumps(summary))


def figures(file: str) -> None:
    """Prints the triangles of a mesh, its smallest angle, and the share of edges that are longer than h at both of their ends."""
    import numpy as np

    data = np.load(file)
    nodes, triangles = data["nodes"], data["triangles"]
    h = np.minimum(FAR, NEAR + SLOPE * distance_to(sea()["rings"], NEAR)(nodes))
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    lengths = np.hypot(*(nodes[edges[:, 1]] - nodes[edges[:, 0]]).T)
    # Boundary points lie 1/8 of the least size apart, and so is the distance wrong by 1/16 of it at most.
    over = (lengths > h[edges].max(axis=1) + SLOPE * NEAR / 16).mean()
    corners = nodes[triangles]
    angles = []
    for n in range(3):
        a, b = corners[:, (n + 1) % 3] - corners[:, n], corners[:, (n + 2) % 3] - corners[:, n]
        angles.append(np.degrees(np.arctan2(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), (a * b).sum(axis=1))))
    print(json.dumps({"triangles": len(triangles), "over": float(over), "angle": float(np.min(angles))}))


def environment(folder: Path, requirements: list[str]) -> tuple[Path, float, float]:
    """Returns the Python of a fresh environment, and the seconds and processor seconds of the installation."""
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    python, begun, before = folder / "bin/python", time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([python, "-m", "pip", "install", "-q", *requirements], check=True, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return python, time.perf_counter() - begun, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def import_seconds(python: Path, module: str) -> float:
    """Returns the processor seconds of an import, beyond those of an empty program: other work does not change them."""

    def once(code: str) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([python, "-c", code], check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    once(f"import {module}")
    return statistics.median(once(f"import {module}") - once("") for _ in range(7))


def lines_of(mesher: Any) -> int:
    """Counts the lines of code of a function, with those of the functions of this file that it calls."""
    def own(function: Any) -> list[str]:
        body = inspect.getsource(function).splitlines()[1:]
        return [line for line in body if line.strip() and not line.strip().startswith(('"""', "#"))]

    source = inspect.getsource(mesher)
    helpers = [helper for helper in (distance_to, segments_and_holes) if f"{helper.__name__}(" in source]
    return sum(len(own(function)) for function in [mesher, *helpers])


def row(mesher: Any, requirement: str, checker: Path, folder: Path) -> str:
    name = mesher.__name__
    python, wall, cpu = environment(folder / name, [requirement, *MORE.get(name, "").split()])
    module = "meshpy.triangle" if name == "meshpy" else name
    importing = import_seconds(python, module)
    file = folder / f"{name}.npz"
    subprocess.run([python, __file__, "run", name, file], check=True, capture_output=True, text=True, timeout=3000)
    found = json.loads(file.with_suffix(".json").read_text())
    found |= json.loads(subprocess.check_output([checker, __file__, "figures", file]))
    boundary = {"names": "names", "numbers": "numbers", "none": "no"}[found["names"]]
    return (
        f"| {name} | {wall:.0f} ({cpu:.0f}) | {1e3 * importing:.0f} | {lines_of(mesher)} | {found['triangles']:,} | "
        f"{found['seconds']:.2f} ({found['cpu']:.2f}) | {100 * found['over']:.1f} % | {found['angle']:.0f}° | {boundary} |"
    )


def main() -> None:
    requirements = {"meshbrush": sys.argv[1], **dict(argument.split("=", 1) for argument in sys.argv[2:])}
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, Python {sys.version.split()[0]}")
    print("| package | install, s (CPU) | import, ms CPU | lines | triangles | mesh, s (CPU) | edges over h | least angle | boundary |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---|", flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        checker, _, _ = environment(folder / "check", ["numpy", "scipy"])
        for mesher in MESHERS:
            requirement = requirements.get(mesher.__name__, mesher.__name__)
            try:
                print(row(mesher, requirement, checker, folder), flush=True)
            except subprocess.SubprocessError as error:
                said = (getattr(error, "stderr", None) or str(error)).strip().splitlines()
                print(f"| {mesher.__name__} | failed: {said[-1][:160] if said else error} |", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["run"]:
        run(*sys.argv[2:])
    elif sys.argv[1:2] == ["figures"]:
        figures(*sys.argv[2:])
    else:
        main()
