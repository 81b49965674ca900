use std::fmt;

use glam::DVec2;

use crate::domain::{Domain, DomainShape, Polygon};
use crate::text::{Grouped, Number, rounded};

/// The least cost per unit of length that paths are found with.
pub(super) const LEAST_COST: f64 = 1e-100;
/// The greatest cost per unit of length that paths are found with.
pub(super) const GREATEST_COST: f64 = 1e100;

/// Why there is no path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathError {
    /// The cost is zero, negative, NaN or infinite at a place.
    #[error(
        "The cost at {} is {}. A cost per unit of length must be positive and finite everywhere; \
         change the formula, or give the length a weight above 0.",
        PointInWords(*at), Number(rounded(*value, VALUE_DIGITS))
    )]
    InvalidCost {
        /// A place with this cost, in world units.
        at: DVec2,
        /// The cost there.
        value: f64,
    },
    /// Interval arithmetic finds no positive, finite bounds of the cost around a place.
    #[error(
        "The cost near {} has no positive, finite bounds. Write the formula so that it stays positive and \
         finite there, for example max(0.01, …) or min(1000, …).",
        PointInWords(*at)
    )]
    UnboundedCost {
        /// The place, in world units.
        at: DVec2,
    },
    /// A weight is negative, NaN or infinite, or both are zero.
    #[error(
        "The weights {} for length and {} for risk make no cost: they must be finite numbers from 0, and one \
         of them above 0.",
        Number(*length), Number(*risk)
    )]
    InvalidWeights {
        /// The weight of the length.
        length: f64,
        /// The weight of the risk.
        risk: f64,
    },
    /// A coordinate is NaN or infinite.
    #[error("The {which} {} is not a place: its coordinates must be finite numbers.", PointInWords(*at))]
    NotAPlace {
        /// Which place.
        which: Waypoint,
        /// The place as given.
        at: DVec2,
    },
    /// The start, the goal or a via point is not in the domain.
    #[error("The {which} {} lies outside the domain. Choose a place inside it.", PointInWords(*at))]
    Outside {
        /// Which place.
        which: Waypoint,
        /// The place, in world units.
        at: DVec2,
    },
    /// The start, the goal or a via point is in a triangle of the mesh, but not in the domain that bounds are
    /// proved for.
    #[error(
        "No bound is proved from the {which} {}: it lies outside the outline of the domain or in a keep-out \
         region, though a triangle of the mesh holds it. Choose a place inside the outline.",
        PointInWords(*at)
    )]
    BeyondOutline {
        /// Which place.
        which: Waypoint,
        /// The place, in world units.
        at: DVec2,
    },
    /// The start, the goal or a via point is in a region where no path may go, or in a triangle that touches
    /// one or the outline.
    #[error(
        "The {which} {} lies in a keep-out region, or in a triangle that one or the outline touches. Choose a \
         place farther away, or make the mesh finer there.",
        PointInWords(*at)
    )]
    KeptOut {
        /// Which place.
        which: Waypoint,
        /// The place, in world units.
        at: DVec2,
    },
    /// The start, the goal or a via point is not on the polygons of the domain, but in a triangle of the
    /// mesh.
    #[error(
        "The {which} {} lies on the outline of the domain or beyond it, though a triangle of the mesh holds it. \
         Paths stay on the polygons of the domain: choose a place on them.",
        PointInWords(*at)
    )]
    BesidePolygons {
        /// Which place.
        which: Waypoint,
        /// The place, in world units.
        at: DVec2,
    },
    /// The start, the goal or a via point is nearer than the clearance to the outline or to a keep-out
    /// region.
    #[error(
        "The {which} {} is only {} from the outline of the domain or a keep-out region, and the clearance of paths is \
         {}. Choose a place farther away, or a smaller clearance.",
        PointInWords(*at), Number(rounded(*distance, VALUE_DIGITS)), Number(rounded(*clearance, VALUE_DIGITS))
    )]
    TooClose {
        /// Which place.
        which: Waypoint,
        /// The place, in world units.
        at: DVec2,
        /// Its distance, in world units.
        distance: f64,
        /// The clearance, in world units.
        clearance: f64,
    },
    /// A clearance is negative, NaN or infinite.
    #[error("A clearance of {} is no distance: it must be a finite number from 0.", Number(*clearance))]
    InvalidClearance {
        /// The clearance as given.
        clearance: f64,
    },
    /// A cost is so great or so small that sums of costs along paths overflow or are lost.
    #[error(
        "The cost near {} is {}. Only costs from {} to {} can be added up along paths: scale the formula or \
         the weights.",
        PointInWords(*at), Number(rounded(*value, VALUE_DIGITS)), Number(LEAST_COST), Number(GREATEST_COST)
    )]
    CostOutOfRange {
        /// A place with such a cost, in world units.
        at: DVec2,
        /// The cost there.
        value: f64,
    },
    /// No path leads from one place to the next.
    #[error(
        "No path leads from the {from} to the {to}: they lie in different parts of the domain. \
         Choose two places in one part, or open a gap between the parts."
    )]
    Apart {
        /// The start of the path.
        from: Waypoint,
        /// The end of the path.
        to: Waypoint,
    },
    /// The triangles of the mesh do not connect two places, but the domain does, or may.
    #[error(
        "The mesh does not connect the {from} with the {to}, but the domain may: a strait between them can be \
         narrower than the triangles there. Make the mesh finer along the outline."
    )]
    MeshApart {
        /// The start of the path.
        from: Waypoint,
        /// The end of the path.
        to: Waypoint,
    },
    /// Keep-out regions, the outline or the clearance separate two places.
    #[error(
        "No path leads from the {from} to the {to}: keep-out regions, the outline of the domain and the \
         clearance, with the triangles that they touch, enclose the {which}. Choose a smaller clearance, remove or \
         move a region, or make the mesh finer where the way is narrow."
    )]
    Enclosed {
        /// The place that is enclosed: of the two parts, its own has fewer triangles.
        which: Waypoint,
        /// The start of the path.
        from: Waypoint,
        /// The end of the path.
        to: Waypoint,
    },
    /// The mesh of a certificate would be too large.
    #[error(
        "The bound needs a mesh of more than {} nodes. Choose a coarser grid for it.", Grouped(*limit)
    )]
    TooLarge {
        /// The most nodes.
        limit: usize,
    },
    /// A tolerance is negative or NaN.
    #[error("A tolerance of {} is no distance: it must be a number from 0.", Number(*tolerance))]
    InvalidTolerance {
        /// The tolerance as given.
        tolerance: f64,
    },
    /// Fewer than two places.
    #[error("A path needs a start and a goal.")]
    TooFewPlaces,
}

