"""Files of coastal solvers, read back by large public packages: MIKE IO (.mesh), xugrid (UGRID), Gmsh (2.2) and adcircpy
(fort.14); by the parser of pyschism (hgrid.gr3, hgrid.ll); and by HYDROLIB-core (thin dams). A small sea in metres has every
type of boundary, and the Celtic Sea of the example has depths, in degrees. Nodes, triangles, depths, each edge of the boundary
exactly once, in the piece that has it, and weirs.

Called by tests/public_readers, which installs the packages: public_readers.py PROGRAM.
"""

import collections
import functools
import json
import pathlib
import subprocess
import sys
import tempfile
import warnings

import gmsh
import meshio
import mikeio
import numpy as np
import pyproj
import solver_readers
import xarray
import xugrid
from adcircpy.mesh.fort14 import Fort14
from hydrolib.core.dflowfm import PolyFile

ENDINGS = ["14", "gr3", "nc", "mesh", "ww3"]
# MIKE's code of a node on land.
LAND = 1


def boundary_edges(triangles):
    """Returns the edges of one triangle only, with the domain on the left."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, place, count = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    return edges[place[count == 1]]


def by_group(edges, groups):
    """Returns the edges of each group, without directions; none may be there twice."""
    found = collections.defaultdict(set)
    for edge, group in zip(np.sort(edges, axis=1).tolist(), groups, strict=True):
        assert tuple(edge) not in found[group], f"the edge {edge} twice"
        found[group].add(tuple(edge))
    return dict(found)


def check_xugrid(path, expected, pieces):
    """Returns the edges of each piece, by its number."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = xugrid.UgridDataset(xarray.open_dataset(path, engine="netcdf4"))
    grid = data.grid
    solver_readers.check_mesh(expected, grid.node_x, grid.node_y, grid.face_node_connectivity, -data["mesh2d_node_z"].values)
    markers = data["mesh2d_boundary"].values
    assert np.array_equal(np.flatnonzero(markers), np.sort(grid.exterior_edges)), "the edges of the boundary"
    ends = grid.edge_node_connectivity[grid.exterior_edges]
    edges_of = by_group(ends, (markers[grid.exterior_edges] - 1).tolist())
    assert {piece["id"]: piece["edges"] for piece in pieces} == {piece: len(edges) for piece, edges in edges_of.items()}
    assert grid.is_geographic == (expected.unit == "degrees"), "what coordinates are"
    return edges_of


def check_mike(path, expected, pieces, edges_of):
    mesh = mikeio.Mesh(path).geometry
    x, y, z = mesh.node_coordinates.T
    triangles = np.array(list(mesh.element_table))
    solver_readers.check_mesh(expected, x, y, triangles, -z)
    assert mesh.projection_string == ("LONG/LAT" if expected.unit == "degrees" else "NON-UTM")
    edges = boundary_edges(triangles)
    inside = np.setdiff1d(np.arange(len(x)), edges)
    assert not mesh.codes[inside].any() and mesh.codes[np.unique(edges)].all(), "codes inside and on the boundary"
    # MIKE's own rule: an edge without a node on land is open, and has the code of its second node.
    first, second = mesh.codes[edges].T
    found = by_group(edges, np.where((first == LAND) | (second == LAND), LAND, second).tolist())
    through = [piece["id"] for piece in pieces if "land" not in piece["type"]]
    land = set().union(*(edges for piece, edges in edges_of.items() if piece not in through))
    assert found.pop(LAND) == land, "the edges of land"
    between = {node for edges in found.values() for edge in edges for node in edge}
    on_land = sorted({node for edge in land for node in edge} - between)
    assert (mesh.codes[on_land] == LAND).all(), "codes on land"
    assert sorted(map(sorted, found.values())) == sorted(sorted(edges_of[piece]) for piece in through), "open pieces"
    lines = mesh.boundary_polygons.lines
    assert sum(len(np.unique(line.xy, axis=0)) for line in lines) == len(edges), "the polygons of the boundary"


