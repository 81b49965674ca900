"""Every export, read back by a reader that is not ours: the same nodes, triangles and levels, and the same area.

Called by tests/run with the program to test: readers.py PROGRAM. Needs numpy, meshio, svg.path and pypng (from Debian), and py2dm,
triangle and trimesh (from PyPI).
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

import meshio
import numpy as np
import png
import py2dm
import svg.path
import triangle.data
import trimesh

ENDINGS = ["vtu", "msh", "msh2", "ww3", "obj", "stl", "node", "2dm", "csv", "svg", "png"]
TARGET = "0.02 + 0.1*hypot(x - 0.3, y - 0.2)"
COAST = pathlib.Path(__file__).parent.parent / "assets" / "aegean_sea.geojson"
RING = "r < 0.95 and r > 0.35"
CASES = {
    "a square": ["--spacing", "0.1"],
    "cells that are not square": ["--domain", "-3.25,0,4.5,3.3", "--spacing", "1.1"],
    "a coast, with nodes on it": ["--region", str(COAST), "--spacing", "0.5", "--boundary", "outline", "--boundary-diameter", "0.05"],
    "a ring": ["--domain", "-1,-1,1,1", "--spacing", "0.1", "--inside", RING],
    "a ring of coarse cells": ["--domain", "-1,-1,1,1", "--spacing", "0.1", "--inside", RING, "--boundary", "report"],
}
PICTURE = [640, 400]


class Found:
    """A mesh as a reader hands it over. Levels and boundary edges are None where the format or its reader has none."""

    def __init__(self, nodes, triangles, levels=None, boundary=None, exact=True):
        self.nodes = np.asarray(nodes, dtype=float)
        self.triangles = np.asarray(triangles, dtype=int)
        self.levels = levels if levels is None else np.asarray(levels, dtype=int)
        self.boundary = boundary if boundary is None else edge_set(boundary)
        self.tolerance = 1e-12 if exact else 1e-5
        # What only some formats have: names and edges of the pieces of the boundary, markers of nodes, parts.
        self.pieces, self.edges_by_marker, self.markers, self.names_by_marker, self.parts = [None] * 5

    def area(self):
        a, b, c = (self.nodes[self.triangles[:, corner], :2] for corner in range(3))
        (bx, by), (cx, cy) = (b - a).T, (c - a).T
        doubled = bx * cy - by * cx
        assert (doubled > 0).all(), "a triangle does not run anticlockwise"
        return doubled.sum() / 2

    def edges(self):
        """Each edge once, and how many triangles have it."""
        edges = np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]])
        return np.unique(np.sort(edges), axis=0, return_counts=True)

    def boundary_of_triangles(self):
        distinct, uses = self.edges()
        return edge_set(distinct[uses == 1])


def edge_set(edges):
    return {tuple(sorted(map(int, edge))) for edge in edges}


def read_vtu(path):
    mesh = meshio.read(path)
    found = Found(mesh.points, mesh.cells_dict["triangle"], mesh.cell_data_dict["level"]["triangle"])
    lines = bytes(mesh.field_data["boundary_names"]).decode().split("\n")
    found.names_by_marker = {marker: name for marker, name in enumerate(lines, start=1) if name}
    found.markers = mesh.point_data["boundary"]
    found.parts = mesh.cell_data_dict["part"]["triangle"]
    assert (mesh.point_data["target_diameter"] > 0).all()
    assert_quantity(found, mesh.point_data["quantity"])
    return found


def read_msh(path):
    mesh = meshio.read(path)
    groups = {name: tuple(map(int, group)) for name, group in mesh.field_data.items()}
    assert groups.pop("domain") == (1, 2)
    assert (mesh.cell_data_dict["gmsh:physical"]["triangle"] == 1).all()
    cells, levels = mesh.cells_dict, mesh.cell_data_dict["level"]["triangle"]
    found = Found(mesh.points, cells["triangle"], levels, cells["line"])
    found.parts = mesh.cell_data_dict["part"]["triangle"]
    found.pieces = {name: edge_set(cells["line"][mesh.cell_sets_dict[name]["line"]]) for name in groups}
    for name, (tag, dimension) in groups.items():
        edges = cells["line"][mesh.cell_data_dict["gmsh:physical"]["line"] == tag]
        assert dimension == 1 and edge_set(edges) == found.pieces[name], name
    found.quantity = mesh.point_data["quantity"]
    assert_quantity(found, found.quantity)
    return found


def read_binary_msh(path):
    """The numbers of the text."""
    found, text = read_msh(path), read_msh(path.parent.parent / "m.msh")
    for name in ["nodes", "triangles", "levels", "parts", "quantity"]:
        assert (getattr(found, name) == getattr(text, name)).all(), name
    assert found.pieces == text.pieces and path.read_bytes()[:15] == b"$MeshFormat\n4.1"
    return found


def read_msh2(path):
    """Gmsh 2.2: what Gmsh 4.1 has, in the same order, but for values of elements, on which meshio fails."""
    mesh = meshio.read(path, file_format="gmsh")
    groups = {name: tuple(map(int, group)) for name, group in mesh.field_data.items()}
    assert groups.pop("domain") == (1, 2)
    assert (mesh.cell_data_dict["gmsh:physical"]["triangle"] == 1).all()
    lines, marks = mesh.cells_dict["line"], mesh.cell_data_dict["gmsh:physical"]["line"]
    found = Found(mesh.points, mesh.cells_dict["triangle"], boundary=lines)
    found.pieces = {name: edge_set(lines[marks == tag]) for name, (tag, _) in groups.items()}
    assert found.pieces == read_msh(path.with_suffix(".msh")).pieces, "pieces"
    assert_quantity(found, mesh.point_data["quantity"])
    return found


def read_ww3(path, summary):
    """Gmsh 2 for WAVEWATCH III: points at the nodes of the open pieces, and z is the depth, which nobody gave."""
    mesh = meshio.read(path, file_format="gmsh")
    found = Found(mesh.points, mesh.cells_dict["triangle"])
    pieces = read_msh(path.with_suffix(".msh")).pieces
    open_names = [piece["name"] for piece in summary["boundary"] if piece["kind"] == "open"]
    open_nodes = {node for name in open_names for edge in pieces[name] for node in edge}
    points = [int(node) for block in mesh.cells if block.type == "vertex" for node in block.data.ravel()]
    assert len(points) == len(open_nodes) and set(points) == open_nodes, "points of open boundaries"
    assert (found.nodes[:, 2] == 0).all(), "depths"
    return found


def read_obj(path):
    mesh = meshio.read(path)
    # A block for each group. meshio drops their names: they come from the file.
    groups = [line.split("_")[1] for line in path.read_text().splitlines() if line.startswith("g level_")]
    levels = [int(level) for level, block in zip(groups, mesh.cells, strict=True) for _ in block.data]
    return Found(mesh.points, np.concatenate([block.data for block in mesh.cells]), levels)


def read_stl(path):
    mesh = meshio.read(path)
    return Found(mesh.points, mesh.cells_dict["triangle"], exact=False)


def read_triangle(path):
    parts = {ending: path.with_suffix("." + ending).read_text() for ending in ["node", "ele", "neigh", "edge"]}
    # That reader takes only Voronoi's edges from an .edge file; the segments of a .poly file are written the same.
    edges_only = "".join(line for line in parts.pop("edge").splitlines(True) if not line.startswith("#"))
    data = triangle.data.loads(poly="0 2 0 1\n" + edges_only + "0\n", **parts)
    markers = data["segment_markers"].ravel()
    edges = data["segments"][markers > 0]
    found = Found(data["vertices"], data["triangles"], data["triangle_attributes"].ravel(), edges)
    found.markers = data["vertex_markers"].ravel()
    found.edges_by_marker = {marker: edge_set(data["segments"][markers == marker]) for marker in set(markers) - {0}}
    assert_quantity(found, data["vertex_attributes"][:, 1])
    assert edge_set(data["segments"]) == edge_set(found.edges()[0]), "all edges"
    # The file counts from 1 and has -1 for none; the reader takes 1 off every number.
    assert (data["triangle_neighbors"] < 0).sum() == len(edges), "triangles across the edges"
    assert data["triangle_neighbors"].max() == len(data["triangles"]) - 1, "triangles are numbered from 1"
    return found


def read_2dm(path):
    with py2dm.Reader(str(path)) as mesh:
        nodes = [node.pos for node in mesh.iter_nodes()]
        triangles = [[node - 1 for node in element.nodes] for element in mesh.iter_elements()]
        strings = [[node - 1 for node in string.nodes] for string in mesh.iter_node_strings()]
    names = [line.split(": ", 1)[1] for line in path.read_text().splitlines() if line.startswith("# nodestring")]
    found = Found(nodes, triangles, boundary=[edge for string in strings for edge in zip(string, string[1:])])
    found.pieces = {}
    for name, string in zip(names, strings, strict=True):
        found.pieces.setdefault(name, set()).update(edge_set(zip(string, string[1:])))
    assert_quantity(found, found.nodes[:, 2])
    return found


def read_csv(path):
    rows = list(csv.DictReader(path.open()))
    corners = [[int(row[f"v{corner}"]) for corner in (1, 2, 3)] for row in rows]
    nodes = np.full((1 + max(max(row) for row in corners), 2), np.nan)
    for row, ids in zip(rows, corners):
        for corner, node in enumerate(ids, start=1):
            nodes[node] = float(row[f"x{corner}"]), float(row[f"y{corner}"])
    across = [(0, 1), (1, 2), (2, 0)]
    boundary = [
        (ids[a], ids[b]) for row, ids in zip(rows, corners) for n, (a, b) in enumerate(across, start=1) if not row[f"n{n}"]
    ]
    return Found(nodes, corners, [row["level"] for row in rows], boundary)


def read_svg(path, size):
    root = ElementTree.parse(path).getroot()
    *_, width, height = map(float, root.get("viewBox").split())
    scale = np.array(size) / [width, height]
    places, triangles, levels = {}, [], []
    for element in root.iter("{http://www.w3.org/2000/svg}path"):
        if not (element.get("id") or "").startswith("level-"):
            continue
        corners = [part.start for part in svg.path.parse_path(element.get("d")) if not isinstance(part, svg.path.Move)]
        assert len(corners) % 3 == 0
        enlarged = float((element.get("transform") or "scale(1)").removeprefix("scale(").removesuffix(")"))
        for first in range(0, len(corners), 3):
            a, b, c = (enlarged * corner for corner in corners[first : first + 3])
            # The page's y grows downwards, and a path may run either way.
            if ((b - a).conjugate() * (c - a)).imag > 0:
                b, c = c, b
            triangles.append([places.setdefault(corner, len(places)) for corner in (a, b, c)])
            levels.append(element.get("id").removeprefix("level-"))
    nodes = [[corner.real * scale[0], (height - corner.imag) * scale[1]] for corner in places]
    return Found(nodes, triangles, levels)


def read_png(path):
    width, height, rows, info = png.Reader(filename=str(path)).read()
    pixels = np.array([list(row) for row in rows]).reshape(height, width, info["planes"])
    assert [width, height] == PICTURE
    assert len(np.unique(pixels.reshape(-1, info["planes"]), axis=0)) > 4, "a picture of one colour"


def assert_quantity(found, values):
    assert np.allclose(values, found.nodes[:, 0] * found.nodes[:, 1], rtol=1e-12, atol=1e-300), "the quantity x*y"


def positions(json):
    """All positions of a GeoJSON object."""
    if isinstance(json, dict):
        return [at for part in json.values() for at in positions(part)]
    if not isinstance(json, list):
        return []
    is_position = len(json) >= 2 and all(isinstance(number, (int, float)) for number in json)
    return [json[:2]] if is_position else [at for part in json for at in positions(part)]


def sizes(options):
    """Width and height of the domain."""
    if "--region" in options:
        xs, ys = zip(*positions(json.loads(COAST.read_text())))
        return [max(xs) - min(xs), max(ys) - min(ys)]
    if "--domain" not in options:
        return [1.0, 1.0]
    x0, y0, x1, y1 = map(float, options[options.index("--domain") + 1].split(","))
    return [x1 - x0, y1 - y0]


def expected_area(summary, options):
    if "--region" in options:
        # The mesh differs from the polygons along the coast by less than a hundredth.
        assert abs(summary["area"] / summary["region_area"] - 1) < 0.01, "the area of the polygons"
        return summary["area"]
    width, height = sizes(options)
    if "--inside" not in options:
        return width * height
    if "--boundary" not in options:
        assert abs(summary["area"] / (np.pi * (0.95**2 - 0.35**2)) - 1) < 1e-4, "the area of the ring"
        return summary["area"]
    # Half a cell of the grid, halved at each level.
    coarse = summary["spacing"] ** 2 / 2
    return sum(count * coarse / 2**level for level, count in enumerate(summary["levels"]))


def check(found, summary, area):
    assert len(found.nodes) == summary["nodes"], f"{len(found.nodes)} nodes"
    assert len(np.unique(found.triangles)) == summary["nodes"], "a node belongs to no triangle"
    assert len(found.triangles) == summary["triangles"], f"{len(found.triangles)} triangles"
    if found.levels is not None:
        counts = np.bincount(found.levels).tolist()
        assert counts == summary["levels"], f"levels {counts}"
    if found.boundary is not None:
        assert found.boundary == found.boundary_of_triangles(), "edges of the boundary"
    check_boundary(found, summary)
    assert abs(found.area() / area - 1) < found.tolerance, f"area {found.area()} and not {area}"


def check_boundary(found, summary):
    """Names, edges and lengths of the pieces are those of the summary; edges with a marker are those of the piece."""
    pieces = summary["boundary"]
    names = [piece["name"] for piece in pieces]
    ids = [piece["id"] for piece in pieces]
    # A piece that the mesh left out is not listed, and the others keep their ids.
    assert len(set(names)) == len(names) and ids == sorted(set(ids)) and all(piece["edges"] > 0 for piece in pieces)
    names_by_marker = dict(zip((id + 1 for id in ids), names))
    assert found.names_by_marker in (None, names_by_marker), f"names {found.names_by_marker}"
    if found.edges_by_marker is not None:
        found.pieces = {names_by_marker[marker]: edges for marker, edges in found.edges_by_marker.items()}
    if found.pieces is not None:
        assert found.pieces.keys() == set(names), f"names {found.pieces.keys()}"
        for piece in pieces:
            edges = found.pieces[piece["name"]]
            ends = found.nodes[np.array(sorted(edges)), :2]
            length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()
            assert len(edges) == piece["edges"] and abs(length / piece["length"] - 1) < 1e-9, piece["name"]
    if found.markers is not None:
        on_boundary = {node for edge in found.boundary_of_triangles() for node in edge}
        assert set(np.flatnonzero(found.markers)) == on_boundary, "markers of the boundary"
    if found.parts is not None:
        assert np.bincount(np.asarray(found.parts, dtype=int)).tolist() == summary["part_triangles"], "parts"


def check_case(program, folder, options):
    outputs = [word for ending in ENDINGS for word in ("-o", str(folder / f"m.{ending}"))]
    picture = ["--size", "x".join(map(str, PICTURE))]
    command = [program, "mesh", "--json", "--target", TARGET, "--quantity", "x*y", *options, *outputs, *picture]
    ran = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    summary = json.loads(ran.stdout)
    area = expected_area(summary, options)
    readers = {
        "vtu": read_vtu,
        "msh": read_msh,
        "msh2": read_msh2,
        "ww3": lambda path: read_ww3(path, summary),
        "obj": read_obj,
        "stl": read_stl,
        "node": read_triangle,
        "2dm": read_2dm,
        "csv": read_csv,
        "svg": lambda path: read_svg(path, sizes(options)),
    }
    failures = check_binary(program, folder, options, summary, area)
    for ending, read in readers.items():
        try:
            check(read(folder / f"m.{ending}"), summary, area)
        except Exception as error:  # whatever a reader cannot take is a failure of that format
            failures.append(f".{ending}: {type(error).__name__}: {error}")
    read_png(folder / "m.png")
    return summary, failures


def check_binary(program, folder, options, summary, area):
    path = folder / "binary" / "m.msh"
    path.parent.mkdir()
    command = [program, "mesh", "--binary", "--target", TARGET, "--quantity", "x*y", *options, "-o", str(path)]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    try:
        check(read_binary_msh(path), summary, area)
    except Exception as error:  # as below
        return [f"binary .msh: {type(error).__name__}: {error}"]
    return []


SURFACE = "30*sin(6*x)*cos(4*y) + 5*x"
MODELS = ["vtu", "msh", "obj", "stl", "ply", "glb", "2dm"]


def read_model(path):
    """Places of nodes, and their triangles. The positions of .glb are turned back, and moved to the place that it states."""
    if path.suffix == ".2dm":
        with py2dm.Reader(str(path)) as mesh:
            places = np.array([node.pos for node in mesh.iter_nodes()])
            return places, np.array([[node - 1 for node in element.nodes] for element in mesh.iter_elements()])
    if path.suffix == ".glb":
        (model,) = trimesh.load(path, process=False).geometry.values()
        data = path.read_bytes()
        extras = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])["nodes"][0]["extras"]
        x, y, z = np.asarray(model.vertices, dtype=float).T
        assert model.is_winding_consistent and (model.face_normals[:, 1] > 0).all(), "triangles face up"
        return np.stack([x, -z, y], axis=1) + np.asarray(extras["origin"]), np.asarray(model.faces)
    mesh = meshio.read(path)
    blocks = [block.data for block in mesh.cells if block.type == "triangle"]
    if path.suffix == ".ply":
        assert np.array_equal(mesh.point_data["surface"], mesh.points[:, 2]), "the quantity"
        assert (mesh.point_data["quality"] > 0).all()
    return mesh.points, np.concatenate(blocks)


def check_heights(program, folder):
    """Heights are those of the surface, in every format that has a third coordinate."""
    words = [word for ending in MODELS for word in ("-o", str(folder / f"m.{ending}"))]
    domain = ["--domain", "2,10,4,11.5", "--spacing", "0.25"]
    command = [program, "mesh", "--json", "--surface", SURFACE, "--max-error", "0.3", *domain, *words]
    summary = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
    failures = []
    for ending in MODELS:
        try:
            places, triangles = read_model(folder / f"m.{ending}")
            x, y, z = places.T
            error = np.abs(30 * np.sin(6 * x) * np.cos(4 * y) + 5 * x - z).max()
            assert error < (1e-3 if ending in ("stl", "glb") else 1e-9), f"heights off by {error}"
            assert len(triangles) == summary["triangles"], f"{len(triangles)} triangles"
            check_area = Found(places, triangles, exact=ending not in ("stl", "glb"))
            assert abs(check_area.area() / 3 - 1) < check_area.tolerance, "area"
        except Exception as error:  # whatever a reader cannot take is a failure of that format
            failures.append(f".{ending}: {type(error).__name__}: {error}")
    return summary, failures


def check_small_vtu(program, folder):
    """meshio takes the arrays of a .vtu file for others, depending on their compressed sizes, unless they are stored in reverse order."""
    failed = []
    spacings = [f"0.{i}" for i in range(1500, 2000, 10)]
    for spacing in spacings:
        path = str(folder / "small.vtu")
        command = [program, "mesh", "--spacing", spacing, "--target", "0.079+0.2*r", "--quantity", "x*y", "-o", path]
        subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
        try:
            read_vtu(path)
        except Exception:  # whatever meshio cannot take
            failed.append(spacing)
    return len(spacings), failed


def check_squares(program, folder):
    """Quadrilaterals of .vtu and .msh are those of .gr3, which is text, and cover the area of the mesh."""
    names = [str(folder / name) for name in ("m.vtu", "m.msh", "b.msh", "m.gr3")]
    command = [program, "mesh", "--target", "0.05+0.2*r", "--cells", "squares", "--json"]
    command += [word for name in names[:2] + names[3:] for word in ("-o", name)]
    summary = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
    subprocess.run(command[:4] + command[4:6] + ["--binary", "-o", names[2]], check=True, stderr=subprocess.DEVNULL)
    lines = (folder / "m.gr3").read_text().splitlines()
    count, nodes = map(int, lines[1].split())
    rows = [list(map(int, line.split()))[2:] for line in lines[2 + nodes : 2 + nodes + count]]
    expected = sorted(tuple(node - 1 for node in row) for row in rows)
    quads = sum(len(row) == 4 for row in rows)
    assert quads > 10 and count + quads == summary["triangles"], f"{quads} quadrilaterals"
    failures = []
    for name in names[:3]:
        try:
            mesh = meshio.read(name)
            blocks = {kind: cells for kind, cells in mesh.cells_dict.items() if kind != "line"}
            assert sorted(blocks) == ["quad", "triangle"], sorted(blocks)
            found = sorted(tuple(map(int, cell)) for cells in blocks.values() for cell in cells)
            assert found == expected, "other cells"
            assert len(mesh.cell_data_dict["level"]["quad"]) == quads, "levels"
        except Exception as error:  # whatever a reader cannot take
            failures.append(f"{pathlib.Path(name).name}: {type(error).__name__}: {error}")
    return quads, failures


def main():
    broken = False
    with tempfile.TemporaryDirectory() as folder:
        quads, failures = check_squares(sys.argv[1], pathlib.Path(folder))
    print(f"squares: {quads} quadrilaterals, vtu, msh: {'; '.join(failures) or 'read back'}")
    broken |= bool(failures)
    with tempfile.TemporaryDirectory() as folder:
        count, failed = check_small_vtu(sys.argv[1], pathlib.Path(folder))
    print(f"{count} small .vtu files: {'not read at the spacings ' + ', '.join(failed) if failed else 'read back'}")
    broken |= bool(failed)
    with tempfile.TemporaryDirectory() as folder:
        summary, failures = check_heights(sys.argv[1], pathlib.Path(folder))
    print(f"heights: {summary['triangles']} triangles, {', '.join(MODELS)}: {'; '.join(failures) or 'read back'}")
    broken |= bool(failures)
    for name, options in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            summary, failures = check_case(sys.argv[1], pathlib.Path(folder), options)
        print(f"{name}: {summary['triangles']} triangles, {', '.join(ENDINGS)}: {'; '.join(failures) or 'read back'}")
        broken |= bool(failures)
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
