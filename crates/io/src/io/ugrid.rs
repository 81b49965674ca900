//! `.nc`: UGRID 1.0 in classic NetCDF, for Delft3D-FM and programs that read UGRID.
//!
//! The mesh is `mesh2d`: nodes, edges (each once, in the order of the triangles) and faces, which run
//! anticlockwise. Faces are quadrilaterals where the link between the two triangles of one would be too short
//! for the solver ([`MeshCells`](meshbrush_core::cells::MeshCells)), unless triangles are asked for. Numbers
//! start at one (`start_index`). `mesh2d_node_z` is the height of the ground in metres, positive upwards.
//! Further values at the nodes are `mesh2d_target_diameter` (h̄) and `mesh2d_quantity_…`; `mesh2d_level` is
//! on faces. `mesh2d_boundary` has the marker of the piece of each boundary edge, 0 inside; the names of the
//! pieces are its `flag_meanings`, with `_` for blanks and signs. Where types of pieces are set, `flag_types`
//! has the type of each, likewise. UGRID has no strings of nodes: lines of the document are in a file beside
//! it, [`pli`], and no quadrilateral has an edge along a line inside it. `idomain` on faces is the number of
//! the processor, from 0, where parts are asked for.
//!
//! A mesh in degrees has longitudes and latitudes in WGS 84; the coordinate system of others is not known.
//! Global attributes describe the origin of the mesh.

use std::io::{self, Write};

use super::netcdf_writer::{AttributeValue, Attributes, Dataset, VariableType, WriteRow, WrittenVariable};
use super::partition::Partition;
use super::triangle_pieces::TrianglePieces;
use super::written_cells::WrittenCells;
use super::{FormatSpec, MeshData, Meter, QuantityPlaces, SquareCells, TypicalSize, pli};
use meshbrush_mesh::mesh::{Extract, MeshEdge, NodeId, TriangleId};
use meshbrush_mesh::text::LengthUnit;

/// UGRID.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "Delft3D-FM (UGRID, NetCDF): squares and triangles, with h̄ and boundary markers",
    size: TypicalSize { bytes: 52.0, bytes_per_digit: 0.0 },
    has_targets: true,
    squares: SquareCells::Usual,
    quantities: QuantityPlaces::All,
    beside_lines: &[("_thd.pli", |out, mesh, data, meter| pli::write(&mut meter.count(out), mesh, data))],
    ..FormatSpec::new("ugrid", &["nc"], |mut out, mesh, data, meter| {
        write_metered(&mut out, mesh, data, meter)
    })
};

/// The numbers of the dimensions in [`dimensions`].
const NODES: usize = 0;
const EDGES: usize = 1;
const FACES: usize = 2;
const CORNERS: usize = 3;
const TWO: usize = 4;

/// The value in place of the fourth node of a triangle beside quadrilaterals.
const NO_NODE: i32 = -999;

/// Writes the mesh.
///
/// # Errors
/// Fails with the errors of `out`, and for a mesh that is too large for NetCDF.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    write_metered(out, mesh, data, &Meter::default())
}

/// Writes as [`write()`] does, and counts the bytes of the file.
///
/// # Errors
/// Fails as [`write()`] does, and when the work was cancelled.
pub fn write_metered(out: &mut impl Write, mesh: &Extract, data: &MeshData, meter: &Meter) -> io::Result<()> {
    let cells = &WrittenCells::new(mesh, data, FORMAT.squares);
    let edges = edge_count(mesh) - cells.joined_count();
    let pieces = TrianglePieces::new(mesh, data.boundary);
    let mut variables =
        vec![topology(), coordinate_system(data), coordinate(mesh, data, 0), coordinate(mesh, data, 1)];
    variables.push(on_nodes(data, "mesh2d_node_z".into(), ground_attributes(), |node| data.ground(node)));
    variables.extend(node_values(data));
    variables.extend([edge_nodes(mesh, cells), boundary(mesh, data, &pieces, cells)]);
    variables.extend([face_nodes(cells), levels(mesh, cells)]);
    variables.extend(domains(mesh, data, cells));
    let dataset = Dataset { dimensions: dimensions(mesh, edges, cells), attributes: origin(data), variables };
    dataset.write(out, meter)
}

