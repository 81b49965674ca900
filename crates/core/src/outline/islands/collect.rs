//! Finds the islands of a mesh that changed, and changes them again.

use rayon::prelude::*;

use super::kept::IslandTriangle;
use super::loaded::LoadedMesh;
use super::written::in_groups;
use super::{ChangedIsland, IslandRule, KeptIslands, PieceSource, from_lowest};
use crate::geometry::{LatticePoint, LatticeRect, NumberSet};
use crate::mesh::{DrawnPiece, Mesh, TriangleId};
use crate::outline::band::GRAIN;
use crate::outline::local::{LocalMesh, PatchedTriangle};
use crate::outline::places::triangle_place;

/// What changed in the triangles below islands.
#[derive(Clone, Copy)]
pub(in crate::outline) struct ChangeBelow<'a> {
    /// The entries of the mesh that are others, or in whose place others may be, in ascending order.
    pub(in crate::outline) entries: &'a [TriangleId],
    /// Where targets may have changed.
    pub(in crate::outline) retargeted: &'a [LatticeRect],
    /// Most triangles that may be changed again.
    pub(in crate::outline) most: usize,
}

/// Islands that are dissolved, and triangles that may be in new ones.
struct IslandSearch<'a> {
    loaded: LoadedMesh<'a>,
    dissolved: Vec<u32>,
    is_dissolved: NumberSet<u32>,
    candidates: Vec<u32>,
    is_candidate: NumberSet<u32>,
}

impl IslandSearch<'_> {
    fn dissolve(&mut self, island: u32) {
        if self.is_dissolved.insert(island) {
            self.dissolved.push(island);
        }
    }

    fn add(&mut self, triangle: u32) {
        if self.is_candidate.insert(triangle) {
            self.candidates.push(triangle);
        }
    }

    /// Returns whether an island of a triangle is as before.
    fn is_same(&self, triangle: u32, kept: &IslandTriangle) -> bool {
        let (corners, lowest) = from_lowest(self.loaded.corners(triangle));
        let on_boundary = self.loaded.on_boundary(triangle);
        corners == kept.corners && [0, 1, 2].map(|i| on_boundary[(lowest + i) % 3]) == kept.on_boundary
    }
}

/// Triangles of new islands.
struct NewIslands {
    triangles: Vec<u32>,
    /// For each node that was loaded, whether all triangles at it are among them.
    is_complete: Vec<bool>,
}

impl KeptIslands {
    /// Takes in what changed below, and returns the entries whose pieces may have changed, in ascending
    /// order; `None` if too many triangles would have to be changed again. Then the islands are no longer in
    /// step.
    pub(in crate::outline) fn update<R: IslandRule>(
        &mut self,
        mesh: &Mesh,
        below: &dyn PieceSource,
        rule: &R,
        change: ChangeBelow<'_>,
    ) -> Option<Vec<TriangleId>> {
        let mut search = IslandSearch {
            loaded: LoadedMesh::new(mesh, below),
            dissolved: Vec::new(),
            is_dissolved: NumberSet::default(),
            candidates: Vec::new(),
            is_candidate: NumberSet::default(),
        };
        self.follow_entries(mesh, below, rule, change.entries, &mut search);
        self.asked_in(change.retargeted).into_iter().for_each(|island| search.dissolve(island));
        if R::COUNTS {
            for n in 0..search.candidates.len() {
                for v in search.loaded.nodes(search.candidates[n]) {
                    search.loaded.around(v).to_vec().into_iter().for_each(|t| search.add(t));
                }
            }
        }
        let new = self.collect(rule, &mut search, change.most)?;
        let islands = changed_islands(rule, &mut search.loaded, &new);
        let mut changed = change.entries.to_vec();
        search.dissolved.iter().for_each(|&island| self.forget(island, &mut changed));
        for group in in_groups(islands) {
            self.write(mesh, below, rule.angles(), &group, &mut changed);
        }
        changed.par_sort_unstable();
        changed.dedup();
        changed.retain(|id| id.index() < mesh.raw_triangle_count());
        Some(changed)
    }

    /// Finds the triangles of the mesh at their new entries, dissolves the islands of those that are gone or
    /// others, and adds the fresh ones.
    fn follow_entries<R: IslandRule>(
        &mut self,
        mesh: &Mesh,
        below: &dyn PieceSource,
        rule: &R,
        entries: &[TriangleId],
        search: &mut IslandSearch,
    ) {
        let count = mesh.raw_triangle_count();
        let gone = (count..std::mem::replace(&mut self.count, count)).map(TriangleId::from_index);
        let mut lost = Vec::new();
        for id in entries.iter().copied().chain(gone) {
            if let Some(place) = self.seats.remove(&(id.index() as u32)) {
                self.owners.get_mut(&place).expect("it has islands").id = None;
                lost.push(place);
            }
        }
        let entries = entries.par_iter().with_min_len(GRAIN).copied().filter(|id| id.index() < count);
        let matters = |id: &TriangleId| self.matters(mesh, below, rule, *id);
        for id in entries.filter(matters).collect::<Vec<TriangleId>>() {
            let pieces = search.loaded.load(id).to_vec();
            let place = triangle_place(mesh.corners(id));
            let kept: &[IslandTriangle] = match self.owners.get_mut(&place) {
                Some(owner) => {
                    owner.id = Some(id);
                    self.seats.insert(id.index() as u32, place);
                    &owner.triangles
                }
                None => &[],
            };
            let is_there = |kept: &&IslandTriangle| pieces.iter().any(|&t| search.is_same(t, kept));
            let others: Vec<u32> =
                kept.iter().filter(|kept| !is_there(kept)).map(|kept| kept.island).collect();
            let is_fresh = |t: &u32| !kept.iter().any(|kept| search.is_same(*t, kept));
            let fresh: Vec<u32> = pieces.iter().copied().filter(is_fresh).collect();
            others.into_iter().for_each(|island| search.dissolve(island));
            for t in fresh {
                search.add(t);
                self.islands_at(search.loaded.corners(t)).for_each(|island| search.dissolve(island));
            }
        }
        for place in lost {
            let owner = &self.owners[&place];
            if owner.id.is_none() {
                owner.triangles.iter().for_each(|t| search.dissolve(t.island));
            }
        }
    }

