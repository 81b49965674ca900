//! Marches from waypoints, which follow changes of the cost.

use super::Passage;
use super::march::{March, Seed};
use super::path_mesh::{NONE, PathMesh};
use super::place::MeshPlace;
use super::shared::SharedParts;
use crate::mesh::Progress;

/// A march from a waypoint.
#[derive(Clone, Debug, Default)]
pub(super) struct WaypointMarch {
    pub march: March,
    place: Option<MeshPlace>,
    seeds: Vec<Seed>,
    /// Whether the values are those of the costs as they are.
    is_current: bool,
    /// Whether the costs changed: then they will again, and only a march to the end can follow.
    follows: bool,
}

impl WaypointMarch {
    /// Marches from a place unless that is done already, for a limited number of nodes. Returns whether more
    /// are left. `until`: only to the corners of that place's triangle, unless the costs change again and
    /// again.
    pub fn run(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        least: Passage,
        (place, until): (MeshPlace, Option<MeshPlace>),
        most: usize,
    ) -> Progress {
        let seeds = place.seeds(mesh, costs);
        let is_same_place = self.place == Some(place);
        let to_the_end = is_same_place && self.follows;
        let until = until.filter(|_| !to_the_end).map(|place| place.corner_nodes(mesh));
        if !(self.is_current && is_same_place && self.seeds == seeds) {
            self.march.begin(mesh, &seeds);
            self.follows = to_the_end;
            (self.place, self.seeds, self.is_current) = (Some(place), seeds, true);
        }
        self.march.go_on_for(mesh, costs, least, until, most)
    }

    /// Follows changed costs; what cannot be followed is marched again later.
    pub fn follow(&mut self, mesh: &PathMesh, costs: &[f64], least: Passage, changed: &[u32]) {
        let seeds = self.place.map(|place| place.seeds(mesh, costs));
        self.follows = true;
        if self.is_current && self.march.is_complete() && seeds.as_ref() == Some(&self.seeds) {
            self.march.resolve(mesh, costs, least, &self.seeds, changed);
        } else {
            self.is_current = false;
        }
    }

    /// Follows the change from an old mesh to a new one, as [`Self::follow`] does. `changed` has the
    /// triangles that are new, or whose costs or passages changed.
    pub fn move_to(
        &mut self,
        [old, new]: [&PathMesh; 2],
        costs: &[f64],
        least: Passage,
        (shared, changed): (&SharedParts, &[u32]),
    ) {
        self.follows = true;
        let triangle = |t: u32| shared.new_triangles[t as usize];
        let place = self.place.map(|place| MeshPlace { triangle: triangle(place.triangle), ..place });
        self.place = place.filter(|place| place.triangle != NONE);
        // Seeds with a node that is gone belong to no place of the new mesh.
        let renumbered = |&(node, value): &Seed| {
            Some((shared.new_nodes[node as usize], value)).filter(|&(node, _)| node != NONE)
        };
        let seeds = self.place.map(|place| place.seeds(new, costs));
        self.seeds = self.seeds.iter().map(renumbered).collect::<Option<_>>().unwrap_or_default();
        if self.is_current && self.march.is_complete() && seeds.as_ref() == Some(&self.seeds) {
            self.march.move_to([old, new], costs, least, &self.seeds, (shared, changed));
        } else {
            self.is_current = false;
        }
    }
}
