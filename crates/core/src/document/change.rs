//! Decides how a mesh follows a change of settings. No other code decides this;
//! [`SizeFieldSpec::difference`](crate::layers::SizeFieldSpec::difference) finds the areas in which size
//! fields differ.

use super::Settings;
use crate::domain::Domain;
use crate::field::RefinementRule;
use crate::layers::{Circumstances, Layer, LayerId, LayerKind, Mask, PaintLayers, Surface};

/// The work that brings the mesh of some settings up to date with others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    /// The mesh is the same, if neither settings have a budget that it exceeds. Data derived from it may
    /// differ.
    Nothing,
    /// The mesh is updated where the outline of the domain or the size field differ.
    Update {
        /// Whether the outline differs.
        outline: bool,
        /// Whether the size field differs.
        field: bool,
    },
    /// Another mesh is made.
    NewMesh {
        /// Whether it is one of the same domain by the same rule, as while a spacing is dragged.
        is_similar: bool,
    },
}

impl Settings {
    /// Returns the work that brings the mesh of earlier settings up to date with these, if the painted pixels
    /// are the same.
    ///
    /// Both settings are taken apart completely, without `..`: a new setting does not compile until somebody
    /// has decided what it changes.
    pub(super) fn change_from(&self, old: &Self, paint: &PaintLayers) -> Change {
        let Self {
            // These say nothing about the mesh.
            name: _,
            unit: _,
            background: _,
            pins: _,
            paths: _,
            // This one decides what is derived from the mesh.
            cleaning: _,
            // What the mesh may cost is compared with what it costs.
            max_triangles: _,
            max_memory: _,
            domain,
            boundary,
            boundary_marks,
            lines,
            spacing,
            transfer,
            layers,
            gradation,
            rule,
            max_level,
        } = self;
        let Self {
            name: _,
            unit: _,
            background: _,
            pins: _,
            paths: _,
            cleaning: _,
            max_triangles: _,
            max_memory: _,
            domain: old_domain,
            boundary: old_boundary,
            boundary_marks: old_boundary_marks,
            lines: old_lines,
            spacing: old_spacing,
            transfer: old_transfer,
            layers: old_layers,
            gradation: old_gradation,
            rule: old_rule,
            max_level: old_max_level,
        } = old;
        // Only an outline is met in one way or another; nodes are moved onto it in the derived mesh.
        let is_fitted_alike = boundary.diameter() == old_boundary.diameter()
            || [domain, old_domain].iter().all(|domain| domain.is_whole());
        let outline = domain != old_domain;
        // The deepest level is part of the rule of an update.
        let has_other_rule = rule != old_rule || max_level != old_max_level;
        let has_other_grid = spacing != old_spacing || has_other_rule || !is_fitted_alike;
        if has_other_grid || (outline && !self.can_follow_outline(old_domain)) {
            return Change::NewMesh { is_similar: !outline && rule == old_rule };
        }
        let field = (transfer, layers, gradation) != (old_transfer, old_layers, old_gradation)
            || (outline && self.shows(Layer::follows_outline))
            || (boundary_marks != old_boundary_marks && self.shows(|layer| layer.kind.follows_pieces()))
            || (lines != old_lines && self.shows(|layer| layer.kind.follows_lines()));
        self.change_on_grid(old, [outline, field], paint)
    }

    /// Returns the work on a mesh of the same grid where the outline of the domain or the size field may
    /// differ.
    fn change_on_grid(&self, old: &Self, [outline, field]: [bool; 2], paint: &PaintLayers) -> Change {
        match self.rule {
            _ if !outline && !field => Change::Nothing,
            _ if self.surfaces_need_another_mesh(old, paint) => Change::NewMesh { is_similar: !outline },
            // Coarsening would leave triangles behind. What does not matter to the mesh is taken over.
            RefinementRule::Vertex if !self.has_same_field(old, paint) => {
                Change::NewMesh { is_similar: true }
            }
            RefinementRule::Area | RefinementRule::Vertex => Change::Update { outline, field },
        }
    }

