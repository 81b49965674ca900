use std::sync::{Mutex, PoisonError};

use glam::DVec2;
use rayon::prelude::*;

use super::engine::KnownParts;
use super::engine::gradation::Accuracy;
use super::{PaintLayers, SizeField};
use crate::field::RefinementRule;
use crate::mesh::Extract;

/// h̄ at many points, each near the one before, as the nodes of a mesh are.
///
/// With gradation, h̄ at a point is at most h̄ at the point before plus g times their distance. So the search
/// begins close to its result, and most rectangles are skipped at once.
struct TargetsInOrder<'a> {
    field: &'a SizeField,
    paint: &'a PaintLayers,
    rule: RefinementRule,
    /// The last point, and h̄ there.
    last: Option<(DVec2, f64)>,
    known: KnownParts,
}

/// The bound is raised by so much that the tolerance of the search cannot hide the result.
const SLACK: f64 = 1.0 + 2e-6;

impl<'a> TargetsInOrder<'a> {
    /// `known` must be of the same field and pixels.
    fn new(known: KnownParts, field: &'a SizeField, paint: &'a PaintLayers, rule: RefinementRule) -> Self {
        Self { field, paint, rule, last: None, known }
    }

    /// [`SizeField::target_by_rule`] at a point in world units.
    fn at(&mut self, point: DVec2) -> f64 {
        let invalid = match self.rule {
            RefinementRule::Area => None,
            RefinementRule::Vertex => self.field.stack.invalid_at(self.paint, point),
        };
        let target = invalid.unwrap_or_else(|| self.valid_at(point));
        self.last = (target > 0.0 && target.is_finite()).then_some((point, target));
        target
    }

    fn valid_at(&mut self, point: DVec2) -> f64 {
        self.known.make_room();
        let before = self.field.stack.ungraded_at(self.paint, point).target;
        let Some(slope) = self.field.stack.slope() else { return before };
        let bound =
            self.last.map_or(f64::INFINITY, |(last, target)| (target + slope * point.distance(last)) * SLACK);
        self.field
            .stack
            .graded(&mut self.known, self.paint, point, (slope, Accuracy::Close), before.min(bound))
            .0
    }
}

/// Nodes that one thread computes at a time.
const NODES: usize = 4096;
/// How many nodes there are, but for the last ones, between two calls of the check of
/// [`SizeField::targets_at_nodes`].
pub const NODES_AT_A_TIME: u64 = NODES as u64;

impl SizeField {
    /// h̄ at every node of a mesh, in world units, as `rule` sees it. All threads compute, and ask `check`
    /// now and then whether to go on.
    ///
    /// # Errors
    /// Fails with the errors of `check`.
    pub fn targets_at_nodes<E: Send>(
        &self,
        rule: RefinementRule,
        paint: &PaintLayers,
        mesh: &Extract,
        check: impl Fn() -> Result<(), E> + Sync,
    ) -> Result<Vec<f64>, E> {
        let mut values = vec![0.0; mesh.nodes().len()];
        // What threads do not use at the moment.
        let known = Mutex::new(Vec::new());
        let known = || known.lock().unwrap_or_else(PoisonError::into_inner);
        let chunks = values.par_chunks_mut(NODES).zip(mesh.nodes().par_chunks(NODES));
        chunks.try_for_each(|(values, nodes)| {
            check()?;
            let own = known().pop().unwrap_or_else(|| self.stack.known_for_points());
            let mut targets = TargetsInOrder::new(own, self, paint, rule);
            for (value, &node) in values.iter_mut().zip(nodes) {
                *value = targets.at(mesh.lattice().world_from_lattice(node));
            }
            known().push(targets.known);
            Ok(())
        })?;
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::{Formula, Transfer};
    use crate::geometry::{Lattice, Rect};
    use crate::layers::{Layer, LayerKind, SizeFieldSpec};
    use crate::mesh::{Limits, Mesh};

    #[test]
    fn in_any_order_the_targets_are_those_of_single_points() {
        let lattice = Lattice::covering(Rect::UNIT, 0.1, 1000).unwrap();
        let layers = ["0.3 + 0.2*x", "if(hypot(x - 0.7, y - 0.2) < 0.03, 0.01, inf)"]
            .map(|text| LayerKind::target(Formula::parse(text).unwrap()));
        let transfer = Transfer::between(0.002, 0.5);
        let layers = Layer::stack(layers);
        let spec = SizeFieldSpec {
            layers,
            transfer,
            unasked: 0.5,
            outline: None,
            gradation: Some(0.4),
            projection: None,
        };
        let (field, paint) = (SizeField::new(spec, &lattice), PaintLayers::blank());
        let known = field.stack.known_for_points();
        let mut targets = TargetsInOrder::new(known, &field, paint, RefinementRule::Area);
        let mut random = fastrand::Rng::with_seed(6);
        let mut limited = 0;
        for _ in 0..300 {
            let point = dvec2(random.f64(), random.f64());
            let single = field.target_by_rule(RefinementRule::Area, paint, point);
            assert_eq!(targets.at(point), single, "{point}");
            limited += usize::from(single < 0.3);
        }
        assert!(limited > 100, "{limited}");
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let extract = mesh.extract();
        let of_nodes = field.targets_at_nodes(RefinementRule::Area, paint, &extract, || Ok::<_, ()>(()));
        let single = |point| field.target_by_rule(RefinementRule::Area, paint, point);
        assert_eq!(of_nodes.unwrap(), extract.world_nodes().map(single).collect::<Vec<_>>());
        assert_eq!(field.targets_at_nodes(RefinementRule::Area, paint, &extract, || Err(1)), Err(1));
    }
}
