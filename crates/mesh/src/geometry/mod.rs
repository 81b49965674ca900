//! The only geometric predicates of the program, rectangles and an index of them, the order of a search
//! through the parts of a region, and the map between the world and the integer lattice on which every node
//! of a mesh lies.

mod best_first;
mod box_runs;
mod box_tree;
mod gauss;
mod lattice;
mod lattice_rect;
mod number_map;
mod octagon;
mod predicates;
mod rect;
mod ring;
mod segment;
mod thinning;
mod z_order;

pub use best_first::BestFirst;
pub use box_runs::BoxRuns;
pub use box_tree::{BoxGroup, BoxTree};
pub use gauss::{GAUSS, gauss_mean};
pub use lattice::{GridError, LATTICE_BITS, Lattice, LatticePoint};
pub use lattice_rect::LatticeRect;
pub use number_map::{NumberMap, NumberSet};
pub use octagon::Octagon;
pub use predicates::{Side, exact_sum_sign, side_of_edge, side_of_line, side_of_points};
pub use rect::Rect;
pub use ring::{is_around, signed_area};
pub use segment::{nearest_on_segment, nearest_share};
pub use thinning::corners_that_stay;
pub use z_order::{interleaved, z_order};