    /// Returns whether what takes the place of a triangle of the mesh is in an island, has a node of one, or
    /// may be changed.
    fn matters<R: IslandRule>(&self, mesh: &Mesh, below: &dyn PieceSource, rule: &R, id: TriangleId) -> bool {
        let is_owner = || self.owners.contains_key(&triangle_place(mesh.corners(id)));
        let of_piece = |piece: &DrawnPiece| {
            rule.may_be_seed(piece.corners) || self.islands_at(piece.corners).next().is_some()
        };
        (R::COUNTS && below.is_near_boundary(mesh, id))
            || is_owner()
            || below.pieces(mesh, id).iter().any(of_piece)
    }

    fn islands_at(&self, corners: [LatticePoint; 3]) -> impl Iterator<Item = u32> {
        corners.map(|at| self.island_at.get(&at).copied()).into_iter().flatten()
    }

    /// Collects the islands around the candidates and in place of the dissolved ones. `None` if they have
    /// too many triangles.
    fn collect<R: IslandRule>(&self, rule: &R, search: &mut IslandSearch, most: usize) -> Option<NewIslands> {
        let mut taken = 0;
        loop {
            for n in taken..search.dissolved.len() {
                self.add_triangles_of(search.dissolved[n], search);
            }
            taken = search.dissolved.len();
            let seeds = seeds(rule, search);
            let new = rings(seeds, R::RINGS, &mut search.loaded, most)?;
            let nodes = new.triangles.iter().flat_map(|&t| search.loaded.corners(t));
            let touched: Vec<u32> = nodes.filter_map(|at| self.island_at.get(&at).copied()).collect();
            touched.into_iter().for_each(|island| search.dissolve(island));
            if taken == search.dissolved.len() {
                return Some(new);
            }
        }
    }

    /// Adds the triangles of a dissolved island that are still there.
    fn add_triangles_of(&self, island: u32, search: &mut IslandSearch) {
        for place in &self.island(island).owners {
            let Some(id) = self.owners[place].id else { continue };
            for t in search.loaded.load(id).to_vec() {
                let mut others = self.islands_at(search.loaded.corners(t));
                if others.all(|other| other == island || search.is_dissolved.contains(&other)) {
                    search.add(t);
                }
            }
        }
    }
}

fn seeds<R: IslandRule>(rule: &R, search: &mut IslandSearch) -> Vec<u32> {
    let loaded = &mut search.loaded;
    if R::COUNTS {
        for &t in &search.candidates {
            loaded.nodes(t).into_iter().for_each(|v| _ = loaded.around(v));
        }
    }
    let loaded = &*loaded;
    let is_seed = |t: &u32| rule.is_seed(loaded.triangle(*t).corners, loaded.corners(*t), &loaded.census);
    search.candidates.iter().copied().filter(is_seed).collect()
}

/// Returns triangles with some rings around them; `None` if these are too many.
fn rings(seeds: Vec<u32>, rings: usize, loaded: &mut LoadedMesh, most: usize) -> Option<NewIslands> {
    let mut is_among: NumberSet<u32> = seeds.iter().copied().collect();
    let mut new = NewIslands { triangles: seeds, is_complete: Vec::new() };
    let mut first = 0;
    for _ in 0..rings {
        let last = std::mem::replace(&mut first, new.triangles.len());
        for n in last..first {
            for v in loaded.nodes(new.triangles[n]) {
                new.is_complete.resize(new.is_complete.len().max(v as usize + 1), false);
                if !std::mem::replace(&mut new.is_complete[v as usize], true) {
                    let around = loaded.around(v).iter().copied().filter(|&t| is_among.insert(t));
                    new.triangles.extend(around);
                }
            }
        }
        if new.triangles.len() > most {
            return None;
        }
    }
    new.is_complete.resize(loaded.places.len(), false);
    Some(new)
}

/// Changes new islands. All threads work on them.
fn changed_islands<R: IslandRule>(rule: &R, loaded: &mut LoadedMesh, new: &NewIslands) -> Vec<ChangedIsland> {
    if R::COUNTS {
        for &t in &new.triangles {
            loaded.nodes(t).into_iter().for_each(|v| _ = loaded.around(v));
        }
    }
    let loaded = &*loaded;
    let mut is_complete = new.is_complete.clone();
    is_complete.resize(loaded.places.len(), false);
    let triangles: Vec<PatchedTriangle> = new.triangles.iter().map(|&t| loaded.triangle(t)).collect();
    let on_outline = |p: LatticePoint| rule.is_on_outline(p);
    let near = LocalMesh::new(&loaded.places, &triangles, &is_complete, rule.angles(), &on_outline);
    let census = &loaded.census;
    near.parts().into_par_iter().map(|part| rule.changed(near.part(&part), census)).collect()
}
