//! The triangles of a mesh in the area of paths are found in slices.

use glam::DVec2;
use rayon::prelude::*;

use super::detail::RimDivision;
use super::path_mesh::PathMesh;
use super::{Passage, PathArea};
use crate::mesh::{MeshView, Progress};

/// Number of triangles that a thread compares with the area at a time.
const TOGETHER: usize = 1024;

/// The work of [`PathMesh::in_area`], in slices.
pub struct PathMeshing {
    mesh: PathMesh,
    step: MeshingStep,
}

/// What is done next.
enum MeshingStep {
    /// Triangles from this one on are compared with the area.
    Compare(usize, Vec<Passage>),
    /// Triangles to bisect are looked for.
    Find,
    /// Triangles through which the rim of the area passes are bisected.
    Divide(RimDivision),
    /// Triangles are sorted along a curve.
    Sort,
    Done,
}

impl PathMeshing {
    /// Begins with a mesh.
    pub fn new(view: MeshView, area: &PathArea) -> Self {
        let passage = |_: &[DVec2; 3], is_outside| if is_outside { Passage::Closed } else { Passage::Open };
        let mut mesh = PathMesh::with_passages(view, passage);
        mesh.area = area.clone();
        let step = if area.is_everything() { MeshingStep::Find } else { MeshingStep::Compare(0, Vec::new()) };
        Self { mesh, step }
    }

    /// Looks at about `triangles` triangles. Returns the mesh at the end.
    pub fn advance(&mut self, triangles: usize) -> Option<PathMesh> {
        let Self { mesh, step } = self;
        *step = match std::mem::replace(step, MeshingStep::Done) {
            MeshingStep::Compare(first, mut passages) => {
                let end = first.saturating_add(triangles.max(1)).min(mesh.triangles.len());
                let numbers = (first as u32..end as u32).into_par_iter().with_min_len(TOGETHER);
                let more: Vec<Passage> = numbers.map(|number| passage_in_area(mesh, number)).collect();
                passages.extend(more);
                if end < mesh.triangles.len() {
                    MeshingStep::Compare(end, passages)
                } else {
                    close_outside_area(mesh, &passages);
                    MeshingStep::Find
                }
            }
            MeshingStep::Find => match RimDivision::new(mesh) {
                Some(division) => MeshingStep::Divide(division),
                None => return Some(std::mem::take(mesh)),
            },
            MeshingStep::Divide(mut division) => match division.advance(mesh, triangles.max(1)) {
                Progress::More => MeshingStep::Divide(division),
                Progress::Done if division.has_changed(mesh) => MeshingStep::Sort,
                Progress::Done => return Some(std::mem::take(mesh)),
            },
            MeshingStep::Sort => {
                mesh.sort_along_curve();
                return Some(std::mem::take(mesh));
            }
            MeshingStep::Done => MeshingStep::Done,
        };
        None
    }
}

fn passage_in_area(mesh: &PathMesh, number: u32) -> Passage {
    match mesh.passage(number) {
        Passage::Closed => Passage::Closed,
        _ => mesh.area.passage(&mesh.corners(number)),
    }
}

/// Closes triangles that the area does not have.
fn close_outside_area(mesh: &mut PathMesh, passages: &[Passage]) {
    for (triangle, &passage) in mesh.triangles.iter_mut().zip(passages) {
        triangle.is_kept_out = passage == Passage::Closed && triangle.is_passable();
        triangle.passage = passage;
    }
    mesh.clear_indices();
    mesh.has_obtuse = mesh.triangles.iter().any(|triangle| triangle.obtuse < 3 && triangle.is_passable());
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::domain::{BoundaryTreatment, Domain};
    use crate::geometry::{Lattice, Rect};
    use crate::layers::Mask;
    use crate::mesh::{Limits, Mesh};

    #[test]
    fn slices_of_any_size_find_the_same_triangles() {
        let lattice = Lattice::covering(Rect::UNIT, 0.05, 100_000).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let ring = vec![dvec2(0.3, 0.3), dvec2(0.7, 0.35), dvec2(0.6, 0.7)];
        let keep_out = vec![Mask::new(&[vec![ring]]).unwrap()];
        let domain = Domain::rectangle(Rect::UNIT);
        for area in [
            PathArea::default(),
            PathArea::outside_of(&keep_out),
            PathArea::new(&domain, BoundaryTreatment::Report, keep_out.clone(), 0.06).unwrap(),
        ] {
            let whole = PathMesh::in_area(mesh.view(), &area);
            for slice in [1, 7, 100] {
                let mut meshing = PathMeshing::new(mesh.view(), &area);
                let mut slices = 1;
                let found = loop {
                    match meshing.advance(slice) {
                        Some(found) => break found,
                        None => slices += 1,
                    }
                };
                assert!(found.is_same_as(&whole));
                let passages = |mesh: &PathMesh| -> Vec<Passage> {
                    mesh.triangles.iter().map(|triangle| triangle.passage).collect()
                };
                assert_eq!(passages(&found), passages(&whole));
                assert!(area.is_everything() || slices > mesh.raw_triangle_count() / slice, "{slices}");
            }
        }
    }
}
