"""Files of coastal solvers, read back by readers that are not ours: nodes, triangles, depths with their sign, and the
pieces of the boundary with their types.

Called by tests/run with the program to test: solver_readers.py PROGRAM. Needs numpy and meshio (from Debian), and from PyPI
netCDF4, python-serafin, and of pyschism the one file that reads meshes, as the package needs others that have no wheels.
"""

import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile

import meshio
import netCDF4
import numpy as np

SEA = {
    "type": "Polygon",
    "coordinates": [[[0, 0], [4, 0], [4, 3], [2, 4], [0, 3], [0, 0]], [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]],
}
RECIPE = """
[domain]
region = "sea.geojson"
unit = "m"
boundary_diameter = 0.2
splits = [[3, 3.5], [1, 3.5]]
names = [{ at = [2, 4], name = "River" }, { at = [1, 1.5], name = "Rock" }]
types = [
  { at = [2, 4], type = "inflow" }, { at = [2, 0], type = "natural inflow" }, { at = [4, 1], type = "no-slip land" },
  { at = [1, 1.5], type = "natural land" },
]
[mesh]
spacing = 1
[[layer]]
kind = "formula"
quantity = "diameter"
formula = "0.4"
"""
# ADCIRC's number of a string; that of an island is one higher. Open strings have none.
ADCIRC = {"open": None, "land": 0, "no-slip land": 10, "natural land": 20, "inflow": 2, "no-slip inflow": 12, "natural inflow": 22}
TELEMAC = {"open": [5, 4, 4, 4], "no-slip land": [2, 0, 0, 2], "land": [2, 2, 2, 2], "natural land": [2, 2, 2, 2]}
INFLOW = [4, 5, 5, 5]


