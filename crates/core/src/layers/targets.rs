//! h̄ at points, and which layer decides it.

use glam::DVec2;

use super::engine::gradation::Accuracy;
use super::engine::{DiameterLimit, KnownParts, Ungraded, is_asked};
use super::{LayerId, LevelCache, PaintLayers, SizeField};
use crate::earth::LEVELS;
use crate::field::RefinementRule;
use crate::geometry::LatticePoint;

/// h̄ at a point, with the layer that decides it.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// h̄ in world units.
    pub target: f64,
    /// The layer that decides; `None` where no layer asks for anything.
    pub layer: Option<LayerId>,
    /// The limit that counts in place of what the layer asks for, if one does.
    pub limit: Option<DiameterLimit>,
    /// The place, in world units, whose diameter limits h̄ here through gradation; the point itself where the
    /// layers decide directly.
    pub from: DVec2,
    /// The target diameter of each visible layer at the point, in world units, from the bottom to the top;
    /// `None` for a layer without a target there.
    pub asked: Vec<(LayerId, Option<f64>)>,
}

impl SizeField {
    /// h̄ at a point in world units.
    pub fn target_at(&self, paint: &PaintLayers, point: DVec2) -> f64 {
        let before = self.stack.ungraded_at(paint, point).target;
        match self.stack.slope() {
            None => before,
            Some(slope) => {
                let how = (slope, Accuracy::Close);
                self.stack.graded(&mut self.stack.known_for_points(), paint, point, how, before).0
            }
        }
    }

    /// h̄ at a node, in world units, for the vertex rule.
    ///
    /// A value that no mesh can meet (NaN, zero or less) is returned as it is, for the rule to refuse.
    pub fn target_at_node(&self, paint: &PaintLayers, point: DVec2) -> f64 {
        self.stack.invalid_at(paint, point).unwrap_or_else(|| self.target_at(paint, point))
    }

    /// h̄ at a point in world units, as `rule` sees it: what files and the inspector show.
    pub fn target_by_rule(&self, rule: RefinementRule, paint: &PaintLayers, point: DVec2) -> f64 {
        match rule {
            RefinementRule::Area => self.target_at(paint, point),
            RefinementRule::Vertex => self.target_at_node(paint, point),
        }
    }

    /// Returns the level at which triangles around a point are no longer than a diameter; `None` where no
    /// level is fine enough. In the plane of a projection the diameter is one on the Earth.
    pub fn level_of_diameter(&self, diameter: f64, point: DVec2) -> Option<u32> {
        let (place, extent) = (self.lattice().nearest(point), self.lattice().extent());
        // A place on the upper or right side belongs to the last square.
        let within = LatticePoint::new(place.x.min(extent.x - 1), place.y.min(extent.y - 1));
        let level = self.edge_lengths().first_level_at(within, diameter);
        Some(level).filter(|&level| diameter > 0.0 && (level as usize) < LEVELS)
    }

    /// Returns h̄ at a point in world units, with the layer that decides it.
    pub fn decision_at(&self, paint: &PaintLayers, point: DVec2) -> Decision {
        self.decision(&mut self.stack.known_for_points(), paint, point, Accuracy::Close)
    }

    /// Returns the decision of [`Self::decision_at`] fast enough for a pointer. With gradation, the diameter
    /// may exceed h̄ by 10⁻³ of it where an exact search would take too long. `squares` must have been used
    /// for this field and these pixels only.
    pub fn quick_decision_at(&self, squares: &mut LevelCache, paint: &PaintLayers, point: DVec2) -> Decision {
        squares.make_room();
        self.decision(&mut squares.known, paint, point, Accuracy::Quick)
    }

    /// Returns h̄ at a point in world units as a triangle of the mesh is compared with it: times
    /// [`Self::scale`], and no larger than the largest triangle, which no mesh exceeds. So a document without
    /// a largest diameter has the same number as one with a diameter that no triangle reaches. With
    /// gradation it may be too large as that of [`Self::quick_decision_at`], and `squares` are as there.
    pub fn compared_target_at(&self, squares: &mut LevelCache, paint: &PaintLayers, point: DVec2) -> f64 {
        squares.make_room();
        let (asked, most) = (self.stack.ungraded_at(paint, point).target, self.edge_lengths().longest());
        let before = if asked > most { most } else { asked };
        let how = |slope| (slope, Accuracy::Quick);
        let graded = self
            .stack
            .slope()
            .map(|slope| self.stack.graded(&mut squares.known, paint, point, how(slope), before).0);
        self.scale() * graded.unwrap_or(before)
    }

    fn decision(
        &self,
        known: &mut KnownParts,
        paint: &PaintLayers,
        point: DVec2,
        accuracy: Accuracy,
    ) -> Decision {
        let asked = self.stack.layers().iter().map(|layer| {
            let diameter = layer.diameter_at(paint, point);
            (layer.id, is_asked(diameter).then_some(diameter))
        });
        let asked = asked.collect();
        let before = self.stack.ungraded_at(paint, point);
        let Ungraded { target, layer, limit } = before;
        let graded =
            self.stack.slope().map(|slope| self.stack.graded(known, paint, point, (slope, accuracy), target));
        match graded {
            Some((carried, from)) if carried < target => {
                let source = self.stack.ungraded_at(paint, from);
                let Ungraded { layer, limit, .. } = if source.layer.is_some() { source } else { before };
                Decision { target: carried, layer, limit, from, asked }
            }
            _ => Decision { target, layer, limit, from: point, asked },
        }
    }
}
