//! The plot of the curve from risk to diameter: its axes and the area under the curve.

use std::ops::RangeInclusive;

use egui::{self, Color32, Mesh, Pos2, Rect, Shape, Stroke, Ui, pos2};

use super::{format, paint};
use crate::theme::{font, tokens};

/// A logarithmic axis from 10^low to 10^high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub low: i32,
    pub high: i32,
}

impl Axis {
    /// Returns the fewest whole decades that hold both diameters.
    pub fn around(h_min: f64, h_max: f64) -> Self {
        let low = (h_min.max(1e-300).log10() + 1e-9).floor() as i32;
        let high = (h_max.max(1e-300).log10() - 1e-9).ceil() as i32;
        Self { low, high: high.max(low + 1) }
    }

    /// Returns the number of decades from one number on the axis to the next.
    pub fn label_every(self) -> i32 {
        (self.high - self.low) / 5 + 1
    }

    pub fn decades(self) -> RangeInclusive<i32> {
        self.low..=self.high
    }

    /// Returns the place of a diameter, 0 at the bottom, 1 at the top.
    fn share(self, diameter: f64) -> f64 {
        let share = (diameter.log10() - f64::from(self.low)) / f64::from(self.high - self.low);
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
    }

    fn diameter(self, share: f64) -> f64 {
        10_f64.powf(f64::from(self.low) + share * f64::from(self.high - self.low))
    }
}

/// The rectangle of the curve and its axis.
pub(super) struct Plot {
    pub rect: Rect,
    pub axis: Axis,
}

impl Plot {
    /// Paints a line for each decade, and as many numbers as fit, from `left` to `gap` points before the
    /// curve.
    pub fn paint_decades(&self, ui: &Ui, left: f32, gap: f32, color: Color32) {
        let every = self.axis.label_every();
        for decade in self.axis.decades() {
            let diameter = 10_f64.powi(decade);
            let y = self.point(0.0, diameter).y;
            ui.painter().hline(self.rect.x_range(), y, Stroke::new(1.0, tokens(ui).line));
            if (decade - self.axis.high) % every == 0 {
                let place = Rect::from_x_y_ranges(left..=self.rect.left() - gap, y - 8.0..=y + 8.0);
                let is_short = (-3..=4).contains(&decade);
                let number = if is_short { format::digits(diameter, 1) } else { format!("1e{decade}") };
                paint::at_right(ui, place, paint::line(ui, &number, font::axis(), color));
            }
        }
    }

    pub fn point(&self, risk: f64, diameter: f64) -> Pos2 {
        let x = egui::lerp(self.rect.x_range(), risk as f32);
        pos2(x, egui::lerp(self.rect.bottom()..=self.rect.top(), self.axis.share(diameter) as f32))
    }

    pub fn risk_at(&self, x: f32) -> f64 {
        f64::from(egui::remap_clamp(x, self.rect.x_range(), 0.0..=1.0))
    }

    pub fn diameter_at(&self, y: f32) -> f64 {
        self.axis.diameter(f64::from(egui::remap(y, self.rect.bottom()..=self.rect.top(), 0.0..=1.0)))
    }
}

/// Returns the area between a curve and the line `bottom`, fading downwards.
pub(super) fn area_under(points: &[Pos2], bottom: f32, color: Color32) -> Shape {
    let mut mesh = Mesh::default();
    for (i, point) in points.iter().enumerate() {
        mesh.colored_vertex(*point, color);
        mesh.colored_vertex(pos2(point.x, bottom), Color32::TRANSPARENT);
        if i > 0 {
            let last = 2 * i as u32;
            mesh.add_triangle(last - 2, last - 1, last);
            mesh.add_triangle(last - 1, last, last + 1);
        }
    }
    Shape::mesh(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_has_whole_decades() {
        assert_eq!(Axis::around(0.0024, 0.2), Axis { low: -3, high: 0 });
        assert_eq!(Axis::around(0.1, 0.1), Axis { low: -1, high: 0 });
        assert_eq!(Axis::around(0.01, 1.0), Axis { low: -2, high: 0 });
        assert!((Axis { low: -3, high: 0 }.diameter(0.5) - 10_f64.powf(-1.5)).abs() < 1e-12);
    }

    #[test]
    fn an_axis_has_whole_decades_and_five_numbers_at_most() {
        for (low, high, decades, every) in [
            (0.002, 0.3, (-3, 0), 1),
            (0.01, 0.01, (-2, -1), 1),
            (1e-7, 1e5, (-7, 5), 3),
            (1e-20, 2.0, (-20, 1), 5),
        ] {
            let axis = Axis::around(low, high);
            assert_eq!((axis.low, axis.high), decades, "{low} to {high}");
            assert_eq!(axis.label_every(), every, "{low} to {high}");
            assert!((axis.high - axis.low) / axis.label_every() < 5);
        }
    }
}
