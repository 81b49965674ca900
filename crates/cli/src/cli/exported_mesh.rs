//! A mesh with all that its files have of it.

use std::path::PathBuf;

use super::build::FinishedMesh;
use super::depths::{ChangedDepths, DepthChanges};
use super::details::MeshDetails;
use super::failure::Failure;
use super::output::Output;
use super::output_coordinates::OutputCoordinates;
use super::quantities::NamedQuantity;
use meshbrush_core::earth::Coordinates;
use meshbrush_io::io::{
    CellShape, DEPTH, JoinedCells, MeshData, Meter, NodeValues, Provenance, SURFACE, ThirdCoordinate,
};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::render::look::Look;

/// Why coordinates in a file cannot be those of another plane.
pub(super) const NOT_ON_EARTH: &str = "--out-crs: the domain is not in the plane of a projection, so its coordinates are those of its \
     files. Choose a plane with --projection, or leave this out.";

/// A mesh as its files have it.
#[derive(Clone, Copy)]
pub struct ExportedMesh<'a> {
    /// The mesh.
    pub finished: &'a FinishedMesh,
    /// Its nodes and triangles.
    pub extract: &'a Extract<'a>,
    /// Its boundary, parts and depths.
    pub details: &'a MeshDetails,
    /// Where it comes from, and what its coordinates are.
    pub provenance: &'a Provenance,
    /// Its coordinates in files.
    pub coordinates: OutputCoordinates,
    /// h̄ at each node; not needed where no format has it.
    pub target_diameter: &'a [f64],
}

impl ExportedMesh<'_> {
    /// Writes a file with the nodes and triangles as they are `placed`.
    ///
    /// A model in space with heights is placed in the plane of a projection instead of in degrees: its
    /// coordinates are lengths.
    pub(super) fn write(
        &self,
        output: &Output,
        placed: &Extract,
        data: &MeshData,
        look: &Look,
        meter: &Meter,
    ) -> Result<Vec<PathBuf>, Failure> {
        let names = data.quantities.iter().map(|quantity| quantity.name.as_str());
        if let Some(name) = output.in_place_of_depth(names)? {
            let of_name = data.quantities.iter().filter(|quantity| quantity.name == name);
            let quantities: Vec<NodeValues> =
                of_name.map(|of| NodeValues { name: DEPTH.into(), values: of.values.clone() }).collect();
            let provenance = &data.provenance.clone().with_line("values at the nodes", name);
            let data = MeshData { quantities: &quantities, provenance, ..*data };
            return output.write(self.finished.mesh(), placed, &data, look, meter);
        }
        let mesh = self.finished.mesh();
        let is_model = output.third_coordinate() == ThirdCoordinate::Model && data.heights.is_some();
        match self.finished.domain().projection {
            Some(plane) if is_model && data.provenance.unit() == LengthUnit::Degree => {
                let provenance = &data.provenance.clone().in_plane(&plane);
                let joined = &JoinedCells::default();
                output.write(mesh, self.extract, &MeshData { provenance, joined, ..*data }, look, meter)
            }
            _ => output.write(mesh, placed, data, look, meter),
        }
    }

    /// Returns the values at the nodes: those given, the quantities, and the depths and surfaces of layers,
    /// unless one of them is called so; and what was changed of the depths. What a person should know about
    /// quantities is added to `notes`.
    ///
    /// # Errors
    /// Fails when a quantity has no value at a node.
    pub fn values_at_nodes(
        &self,
        quantities: &[NamedQuantity],
        mut values: Vec<NodeValues>,
        changes: DepthChanges,
        notes: &mut Vec<String>,
    ) -> Result<(Vec<NodeValues>, ChangedDepths), Failure> {
        let details = self.details;
        let is_known = changes == details.depth_changes;
        let mut depths_are_changed = false;
        for quantity in quantities {
            let known = details.given_depths(quantity).filter(|_| is_known);
            depths_are_changed |= known.is_some();
            values.push(match known {
                Some(depths) => NodeValues { name: DEPTH.into(), values: depths.to_vec() },
                None => {
                    let of_layers = details.depths_of_layers();
                    quantity.at_nodes(self.finished, self.extract, of_layers, notes)?
                }
            });
        }
        let heights = details.heights.as_ref().map(|heights| (SURFACE, &**heights));
        let has_depths = values.iter().any(|values| values.name == DEPTH);
        let written = details.written_depths().filter(|_| is_known);
        depths_are_changed |= !has_depths && written.is_some();
        let depths = written.or(details.depths_of_layers()).map(|depths| (DEPTH, depths));
        for (name, of_layers) in depths.into_iter().chain(heights) {
            if !values.iter().any(|values| values.name == name) {
                values.push(NodeValues { name: name.into(), values: of_layers.to_vec() });
            }
        }
        let changed = match values.iter_mut().find(|values| values.name == DEPTH) {
            Some(_) if depths_are_changed => details.changed_depths,
            Some(depths) => changes.apply(self.extract, &mut depths.values),
            None => ChangedDepths::default(),
        };
        Ok((values, changed))
    }

    /// Returns the data of the mesh with these values at the nodes. A flat mesh has no heights.
    pub(super) fn data<'a>(&'a self, quantities: &'a [NodeValues], is_flat: bool) -> MeshData<'a> {
        let Self { details, provenance, target_diameter, .. } = *self;
        let MeshDetails { boundary, lines, parts, joined, .. } = details;
        let surface = quantities.iter().find(|values| values.name == SURFACE && !is_flat);
        let heights = surface.map(|surface| &*surface.values);
        MeshData {
            target_diameter,
            quantities,
            heights,
            boundary,
            lines,
            parts,
            cells: CellShape::OfFormat,
            joined,
            parts_for: None,
            provenance,
        }
    }

    /// Returns the nodes and triangles with other coordinates, if these are not those of the mesh.
    ///
    /// # Errors
    /// Fails where the domain is not in the plane of a projection.
    pub(super) fn in_coordinates(&self) -> Result<Option<Extract<'_>>, Failure> {
        let domain = self.finished.domain();
        let nodes = match self.coordinates {
            OutputCoordinates::Lonlat => domain.nodes_in(&Coordinates::Geographic, self.extract),
            OutputCoordinates::Plane => None,
            OutputCoordinates::Other(coordinates) => {
                let nodes = domain.nodes_in(&coordinates, self.extract);
                Some(nodes.ok_or_else(|| Failure::Usage(NOT_ON_EARTH.into()))?)
            }
        };
        Ok(nodes.map(|nodes| self.extract.with_coordinates(nodes)))
    }
}
