//! The coordinates of a GeoJSON geometry, nested lists of positions.

use std::fmt;

use glam::DVec2;
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, SeqAccess, Visitor};

use meshbrush_core::domain::{MOST_CORNERS, Polygon};
use meshbrush_mesh::text::Grouped;

/// The positions of nested lists in one flat list: nested vectors would take several times the memory while
/// reading.
#[derive(Default)]
pub(super) struct NestedPositions {
    pub(super) positions: Vec<DVec2>,
    /// The end of each ring in `positions`, and of each polygon in `ring_ends`.
    ring_ends: Vec<usize>,
    polygon_ends: Vec<usize>,
    /// How deep the positions are nested: 1 for a single position, 3 for a list of rings; 0 without
    /// positions.
    pub(super) depth: usize,
}

impl NestedPositions {
    /// Returns the polygons, if the positions are nested `depth` deep.
    pub(super) fn polygons(mut self, kind: &str, depth: usize) -> Result<Vec<Polygon>, String> {
        if self.positions.is_empty() {
            return Ok(Vec::new());
        }
        if self.depth != depth {
            let lists = "lists of positions in lists of rings";
            return Err(format!(
                "the coordinates of a {kind} must be {lists}, nested {depth} deep; here it is {}.",
                self.depth
            ));
        }
        if depth == 3 {
            self.polygon_ends.push(self.ring_ends.len());
        }
        let mut rings = self.rings().into_iter();
        let mut start = 0;
        let polygon = |end: usize| {
            let count = end - std::mem::replace(&mut start, end);
            rings.by_ref().take(count).collect::<Polygon>()
        };
        Ok(self.polygon_ends.iter().copied().map(polygon).filter(|polygon| !polygon.is_empty()).collect())
    }

    /// Returns the rings, without the repeated last position.
    fn rings(&self) -> Vec<Vec<DVec2>> {
        let mut rings = self.lists();
        rings.iter_mut().for_each(open_ring);
        rings
    }

    /// Returns the lists of positions, as rings and lines are.
    pub(super) fn lists(&self) -> Vec<Vec<DVec2>> {
        let mut start = 0;
        let list = |&end: &usize| self.positions[std::mem::replace(&mut start, end)..end].to_vec();
        self.ring_ends.iter().map(list).collect()
    }
}

impl<'de> Deserialize<'de> for NestedPositions {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        let mut coordinates = Self::default();
        coordinates.depth = List(&mut coordinates).deserialize(json)?.depth();
        Ok(coordinates)
    }
}

/// The deepest nesting of the format: the positions of a MultiPolygon.
const DEEPEST: usize = 4;

/// Reads a list of numbers or of lists into the coordinates.
struct List<'a>(&'a mut NestedPositions);

/// A value that was read.
#[derive(Clone, Copy, PartialEq)]
enum Met {
    Number(f64),
    /// A list with positions nested this deep; 0 if it has none.
    List(usize),
}

impl Met {
    fn depth(self) -> usize {
        match self {
            Self::Number(_) => 0,
            Self::List(depth) => depth,
        }
    }
}

impl<'de> DeserializeSeed<'de> for List<'_> {
    type Value = Met;

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<Met, D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for List<'_> {
    type Value = Met;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a list")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Met, E> {
        if value.is_finite() { Ok(Met::Number(value)) } else { Err(E::custom("a coordinate is not finite")) }
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Met, E> {
        Ok(Met::Number(value as f64))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Met, E> {
        Ok(Met::Number(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Met, A::Error> {
        let mut position = DVec2::ZERO;
        let (mut numbers, mut lists, mut depth) = (0, 0, 0);
        while let Some(met) = list.next_element_seed(List(self.0))? {
            match met {
                Met::Number(value) => {
                    if numbers < 2 {
                        position[numbers] = value;
                    }
                    numbers += 1;
                }
                Met::List(inner) if depth > 0 && inner > 0 && inner != depth => {
                    return Err(A::Error::custom("a list has elements that are nested to different depths"));
                }
                Met::List(inner) => {
                    depth = depth.max(inner);
                    lists += 1;
                }
            }
        }
        if numbers > 0 && lists > 0 {
            return Err(A::Error::custom("a list has both numbers and lists"));
        }
        let depth = if depth > 0 { depth + 1 } else { usize::from(numbers > 0) };
        self.0.close(position, numbers, depth).map_err(A::Error::custom)?;
        Ok(Met::List(depth))
    }
}

impl NestedPositions {
    /// Ends a list with positions nested `depth` deep.
    fn close(&mut self, position: DVec2, numbers: usize, depth: usize) -> Result<(), String> {
        match depth {
            0 => {}
            1 if numbers < 2 => return Err("a position needs two numbers".into()),
            1 => self.positions.push(position),
            2 => self.ring_ends.push(self.positions.len()),
            3 => self.polygon_ends.push(self.ring_ends.len()),
            DEEPEST => {}
            _ => return Err("lists are nested deeper than those of a MultiPolygon".into()),
        }
        if self.positions.len() > MOST_CORNERS {
            let help = "Simplify the outline first, to the detail that the mesh needs";
            return Err(format!(
                "a geometry has more than {} corners, which is the limit. {help}",
                Grouped(MOST_CORNERS)
            ));
        }
        Ok(())
    }
}

/// Leaves out the last position of a ring where it repeats the first.
pub(super) fn open_ring(ring: &mut Vec<DVec2>) {
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
}
