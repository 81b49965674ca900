//! Names, types and splits of a boundary, as people or files give them.

use glam::DVec2;

use super::super::segments::Segments;
use super::super::{Domain, OutlineOnEarth, Polygon, RegionError};
use super::{BoundaryKind, BoundaryPieces, BoundaryType};
use crate::geometry::{NumberMap, Rect};

/// Most characters of a name; longer ones are cut.
pub const LONGEST_NAME: usize = 80;

/// Names and types of pieces of a boundary, and points where it is split.
///
/// All are tied to points on the boundary in world units. An edit of the domain elsewhere does not move
/// them. A mark that is no longer on the boundary has no effect until an undo restores the boundary there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoundaryMarks {
    /// The points where the boundary is split, in world units.
    pub splits: Vec<DVec2>,
    /// A point of each named piece, and its name. Of several names on one piece, the first counts.
    pub names: Vec<(DVec2, String)>,
    /// A point of each piece whose type is set, and the type. Of several types on one piece, the first
    /// counts.
    pub types: Vec<(DVec2, BoundaryType)>,
}

// No coordinate is NaN. With `Eq`, `Arc<BoundaryMarks>` compares pointers before the data.
impl Eq for BoundaryMarks {}

/// A polygon with a name, as files have them.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPolygon {
    /// The rings of the polygon.
    pub polygon: Polygon,
    /// The name of the polygon; empty if it has none.
    pub name: String,
}

impl BoundaryMarks {
    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.splits.is_empty() && self.names.is_empty() && self.types.is_empty()
    }

    /// Returns these marks and others after them: of two names or types on one piece, these count.
    pub fn before(mut self, others: Self) -> Self {
        self.splits.extend(others.splits);
        self.names.extend(others.names);
        self.types.extend(others.types);
        self
    }

    /// Returns the marks at other places.
    pub fn moved(&self, place: impl Fn(DVec2) -> DVec2) -> Self {
        Self {
            splits: self.splits.iter().map(|&at| place(at)).collect(),
            names: self.names.iter().map(|(at, name)| (place(*at), name.clone())).collect(),
            types: self.types.iter().map(|&(at, of_piece)| (place(at), of_piece)).collect(),
        }
    }

    /// Returns the memory of names, types and places, in bytes.
    pub fn bytes(&self) -> usize {
        let names: usize = self.names.iter().map(|(_, name)| name.capacity()).sum();
        size_of_val(&*self.splits) + size_of_val(&*self.names) + size_of_val(&*self.types) + names
    }

    /// Returns a name that files can hold: control characters become blanks, quotation marks apostrophes, and
    /// backslashes slashes; blanks at the ends are removed.
    pub fn valid_name(text: &str) -> String {
        let valid = |c: char| match c {
            '"' => '\'',
            '\\' => '/',
            c if c.is_control() => ' ',
            c => c,
        };
        let name: String = text.trim().chars().map(valid).take(LONGEST_NAME).collect();
        name.trim().to_owned()
    }

    /// Returns the domain that named polygons cover, in `bounds` where these are given, and the names that
    /// they bring.
    ///
    /// # Errors
    /// Fails as [`Domain::of_polygons_on_earth`] does.
    pub fn domain_of(
        polygons: &[NamedPolygon],
        bounds: Option<Rect>,
        on_earth: &OutlineOnEarth,
    ) -> Result<(Domain, Self), RegionError> {
        let plain: Vec<Polygon> = polygons.iter().map(|named| named.polygon.clone()).collect();
        let domain = match bounds {
            Some(bounds) => Domain::of_stored_polygons(plain, bounds, on_earth)?,
            None => Domain::of_polygons_on_earth(&plain, on_earth)?,
        };
        let marks = Self::of_polygons(polygons, &domain);
        Ok((domain, marks))
    }

    /// Returns the names from the polygons of a domain: the name of a polygon for the coasts of its outer
    /// ring, and with `island` and a number for its holes, the largest first.
    ///
    /// A piece of the domain's boundary belongs to the polygon that has an edge at the middle of the piece.
    /// Open sides get no names.
    pub fn of_polygons(polygons: &[NamedPolygon], domain: &Domain) -> Self {
        let mut marks = Self::default();
        let Some(pieces) = BoundaryPieces::of_domain(domain, &marks) else { return marks };
        let (mut segments, mut owners) = (Vec::new(), Vec::new());
        for (owner, named) in polygons.iter().enumerate().filter(|(_, named)| !named.name.trim().is_empty()) {
            for ring in &named.polygon {
                segments.extend(ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]));
                owners.resize(segments.len(), owner);
            }
        }
        let Some(segments) = Segments::new(segments) else { return marks };
        let mut islands: NumberMap<usize, usize> = NumberMap::default();
        for piece in pieces.list().iter().filter(|piece| piece.kind != BoundaryKind::Open) {
            let middle = piece.middle();
            let owner = match segments.nearest(middle, |_| true) {
                Some((segment, distance)) if distance <= pieces.tolerance() => owners[segment as usize],
                _ => continue,
            };
            let name = Self::valid_name(&polygons[owner].name);
            let name = if piece.kind == BoundaryKind::Island {
                let number = islands.entry(owner).or_default();
                *number += 1;
                format!("{name} island {number}")
            } else {
                name
            };
            marks.names.push((middle, name));
        }
        marks
    }
}
