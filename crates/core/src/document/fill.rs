//! What a fill adds to an area that is drawn by hand, or cuts from it.

use glam::DVec2;

use super::Drawing;
use crate::domain::{CutShape, Polygon, Ring, signed_area};
use crate::geometry::is_around;

impl Drawing {
    /// Returns the area that a fill at a point, in world units, adds: the hole around the point; or cuts
    /// away: the part that the point is in, with all that lies in holes of it. `None` where the point is in
    /// no hole, or in no part.
    ///
    /// ```text
    /// ┌─────────────┐   · adds the hole with the part in it,
    /// │  ┌───────┐  │   × adds nothing, and cuts all of this away,
    /// │ ×│ · ┌─┐ │  │   ∘ cuts only the inner part away.
    /// │  │   │∘│ │  │
    /// │  │   └─┘ │  │
    /// │  └───────┘  │
    /// └─────────────┘
    /// ```
    pub fn fill_at(&self, point: DVec2, adds: bool) -> Option<CutShape> {
        let whole;
        let polygons = match self {
            Self::Domain(domain) => {
                whole = domain.as_region()?;
                whole.polygons()
            }
            Self::Area { area, .. } => area.as_ref()?.polygons(),
            Self::Shapes(shapes) => &shapes.as_ref()?.list().polygons,
        };
        let (ring, is_hole) = innermost_ring(polygons, point)?;
        (is_hole == adds).then(|| CutShape::Ring(ring.clone()))
    }
}

/// Returns the smallest ring around a point, and whether it is a hole.
fn innermost_ring(polygons: &[Polygon], point: DVec2) -> Option<(&Ring, bool)> {
    let rings = polygons.iter().flat_map(|polygon| polygon.iter().enumerate());
    let around = rings.filter(|(_, ring)| is_around(ring, point));
    let area = |ring: &Ring| signed_area(ring).abs();
    let smallest = around.min_by(|(_, a), (_, b)| area(a).total_cmp(&area(b)));
    smallest.map(|(number, ring)| (ring, number > 0))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::domain::{Domain, corners};
    use crate::geometry::Rect;
    use crate::layers::Mask;

    fn square(half: f64) -> Ring {
        corners(&Rect::around(DVec2::ZERO, half))
    }

    /// A frame with a smaller square in its hole, as in the drawing of [`Drawing::fill_at`].
    fn nested() -> Vec<Polygon> {
        vec![vec![square(4.0), square(3.0)], vec![square(1.0)]]
    }

    fn area(shape: &CutShape) -> f64 {
        shape.rings().iter().map(|ring| signed_area(ring).abs()).sum()
    }

    #[test]
    fn a_fill_adds_the_hole_around_the_point_and_cuts_the_part_under_it() {
        let mask = Mask::new(&nested()).unwrap();
        let whole = Some(Rect::around(DVec2::ZERO, 5.0));
        let drawing = Drawing::Area { area: Some(mask), whole };
        let filled = |x: f64, adds| drawing.fill_at(dvec2(x, 0.1), adds).as_ref().map(area);
        for (x, added, cut) in
            [(0.0, None, Some(4.0)), (2.0, Some(36.0), None), (3.5, None, Some(64.0)), (4.5, None, None)]
        {
            assert_eq!((filled(x, true), filled(x, false)), (added, cut), "at {x}");
        }
        let nothing = Drawing::Area { area: None, whole };
        assert_eq!(nothing.fill_at(DVec2::ZERO, true), None);
        let domain = Drawing::Domain(Domain::rectangle(Rect::around(DVec2::ZERO, 5.0)));
        assert_eq!(domain.fill_at(DVec2::ZERO, false).as_ref().map(area), Some(100.0));
    }

    #[test]
    fn a_filled_hole_leaves_neither_a_gap_nor_a_piece() {
        let drawing = Drawing::Area { area: Some(Mask::new(&nested()).unwrap()), whole: None };
        let hole = drawing.fill_at(dvec2(2.0, 0.3), true).unwrap();
        let Ok(Some(Drawing::Area { area: Some(filled), .. })) =
            drawing.edited(&crate::document::DrawnShape::Area(hole), true)
        else {
            panic!("the hole can be filled");
        };
        assert_eq!((filled.polygons().len(), filled.polygons()[0].len(), filled.area()), (1, 1, 64.0));
    }
}
