//! A small picture of a file of data.

use glam::DVec2;

use meshbrush_core::layers::ShapeList;
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;
use meshbrush_render::colormap::Colormap;

/// Pixels along the longer side.
const LONGER_SIDE: f64 = 240.0;
/// Space around shapes, in pixels.
const MARGIN: f64 = 4.0;
/// The opacity of the inside of polygons.
const INSIDE: u8 = 70;

/// A small picture, from its upper left pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// [columns, rows], at least 1 each.
    pub size: [usize; 2],
    /// Red, green, blue and opacity of each pixel.
    pub rgba: Vec<[u8; 4]>,
    /// Whether it is a white drawing, which takes the colour of the theme.
    pub is_drawing: bool,
}

impl Preview {
    /// Returns every so many pixels of a raster, in colours from the least to the greatest finite value.
    /// Pixels without a value are transparent.
    pub fn of_raster(raster: &Raster, values: Option<[f64; 2]>) -> Self {
        let [columns, rows] = raster.size();
        let every = (f64::from(columns.max(rows)) / LONGER_SIDE).max(1.0);
        let size = [columns, rows].map(|side| ((f64::from(side) / every).round() as usize).max(1));
        let [least, greatest] = values.unwrap_or([0.0, 1.0]);
        let color = |value: f32| {
            let value = f64::from(value);
            if !value.is_finite() {
                return [0; 4];
            }
            let share = if greatest > least { (value - least) / (greatest - least) } else { 0.5 };
            let [r, g, b] = Colormap::Viridis.sample(share);
            [r, g, b, 255]
        };
        let source = |place: usize, count: u32| (((place as f64 + 0.5) * every) as u32).min(count - 1);
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let rgba = pixels.map(|(x, y)| {
            // The rows of a raster begin at the bottom.
            color(raster.get(source(x, columns), rows - 1 - source(y, rows)))
        });
        Self { size, rgba: rgba.collect(), is_drawing: false }
    }

    /// Draws shapes over the rectangle around them.
    pub fn of_shapes(shapes: &ShapeList, extent: Rect) -> Self {
        let mut drawing = Drawing::over(extent);
        for polygon in &shapes.polygons {
            drawing.fill(polygon);
        }
        for line in shapes.lines.iter().chain(shapes.polygons.iter().flatten()) {
            line.windows(2).for_each(|ends| drawing.line(ends[0], ends[1]));
        }
        for ring in shapes.polygons.iter().flatten() {
            if let [first, .., last] = ring[..] {
                drawing.line(last, first);
            }
        }
        shapes.points.iter().for_each(|&point| drawing.dot(point));
        let rgba = drawing.ink.iter().map(|&ink| [255, 255, 255, ink]).collect();
        Self { size: drawing.size, rgba, is_drawing: true }
    }
}

/// A drawing in one colour.
struct Drawing {
    size: [usize; 2],
    ink: Vec<u8>,
    extent: Rect,
    px_per_unit: f64,
}

impl Drawing {
    fn over(extent: Rect) -> Self {
        let side = extent.size().max_element();
        let px_per_unit = if side > 0.0 { LONGER_SIDE / side } else { 1.0 };
        let size = [extent.size().x, extent.size().y]
            .map(|side| (side * px_per_unit + 2.0 * MARGIN).round() as usize + 1);
        Self { size, ink: vec![0; size[0] * size[1]], extent, px_per_unit }
    }

    /// Returns the place of a point, in pixels from the upper left corner.
    fn place(&self, point: DVec2) -> DVec2 {
        let from_corner = DVec2::new(point.x - self.extent.min.x, self.extent.max.y - point.y);
        from_corner * self.px_per_unit + DVec2::splat(MARGIN)
    }

    fn mark(&mut self, x: f64, y: f64, ink: u8) {
        let (x, y) = (x.round() as usize, y.round() as usize);
        if x < self.size[0] && y < self.size[1] {
            let pixel = &mut self.ink[y * self.size[0] + x];
            *pixel = (*pixel).max(ink);
        }
    }

    fn line(&mut self, from: DVec2, to: DVec2) {
        let (from, to) = (self.place(from), self.place(to));
        let steps = (to - from).abs().max_element().ceil().clamp(1.0, 4.0 * LONGER_SIDE);
        for step in 0..=steps as u32 {
            let at = from.lerp(to, f64::from(step) / steps);
            self.mark(at.x, at.y, 255);
        }
    }

