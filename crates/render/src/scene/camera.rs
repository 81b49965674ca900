use glam::{DVec2, IVec2, dvec2};

use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};

/// Smallest share of the canvas that the whole grid covers, at the furthest zoom out.
const SMALLEST_SHARE: f64 = 0.25;
/// Size of a lattice step, the leg of the deepest triangles, at the furthest zoom in, in pixels.
const LARGEST_STEP_PX: f64 = 200.0;

/// The view of a grid on a canvas: the point in the middle, and the scale.
///
/// The middle is stored in lattice coordinates. They need 30 bits before the binary point, which leaves 22
/// bits of an f64 after it: at the deepest zoom a position is exact to 0.0001 px. The middle always lies on
/// the grid, so differences to nodes fit an `i32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    lattice: Lattice,
    center: DVec2,
    px_per_world: f64,
    size_px: [u32; 2],
}

impl Camera {
    /// Returns the camera that shows `bounds`, in world units, as large as possible on a canvas of `size_px`,
    /// with a margin of `margin_px` on every side.
    pub fn fit(lattice: &Lattice, bounds: Rect, size_px: [u32; 2], margin_px: f64) -> Self {
        let size_px = size_px.map(|n| n.max(1));
        let px_per_world = fitting_scale(bounds, size_px, margin_px);
        let center = lattice.lattice_from_world(bounds.center());
        Self { lattice: *lattice, center, px_per_world, size_px }.within_limits()
    }

    /// Returns this view on a canvas of another size, in pixels. The point in the middle stays there.
    pub fn resized(self, size_px: [u32; 2]) -> Self {
        Self { size_px: size_px.map(|n| n.max(1)), ..self }.within_limits()
    }

    /// Returns this view on another grid. World positions stay where they are, as far as the other grid
    /// extends.
    pub fn on_lattice(self, lattice: &Lattice) -> Self {
        if self.lattice == *lattice {
            return self;
        }
        let world = self.world_from_lattice(self.center);
        Self { lattice: *lattice, center: lattice.lattice_from_world(world), ..self }.within_limits()
    }

    /// Moves the picture by `delta_px`, as a drag of the pointer does.
    pub fn panned(self, delta_px: DVec2) -> Self {
        Self { center: self.center - self.steps_from_px(delta_px), ..self }.within_limits()
    }

    /// Scales the picture by `factor` and keeps the point at `at_px` in its place. The scale is limited to
    /// the whole grid on a quarter of the canvas, and to 200 px per lattice step.
    pub fn zoomed(self, factor: f64, at_px: DVec2) -> Self {
        let fixed = self.lattice_from_screen(at_px);
        let scaled = Self { px_per_world: self.px_per_world * factor, ..self }.within_limits();
        let center = fixed - scaled.steps_from_px(at_px - scaled.half_size_px());
        Self { center, ..scaled }.within_limits()
    }

    /// Moves a point of the world to the middle of the canvas.
    pub fn centered_on(self, world: DVec2) -> Self {
        Self { center: self.lattice.lattice_from_world(world), ..self }.within_limits()
    }

    /// Returns the lattice of the grid.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns width and height of the canvas in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Returns pixels per world unit.
    pub fn px_per_world(&self) -> f64 {
        self.px_per_world
    }

    /// Returns pixels per lattice step along x and y. They differ by up to 5 % where cells are not square.
    pub fn px_per_step(&self) -> DVec2 {
        self.px_per_world * self.lattice.step()
    }

    /// Returns the middle of the canvas as a lattice point (rounded down) and the remainder, in lattice steps
    /// from 0 to 1.
    pub fn anchor(&self) -> (IVec2, DVec2) {
        let whole = self.center.floor();
        (whole.as_ivec2(), self.center - whole)
    }

    /// Returns position of a node on the screen, in pixels.
    #[inline]
    pub fn screen_from_lattice(&self, p: LatticePoint) -> DVec2 {
        self.screen(p.as_dvec2() - self.center)
    }

    /// Returns a function that does the work of [`Self::screen_from_lattice`] for many nodes: faster, with
    /// results equal to the last bit.
    pub fn lattice_map(&self) -> impl Fn(LatticePoint) -> DVec2 + use<> {
        let (center, scale, middle) = (self.center, self.px_per_step(), self.half_size_px());
        move |p| {
            let px = (p.as_dvec2() - center) * scale;
            middle + dvec2(px.x, -px.y)
        }
    }

