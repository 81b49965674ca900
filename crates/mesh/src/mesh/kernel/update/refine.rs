//! Bisects what exceeds its target.

use super::Updater;
use super::questions::{OpenTriangle, SubtreeQuestions};
use crate::mesh::kernel::{LevelsWithin, LimitError, Mesh, RefineError, SharedRule, TriangleId, ask_all};

impl Updater {
    /// Asks about up to `most` triangles that may exceed their target, and bisects those that do. Returns how
    /// many they were.
    pub(super) fn refine_on<R: SharedRule>(
        &mut self,
        mesh: &mut Mesh,
        rule: &R,
        room: &mut usize,
        most: usize,
    ) -> Result<usize, RefineError<R::Error>> {
        if self.open.is_empty() {
            self.reopen(mesh);
        }
        let from = self.open.len().saturating_sub(most);
        let mut batch = std::mem::take(&mut self.batch);
        let outdated = self.outdated.saturating_sub(from);
        self.outdated -= outdated;
        batch.extend(self.open.drain(from..));
        batch[..outdated].iter_mut().for_each(|open| open.known = LevelsWithin::UNKNOWN);
        let asked = ask_all(&SubtreeQuestions { mesh }, &mut batch, rule).map_err(RefineError::Rule);
        batch.iter().for_each(|open| self.known.set(open.id, open.known));
        let mut done = 0;
        let result = asked.and_then(|()| {
            batch
                .iter()
                .try_for_each(|open| {
                    self.close(mesh, open, room)?;
                    done += 1;
                    Ok(())
                })
                .map_err(LimitError::with_rule)
        });
        self.open.extend_from_slice(&batch[done..]);
        batch.clear();
        self.batch = batch;
        match result {
            // Nodes that can be removed may make room, even where nothing was searched yet.
            Err(error) if error.is_over_budget() && (self.has_areas() || self.loose.count() > 0) => {
                self.is_short = true;
                Ok(done)
            }
            result => result.map(|()| done),
        }
    }

    /// Lists the marked triangles again, after entries have moved.
    fn reopen(&mut self, mesh: &Mesh) {
        for index in self.exceeding.clone().take_ranges().into_iter().flatten() {
            let id = TriangleId::from_index(index);
            self.note_open(OpenTriangle {
                id,
                level: mesh.triangle(id).level(),
                known: LevelsWithin::UNKNOWN,
            });
        }
    }

    /// Bisects a triangle if it exceeds its target.
    #[inline]
    fn close(&mut self, mesh: &mut Mesh, open: &OpenTriangle, room: &mut usize) -> Result<(), LimitError> {
        let &OpenTriangle { id, level, known } = open;
        if mesh.triangle(id).level() != level {
            // It was bisected with another one, and its children are listed.
            return Ok(());
        }
        if level < self.limits.level_cap() && known.exceeds(level) == Some(true) {
            return self.bisect(mesh, open, room);
        }
        self.exceeding.remove(id.index());
        Ok(())
    }

    /// Bisects a triangle and what must be bisected with it.
    #[inline]
    fn bisect(&mut self, mesh: &mut Mesh, open: &OpenTriangle, room: &mut usize) -> Result<(), LimitError> {
        let &OpenTriangle { id, level, .. } = open;
        if level >= mesh.lattice().deepest_level() {
            return Err(RefineError::too_fine(mesh.lattice(), mesh.node(mesh.triangle(id).vertices[0])));
        }
        let most_new = Mesh::most_new_triangles(level);
        if mesh.raw_triangle_count() + most_new > *room {
            *room = mesh.room_for(id, most_new, &self.limits)?;
        }
        let (first_node, first_new) = (mesh.raw_nodes().len(), mesh.raw_triangle_count());
        let mut new = first_new;
        let mut chain = std::mem::take(&mut self.chain);
        mesh.refine_triangle_with(id, &mut chain, |mesh, parent| {
            self.note_bisected(mesh, parent, TriangleId::from_index(new));
            new += 1;
        });
        self.chain = chain;
        // The neighbour across a new child's bisection edge bordered on the parent's entry before.
        for new in first_new..new {
            if let Some(outer) = mesh.raw_triangles()[new].raw_neighbours[0].triangle() {
                self.log.triangle(outer);
            }
        }
        for node in first_node..mesh.raw_nodes().len() {
            self.log.nodes.insert(node);
        }
        self.log.step();
        Ok(())
    }

    /// Adds a marked triangle to the list.
    #[inline]
    pub(super) fn note_open(&mut self, open: OpenTriangle) {
        self.known.set(open.id, open.known);
        self.open.push(open);
    }

    /// Notes that a triangle was bisected. Its entry is one of the children now, and `new` the other.
    #[inline]
    fn note_bisected(&mut self, mesh: &Mesh, parent: TriangleId, new: TriangleId) {
        self.log.triangles.insert(parent.index());
        self.log.triangles.insert(new.index());
        if self.exceeding.contains(parent.index()) {
            let (level, known) = (mesh.triangle(parent).level(), self.known.of(parent));
            if known.exceeds(level) == Some(false) || level >= self.limits.level_cap() {
                self.exceeding.remove(parent.index());
            } else {
                self.exceeding.insert(new.index());
                [parent, new].into_iter().for_each(|id| self.note_open(OpenTriangle { id, level, known }));
            }
        } else if self.is_unsearched(parent) {
            // The search will not come to the end of the array again.
            let level = mesh.triangle(new).level();
            self.exceeding.insert(new.index());
            self.loose.insert(new.index());
            self.note_open(OpenTriangle { id: new, level, known: LevelsWithin::UNKNOWN });
        }
    }
}
