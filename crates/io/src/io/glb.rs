//! `.glb`: glTF 2.0 in one binary file, for viewers, browsers, game engines and 3D programs.
//!
//! The format has lengths in metres and y upwards: x is that of the mesh, y the height of the surface (0
//! without one), and z is minus the y of the mesh. Positions have seven digits, so they are relative to the
//! middle of the mesh; `extras` of the node has that place as `origin`, and the length in metres of a unit of
//! x and of y as `metres_per_unit`. Degrees become metres by the radius of the Earth and the latitude of the
//! middle. Normals are those of the triangles around a node, weighted by their areas. Triangles face up;
//! `asset.extras` describes the origin of the mesh. The format has no place for h̄ and levels.

use std::io::{self, Write};

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::{FormatSpec, MeshData, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, TriangleId};
use meshbrush_mesh::text::LengthUnit;

/// glTF in binary form.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "glTF: viewers, browsers, game engines; in metres, y upwards",
    size: TypicalSize { bytes: 24.0, bytes_per_digit: 0.0 },
    third: ThirdCoordinate::Model,
    ..FormatSpec::new("glb", &["glb"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Metres in a degree of latitude, on a sphere with the mean radius of the Earth.
const METRES_A_DEGREE: f64 = 6_371_008.8 * std::f64::consts::PI / 180.0;
/// glTF's numbers for kinds of values and uses of buffers.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const OF_VERTICES: u32 = 34_962;
const OF_INDICES: u32 = 34_963;

/// Positions and normals of the nodes, in the coordinates of glTF.
struct Model {
    /// The middle of the mesh, in its own coordinates: x, y and height.
    origin: DVec3,
    metres_per_unit: DVec2,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

/// Writes positions, normals and triangles.
///
/// # Errors
/// Fails with the errors of `out`, and when the file would be larger than 4 GiB, the limit of the format.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let model = Model::new(mesh, data);
    let (nodes, triangles) = (mesh.nodes().len(), mesh.triangles().len());
    let bytes = 24 * nodes + 12 * triangles;
    let mut text = model.description(mesh, data, bytes).to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let whole = u32::try_from(12 + 8 + text.len() + 8 + bytes)
        .map_err(|_| io::Error::other("a .glb has at most 4 GiB, and this mesh needs more"))?;
    out.write_all(b"glTF")?;
    [2, whole, text.len() as u32].iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))?;
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    out.write_all(&(bytes as u32).to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    for values in [&model.positions, &model.normals] {
        write_rows(out, nodes, |out, node| {
            out.write_all(bytemuck::bytes_of(&values[node].map(f32::to_le_bytes)))
        })?;
    }
    write_rows(out, triangles, |out, id| {
        let corners = mesh.cell(TriangleId::from_index(id)).corners;
        out.write_all(bytemuck::bytes_of(&corners.map(|node| (node as u32).to_le_bytes())))
    })
}

impl Model {
    fn new(mesh: &Extract, data: &MeshData) -> Self {
        let bounds = Rect::holding(mesh.world_nodes());
        let middle = bounds.map_or(DVec2::ZERO, |bounds| bounds.center());
        let heights = (0..mesh.nodes().len()).map(|node| data.height(node));
        let [lowest, highest] =
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], height| [a.min(height), b.max(height)]);
        let origin = middle.extend(if lowest <= highest { lowest.midpoint(highest) } else { 0.0 });
        let metres_per_unit = metres_per_unit(data.provenance.unit(), middle);
        let places: Vec<DVec3> = (mesh.world_nodes().enumerate())
            .map(|(node, p)| {
                let along = (p - middle) * metres_per_unit;
                DVec3::new(along.x, data.height(node) - origin.z, -along.y)
            })
            .collect();
        let mut normals = vec![DVec3::ZERO; places.len()];
        for id in (0..mesh.triangles().len()).map(TriangleId::from_index) {
            let corners = mesh.cell(id).corners;
            let [a, b, c] = corners.map(|node| places[node]);
            corners.iter().for_each(|&node| normals[node] += (b - a).cross(c - a));
        }
        let normal = |normal: DVec3| normal.try_normalize().unwrap_or(DVec3::Y).as_vec3().to_array();
        Self {
            origin,
            metres_per_unit,
            positions: places.into_iter().map(|place| place.as_vec3().to_array()).collect(),
            normals: normals.into_iter().map(normal).collect(),
        }
    }

    /// Returns the part of the file that describes the other one, of so many bytes.
    fn description(&self, mesh: &Extract, data: &MeshData, bytes: usize) -> Value {
        let (nodes, triangles) = (mesh.nodes().len(), mesh.triangles().len());
        let corner = |choose: fn(f32, f32) -> f32| {
            let chosen = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|axis| choose(a[axis], b[axis]));
            self.positions.iter().copied().reduce(chosen).unwrap_or_default()
        };
        let entries = data.provenance.entries().map(|(key, text)| (key.to_owned(), Value::from(text)));
        let view = |offset: usize, length: usize, target: u32| json!({"buffer": 0, "byteOffset": offset, "byteLength": length, "target": target});
        json!({
            "asset": {
                "version": "2.0",
                "generator": concat!("Meshbrush ", env!("CARGO_PKG_VERSION")),
                "extras": Value::Object(entries.collect()),
            },
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{
                "mesh": 0,
                "name": "mesh",
                "extras": {
                    "origin": self.origin.to_array(),
                    "metres_per_unit": self.metres_per_unit.to_array(),
                },
            }],
            "meshes": [{
                "primitives": [{
                    "attributes": {"POSITION": 0, "NORMAL": 1},
                    "indices": 2,
                    "material": 0,
                    "mode": 4,
                }],
            }],
            "materials": [{
                "doubleSided": true,
                "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1.0], "metallicFactor": 0.0},
            }],
            "buffers": [{"byteLength": bytes}],
            "bufferViews": [
                view(0, 12 * nodes, OF_VERTICES),
                view(12 * nodes, 12 * nodes, OF_VERTICES),
                view(24 * nodes, 12 * triangles, OF_INDICES),
            ],
            "accessors": [
                {
                    "bufferView": 0, "componentType": FLOAT, "count": nodes, "type": "VEC3",
                    "min": corner(f32::min), "max": corner(f32::max),
                },
                {"bufferView": 1, "componentType": FLOAT, "count": nodes, "type": "VEC3"},
                {"bufferView": 2, "componentType": UNSIGNED_INT, "count": 3 * triangles, "type": "SCALAR"},
            ],
        })
    }
}

/// Returns the lengths of a unit of x and of y around a place, in metres.
fn metres_per_unit(unit: LengthUnit, middle: DVec2) -> DVec2 {
    match unit {
        LengthUnit::None | LengthUnit::Metre => DVec2::ONE,
        LengthUnit::Kilometre => DVec2::splat(1000.0),
        LengthUnit::Degree => METRES_A_DEGREE * DVec2::new(libm::cos(middle.y.to_radians()), 1.0),
    }
}