    fn dot(&mut self, point: DVec2) {
        let at = self.place(point);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            self.mark(at.x + dx, at.y + dy, 255);
        }
    }

    /// Fills what lies within an odd number of rings, row by row.
    fn fill(&mut self, rings: &[Vec<DVec2>]) {
        let mut crossings = vec![Vec::new(); self.size[1]];
        for ring in rings {
            for (number, &from) in ring.iter().enumerate() {
                let (a, b) = (self.place(from), self.place(ring[(number + 1) % ring.len()]));
                let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
                let rows =
                    low.y.ceil().max(0.0) as usize..(high.y.ceil().max(0.0) as usize).min(self.size[1]);
                for row in rows {
                    let share = (row as f64 - low.y) / (high.y - low.y);
                    crossings[row].push(low.x + share * (high.x - low.x));
                }
            }
        }
        for (row, mut places) in crossings.into_iter().enumerate() {
            places.sort_by(f64::total_cmp);
            for pair in places.chunks_exact(2) {
                for x in pair[0].ceil() as usize..=pair[1].floor().max(0.0) as usize {
                    self.mark(x as f64, row as f64, INSIDE);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn ink(preview: &Preview, x: f64, y: f64) -> u8 {
        let [columns, rows] = preview.size.map(|side| side as f64 - 1.0);
        let (x, y) = ((x * columns).round() as usize, (y * rows).round() as usize);
        preview.rgba[y * preview.size[0] + x][3]
    }

    #[test]
    fn a_raster_begins_with_its_highest_row_and_leaves_pixels_without_a_value_out() {
        let raster = Raster::from_values(Rect::UNIT, [2, 2], vec![0.0, 1.0, 2.0, f32::NAN]);
        let preview = Preview::of_raster(&raster, Some([0.0, 2.0]));
        assert_eq!(preview.size, [2, 2]);
        let [r, g, b] = Colormap::Viridis.sample(1.0);
        assert_eq!(preview.rgba[..2], [[r, g, b, 255], [0; 4]]);
    }

    #[test]
    fn a_large_raster_is_thinned() {
        let raster = Raster::from_values(Rect::UNIT, [1000, 500], vec![0.5; 500_000]);
        let preview = Preview::of_raster(&raster, Some([0.5, 0.5]));
        assert_eq!(preview.size, [240, 120]);
    }

    #[test]
    fn polygons_are_filled_but_for_their_holes() {
        let square = |low: f64, high: f64| {
            vec![dvec2(low, low), dvec2(high, low), dvec2(high, high), dvec2(low, high)]
        };
        let polygons = vec![vec![square(0.0, 10.0), square(3.0, 7.0)]];
        let shapes = ShapeList { polygons, ..ShapeList::default() };
        let preview = Preview::of_shapes(&shapes, Rect::new(DVec2::ZERO, DVec2::splat(10.0)));
        assert_eq!((ink(&preview, 0.2, 0.2), ink(&preview, 0.5, 0.5)), (INSIDE, 0));
        assert!(preview.is_drawing && preview.rgba.iter().any(|pixel| pixel[3] == 255));
    }

    #[test]
    fn the_pixels_of_a_slanted_polygon_are_those_whose_centres_it_has() {
        let corners = vec![dvec2(0.0, 0.0), dvec2(10.0, 0.0), dvec2(10.0, 4.0)];
        let shapes = ShapeList { polygons: vec![vec![corners]], ..ShapeList::default() };
        let preview = Preview::of_shapes(&shapes, Rect::new(DVec2::ZERO, DVec2::splat(10.0)));
        for (x, y) in (1..20).flat_map(|x| (1..20).map(move |y| (0.5 * f64::from(x), 0.5 * f64::from(y)))) {
            // Not on the slanted side itself, where its line is.
            let above = y - 0.4 * x;
            if above.abs() > 0.25 {
                let expected = if above < 0.0 { INSIDE } else { 0 };
                assert_eq!(ink(&preview, x / 10.0, 1.0 - y / 10.0), expected, "{x} {y}");
            }
        }
    }

    #[test]
    fn a_single_point_is_a_dot() {
        let shapes = ShapeList { points: vec![dvec2(1e9, -1e9)], ..ShapeList::default() };
        let at = shapes.points[0];
        let preview = Preview::of_shapes(&shapes, Rect::new(at, at));
        assert_eq!(preview.rgba.iter().filter(|pixel| pixel[3] == 255).count(), 5);
    }
}
