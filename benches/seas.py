"""Meshes the Celtic Sea by published recipes of OceanMesh2D: python benches/seas.py PROGRAM [PYTHON_WITH_OCEANMESH]

The size functions, limits and gradations are those of two of its examples; coast and depths are those of `assets`. With a Python
that has the package oceanmesh, by the same authors, makes the same seas with it. Needs numpy, meshio and pyproj. Prints the
table of docs/comparison.md.

An edge is over its target if it is longer on the ellipsoid than h at both of its ends. A strait is a place where the water
between two coasts is 3 to 30 km wide, and it should have three triangles from coast to coast.
"""

import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ASSETS = pathlib.Path(__file__).resolve().parent.parent / "assets"
BOX = (-6.6, 0.0, 47.75, 51.95)  # oceanmesh's: west, east, south, north
# The tide M2 in seconds.
PERIOD = 12.42 * 3600
# Keywords as OceanMesh2D has them, lengths in metres. Of the second, the coarse region around the islands.
RECIPES = {
    "1, South Island of New Zealand": {"min_el": 1000, "max_el": 100_000, "max_el_ns": 5000, "g": 0.35, "fs": 3},
    "4, around Puerto Rico": {"min_el": 1000, "max_el": 10_000, "g": 0.25, "fs": 5, "wl": 30, "slp": 15},
}


def recipe(p):
    """Returns our recipe for parameters of OceanMesh2D."""
    depths = f'kind = "depth"\nfile = "{ASSETS / "celtic_sea_depths.tif"}"\npositive = "down"\n'
    layers = [f'kind = "feature-size"\nacross = {p["fs"]}\nwidth_from = {p["fs"] * p["min_el"]}\nwidth_to = 100_000\n']
    if "wl" in p:
        layers.append(f'{depths}size = "wavelength"\nperiod = {PERIOD}\ntriangles = {p["wl"]}\n')
    if "slp" in p:
        layers.append(f'{depths}size = "slope"\ntriangles = {p["slp"]}\nsmoothing = 8000\n')
    if "max_el_ns" in p:
        layers.append(f'kind = "distance"\nto = "coasts"\nat_zero = {p["max_el_ns"]}\nslope = {p["g"]}\n')
    layers.append('kind = "straits"\nacross = 3\nwidth_from = 3000\nwidth_to = 30_000\n')
    return (
        f'[domain]\nregion = "{ASSETS / "celtic_sea.geojson"}"\nprojection = "auto"\nboundary_diameter = {p["min_el"]}\n'
        f"[limits]\nh_min = {p['min_el']}\nh_max = {p['max_el']}\ngradation = {p['g']}\n" + "".join(f"[[layer]]\n{layer}" for layer in layers)
    )


def figures(nodes, triangles, h):
    """Returns nodes, edges over target, those of them without a node of the boundary, all edges, and the least angle in degrees."""
    import numpy as np
    from pyproj import Geod

    every = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(every, axis=0, return_counts=True)
    on_boundary = np.zeros(len(nodes), dtype=bool)
    on_boundary[edges[count == 1]] = True
    (a, b) = nodes[edges[:, 0]], nodes[edges[:, 1]]
    lengths = Geod(ellps="WGS84").inv(a[:, 0], a[:, 1], b[:, 0], b[:, 1])[2]
    corners = nodes[triangles] * [1, 1] - nodes[triangles[:, :1]]
    corners[:, :, 0] *= np.cos(np.radians(nodes[triangles[:, 0], 1]))[:, None]
    angles = []
    for n in range(3):
        p, q = corners[:, (n + 1) % 3] - corners[:, n], corners[:, (n + 2) % 3] - corners[:, n]
        angles.append(np.degrees(np.arctan2(np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]), (p * q).sum(axis=1))))
    over = lengths > h[edges].max(axis=1) * (1 + 1e-9)
    inside = over & ~on_boundary[edges].any(axis=1)
    return len(nodes), int(over.sum()), int(inside.sum()), len(edges), float(np.min(angles))


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def ours(program, parameters, folder):
    import meshio

    (folder / "sea.toml").write_text(recipe(parameters))
    command = [program, "mesh", "sea.toml", "--json"]
    # Once for the time, and again with h at each node.
    before, begun = processor_seconds(), time.perf_counter()
    said = subprocess.run([*command, "-o", "sea.14"], cwd=folder, check=True, capture_output=True, text=True).stdout
    wall, cpu = time.perf_counter() - begun, processor_seconds() - before
    subprocess.run([*command, "-o", "sea.vtu"], cwd=folder, check=True, capture_output=True)
    mesh = meshio.read(folder / "sea.vtu")
    straits = json.loads(said)["straits"]
    found = figures(mesh.points[:, :2], mesh.cells_dict["triangle"], mesh.point_data["target_diameter"])
    return *found, wall, cpu, f"{straits['below']} of {straits['crossings']}"