def pyschism_reader():
    package = importlib.util.find_spec("pyschism").submodule_search_locations[0]
    spec = importlib.util.spec_from_file_location("grd", pathlib.Path(package) / "mesh" / "parsers" / "grd.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check_mesh(expected, x, y, triangles, depths, parser_error=0):
    """`parser_error`: the relative error of the reader's own parser of numbers."""
    places, wanted = np.column_stack([x, y]), expected.points[:, :2]
    assert places.shape == wanted.shape and np.allclose(places, wanted, rtol=parser_error, atol=0), "nodes"
    assert np.array_equal(triangles, expected.cells_dict["triangle"]), "triangles"
    assert np.allclose(depths, expected.point_data["depth"], rtol=1e-12), "depths"


def plane_length(places, edges):
    ends = places[np.array(edges)]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()


def check_pyschism(path, expected, pieces, number_of, length_of=plane_length):
    with path.open() as file:
        found = pyschism_reader().buffer_to_dict(file)
    nodes = found["nodes"].values()
    places, depths = np.array([place for place, _ in nodes]), [depth for _, depth in nodes]
    triangles = np.array(list(found["elements"].values()), dtype=int) - 1
    check_mesh(expected, places[:, 0], places[:, 1], triangles, depths)
    strings = {
        number: [[int(node) - 1 for node in string["indexes"]] for string in strings.values()]
        for number, strings in found["boundaries"].items()
    }
    check_strings(path, strings, pieces, number_of, lambda edges: length_of(places, edges))


def check_strings(path, strings, pieces, number_of, length_of):
    """`strings` are those of each number as a reader has them, in the order of the file. Names come from the text, as
    readers drop them."""
    heads = [line for line in path.read_text().splitlines() if " = Number of nodes for " in line]
    seen, edges_of = set(), {}
    for head in heads:
        number = None if " for open " in head else int(head.split()[1])
        nodes = strings[number].pop(0)
        if number is not None and number % 10 == 1:
            nodes.append(nodes[0])
        # ADCIRC has open pieces that meet as one string, with the names of all.
        names = tuple(head.split(": ", 1)[1].split(", "))
        edges_of.setdefault(names, [number]).extend(zip(nodes, nodes[1:]))
        seen |= set(zip(nodes, nodes[1:]))
    assert not any(strings.values()), "a string without a head"
    assert len(seen) == sum(piece["edges"] for piece in pieces), "each edge once"
    of_name = {piece["name"]: piece for piece in pieces}
    assert sorted(name for names in edges_of for name in names) == sorted(of_name), edges_of.keys()
    for names, (number, *edges) in edges_of.items():
        parts = [of_name[name] for name in names]
        assert len(edges) == sum(piece["edges"] for piece in parts), names
        assert abs(length_of(edges) / sum(piece["length"] for piece in parts) - 1) < 1e-9, names
        assert {number} == {number_of(piece) for piece in parts}, f"{names}: {number}"


def adcirc_number(piece):
    number = ADCIRC[piece["type"]]
    return number + 1 if piece["kind"] == "island" and "land" in piece["type"] else number


def schism_number(piece):
    is_open = piece["type"] == "open" or "inflow" in piece["type"]
    return None if is_open else int(piece["kind"] == "island")


def check_friction(path, expected):
    """Checks the file that SCHISM reads Manning's n from."""
    with path.open() as file:
        nodes = pyschism_reader().buffer_to_dict(file)["nodes"].values()
    assert np.allclose([value for _, value in nodes], expected.point_data["manning"], rtol=1e-12), "Manning's n"


def check_selafin(path, expected, pieces):
    from serafin import SerafinReader  # tests/public_readers.py does without

    with SerafinReader(str(path), "en") as file:
        file.read_header()
        file.get_time()
        header, bottom = file.header, file.read_var_in_frame(0, "B")
        assert [name.decode().strip() for name in header.var_names] == ["BOTTOM", "BOTTOM FRICTION"], header.var_names
        friction = file.read_var_in_frame(0, header.var_ids[1])
    assert np.allclose(friction, expected.point_data["manning"], rtol=1e-12), "Manning's n"
    check_mesh(expected, header.x, header.y, header.ikle_2d_zero_based, -bottom)
    types = {piece["name"]: piece["type"] for piece in pieces}
    rows = [line.split(" # ") for line in path.with_suffix(".cli").read_text().splitlines()]
    assert len(rows) == sum(piece["edges"] for piece in pieces), "boundary nodes"
    for place, (numbers, name) in enumerate(rows, start=1):
        row = [float(number) for number in numbers.split()]
        assert row[12] == place and header.ipobo[int(row[11]) - 1] == place, "IPOBO"
        assert [row[0], row[1], row[2], row[7]] == TELEMAC.get(types[name], INFLOW), f"{name}: {numbers}"
    assert {name for _, name in rows} == types.keys(), "names"


def check_ugrid(path, expected, pieces):
    with netCDF4.Dataset(path) as file:
        topology = next(variable for variable in file.variables.values() if getattr(variable, "cf_role", "") == "mesh_topology")
        x, y = (file[name][:] for name in topology.node_coordinates.split())
        corners = file[topology.face_node_connectivity]
        assert file["mesh2d_node_z"].positive == "up"
        check_mesh(expected, x, y, corners[:] - corners.start_index, -file["mesh2d_node_z"][:])
        assert np.allclose(file["mesh2d_quantity_manning"][:], expected.point_data["manning"], rtol=1e-12), "Manning's n"
        boundary = file["mesh2d_boundary"]
        names, types = boundary.flag_meanings.split(), boundary.flag_types.split()
        markers = dict(zip(boundary.flag_values.tolist(), zip(names, types, strict=True), strict=True))
        counts = np.bincount(boundary[:])
    for piece in pieces:
        marker = piece["id"] + 1
        assert markers[marker] == (piece["name"].replace(" ", "_"), piece["type"].replace(" ", "_")), piece["name"]
        assert counts[marker] == piece["edges"], piece["name"]
    assert counts.sum() - counts[0] == sum(piece["edges"] for piece in pieces), "edges of the boundary"


def check_squares(program, folder, expected):
    """Checks the cells that `.nc` has by default: they cover the mesh, and two triangles make a quadrilateral."""
    subprocess.run([program, "mesh", "sea.toml", "-o", "squares.nc"], check=True, stderr=subprocess.DEVNULL, cwd=folder)
    with netCDF4.Dataset(folder / "squares.nc") as file:
        topology = next(variable for variable in file.variables.values() if getattr(variable, "cf_role", "") == "mesh_topology")
        x, y = (np.asarray(file[name][:]) for name in topology.node_coordinates.split())
        corners = file[topology.face_node_connectivity]
        cells = [row.compressed() - corners.start_index for row in np.ma.masked_array(corners[:])]
        edges = file[topology.edge_node_connectivity][:] - 1

    def area(cell):
        return 0.5 * np.sum(x[cell] * np.roll(y[cell], -1) - np.roll(x[cell], -1) * y[cell])

    triangles = expected.cells_dict["triangle"]
    squares = sum(len(cell) == 4 for cell in cells)
    assert squares > 10 and len(cells) + squares == len(triangles), "a quadrilateral is two triangles"
    assert all(area(cell) > 0 for cell in cells), "anticlockwise"
    assert np.isclose(sum(map(area, cells)), sum(map(area, triangles)), rtol=1e-12), "the cells cover the mesh"
    sides = {frozenset(side) for cell in cells for side in zip(cell.tolist(), np.roll(cell, -1).tolist(), strict=True)}
    assert sides == {frozenset(edge) for edge in edges.tolist()} and len(sides) == len(edges), "each edge once"


def write_sea(program, folder, endings):
    """Writes a small sea with every type of boundary; returns the mesh that the files have, and the pieces of its boundary."""
    (folder / "sea.geojson").write_text(json.dumps(SEA))
    (folder / "sea.toml").write_text(RECIPE)
    outputs = [word for ending in ["vtu", *endings] for word in ("-o", f"sea.{ending}")]
    outputs += ["-o", "manning.gr3"]
    command = [program, "mesh", "sea.toml", "--json", "--cells", "triangles", "--quantity", "depth=20 + x/3 - y", "--quantity", "manning=0.02 + y/100", *outputs]
    ran = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=folder)
    pieces = json.loads(ran.stdout)["boundary"]
    assert {piece["type"] for piece in pieces} == {"open", "land", "no-slip land", "natural land", "inflow", "natural inflow"}
    expected = meshio.read(folder / "sea.vtu")
    depths = 20 + expected.points[:, 0] / 3 - expected.points[:, 1]
    assert np.allclose(expected.point_data["depth"], depths, rtol=1e-12), "depths"
    return expected, pieces


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        expected, pieces = write_sea(str(pathlib.Path(sys.argv[1]).resolve()), folder, ["14", "gr3", "slf", "nc"])
        check_friction(folder / "manning.gr3", expected)
        check_pyschism(folder / "sea.14", expected, pieces, adcirc_number)
        check_pyschism(folder / "sea.gr3", expected, pieces, schism_number)
        check_selafin(folder / "sea.slf", expected, pieces)
        check_ugrid(folder / "sea.nc", expected, pieces)
        check_squares(str(pathlib.Path(sys.argv[1]).resolve()), folder, expected)
    print(f"a sea with {len(pieces)} typed pieces: .14, .gr3, .slf with .cli, .nc: read back")


if __name__ == "__main__":
    main()
