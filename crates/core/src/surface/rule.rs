//! Which triangles must be bisected for a surface.

use std::sync::Arc;

use glam::DVec2;

use super::nodes::{SurfaceNodes, SurfaceTriangle};
use super::samples::{LayerSamples, SurfaceSamples};
use crate::geometry::{Lattice, LatticePoint};
use crate::layers::{LayerId, SurfaceGoal};
use crate::mesh::Element;

/// Share of the step between samples below which a triangle is not bisected. Between samples a surface is
/// smooth, so that only a jump can still have a larger error there, and no mesh meets any ε at a jump.
const LEAST_SHARE: f64 = 1.0 / 32.0;

/// The condition that triangles are within an error of a surface.
#[derive(Clone, Debug)]
pub struct SurfaceRule {
    samples: Arc<SurfaceSamples>,
    /// The largest error of each layer of the samples; infinite where it is not known yet.
    errors: Vec<f64>,
}

/// Why a triangle is too far from a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDemand {
    /// The layer of the surface.
    pub layer: LayerId,
    /// The largest difference of a sample in the triangle, of either sign.
    pub error: f64,
    /// The place of this sample, in world units.
    pub at: DVec2,
    /// The largest error that is allowed there: by the layer, or by one of errors.
    pub most: f64,
}

impl SurfaceRule {
    /// Returns the condition for samples: by the errors of their layers. Layers with a number of triangles do
    /// not count, until [`Self::counted`].
    pub fn new(samples: Arc<SurfaceSamples>) -> Self {
        let errors = samples.layers.iter().map(|layer| match layer.goal {
            SurfaceGoal::Within(error) => error,
            SurfaceGoal::AtMost(_) => f64::INFINITY,
        });
        Self { errors: errors.collect(), samples }
    }

    /// Returns the samples.
    pub fn samples(&self) -> &Arc<SurfaceSamples> {
        &self.samples
    }

    /// Returns the least number of triangles that a layer allows, if one allows a number.
    pub fn most_triangles(&self) -> Option<usize> {
        let counts = self.samples.layers.iter().filter_map(|layer| match layer.goal {
            SurfaceGoal::AtMost(count) => Some(count),
            SurfaceGoal::Within(_) => None,
        });
        counts.min()
    }

    /// Returns whether the mesh has more triangles than a layer allows, also without the surface of the
    /// layer.
    pub fn has_too_few_triangles(&self) -> bool {
        self.errors.iter().any(|error| error.is_infinite())
    }

    /// Returns this condition with the least error that layers with a number of triangles can have.
    pub fn counted(mut self, least_error: f64) -> Self {
        for (error, layer) in self.errors.iter_mut().zip(&self.samples.layers) {
            if matches!(layer.goal, SurfaceGoal::AtMost(_)) {
                *error = least_error;
            }
        }
        self
    }

