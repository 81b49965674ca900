//! Which triangles must be bisected for a surface.

use std::sync::Arc;

use glam::DVec2;

use super::nodes::{SurfaceNodes, SurfaceTriangle};
use super::order::{MeasuredTriangle, triangle_key};
use super::queue::{ErrorQueue, QueueGoal};
use super::samples::{LayerSamples, SurfaceSamples};
use crate::geometry::{Lattice, LatticePoint, NumberSet};
use crate::layers::{Layer, LayerId, Surface, SurfaceGoal, SurfaceNorm};
use crate::mesh::Element;

/// Share of the step between samples below which a triangle is not bisected. Between samples a surface is
/// smooth, so that only a jump can still have a larger error there, and no mesh meets any ε at a jump.
const LEAST_SHARE: f64 = 1.0 / 32.0;

/// The condition that triangles are within an error of a surface.
#[derive(Clone, Debug)]
pub struct SurfaceRule {
    samples: Arc<SurfaceSamples>,
    /// What each layer of the samples asks for.
    asked: Vec<LayerGoal>,
    /// The triangles that are bisected for sums of squares, as [`triangle_key`].
    bisected: Arc<NumberSet<u64>>,
    /// The errors by the norms of sums of squares that the mesh was made for.
    summed: Vec<(SurfaceNorm, f64)>,
    /// The number of triangles that a layer allows, where the mesh has more without the surface.
    exceeded_count: Option<usize>,
}

/// What a layer asks for.
#[derive(Clone, Copy, Debug)]
struct LayerGoal {
    goal: SurfaceGoal,
    norm: SurfaceNorm,
    /// The largest difference that the layer allows; infinite where that is not known yet, and for other
    /// norms.
    error: f64,
}

/// Why a triangle is too far from a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDemand {
    /// The layer of the surface.
    pub layer: LayerId,
    /// The error that the layer is about.
    pub norm: SurfaceNorm,
    /// The error of the triangle: the largest difference of a sample in it, of either sign, or the root of
    /// the mean of the squares in it.
    pub error: f64,
    /// The place of the largest difference, in world units.
    pub at: DVec2,
    /// The largest difference that is allowed there, by the layer or by one of errors; or the error of the
    /// whole mesh.
    pub most: f64,
}

impl LayerGoal {
    const NOTHING: Self =
        Self { goal: SurfaceGoal::Within(f64::INFINITY), norm: SurfaceNorm::Largest, error: f64::INFINITY };

    fn new(&Surface { goal, norm, source: _ }: &Surface) -> Self {
        let error = match (norm, goal) {
            (SurfaceNorm::Largest, SurfaceGoal::Within(error)) => error,
            _ => f64::INFINITY,
        };
        Self { goal, norm, error }
    }

    /// Returns whether the layer has a goal by this norm that is looked for, and not asked of each triangle.
    fn is_counted(&self, norm: SurfaceNorm) -> bool {
        let is_counted = norm != SurfaceNorm::Largest || matches!(self.goal, SurfaceGoal::AtMost(_));
        self.norm == norm && is_counted
    }
}

impl SurfaceRule {
    /// Returns the condition for the samples of a stack of layers: by the largest differences that the layers
    /// allow. Other goals do not count, until [`Self::with_found`].
    pub fn new(samples: Arc<SurfaceSamples>, stack: &[Layer]) -> Self {
        let surface = |id: LayerId| stack.iter().find(|layer| layer.id == id)?.kind.get();
        let asked =
            samples.layers.iter().map(|layer| surface(layer.id).map_or(LayerGoal::NOTHING, LayerGoal::new));
        let (bisected, summed) = (Arc::default(), Vec::new());
        Self { asked: asked.collect(), samples, bisected, summed, exceeded_count: None }
    }

    /// Returns the layers of the samples, from the top to the bottom, with what they ask for.
    fn layers(&self) -> impl Iterator<Item = (&LayerSamples, &LayerGoal)> {
        self.samples.layers.iter().zip(&self.asked)
    }

    /// Returns the samples.
    pub fn samples(&self) -> &Arc<SurfaceSamples> {
        &self.samples
    }

    /// Returns what is to be looked for besides, norm by norm.
    pub(crate) fn goals(&self) -> Vec<QueueGoal> {
        let goals = SurfaceNorm::ALL.into_iter().map(|norm| {
            let of_norm = || self.asked.iter().filter(move |asked| asked.norm == norm);
            let errors = of_norm().filter_map(|asked| match asked.goal {
                // The largest difference is asked of each triangle.
                SurfaceGoal::Within(error) if norm != SurfaceNorm::Largest => Some(error),
                _ => None,
            });
            let counts = of_norm().filter_map(|asked| match asked.goal {
                SurfaceGoal::AtMost(count) => Some(count),
                SurfaceGoal::Within(_) => None,
            });
            QueueGoal { norm, within: errors.min_by(f64::total_cmp), at_most: counts.min() }
        });
        goals.filter(|goal| goal.within.is_some() || goal.at_most.is_some()).collect()
    }