impl PathError {
    /// Returns the error of a leg between two of `count` places, by its number from 0, as one of the whole
    /// path.
    pub(super) fn of_leg(self, leg: usize, count: usize) -> Self {
        let of = |which: Waypoint| Waypoint::of(if which == Waypoint::Goal { leg + 1 } else { leg }, count);
        match self {
            Self::BeyondOutline { which, at } => Self::BeyondOutline { which: of(which), at },
            Self::Apart { from, to } => Self::Apart { from: of(from), to: of(to) },
            other => other,
        }
    }

    /// Returns the error as what is known of the domain tells it: whether two places that the mesh does not
    /// connect lie in different parts of the domain as well. `places` are those that the path was to visit.
    pub fn in_domain(self, domain: &Domain, places: &[DVec2]) -> Self {
        let (from, to) = match self {
            Self::Apart { from, to } | Self::Enclosed { from, to, .. } => (from, to),
            _ => return self,
        };
        let polygons = match &domain.shape {
            DomainShape::Whole => return self,
            DomainShape::Formula(_) if matches!(self, Self::Apart { .. }) => {
                return Self::MeshApart { from, to };
            }
            DomainShape::Formula(_) => return self,
            DomainShape::Region(region) => region.polygons(),
        };
        let part = |which: Waypoint| {
            let place = places.get(which.index(places.len()))?;
            polygons.iter().position(|polygon| covers(polygon, *place))
        };
        match (part(from), part(to)) {
            (Some(a), Some(b)) if a != b => Self::Apart { from, to },
            _ if matches!(self, Self::Enclosed { .. }) => self,
            // A place that is in no part is beside the outline, where the mesh follows it roughly.
            _ => Self::MeshApart { from, to },
        }
    }
}

/// Returns whether a polygon covers a point: a ray to the right crosses an odd number of its edges.
fn covers(polygon: &Polygon, point: DVec2) -> bool {
    let edges =
        polygon.iter().flat_map(|ring| (0..ring.len()).map(|n| [ring[n], ring[(n + 1) % ring.len()]]));
    let crosses = |[a, b]: &[DVec2; 2]| {
        (a.y <= point.y) != (b.y <= point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    edges.filter(crosses).count() % 2 == 1
}

/// A place that a path must visit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waypoint {
    /// The start of the path.
    Start,
    /// A place in between, counted from 1.
    Via(usize),
    /// The end of the path.
    Goal,
}

impl Waypoint {
    /// Returns the place in order of this one of `count`.
    fn index(self, count: usize) -> usize {
        match self {
            Self::Start => 0,
            Self::Via(number) => number,
            Self::Goal => count.saturating_sub(1),
        }
    }

    /// Returns the waypoint at a place of `count` in order.
    pub fn of(index: usize, count: usize) -> Self {
        match index {
            0 => Self::Start,
            _ if index + 1 == count => Self::Goal,
            _ => Self::Via(index),
        }
    }
}

impl fmt::Display for Waypoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start => f.write_str("start"),
            Self::Via(number) => write!(f, "via point {number}"),
            Self::Goal => f.write_str("goal"),
        }
    }
}

/// A point for a sentence.
struct PointInWords(DVec2);

/// Digits of a coordinate in a sentence: metres of a country, or centimetres of a degree.
const POINT_DIGITS: usize = 7;
/// Digits of a cost in a sentence.
const VALUE_DIGITS: usize = 6;

impl fmt::Display for PointInWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.0.to_array().map(|value| Number(rounded(value, POINT_DIGITS)));
        write!(f, "({x}, {y})")
    }
}
