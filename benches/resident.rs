//! The memory of a document and of what the window derives from its mesh, each measured in a process of its
//! own: memory that is given back stays with the process.

use std::process::Command;
use std::sync::Arc;

use meshbrush_core::document::{Document, Follower};
use meshbrush_core::outline::OutlineFollower;
use meshbrush_core::path::{PathMesh, PathRequest, Planner};
use meshbrush_mesh::mesh::ProgramAllocator;

use crate::documents::{lake_document, layered, painted};
use crate::risks::RandomRisk;

/// What is measured, and its name on the page.
#[derive(Clone, Copy)]
pub enum Case {
    Paint,
    Layers,
    Graded,
    Outline,
    Path,
}

/// The memory of one case, in bytes for each triangle, beyond what the program takes without a mesh.
pub struct Memory {
    pub triangles: usize,
    /// Of the mesh and what belongs to it, once everything is done.
    pub at_rest: f64,
    /// The most while it was made.
    pub most: f64,
}

impl Case {
    pub const ALL: [Self; 5] = [Self::Paint, Self::Layers, Self::Graded, Self::Outline, Self::Path];

    pub fn name(self) -> &'static str {
        match self {
            Self::Paint => "plain paint",
            Self::Layers => "eight layers",
            Self::Graded => "eight layers, gradation 0.5",
            Self::Outline => "nodes on an outline of 200,000 corners",
            Self::Path => "plain paint and a path",
        }
    }

    fn document(self) -> Document {
        match self {
            Self::Paint => painted(17, 1220),
            Self::Path => painted(12, 1950),
            Self::Layers => layered(0.00035, None),
            Self::Graded => layered(0.0011, Some(0.5)),
            Self::Outline => lake_document(),
        }
    }
}

/// Measures a case in a process of its own, which runs this program with two words. `None` where the system
/// does not tell.
pub fn measure(case: Case) -> Option<Memory> {
    let program = std::env::current_exe().ok()?;
    let output = Command::new(program).args(["memory", case.name()]).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut numbers = text.split_whitespace().map(|word| word.parse::<usize>().ok());
    let mut next = || numbers.next().flatten();
    let (triangles, before, at_rest, most) = (next()?, next()?, next()?, next()?);
    let for_each = |bytes: usize| bytes.saturating_sub(before) as f64 / triangles as f64;
    Some(Memory { triangles, at_rest: for_each(at_rest), most: for_each(most) })
}

/// Does what [`measure`] asks of the process that it starts: where the arguments name a case, prints
/// triangles and bytes, and returns true.
pub fn answer() -> bool {
    let arguments: Vec<String> = std::env::args().skip_while(|argument| argument != "memory").collect();
    let named = |case: &Case| arguments.get(1).is_some_and(|name| name == case.name());
    let Some(case) = Case::ALL.into_iter().find(named) else { return false };
    // As the program does.
    ProgramAllocator::give_large_arrays_back();
    let mut document = case.document();
    let Some([before, _]) = resident_and_most() else { return true };
    let follower = Follower::new(&mut document).expect("it has a mesh");
    let outline = {
        let targets = follower.edge_targets(document.paint());
        OutlineFollower::new(follower.mesh(), follower.domain(), targets)
    };
    let path = matches!(case, Case::Path).then(|| planner(&follower));
    let [at_rest, most] = resident_and_most().expect("the system has told before");
    println!("{} {before} {at_rest} {most}", follower.mesh().raw_triangle_count());
    drop((document, outline, path));
    true
}

/// Returns a planner after it has found a path across the mesh.
fn planner(follower: &Follower) -> Planner {
    let mesh = Arc::new(PathMesh::new(follower.mesh().view()));
    let RandomRisk { cost, places } = RandomRisk::new(0);
    let mut planner = Planner::new(mesh, &cost).expect("the cost is positive");
    planner.solve(&cost, &places, PathRequest::FULL).expect("there is a path");
    planner
}

/// Returns the bytes of this process in memory now, and the most so far; `None` where the system does not
/// tell.
fn resident_and_most() -> Option<[usize; 2]> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kilobytes = |name: &str| -> Option<usize> {
        let line = status.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    Some([1024 * kilobytes("VmRSS:")?, 1024 * kilobytes("VmHWM:")?])
}