fn dimensions(mesh: &Extract, edges: usize, cells: &WrittenCells<'_>) -> Vec<(&'static str, usize)> {
    vec![
        ("mesh2d_nNodes", mesh.nodes().len()),
        ("mesh2d_nEdges", edges),
        ("mesh2d_nFaces", cells.count()),
        ("mesh2d_nMax_face_nodes", cells.most_corners()),
        ("Two", 2),
    ]
}

/// Returns the number of edges: each triangle has three, and all but those of the boundary have two.
fn edge_count(mesh: &Extract) -> usize {
    (3 * mesh.triangles().len() + mesh.boundary_edges().count()) / 2
}

fn origin(data: &MeshData) -> Attributes {
    let conventions = ("Conventions", "CF-1.8 UGRID-1.0 Deltares-0.10".into());
    let entries = data.provenance.entries().map(|(key, text)| (key, AttributeValue::from(text)));
    std::iter::once(conventions).chain(entries).collect()
}

/// Returns a variable without values, for its attributes.
fn described<'a>(name: &str, attributes: Attributes) -> WrittenVariable<'a> {
    let write_row: WriteRow = Box::new(|out, _| out.write_all(&0_i32.to_be_bytes()));
    WrittenVariable {
        name: name.into(),
        kind: VariableType::Int,
        dimensions: Vec::new(),
        attributes,
        rows: 1,
        write_row,
    }
}

fn topology<'a>() -> WrittenVariable<'a> {
    let attributes = vec![
        ("cf_role", "mesh_topology".into()),
        ("long_name", "Topology data of 2D mesh".into()),
        ("topology_dimension", 2.into()),
        ("node_coordinates", "mesh2d_node_x mesh2d_node_y".into()),
        ("node_dimension", "mesh2d_nNodes".into()),
        ("max_face_nodes_dimension", "mesh2d_nMax_face_nodes".into()),
        ("edge_node_connectivity", "mesh2d_edge_nodes".into()),
        ("edge_dimension", "mesh2d_nEdges".into()),
        ("face_node_connectivity", "mesh2d_face_nodes".into()),
        ("face_dimension", "mesh2d_nFaces".into()),
    ];
    described("mesh2d", attributes)
}

/// The name of the variable that describes the coordinate system.
fn system_name(data: &MeshData) -> &'static str {
    if data.provenance.unit() == LengthUnit::Degree { "wgs84" } else { "projected_coordinate_system" }
}

fn coordinate_system<'a>(data: &MeshData) -> WrittenVariable<'a> {
    let attributes = match data.provenance.unit() {
        LengthUnit::Degree => vec![
            ("name", "WGS84".into()),
            ("epsg", 4326.into()),
            ("EPSG_code", "EPSG:4326".into()),
            ("grid_mapping_name", "latitude_longitude".into()),
            ("longitude_of_prime_meridian", 0.0.into()),
            ("semi_major_axis", 6_378_137.0.into()),
            ("inverse_flattening", 298.257_223_563.into()),
        ],
        LengthUnit::None | LengthUnit::Metre | LengthUnit::Kilometre => vec![
            ("name", "Unknown projected".into()),
            ("epsg", 0.into()),
            ("grid_mapping_name", "Unknown projected".into()),
        ],
    };
    described(system_name(data), attributes)
}

/// Returns the coordinates of the nodes along an axis, 0 for x and 1 for y.
fn coordinate<'a>(mesh: &'a Extract, data: &MeshData, axis: usize) -> WrittenVariable<'a> {
    let (standard, unit) = match data.provenance.unit() {
        LengthUnit::Degree => [("longitude", "degrees_east"), ("latitude", "degrees_north")][axis],
        unit => {
            let standard = ["projection_x_coordinate", "projection_y_coordinate"][axis];
            (standard, if unit == LengthUnit::None { "1" } else { unit.symbol() })
        }
    };
    let attributes = vec![
        ("standard_name", standard.into()),
        ("long_name", ["x of the nodes", "y of the nodes"][axis].into()),
        ("units", unit.into()),
        ("mesh", "mesh2d".into()),
        ("location", "node".into()),
    ];
    let name = ["mesh2d_node_x", "mesh2d_node_y"][axis].to_owned();
    real(name, attributes, mesh.nodes().len(), move |node| mesh.world(NodeId::from_index(node))[axis])
}