    /// Returns whether coarsening would leave triangles behind because of surfaces.
    fn surfaces_need_another_mesh(&self, old: &Self, paint: &PaintLayers) -> bool {
        let is_same = || self.domain == old.domain && self.has_same_field(old, paint);
        let has_other_errors = || !self.errors_asked().eq(old.errors_asked());
        !self.surfaces_asked().eq(old.surfaces_asked())
            || (self.has_surface() && (has_other_errors() || !is_same()))
    }

    /// Returns what matters of the visible layers of surfaces, from the bottom to the top.
    fn surfaces_asked(&self) -> impl Iterator<Item = (Option<&Mask>, &Surface)> {
        self.surfaces().map(|(layer, surface)| (layer.mask.as_ref(), surface))
    }

    /// Returns what matters of the visible layers of errors, from the bottom to the top. Paint belongs to a
    /// layer by its identifier.
    fn errors_asked(&self) -> impl Iterator<Item = (LayerId, Option<&Mask>, &LayerKind)> {
        let asking = self.layers.iter().filter(|layer| layer.visible && layer.is_of_errors());
        asking.map(|layer| (layer.id, layer.mask.as_ref(), &layer.kind))
    }

    /// Returns whether some visible layer is of a sort.
    fn shows(&self, is_of: impl Fn(&Layer) -> bool) -> bool {
        self.layers.iter().any(|layer| layer.visible && is_of(layer))
    }

    /// Returns whether the mesh can follow from another domain to this one in place: only where it is fitted,
    /// so that triangles outside stay in it, marked.
    fn can_follow_outline(&self, old: &Domain) -> bool {
        let Domain { bounds, shape: _, projection } = &self.domain;
        let Domain { bounds: old_bounds, shape: _, projection: old_projection } = old;
        bounds == old_bounds
            && projection == old_projection
            && [&self.domain, old].iter().all(|domain| domain.formula().is_none())
            && self.boundary.diameter().is_some()
            && self.rule == RefinementRule::Area
    }

    /// Returns whether the size field asks for the same everywhere.
    fn has_same_field(&self, old: &Self, paint: &PaintLayers) -> bool {
        let circumstances =
            Circumstances { paint, longest: f64::INFINITY, greatest_scale: 1.0, outline_areas: None };
        self.field_spec().difference(&old.field_spec(), &circumstances).is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Setting;
    use crate::domain::BoundaryTreatment;
    use crate::geometry::Rect;
    use crate::layers::LayerKind;

    fn change(rule: RefinementRule, edit: impl FnOnce(&mut Settings)) -> Change {
        let old = Settings { rule, ..Settings::default() };
        let mut new = old.clone();
        edit(&mut new);
        new.change_from(&old, PaintLayers::blank())
    }

    #[test]
    fn names_and_budgets_leave_the_mesh_alone() {
        for rule in [RefinementRule::Area, RefinementRule::Vertex] {
            let same = change(rule, |new| {
                new.name = "other".into();
                new.max_triangles = 5;
                new.boundary = BoundaryTreatment::Report;
            });
            assert_eq!(same, Change::Nothing);
            let renamed = change(rule, |new| new.layers[0].name = "other".into());
            assert_eq!(renamed, Change::Update { outline: false, field: true });
        }
    }

    #[test]
    fn another_grid_or_rule_needs_another_mesh() {
        let area = RefinementRule::Area;
        let spacing = change(area, |new| new.spacing *= 2.0);
        assert_eq!(spacing, Change::NewMesh { is_similar: true });
        let bounds =
            |new: &mut Settings| Setting::Bounds(Rect::new(-glam::DVec2::ONE, glam::DVec2::ONE)).apply(new);
        assert_eq!(change(area, bounds), Change::NewMesh { is_similar: false });
        let base = |new: &mut Settings| new.layers[0].kind = LayerKind::constant(0.1);
        assert_eq!(change(area, base), Change::Update { outline: false, field: true });
        assert_eq!(change(RefinementRule::Vertex, base), Change::NewMesh { is_similar: true });
    }
}
