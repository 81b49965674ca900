//! Edges that are longer than their target.

use std::cell::Cell;
use std::sync::Arc;

use super::angles::Angles;
use crate::field::RefinementRule;
use crate::geometry::{LatticePoint, LatticeRect};
use crate::layers::{LevelCache, LevelCachePool, PaintLayers, SizeField};

/// What the edges of a derived mesh are compared with: h̄ by the area rule, for the pixels of paint layers.
#[derive(Clone, Copy, Debug)]
pub struct EdgeTargets<'a> {
    /// h̄.
    pub field: &'a SizeField,
    /// The painted pixels.
    pub paint: &'a PaintLayers,
}

impl<'a> EdgeTargets<'a> {
    /// Returns what the edges of a mesh by a rule are compared with; `None` by the vertex rule, which knows
    /// h̄ at the nodes of the mesh only.
    pub fn by_rule(rule: RefinementRule, field: &'a SizeField, paint: &'a PaintLayers) -> Option<Self> {
        (rule == RefinementRule::Area).then_some(Self { field, paint })
    }
}

/// [`EdgeTargets`] for work on another thread.
#[derive(Clone, Debug)]
pub struct SharedTargets {
    /// h̄.
    pub field: Arc<SizeField>,
    /// The painted pixels.
    pub paint: PaintLayers,
}

impl SharedTargets {
    /// Returns the targets.
    pub fn targets(&self) -> EdgeTargets<'_> {
        EdgeTargets { field: &self.field, paint: &self.paint }
    }
}

/// The rule that no edge of a triangle is longer than h̄ at any point of the triangle, for all threads.
pub(super) struct LengthRule<'a> {
    /// `None` where edges may have any length.
    targets: Option<EdgeTargets<'a>>,
    angles: Angles,
    known: LevelCachePool,
}

impl<'a> LengthRule<'a> {
    pub(super) fn new(targets: Option<EdgeTargets<'a>>, angles: Angles) -> Self {
        Self { targets, angles, known: LevelCachePool::default() }
    }

    /// Returns the answers for one thread.
    pub(super) fn answers(&self) -> LengthAnswers<'_> {
        LengthAnswers { rule: self, squares: None, asked: None }
    }

    /// [`Self::answers`], which note where they were asked for.
    pub(super) fn answers_noted<'b>(&'b self, asked: &'b AskedArea) -> LengthAnswers<'b> {
        LengthAnswers { rule: self, squares: None, asked: Some(asked) }
    }

    pub(super) fn is_any(&self) -> bool {
        self.targets.is_some()
    }

    /// Returns the lengths of the edges opposite the corners of a triangle, in the plane.
    fn edges(&self, [a, b, c]: [LatticePoint; 3]) -> [f64; 3] {
        [[b, c], [c, a], [a, b]].map(|[from, to]| self.angles.vector(from, to).length())
    }

    fn longest(&self, points: [LatticePoint; 3]) -> f64 {
        let [a, b, c] = self.edges(points);
        a.max(b).max(c)
    }
}

/// The rectangle around all triangles that a rule was asked about: while no target changes in it, the
/// answers stay.
#[derive(Debug, Default)]
pub(super) struct AskedArea(Cell<Option<LatticeRect>>);

impl AskedArea {
    /// Returns the rectangle; `None` if nothing was asked.
    pub(super) fn rect(&self) -> Option<LatticeRect> {
        self.0.get()
    }

    fn add(&self, corners: [LatticePoint; 3]) {
        let (x, y) = (corners.map(|p| p.x), corners.map(|p| p.y));
        let [x0, y0] = [x, y].map(|[a, b, c]| a.min(b).min(c));
        let [x1, y1] = [x, y].map(|[a, b, c]| a.max(b).max(c));
        let own = LatticeRect { min: LatticePoint::new(x0, y0), max: LatticePoint::new(x1, y1) };
        self.0.set(Some(self.0.get().map_or(own, |area| area.union(&own))));
    }
}

/// The answers of a [`LengthRule`] for one thread.
pub(super) struct LengthAnswers<'a> {
    rule: &'a LengthRule<'a>,
    squares: Option<LevelCache>,
    asked: Option<&'a AskedArea>,
}

impl Drop for LengthAnswers<'_> {
    fn drop(&mut self) {
        self.squares.take().into_iter().for_each(|squares| self.rule.known.put_back(squares));
    }
}

impl LengthAnswers<'_> {
    /// Returns whether a triangle has an edge that is too long.
    pub(super) fn exceed(&mut self, points: [LatticePoint; 3]) -> bool {
        self.is_below(points, self.rule.longest(points))
    }

    /// Returns for each corner of a triangle whether the opposite edge is too long.
    pub(super) fn exceeding(&mut self, points: [LatticePoint; 3]) -> [bool; 3] {
        self.rule.edges(points).map(|length| self.is_below(points, length))
    }

    /// Returns whether a triangle may take the place of another one: unless it gets an edge that is too long,
    /// or one that was gets longer.
    pub(super) fn allow(&mut self, points: [LatticePoint; 3], former: [LatticePoint; 3]) -> bool {
        !self.exceed(points)
            || (self.exceed(former) && self.rule.longest(points) <= self.rule.longest(former))
    }

    /// Returns whether a triangle of the mesh is larger than its target.
    pub(super) fn ask_for_more(&mut self, corners: [LatticePoint; 3], level: u32) -> bool {
        let Some(EdgeTargets { field, paint }) = self.rule.targets else { return false };
        self.asked.iter().for_each(|asked| asked.add(corners));
        field.asks_for_more(paint, corners, level)
    }

    fn is_below(&mut self, points: [LatticePoint; 3], length: f64) -> bool {
        let Some(EdgeTargets { field, paint }) = self.rule.targets else { return false };
        self.asked.iter().for_each(|asked| asked.add(points));
        let squares = self.squares.get_or_insert_with(|| self.rule.known.take());
        field.is_below(squares, paint, points, length)
    }
}