def check_gmsh(path, expected, pieces, edges_of):
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.merge(str(path))
        tags, places, _ = gmsh.model.mesh.getNodes()
        x, y, z = places.reshape(-1, 3)[np.argsort(tags)].T
        tags, corners = gmsh.model.mesh.getElementsByType(gmsh.model.mesh.getElementType("triangle", 1))
        triangles = corners.reshape(-1, 3)[np.argsort(tags)].astype(int) - 1
        _, points = gmsh.model.mesh.getElementsByType(gmsh.model.mesh.getElementType("point", 0))
    finally:
        gmsh.finalize()
    solver_readers.check_mesh(expected, x, y, triangles, z)
    is_open = [edges_of[piece["id"]] for piece in pieces if piece["type"] == "open"]
    assert sorted(points.tolist()) == sorted({node + 1 for edges in is_open for edge in edges for node in edge}), "open nodes"


def hole_edges(points, triangles):
    """Returns the edges of loops that run clockwise: islands, and holes that land of the outer loop has in the mesh."""
    follows = dict(boundary_edges(triangles).tolist())
    found = set()
    while follows:
        first, node = follows.popitem()
        loop = [first]
        while node != first:
            loop.append(node)
            node = follows.pop(node)
        x, y = points[loop, 0], points[loop, 1]
        if x @ np.roll(y, -1) < y @ np.roll(x, -1):
            found |= {tuple(sorted(edge)) for edge in zip(loop, [*loop[1:], first])}
    return found


def check_adcircpy(path, expected, pieces, edges_of):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mesh = Fort14.open(path, crs="EPSG:4326")
    nodes = mesh.nodes
    triangles = mesh.elements.elements.filter(like="node_").dropna(axis=1).to_numpy().astype(int) - 1
    # adcircpy reads numbers with the fast parser of pandas, which is not exact.
    solver_readers.check_mesh(expected, nodes["x"], nodes["y"], triangles, -nodes["value_1"], parser_error=1e-15)
    strings, found = {}, collections.defaultdict(list)
    for text, of_number in mesh._boundaries.to_dict().items():
        number = None if text is None else int(text)
        strings[number] = [[int(node) - 1 for node in string["node_id"]] for string in of_number]
        for string in strings[number]:
            closed = [*string, string[0]] if number is not None and number % 10 == 1 else string
            found[number] += (tuple(sorted(edge)) for edge in zip(closed, closed[1:]))
    wanted, holes = collections.defaultdict(list), hole_edges(expected.points, triangles)
    for piece in pieces:
        number = solver_readers.ADCIRC[piece["type"]]
        for edge in edges_of[piece["id"]]:
            wanted[number + 1 if "land" in piece["type"] and edge in holes else number].append(edge)
    assert found.keys() == wanted.keys(), "types"
    assert all(sorted(found[number]) == sorted(wanted[number]) for number in wanted), "each edge once, in its type"
    length_of = functools.partial(expected.length_of, expected.points)
    solver_readers.check_strings(path, strings, pieces, solver_readers.adcirc_number, length_of)


def ground_length(places, edges):
    (x, y), (u, v) = places[np.array(edges)][:, :, :2].transpose(1, 2, 0)
    return pyproj.Geod(ellps="WGS84").inv(x, y, u, v)[2].sum()


def check_all(folder, stem, expected, pieces):
    edges_of = check_xugrid(folder / f"{stem}.nc", expected, pieces)
    every = {tuple(edge) for edge in np.sort(boundary_edges(expected.cells_dict["triangle"]), axis=1).tolist()}
    assert set().union(*edges_of.values()) == every and sum(map(len, edges_of.values())) == len(every), "every edge once"
    check_mike(folder / f"{stem}.mesh", expected, pieces, edges_of)
    check_gmsh(folder / f"{stem}.ww3", expected, pieces, edges_of)
    check_adcircpy(folder / f"{stem}.14", expected, pieces, edges_of)
    for path in filter(pathlib.Path.exists, (folder / f"{stem}.{ending}" for ending in ("gr3", "ll"))):
        solver_readers.check_pyschism(path, expected, pieces, solver_readers.schism_number, expected.length_of)
    print(f"{stem}: {len(expected.points)} nodes, {len(every)} boundary edges in {len(pieces)} pieces: read back")