fn ground_attributes() -> Attributes {
    vec![
        ("standard_name", "altitude".into()),
        ("long_name", "height of the ground at the nodes".into()),
        ("units", "m".into()),
        ("positive", "up".into()),
    ]
}

/// Returns h̄ and the quantities.
fn node_values<'a>(data: &'a MeshData) -> impl Iterator<Item = WrittenVariable<'a>> {
    data.node_values().enumerate().map(|(number, (name, values))| {
        let variable = if number == 0 { format!("mesh2d_{name}") } else { format!("mesh2d_quantity_{name}") };
        on_nodes(data, variable, vec![("long_name", name.into())], move |node| values[node])
    })
}

/// Returns a variable with a value at each node.
fn on_nodes<'a>(
    data: &MeshData<'a>,
    name: String,
    mut attributes: Attributes,
    value: impl Fn(usize) -> f64 + Sync + 'a,
) -> WrittenVariable<'a> {
    attributes.extend([
        ("mesh", "mesh2d".into()),
        ("location", "node".into()),
        ("coordinates", "mesh2d_node_x mesh2d_node_y".into()),
        ("grid_mapping", system_name(data).into()),
    ]);
    real(name, attributes, data.target_diameter.len(), value)
}

fn real<'a>(
    name: String,
    attributes: Attributes,
    rows: usize,
    value: impl Fn(usize) -> f64 + Sync + 'a,
) -> WrittenVariable<'a> {
    let write_row: WriteRow = Box::new(move |out, row| out.write_all(&value(row).to_be_bytes()));
    WrittenVariable { name, kind: VariableType::Double, dimensions: vec![NODES], attributes, rows, write_row }
}

/// Returns a variable of whole numbers that is written in so many rows: of triangles, or of cells.
fn whole<'a>(
    name: &str,
    dimensions: Vec<usize>,
    attributes: Attributes,
    rows: usize,
    write_row: WriteRow<'a>,
) -> WrittenVariable<'a> {
    let name = name.to_owned();
    WrittenVariable { name, kind: VariableType::Int, dimensions, attributes, rows, write_row }
}

fn write_node(out: &mut Vec<u8>, node: usize) -> io::Result<()> {
    out.write_all(&(node as i32 + 1).to_be_bytes())
}

/// Returns the edges of a cell that no triangle with a lower number than `triangle` has.
fn first_edges<'a>(
    mesh: &'a Extract,
    cells: &'a WrittenCells<'_>,
    triangle: usize,
) -> impl Iterator<Item = MeshEdge> + 'a {
    let edges = mesh.first_edges_of(TriangleId::from_index(triangle));
    edges.filter(move |edge| cells.has_edge(triangle, edge.ends))
}

fn edge_nodes<'a>(mesh: &'a Extract, cells: &'a WrittenCells<'_>) -> WrittenVariable<'a> {
    let attributes = vec![
        ("cf_role", "edge_node_connectivity".into()),
        ("long_name", "the two nodes of each edge".into()),
        ("start_index", 1.into()),
    ];
    let write_row = Box::new(|out: &mut Vec<u8>, triangle: usize| {
        let edges = first_edges(mesh, cells, triangle);
        edges.flat_map(|edge| edge.ends).try_for_each(|node| write_node(out, node))
    });
    whole("mesh2d_edge_nodes", vec![EDGES, TWO], attributes, mesh.triangles().len(), write_row)
}

