//! A mesh as arrays.

use std::convert::Infallible;

use js_sys::{Array, Float64Array, Int32Array, Uint8Array, Uint32Array};
use meshbrush_core::domain::MeshBoundary;
use wasm_bindgen::prelude::*;

use crate::document::Core;

/// Nodes and triangles have the order and the numbers that they have in files, counted from 0.
#[wasm_bindgen]
impl Core {
    /// The number of nodes.
    #[wasm_bindgen(getter, js_name = nodeCount)]
    pub fn node_count(&self) -> usize {
        self.derived().extract.nodes().len()
    }

    /// The number of triangles.
    #[wasm_bindgen(getter, js_name = triangleCount)]
    pub fn triangle_count(&self) -> usize {
        self.derived().extract.triangles().len()
    }

    /// x and y of each node, in world units.
    pub fn nodes(&self) -> Float64Array {
        let nodes: Vec<f64> =
            self.derived().extract.world_nodes().flat_map(|node| [node.x, node.y]).collect();
        Float64Array::from(&nodes[..])
    }

    /// The nodes of each triangle anticlockwise; the first two are the ends of its longest edge.
    pub fn triangles(&self) -> Uint32Array {
        let cells = self.derived().extract.cells();
        let corners: Vec<u32> = cells.flat_map(|cell| cell.corners.map(|node| node as u32)).collect();
        Uint32Array::from(&corners[..])
    }

    /// How often the coarse triangle was halved to get each triangle.
    pub fn levels(&self) -> Uint8Array {
        let levels: Vec<u8> = self.derived().extract.cells().map(|cell| cell.level as u8).collect();
        Uint8Array::from(&levels[..])
    }

    /// The triangle opposite each corner; −1 where there is none.
    pub fn neighbours(&self) -> Int32Array {
        let number = |opposite: Option<usize>| opposite.map_or(-1, |triangle| triangle as i32);
        let neighbours: Vec<i32> =
            self.derived().extract.cells().flat_map(|cell| cell.opposite.map(number)).collect();
        Int32Array::from(&neighbours[..])
    }

    /// h̄ at each node, in world units.
    pub fn h(&self) -> Float64Array {
        let (field, paint) = (self.field(), self.document.paint());
        let rule = self.settings().rule;
        let Ok(targets) =
            field.targets_at_nodes(rule, paint, &self.derived().extract, || Ok::<_, Infallible>(()));
        Float64Array::from(&targets[..])
    }

    /// The pieces of the boundary in the order of markers: name, marker, and edges as the nodes at their
    /// ends with the domain on the left.
    pub fn boundary(&self) -> Array {
        let (settings, extract) = (self.settings(), &self.derived().extract);
        let boundary = MeshBoundary::new(extract, &settings.domain, &settings.boundary_marks);
        let pieces = boundary.pieces().list();
        let mut edges = vec![Vec::new(); pieces.len()];
        for (edge, &piece) in extract.boundary_edges().zip(boundary.piece_of_edge()) {
            edges[piece as usize].extend(edge.ends.map(|node| node as u32));
        }
        let row = |piece: usize| {
            let edges = Uint32Array::from(&edges[piece][..]);
            Array::of3(&pieces[piece].name.as_str().into(), &(piece as u32 + 1).into(), &edges)
        };
        boundary.present().map(row).collect()
    }

    /// 32 hexadecimal digits, equal for equal meshes.
    pub fn fingerprint(&self) -> String {
        self.mesh().map(|mesh| mesh.fingerprint().to_string()).unwrap_or_default()
    }

    /// The number of rules that the mesh breaks.
    pub fn violations(&self) -> usize {
        let derived = self.derived();
        let of_mesh = self.mesh().map_or(0, |mesh| mesh.violations().len());
        of_mesh + derived.mesh.violations(&derived.extract).len()
    }

    /// x₀, y₀, x₁ and y₁ of the rectangle of the domain, in world units.
    pub fn bounds(&self) -> Vec<f64> {
        let bounds = self.settings().domain.bounds;
        vec![bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y]
    }
}