    /// Returns the number of triangles that a layer allows, where the mesh has more of them even without the
    /// surface of the layer.
    pub fn exceeded_count(&self) -> Option<usize> {
        self.exceeded_count
    }

    /// Returns this condition with what was found for one of its goals.
    pub(crate) fn with_found(mut self, queue: &ErrorQueue) -> Self {
        let QueueGoal { norm, at_most, within } = queue.goal();
        let error = queue.found_error();
        if error.is_none() {
            self.exceeded_count = self.exceeded_count.or(at_most);
        }
        if norm == SurfaceNorm::Largest {
            for asked in self.asked.iter_mut().filter(|asked| asked.is_counted(norm)) {
                asked.error = error.unwrap_or(f64::INFINITY);
            }
        } else {
            self.summed.push((norm, error.or(within).unwrap_or(f64::INFINITY)));
            Arc::make_mut(&mut self.bisected).extend(queue.bisected());
        }
        self
    }

    /// Returns the error of each layer by its norm, from the top to the bottom: the largest difference that
    /// it allows, or the error that the mesh was made for. It is infinite where none was found.
    pub fn errors(&self) -> impl Iterator<Item = (LayerId, f64)> + '_ {
        self.layers().map(|(layer, asked)| (layer.id, self.summed_error(asked.norm).unwrap_or(asked.error)))
    }

    fn summed_error(&self, norm: SurfaceNorm) -> Option<f64> {
        self.summed.iter().find(|(one, _)| *one == norm).map(|(_, error)| *error)
    }

    /// Returns the largest difference that is allowed anywhere: by the layers of surfaces, and by layers of
    /// errors.
    pub fn largest_allowed(&self) -> f64 {
        let of_layers = self.samples.layers.iter().flat_map(|layer| layer.errors.iter().flatten());
        let of_layers = of_layers.filter(|error| !error.is_nan()).map(|&error| f64::from(error));
        self.asked.iter().map(|asked| asked.error).chain(of_layers).fold(0.0, f64::max)
    }

    /// Returns whether layers of errors give samples an error in place of that of their surface.
    pub fn has_errors_of_layers(&self) -> bool {
        self.samples.layers.iter().any(|layer| layer.errors.is_some())
    }

    /// Returns the height of the surface at a point in world units, and the largest difference that layers of
    /// errors, or else the layer of the surface, allow there; `None` where no layer that covers it has a
    /// value. It is infinite where nothing but an error of the whole mesh is asked for.
    /// value.
    pub fn allowed_at(&self, point: DVec2) -> Option<(f64, f64)> {
        let mut covering = self.layers().filter(|(layer, _)| layer.covers(point));
        let (height, own) =
            covering.find_map(|(layer, asked)| Some((layer.source.height_at(point)?, asked.error)))?;
        Some((height, self.samples.errors.at(point).unwrap_or(own)))
    }

    /// Returns the largest error by a norm that the mesh was made for, if a layer has this norm.
    pub fn error_of(&self, norm: SurfaceNorm) -> Option<f64> {
        let of_norm = self.asked.iter().filter(|asked| asked.norm == norm);
        let errors = of_norm.map(|asked| self.summed_error(norm).unwrap_or(asked.error));
        errors.max_by(f64::total_cmp)
    }

    /// Returns whether a triangle is bisected for a surface. `nodes` keeps the heights at nodes.
    pub fn exceeds(&self, element: &Element, nodes: &mut SurfaceNodes) -> bool {
        self.is_bisected(element.corners)
            || self.layer_exceeded(&nodes.triangle(element, &self.samples)).is_some()
    }

    /// Returns whether a triangle, given by its corners, is bisected for a surface.
    pub fn exceeds_at(&self, corners: [LatticePoint; 3], lattice: &Lattice) -> bool {
        self.is_bisected(corners)
            || self.layer_exceeded(&SurfaceTriangle::from_samples(corners, lattice, &self.samples)).is_some()
    }

    fn is_bisected(&self, corners: [LatticePoint; 3]) -> bool {
        !self.bisected.is_empty() && self.bisected.contains(&triangle_key(corners))
    }

    /// Returns why a triangle, given by its corners, is bisected for a surface; `None` where it is not, and
    /// where the surface has no height at a corner.
    pub fn demand_in(&self, corners: [LatticePoint; 3], lattice: &Lattice) -> Option<SurfaceDemand> {
        let triangle = SurfaceTriangle::from_samples(corners, lattice, &self.samples);
        let heights = triangle.heights?;
        if let Some(exceeded) = self.layer_exceeded(&triangle) {
            return Some(self.demand_of_difference(exceeded, &triangle, heights));
        }
        if !self.is_bisected(corners) {
            return None;
        }
        let mut summed = self.layers().filter(|(_, asked)| asked.norm != SurfaceNorm::Largest);
        let (layer, asked) = summed.find(|(layer, _)| layer.has_sample(triangle.corners))?;
        let squares = layer.squares(triangle.corners, heights, asked.norm);
        let most = self.summed_error(asked.norm)?;
        let largest = self.demand_of_difference((layer, asked), &triangle, heights);
        Some(SurfaceDemand { error: libm::sqrt(squares / triangle.area()), most, ..largest })
    }

    /// Returns the demand of the sample that exceeds what is allowed by the largest factor; where nothing is
    /// allowed or forbidden, by the largest difference.
    fn demand_of_difference(
        &self,
        (layer, asked): (&LayerSamples, &LayerGoal),
        triangle: &SurfaceTriangle,
        heights: [f64; 3],
    ) -> SurfaceDemand {
        let (mut largest, mut at) = ([0.0; 3], triangle.corners[0]);
        layer.each(triangle.corners, heights, |place, difference| {
            let (error, most) = (difference.abs(), self.samples.errors.at(place).unwrap_or(asked.error));
            let factor = if most.is_finite() { error / most } else { 0.0 };
            if [factor, error] > [largest[0], largest[1]] {
                (largest, at) = ([factor, error, most], place);
            }
        });
        let [_, error, most] = largest;
        SurfaceDemand { layer: layer.id, norm: asked.norm, error, at, most }
    }

    /// Returns a layer whose largest difference a triangle exceeds, or that of a layer of errors over it,
    /// with the difference that the layer allows.
    fn layer_exceeded(&self, triangle: &SurfaceTriangle) -> Option<(&LayerSamples, &LayerGoal)> {
        let can_ask =
            |layer: &LayerSamples, asked: &LayerGoal| asked.error.is_finite() || layer.errors.is_some();
        let mut asking =
            self.layers().filter(|(layer, asked)| can_ask(layer, asked) && layer.may_ask(triangle));
        asking.find(|(layer, asked)| match triangle.heights {
            Some(heights) => layer.exceeds(triangle.corners, heights, asked.error),
            None if asked.error.is_finite() => layer.has_sample(triangle.corners),
            None => layer.has_sample_of_layers(triangle.corners),
        })
    }

    /// Returns what a norm says about a triangle of the domain. `nodes` keeps the heights at nodes.
    pub(super) fn measure(
        &self,
        element: &Element,
        nodes: &mut SurfaceNodes,
        norm: SurfaceNorm,
    ) -> MeasuredTriangle {
        let triangle = nodes.triangle(element, &self.samples);
        let asking = || {
            let counted = self.layers().filter(|(_, asked)| asked.is_counted(norm));
            counted.map(|(layer, _)| layer).filter(|layer| layer.may_ask(&triangle))
        };
        let is_bound = self.is_bisected(element.corners)
            || self.layer_exceeded(&triangle).is_some()
            || (triangle.heights.is_none() && asking().any(|layer| layer.has_sample(triangle.corners)));
        let error = self.error_of_triangle(&triangle, norm);
        MeasuredTriangle { is_bound, error, may_be_bisected: asking().next().is_some(), is_inside: true }
    }

    /// Returns the error of a triangle, given by its corners, by a norm: the largest difference from the
    /// layers with a number of triangles, or its part of the sum of the squares.
    pub(crate) fn error_at(&self, corners: [LatticePoint; 3], lattice: &Lattice, norm: SurfaceNorm) -> f64 {
        self.error_of_triangle(&SurfaceTriangle::from_samples(corners, lattice, &self.samples), norm)
    }

    fn error_of_triangle(&self, triangle: &SurfaceTriangle, norm: SurfaceNorm) -> f64 {
        let Some(heights) = triangle.heights else { return 0.0 };
        let layers = self.layers().filter(|(_, asked)| asked.is_counted(norm)).map(|(layer, _)| layer);
        match norm {
            SurfaceNorm::Largest => {
                let asking = layers.filter(|layer| layer.may_ask(triangle));
                asking.map(|layer| layer.error(triangle.corners, heights)).fold(0.0, f64::max)
            }
            _ => layers.map(|layer| layer.squares(triangle.corners, heights, norm)).sum(),
        }
    }
}

impl LayerSamples {
    /// Returns whether a triangle is so large that its error can be that of a surface without jumps.
    fn may_ask(&self, triangle: &SurfaceTriangle) -> bool {
        triangle.diameter() >= LEAST_SHARE * self.grid.step.min_element()
    }
}