    /// Returns position of a point of the world on the screen, in pixels.
    pub fn screen_from_world(&self, p: DVec2) -> DVec2 {
        self.screen(self.lattice.lattice_from_world(p) - self.center)
    }

    /// Returns a function that does the work of [`Self::screen_from_world`] for many points: faster, and
    /// exact up to the rounding of world coordinates.
    pub fn screen_map(&self) -> impl Fn(DVec2) -> DVec2 + use<> {
        let (world, middle) = (self.world_from_lattice(self.center), self.half_size_px());
        let scale = dvec2(self.px_per_world, -self.px_per_world);
        move |p| middle + (p - world) * scale
    }

    /// Returns lattice coordinates of a pixel position, as real numbers; the point may be outside the grid.
    pub fn lattice_from_screen(&self, px: DVec2) -> DVec2 {
        self.center + self.steps_from_px(px - self.half_size_px())
    }

    /// Returns world coordinates of a pixel position.
    pub fn world_from_screen(&self, px: DVec2) -> DVec2 {
        self.world_from_lattice(self.lattice_from_screen(px))
    }

    /// Returns the rectangle of the world that the canvas shows.
    pub fn visible_world(&self) -> Rect {
        let [width, height] = self.size_px.map(f64::from);
        Rect::spanning(self.world_from_screen(DVec2::ZERO), self.world_from_screen(dvec2(width, height)))
    }

    /// Returns the part of the lattice that the canvas shows, and `margin_px` more on every side.
    pub fn visible_lattice(&self, margin_px: f64) -> LatticeRect {
        let [width, height] = self.size_px.map(f64::from);
        let extent = self.lattice.extent();
        let lower_left = self.lattice_from_screen(dvec2(-margin_px, height + margin_px)).floor();
        let upper_right = self.lattice_from_screen(dvec2(width + margin_px, -margin_px)).ceil();
        let clamped = |p: DVec2| p.clamp(DVec2::ZERO, extent.as_dvec2()).as_uvec2();
        let [min, max] = [clamped(lower_left), clamped(upper_right)].map(|p| LatticePoint::new(p.x, p.y));
        LatticeRect { min, max }
    }

    /// Returns half the size of the canvas: the position of its middle, in pixels.
    pub fn half_size_px(&self) -> DVec2 {
        let [width, height] = self.size_px.map(f64::from);
        dvec2(width, height) / 2.0
    }

    fn screen(&self, steps_from_center: DVec2) -> DVec2 {
        let px = steps_from_center * self.px_per_step();
        self.half_size_px() + dvec2(px.x, -px.y)
    }

    fn steps_from_px(&self, px: DVec2) -> DVec2 {
        dvec2(px.x, -px.y) / self.px_per_step()
    }

    fn world_from_lattice(&self, p: DVec2) -> DVec2 {
        self.lattice.bounds().min + p * self.lattice.step()
    }

    fn within_limits(mut self) -> Self {
        let whole = fitting_scale(self.lattice.bounds(), self.size_px, 0.0);
        let smallest = whole * SMALLEST_SHARE;
        // On a grid that is far from the origin and allows few halvings, a step can be larger than this at
        // the scale that shows the whole grid.
        let largest = (LARGEST_STEP_PX / self.lattice.step().max_element()).max(whole);
        let scale = if self.px_per_world.is_finite() { self.px_per_world } else { whole };
        self.px_per_world = scale.clamp(smallest, largest);
        let middle = self.lattice.extent().as_dvec2() / 2.0;
        let center = if self.center.is_finite() { self.center } else { middle };
        self.center = center.clamp(DVec2::ZERO, self.lattice.extent().as_dvec2());
        self
    }
}