def celtic_sea(program, folder):
    recipe = pathlib.Path(__file__).resolve().parent.parent / "assets" / "celtic_sea.toml"
    outputs = [word for ending in ["vtu", "ll", *ENDINGS] for word in ("-o", str(folder / f"celtic_sea.{ending}"))]
    ran = subprocess.run(
        [program, "mesh", str(recipe), "--json", "--cells", "triangles", *outputs], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    return meshio.read(folder / "celtic_sea.vtu"), json.loads(ran.stdout)["boundary"]


WEIRS = """
[domain]
bounds = [0, 0, 1000, 1000]
[mesh]
spacing = 100
[[layer]]
kind = "formula"
quantity = "diameter"
formula = "60"
[[line]]
points = [[200, 300], [550, 400], [700, 750]]
name = "dam"
type = "weir"
crest = 2.5
[[line]]
points = [[150, 800], [450, 700]]
name = "groyne"
"""


def sides(points, triangles, node, line):
    """Returns on which sides of a line the triangles at a node have their centroids."""
    offsets = points[triangles[(triangles == node).any(axis=1)]].mean(axis=1) - points[node]
    along = np.diff(line, axis=0)
    # The segment that the node is on.
    segment = np.argmin([abs(np.cross(d, points[node] - a)) / np.hypot(*d) for a, d in zip(line, along)])
    return set(np.sign(np.cross(along[segment], offsets)))


def check_weirs(program, folder):
    """A weir in fort.14 by adcircpy, and thin dams in a .pli by HYDROLIB-core, beside the lines of the recipe."""
    (folder / "weirs.toml").write_text(WEIRS)
    subprocess.run(
        [program, "mesh", "weirs.toml", "--quantity", "depth=10", "-o", "weirs.14", "-o", "weirs.nc"],
        check=True, cwd=folder, stderr=subprocess.DEVNULL,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mesh = Fort14.open(folder / "weirs.14", crs="EPSG:32630")
    points = mesh.nodes[["x", "y"]].to_numpy()
    triangles = mesh.elements.elements.filter(like="node_").dropna(axis=1).to_numpy().astype(int) - 1
    [weir] = mesh._boundaries.to_dict()["24"]
    pairs = np.array(weir["node_id"]).astype(int) - 1
    assert np.array_equal(points[pairs[:, 0]], points[pairs[:, 1]]), "the nodes of a pair have one place"
    assert set(weir["barrier_height"]) == {2.5} and len(pairs) > 10
    dam = np.array([[200, 300], [550, 400], [700, 750]])
    corner = {tuple(at) for at in dam[1:-1]}
    for front, back in pairs[[tuple(at) not in corner for at in points[pairs[:, 0]]]]:
        # Water flows from the front on the left to the back on the right.
        assert sides(points, triangles, front, dam) == {1} and sides(points, triangles, back, dam) == {-1}, "sides"
    dams = {dam.metadata.name: np.array([[p.x, p.y] for p in dam.points]) for dam in PolyFile(folder / "weirs_thd.pli").objects}
    assert dams.keys() == {"dam", "groyne"}
    # The ends of a weir inside the domain are no pairs.
    assert np.abs(dams["dam"][1:-1] - points[pairs[:, 0]]).max() < 1e-9, "the nodes of the weir along the dam"
    assert np.array_equal(dams["groyne"][[0, -1]], [[150, 800], [450, 700]])
    print(f"weirs: {len(pairs)} pairs and {len(dams)} thin dams: read back")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        expected, pieces = solver_readers.write_sea(program, folder, ENDINGS)
        expected.unit, expected.length_of = "metres", solver_readers.plane_length
        check_all(folder, "sea", expected, pieces)
        expected, pieces = celtic_sea(program, folder)
        expected.unit, expected.length_of = "degrees", ground_length
        check_all(folder, "celtic_sea", expected, pieces)
        check_weirs(program, folder)


if __name__ == "__main__":
    main()
