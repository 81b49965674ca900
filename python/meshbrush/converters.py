"""Meshes of other libraries, with the names of the boundary. Each library is imported when it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import meshio
    import skfem
    from matplotlib.tri import Triangulation

    from .mesh import Mesh


def _edges(mesh: Mesh) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Returns all boundary edges, and their markers."""
    boundary, markers = mesh.boundary, mesh.markers
    if not boundary:
        return np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int64)
    edges = np.concatenate(list(boundary.values())).astype(np.int64)
    marker = np.concatenate([np.full(len(part), markers[name]) for name, part in boundary.items()])
    return edges, marker.astype(np.int64)


def _lines(mesh: Mesh) -> dict[str, npt.NDArray[np.int64]]:
    """Returns the edges along each line. A line with the name of a piece of the boundary is called "line" and its name."""
    edges = {}
    for name, runs in mesh.lines.items():
        while name in mesh.markers or name in edges:
            name = f"line {name}"
        edges[name] = np.concatenate([np.column_stack([run[:-1], run[1:]]) for run in runs]).astype(np.int64)
    return edges


def to_meshio(mesh: Mesh) -> meshio.Mesh:
    """Returns triangles, and edges of the boundary and of lines, in two dimensions: with sets and with physical groups."""
    import meshio

    edges, marker = _edges(mesh)
    count = len(mesh.triangles)
    inside = max(mesh.markers.values(), default=0) + 1
    numbers = dict(mesh.markers)
    for number, (name, along) in enumerate(_lines(mesh).items(), inside + 1):
        numbers[name] = number
        edges = np.concatenate([edges, along])
        marker = np.concatenate([marker, np.full(len(along), number, dtype=np.int64)])
    nothing = np.empty(0, dtype=np.int64)
    sets = {name: [nothing, np.flatnonzero(marker == number)] for name, number in numbers.items()}
    physical = [np.full(count, inside, dtype=np.int32), marker.astype(np.int32)]
    return meshio.Mesh(
        mesh.nodes,
        [("triangle", mesh.triangles.astype(np.int64)), ("line", edges)],
        point_data={"target_diameter": mesh.h},
        cell_data={
            "level": [mesh.levels.astype(np.int64), np.zeros(len(edges), dtype=np.int64)],
            "gmsh:physical": physical,
            "gmsh:geometrical": physical,
        },
        cell_sets=sets,
        field_data={**{name: np.array([n, 1]) for name, n in numbers.items()}, "domain": np.array([inside, 2])},
    )


def to_skfem(mesh: Mesh) -> skfem.MeshTri:
    """Returns a `MeshTri` with the pieces of the boundary and the lines as named facets."""
    import skfem

    found = skfem.MeshTri(np.ascontiguousarray(mesh.nodes.T), np.ascontiguousarray(mesh.triangles.T.astype(np.int64)))
    count = np.int64(len(mesh.nodes))
    keys = found.facets[0].astype(np.int64) * count + found.facets[1]
    order = np.argsort(keys)
    names = {}
    all_edges: dict[str, npt.NDArray[Any]] = {**mesh.boundary, **_lines(mesh)}
    for name, edges in all_edges.items():
        ends = np.sort(edges.astype(np.int64), axis=1)
        names[name] = order[np.searchsorted(keys, ends[:, 0] * count + ends[:, 1], sorter=order)]
    return found.with_boundaries(names)


def to_triangulation(mesh: Mesh) -> Triangulation:
    """Returns a triangulation of matplotlib."""
    from matplotlib.tri import Triangulation

    x, y = np.ascontiguousarray(mesh.nodes.T)
    return Triangulation(x, y, mesh.triangles.astype(np.int32))


def to_dolfinx(mesh: Mesh, comm: Any) -> Any:
    """Returns mesh, facet tags and the marker of each name. All ranks call it; the arrays of rank 0 count."""
    import basix.ufl
    import dolfinx
    import ufl

    edges, marker = _edges(mesh)
    is_first = comm.rank == 0
    cells = mesh.triangles.astype(np.int64) if is_first else np.empty((0, 3), dtype=np.int64)
    points = np.array(mesh.nodes) if is_first else np.empty((0, 2), dtype=np.float64)
    element = ufl.Mesh(basix.ufl.element("Lagrange", "triangle", 1, shape=(2,)))
    # The order of the arguments has changed from version to version; their names have not.
    found = dolfinx.mesh.create_mesh(comm=comm, cells=cells, e=element, x=points)
    given = (edges, marker.astype(np.int32)) if is_first else (edges[:0], np.empty(0, dtype=np.int32))
    local, values = dolfinx.io.distribute_entity_data(found, 1, *given)
    found.topology.create_connectivity(1, 0)
    found.topology.create_connectivity(1, 2)
    tags = dolfinx.mesh.meshtags_from_entities(found, 1, dolfinx.graph.adjacencylist(local), values.astype(np.int32))
    tags.name = "boundary"
    return found, tags, mesh.markers


def to_firedrake(mesh: Mesh, comm: Any = None) -> Any:
    """Returns a mesh whose boundary ids are the markers. The arrays are those of each process: call it on one."""
    import firedrake
    from firedrake import mesh as firedrake_mesh

    comm = firedrake.COMM_WORLD if comm is None else comm
    plex = firedrake_mesh.plex_from_cell_list(2, mesh.triangles.astype(np.int32), np.array(mesh.nodes), comm)
    plex.createLabel("Face Sets")
    first, _ = plex.getDepthStratum(0)
    edges, marker = _edges(mesh)
    for (a, b), number in zip(edges.tolist(), marker.tolist()):
        joined = plex.getJoin([first + a, first + b])
        plex.setLabelValue("Face Sets", int(joined[0]), number)
    return firedrake.Mesh(plex)