fn face_nodes<'a>(cells: &'a WrittenCells<'_>) -> WrittenVariable<'a> {
    let attributes = vec![
        ("cf_role", "face_node_connectivity".into()),
        ("long_name", "the nodes of each face, anticlockwise".into()),
        ("start_index", 1.into()),
        ("_FillValue", NO_NODE.into()),
    ];
    let has_fourth = cells.most_corners() == 4;
    let write_row = Box::new(move |out: &mut Vec<u8>, cell: usize| {
        let (corners, fourth) = cells.corners(cell);
        corners.into_iter().try_for_each(|node| write_node(out, node))?;
        match fourth {
            Some(node) => write_node(out, node),
            None if has_fourth => out.write_all(&NO_NODE.to_be_bytes()),
            None => Ok(()),
        }
    });
    whole("mesh2d_face_nodes", vec![FACES, CORNERS], attributes, cells.count(), write_row)
}

fn boundary<'a>(
    mesh: &'a Extract,
    data: &MeshData,
    pieces: &'a TrianglePieces,
    cells: &'a WrittenCells<'_>,
) -> WrittenVariable<'a> {
    let list = data.boundary.pieces().list();
    let names = data.boundary.present().map(|piece| one_word(&list[piece].name));
    let names: Vec<String> = std::iter::once("inside".to_owned()).chain(names).collect();
    let values = std::iter::once(0).chain(data.boundary.present().map(|piece| piece as i32 + 1)).collect();
    let mut attributes = vec![
        ("long_name", "piece of the boundary".into()),
        ("mesh", "mesh2d".into()),
        ("location", "edge".into()),
        ("flag_values", AttributeValue::Ints(values)),
        ("flag_meanings", AttributeValue::Text(names.join(" "))),
    ];
    if data.boundary.present().any(|piece| list[piece].set_type.is_some()) {
        let types = data.boundary.present().map(|piece| one_word(list[piece].boundary_type().word()));
        let types: Vec<String> = std::iter::once("inside".to_owned()).chain(types).collect();
        attributes.push(("flag_types", AttributeValue::Text(types.join(" "))));
    }
    let write_row = Box::new(|out: &mut Vec<u8>, triangle: usize| {
        let mut pieces = pieces.of(triangle);
        for edge in first_edges(mesh, cells, triangle) {
            let piece = if edge.on_boundary { pieces.next() } else { None };
            out.write_all(&piece.map_or(0, |piece| piece + 1).to_be_bytes())?;
        }
        Ok(())
    });
    whole("mesh2d_boundary", vec![EDGES], attributes, mesh.triangles().len(), write_row)
}

/// Returns a name as the conventions of NetCDF want it in a list of words.
fn one_word(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "_-.+@".contains(c) { c } else { '_' }).collect()
}

fn levels<'a>(mesh: &'a Extract, cells: &'a WrittenCells<'_>) -> WrittenVariable<'a> {
    let attributes = vec![
        ("long_name", "level of the triangle, or the lower one of two".into()),
        ("mesh", "mesh2d".into()),
        ("location", "face".into()),
    ];
    let write_row = Box::new(|out: &mut Vec<u8>, cell: usize| {
        let levels = cells.triangles(cell).map(|triangle| mesh.triangles()[triangle].level());
        out.write_all(&(levels[0].min(levels[1]) as i32).to_be_bytes())
    });
    whole("mesh2d_level", vec![FACES], attributes, cells.count(), write_row)
}

/// Returns the part of each cell, where parts are asked for.
fn domains<'a>(mesh: &Extract, data: &MeshData, cells: &'a WrittenCells<'_>) -> Option<WrittenVariable<'a>> {
    let parts = data.parts_for?;
    let attributes = vec![
        ("long_name", "number of the domain of each face, from 0".into()),
        ("mesh", "mesh2d".into()),
        ("location", "face".into()),
    ];
    let partition = Partition::new(mesh, cells, parts);
    let write_row = Box::new(move |out: &mut Vec<u8>, cell: usize| {
        out.write_all(&(partition.owner(cell) as i32).to_be_bytes())
    });
    Some(whole("idomain", vec![FACES], attributes, cells.count(), write_row))
}