    /// Returns the largest error of triangles by layer, from the top to the bottom.
    pub fn errors(&self) -> impl Iterator<Item = (LayerId, f64)> + '_ {
        self.samples.layers.iter().zip(&self.errors).map(|(layer, &error)| (layer.id, error))
    }

    /// Returns the largest error that is allowed anywhere: by the layers of surfaces, and by layers of
    /// errors.
    pub fn largest_allowed(&self) -> f64 {
        let of_layers = self.samples.layers.iter().flat_map(|layer| layer.errors.iter().flatten());
        let of_layers = of_layers.filter(|error| !error.is_nan()).map(|&error| f64::from(error));
        self.errors.iter().copied().chain(of_layers).fold(0.0, f64::max)
    }

    /// Returns whether layers of errors give samples an error in place of that of their surface.
    pub fn has_errors_of_layers(&self) -> bool {
        self.samples.layers.iter().any(|layer| layer.errors.is_some())
    }

    /// Returns the height of the surface at a point in world units, and the largest error that layers of
    /// errors, or else the layer of the surface, allow there; `None` where no layer that covers it has a
    /// value.
    pub fn allowed_at(&self, point: DVec2) -> Option<(f64, f64)> {
        let layers = self.samples.layers.iter().zip(&self.errors);
        let mut covering = layers.filter(|(layer, _)| layer.covers(point));
        let (height, own) =
            covering.find_map(|(layer, &error)| Some((layer.source.height_at(point)?, error)))?;
        Some((height, self.samples.errors.at(point).unwrap_or(own)))
    }

    /// Returns whether the error of a triangle exceeds that of a layer. `nodes` keeps the heights at nodes.
    pub fn exceeds(&self, element: &Element, nodes: &mut SurfaceNodes) -> bool {
        self.layer_exceeded(&nodes.triangle(element, &self.samples)).is_some()
    }

    /// Returns the layer whose error a triangle, given by its corners, exceeds, if there is one.
    pub fn exceeded_at(&self, corners: [LatticePoint; 3], lattice: &Lattice) -> Option<LayerId> {
        let corners = corners.map(|corner| lattice.world_from_lattice(corner));
        let heights = corners.map(|corner| self.samples.height_at(corner));
        self.layer_exceeded(&SurfaceTriangle::new(corners, heights))
    }

    /// Returns the sample of a triangle, given by its corners, that is farthest from its plane in the layer
    /// whose error it exceeds; `None` where it exceeds none, and where the surface has no height at a corner.
    pub fn demand_in(&self, corners: [LatticePoint; 3], lattice: &Lattice) -> Option<SurfaceDemand> {
        let layer = self.exceeded_at(corners, lattice)?;
        let corners = corners.map(|corner| lattice.world_from_lattice(corner));
        let heights = corners.map(|corner| self.samples.height_at(corner));
        let heights = SurfaceTriangle::new(corners, heights).heights?;
        let layers = self.samples.layers.iter().zip(&self.errors);
        let (samples, &own) = layers.into_iter().find(|(samples, _)| samples.id == layer)?;
        let mut demand = SurfaceDemand { layer, error: 0.0, at: corners[0], most: own };
        samples.each(corners, heights, |at, difference| {
            let (error, most) = (difference.abs(), self.samples.errors.at(at).unwrap_or(own));
            if error / most > demand.error / demand.most {
                (demand.error, demand.at, demand.most) = (error, at, most);
            }
        });
        Some(demand)
    }

    fn layer_exceeded(&self, triangle: &SurfaceTriangle) -> Option<LayerId> {
        let layers = self.samples.layers.iter().zip(&self.errors);
        let asks = |layer: &LayerSamples, error: f64| error.is_finite() || layer.errors.is_some();
        let mut asking = layers.filter(|(layer, error)| asks(layer, **error) && layer.may_ask(triangle));
        let exceeded = asking.find(|(layer, error)| match triangle.heights {
            Some(heights) => layer.exceeds(triangle.corners, heights, **error),
            None if error.is_finite() => layer.has_sample(triangle.corners),
            None => layer.has_sample_of_layers(triangle.corners),
        });
        exceeded.map(|(layer, _)| layer.id)
    }

    /// Returns the error of a triangle by the layers with a number of triangles. It is infinite where the
    /// triangle must be bisected in any case.
    pub(super) fn counted_error(&self, element: &Element, nodes: &mut SurfaceNodes) -> f64 {
        let triangle = nodes.triangle(element, &self.samples);
        if self.layer_exceeded(&triangle).is_some() {
            return f64::INFINITY;
        }
        let counted = self.samples.layers.iter().filter(|layer| matches!(layer.goal, SurfaceGoal::AtMost(_)));
        let errors = counted.filter(|layer| layer.may_ask(&triangle)).map(|layer| match triangle.heights {
            Some(heights) => layer.error(triangle.corners, heights),
            None if layer.has_sample(triangle.corners) => f64::INFINITY,
            None => 0.0,
        });
        errors.fold(0.0, f64::max)
    }
}

impl LayerSamples {
    /// Returns whether a triangle is so large that its error can be that of a surface without jumps.
    fn may_ask(&self, triangle: &SurfaceTriangle) -> bool {
        triangle.diameter() >= LEAST_SHARE * self.grid.step.min_element()
    }
}