fn fitting_scale(bounds: Rect, size_px: [u32; 2], margin_px: f64) -> f64 {
    let [width, height] = size_px.map(|n| (f64::from(n) - 2.0 * margin_px).max(1.0));
    let size = bounds.size();
    (width / size.x).min(height / size.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(bounds: Rect, spacing: f64) -> Camera {
        let lattice = Lattice::covering(bounds, spacing, 100_000).unwrap();
        Camera::fit(&lattice, bounds, [800, 600], 20.0)
    }

    #[test]
    fn a_fitted_rectangle_is_centred_within_the_margin() {
        let lattice = Lattice::covering(Rect::UNIT, 0.1, 1000).unwrap();
        let camera = Camera::fit(&lattice, Rect::UNIT, [120, 220], 10.0);
        assert_eq!(camera.screen_from_world(dvec2(0.0, 1.0)), dvec2(10.0, 60.0));
    }

    #[test]
    fn y_points_up_in_the_world_and_down_on_the_screen() {
        let camera = camera(Rect::UNIT, 0.1);
        let low = camera.screen_from_world(dvec2(0.5, 0.0));
        let high = camera.screen_from_world(dvec2(0.5, 1.0));
        assert!((low.y - 580.0).abs() < 1e-9 && (high.y - 20.0).abs() < 1e-9);
        assert!((low.x - 400.0).abs() < 1e-9);
    }

    #[test]
    fn screen_and_world_are_inverse_at_every_zoom() {
        let mut camera = camera(Rect::new(dvec2(-3.0, 7.0), dvec2(10.1, 12.3)), 0.7);
        for _ in 0..60 {
            for px in [dvec2(0.0, 0.0), dvec2(400.5, 299.25), dvec2(800.0, 600.0)] {
                let back = camera.screen_from_world(camera.world_from_screen(px));
                assert!(back.distance(px) < 1e-3, "{px} became {back} at {} px", camera.px_per_step());
            }
            camera = camera.zoomed(1.7, dvec2(333.0, 222.0));
        }
    }

    #[test]
    fn zooming_keeps_the_point_below_the_pointer() {
        let mut camera = camera(Rect::UNIT, 0.05);
        let pointer = dvec2(301.0, 207.0);
        let below = camera.lattice_from_screen(pointer);
        for _ in 0..40 {
            camera = camera.zoomed(2.0, pointer);
            let off = (camera.lattice_from_screen(pointer) - below) * camera.px_per_step();
            assert!(off.length() < 0.01, "{off}");
        }
    }

    #[test]
    fn zoom_ends_at_a_quarter_of_the_canvas_and_at_two_hundred_pixels_a_step() {
        let mut camera = camera(Rect::UNIT, 0.05);
        camera = camera.zoomed(1e300, dvec2(0.0, 0.0));
        assert!((camera.px_per_step().max_element() - 200.0).abs() < 1e-9);
        camera = camera.zoomed(0.0, dvec2(0.0, 0.0));
        assert_eq!(camera.px_per_world(), 150.0);
        camera = camera.zoomed(f64::NAN, dvec2(f64::NAN, 0.0));
        assert!(camera.px_per_world().is_finite() && camera.center.is_finite());
    }

    #[test]
    fn a_drag_of_one_pixel_moves_one_pixel_at_the_deepest_zoom() {
        let mut camera = camera(Rect::UNIT, 0.05).zoomed(1e300, dvec2(123.0, 456.0));
        let node = LatticePoint::new(camera.anchor().0.x as u32, camera.anchor().0.y as u32);
        let before = camera.screen_from_lattice(node);
        for _ in 0..1000 {
            camera = camera.panned(dvec2(1.0, -1.0));
        }
        let moved = camera.screen_from_lattice(node) - before;
        assert!(moved.distance(dvec2(1000.0, -1000.0)) < 0.05, "{moved}");
    }

    #[test]
    fn the_map_for_many_points_agrees_with_single_points() {
        let camera =
            camera(Rect::new(dvec2(3.0, -2.0), dvec2(7.0, 1.1)), 0.31).zoomed(900.0, dvec2(310.0, 120.0));
        let quick = camera.screen_map();
        for p in [dvec2(3.0, -2.0), dvec2(5.1, 0.3), camera.world_from_screen(dvec2(3.0, 5.0))] {
            assert!(quick(p).distance(camera.screen_from_world(p)) < 1e-6, "{p}");
        }
    }

    #[test]
    fn the_view_stays_when_the_grid_changes() {
        let camera = camera(Rect::UNIT, 0.05).zoomed(8.0, dvec2(100.0, 100.0));
        let finer = Lattice::covering(Rect::UNIT, 0.013, 100_000).unwrap();
        let px = dvec2(700.0, 40.0);
        let off = camera.on_lattice(&finer).world_from_screen(px) - camera.world_from_screen(px);
        assert!(off.length() < 1e-9, "{off}");
    }
}