def theirs(python, parameters, folder):
    file = folder / "theirs.npz"
    before, begun = processor_seconds(), time.perf_counter()
    subprocess.run([python, __file__, "oceanmesh", json.dumps(parameters), file], check=True, capture_output=True, text=True, timeout=3000)
    wall, cpu = time.perf_counter() - begun, processor_seconds() - before
    import numpy as np

    data = np.load(file)
    return *figures(data["nodes"], data["triangles"], data["h"]), wall, cpu, "not counted"


def oceanmesh(text, file):
    """Makes a sea with oceanmesh, in degrees as its examples do, and saves it with its own h at the nodes, in metres."""
    import geopandas
    import numpy as np
    import oceanmesh as om
    import rasterio
    from shapely.geometry import box, shape

    p, folder = json.loads(text), pathlib.Path(file).parent
    degree = 111_000
    water = shape(json.loads((ASSETS / "celtic_sea.geojson").read_text()))
    land = box(*water.bounds).difference(water)
    geopandas.GeoDataFrame(geometry=list(land.geoms), crs=4326).to_file(folder / "land.shp")
    with rasterio.open(ASSETS / "celtic_sea_depths.tif") as depths:
        profile = dict(depths.profile, dtype="float32", driver="GTiff")
        with rasterio.open(folder / "heights.tif", "w", **profile) as heights:
            heights.write(-depths.read(1).astype("float32"), 1)
    region = om.Region(BOX, crs=4326)
    shore = om.Shoreline(str(folder / "land.shp"), region, p["min_el"] / degree)
    dem = om.DEM(str(folder / "heights.tif"), bbox=region, crs=4326)
    domain = om.signed_distance_function(shore)
    least, most = p["min_el"] / degree, p["max_el"] / degree
    sizes = [om.feature_sizing_function(shore, domain, r=p["fs"], min_edge_length=least, max_edge_length=most)]
    if "wl" in p:
        sizes.append(om.wavelength_sizing_function(dem, wl=p["wl"], min_edgelength=least, max_edge_length=most, period=PERIOD))
    if "slp" in p:
        slope = {"slope_parameter": p["slp"], "filter_quotient": 50, "min_edge_length": least, "max_edge_length": most}
        sizes.append(om.bathymetric_gradient_sizing_function(dem, crs=4326, **slope))
    if "max_el_ns" in p:
        sizes.append(om.distance_sizing_function(shore, rate=p["g"], max_edge_length=most))
    h = om.enforce_mesh_gradation(om.compute_minimum(sizes), gradation=p["g"])
    points, cells = om.generate_mesh(domain, h)
    points, cells = om.make_mesh_boundaries_traversable(points, cells)
    points, cells = om.delete_faces_connected_to_one_face(points, cells)
    points, cells = om.delete_boundary_faces(points, cells, min_qual=0.15)
    points, cells = om.laplacian2(points, cells)
    np.savez(file, nodes=points, triangles=np.asarray(cells, dtype=np.int64), h=h.eval(points) * degree)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    makers = {"meshbrush": lambda *given: ours(program, *given)}
    if len(sys.argv) > 2:
        makers["oceanmesh"] = lambda *given: theirs(os.path.abspath(sys.argv[2]), *given)
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    print("| sizes of example | made by | nodes | seconds (CPU) | edges over target, away from the boundary | edges | least angle | straits under 3 |")
    print("|---|---|---:|---:|---:|---:|---:|---:|")
    for name, parameters in RECIPES.items():
        for maker, make in makers.items():
            with tempfile.TemporaryDirectory() as folder:
                try:
                    count, over, inside, edges, angle, wall, cpu, straits = make(parameters, pathlib.Path(folder))
                except subprocess.SubprocessError as error:
                    said = (getattr(error, "stderr", None) or str(error)).strip().splitlines()[-1]
                    print(f"| {name} | {maker} | failed: {said[:200]} |", flush=True)
                    continue
                row = f"{count:,} | {wall:.1f} ({cpu:.1f}) | {over:,}, {inside:,} | {edges:,} | {angle:.0f}° | {straits}"
                print(f"| {name} | {maker} | {row} |", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["oceanmesh"]:
        oceanmesh(*sys.argv[2:])
    else:
        main()
