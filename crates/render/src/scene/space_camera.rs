use glam::{DMat3, DVec2, DVec3, IVec3, dvec2, dvec3};

use super::{Camera, HeightScale};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::text::LengthUnit;

/// Lowest altitude of the view, in degrees. From the horizon nothing could be seen but an edge.
const LOWEST_ALTITUDE: f64 = 5.0;
/// Largest length of the longer side of the grid in pixels: at four million a position in f32 is exact to a
/// quarter of a pixel.
const LARGEST_SIDE_PX: f64 = (1u32 << 21) as f64;
/// Share of the longer side of the domain that its relief has in a picture, where nothing else is asked for.
const RELIEF_SHARE: f64 = 0.125;
/// Metres of a degree of latitude.
const METRES_PER_DEGREE: f64 = 111_195.0;
/// The range of factors by which heights can be exaggerated.
const EXAGGERATIONS: [f64; 2] = [1e-9, 1e9];

/// The direction of a view, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDirection {
    /// Where one looks, clockwise from the y axis: at 0, the y axis points away from the viewer.
    pub azimuth: f64,
    /// How high the viewer is above the horizon: 90 is the view of the plan.
    pub altitude: f64,
}

impl Default for ViewDirection {
    fn default() -> Self {
        Self { azimuth: 20.0, altitude: 40.0 }
    }
}

/// The light of a view in space: parallel rays, and the same light from everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where the light comes from, in degrees clockwise from the y axis.
    pub azimuth: f64,
    /// How high it stands above the horizon, in degrees.
    pub altitude: f64,
}

impl Default for Light {
    /// From the upper left, as on maps.
    fn default() -> Self {
        Self { azimuth: 315.0, altitude: 45.0 }
    }
}

impl Light {
    /// Share of the brightness of level ground that comes from everywhere.
    pub const AMBIENT: f32 = 0.5;
    /// Least altitude, in degrees: level ground keeps the colour of its level at any.
    const LOWEST: f64 = 5.0;

    /// Returns the direction to the light, of length 1.
    pub fn direction(&self) -> DVec3 {
        let altitude = self.altitude.clamp(Self::LOWEST, 90.0).to_radians();
        let horizontal = bearing(self.azimuth) * libm::cos(altitude);
        dvec3(horizontal.x, horizontal.y, libm::sin(altitude))
    }

    /// Returns how bright the light is, so that level ground has the brightness 1.
    pub fn strength(&self) -> f32 {
        (1.0 - Self::AMBIENT) / self.direction().z as f32
    }
}

/// Returns the direction of a bearing in degrees, clockwise from the y axis.
fn bearing(degrees: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    dvec2(sin, cos)
}

/// A view of a surface from one direction, from far away: a parallel projection, in which lengths have the
/// same scale everywhere and nothing can be behind the viewer.
///
/// The point in the middle is that of a [`Camera`], with a height. Nodes are given by three whole numbers,
/// and the middle is subtracted from them in integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceCamera {
    plan: Camera,
    /// The height in the middle, in steps.
    height: f64,
    scale: HeightScale,
    /// The lowest and the highest height of the surface, in steps.
    ends: [f64; 2],
    direction: ViewDirection,
    exaggeration: f64,
}

/// The points of the world behind a pixel: a place in the plane for each height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay {
    /// The place at the height 0, in lattice steps.
    pub at: DVec2,
    /// By how many lattice steps the place moves with each step of height.
    pub per_step: DVec2,
}

impl SpaceCamera {
    /// Returns the length of a metre in a unit: factors for heights in metres are then true at 1. Without a
    /// unit, heights have that of the plane.
    pub fn metre_in(unit: LengthUnit) -> f64 {
        match unit {
            LengthUnit::None | LengthUnit::Metre => 1.0,
            LengthUnit::Kilometre => 1e-3,
            LengthUnit::Degree => 1.0 / METRES_PER_DEGREE,
        }
    }

    /// Returns the factor that gives relief an eighth of the longer side of a domain.
    pub fn visible_exaggeration(bounds: Rect, relief: f64) -> f64 {
        let factor = RELIEF_SHARE * bounds.size().max_element() / relief;
        if factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
    }

    /// Returns the view whose middle is that of `plan`, at a height in steps, with its scale. `ends` are the
    /// lowest and the highest height of the surface, in steps.
    pub fn new(
        plan: Camera,
        height: f64,
        (scale, ends): (HeightScale, [u32; 2]),
        direction: ViewDirection,
        exaggeration: f64,
    ) -> Self {
        let exaggeration = exaggeration.clamp(EXAGGERATIONS[0], EXAGGERATIONS[1]);
        Self { plan, height, scale, ends: ends.map(f64::from), direction, exaggeration }.within_limits()
    }

    /// Returns the view of everything above the grid of a lattice, as large as possible with a margin on
    /// every side. `ends` are the lowest and the highest height, in steps.
    pub fn fit(
        lattice: &Lattice,
        surface: (HeightScale, [u32; 2]),
        direction: ViewDirection,
        exaggeration: f64,
        size_px: [u32; 2],
        margin_px: f64,
    ) -> Self {
        let plan = Camera::fit(lattice, lattice.bounds(), size_px, margin_px);
        let [low, high] = surface.1.map(f64::from);
        let camera = Self::new(plan, (low + high) / 2.0, surface, direction, exaggeration);
        let half = camera.box_px() / 2.0;
        let room = (camera.plan.half_size_px() - margin_px).max(DVec2::ONE);
        let factor = (room / half).min_element();
        Self { plan: camera.plan.zoomed(factor, camera.plan.half_size_px()), ..camera }.within_limits()
    }

    /// Returns width and height of the box around the surface in the picture, in pixels.
    pub fn box_px(&self) -> DVec2 {
        let size = self.plan.lattice().extent().as_dvec2().extend(self.ends[1] - self.ends[0]);
        let [right, up, _] = self.rows();
        dvec2((right.abs()).dot(size), (up.abs()).dot(size)).max(DVec2::splat(1e-9))
    }

    /// Returns the camera of the plan with the same middle and scale.
    pub fn plan(&self) -> &Camera {
        &self.plan
    }

    /// Returns the height in the middle, in steps.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// Returns the meaning of heights in steps.
    pub fn scale(&self) -> HeightScale {
        self.scale
    }

    /// Returns the direction of the view.
    pub fn direction(&self) -> ViewDirection {
        self.direction
    }

    /// Returns the factor by which heights are exaggerated.
    pub fn exaggeration(&self) -> f64 {
        self.exaggeration
    }

    /// Returns width and height of the canvas in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.plan.size_px()
    }

    /// Returns this view on a canvas of another size, in pixels.
    pub fn resized(self, size_px: [u32; 2]) -> Self {
        Self { plan: self.plan.resized(size_px), ..self }.within_limits()
    }

    /// Turns the view around the point in the middle, by angles in degrees.
    pub fn turned(self, azimuth: f64, altitude: f64) -> Self {
        let ViewDirection { azimuth: from, altitude: high } = self.direction;
        self.seen_from(ViewDirection { azimuth: from + azimuth, altitude: high + altitude })
    }

    /// Returns the view of the same middle in another direction.
    pub fn seen_from(self, direction: ViewDirection) -> Self {
        Self { direction, ..self }.within_limits()
    }

    /// Moves the middle along the line of sight to another height, in steps, or as far towards it as it stays
    /// above the grid. The picture stays the same, and turns and zooms are then about what is at that height.
    pub fn about(self, height: f64) -> Self {
        let height = height.clamp(self.ends[0], self.ends[1]);
        let ViewRay { at, per_step } = self.ray(self.plan.half_size_px());
        let [from, to] = [self.height, height].map(|height| at + per_step * height);
        let extent = self.plan.lattice().extent().as_dvec2();
        let share = |from: f64, to: f64, end: f64| {
            let limit = if to < 0.0 { from / (from - to) } else { (end - from) / (to - from) };
            if (0.0..=end).contains(&to) { 1.0 } else { limit.clamp(0.0, 1.0) }
        };
        let share = share(from.x, to.x, extent.x).min(share(from.y, to.y, extent.y));
        let plan = self.at_lattice(from + share * (to - from));
        Self { plan, height: self.height + share * (height - self.height), ..self }
    }

    /// Puts a point of the surface in the middle: a place in world units, and a height in steps.
    pub fn centered_on(self, world: DVec2, height: f64) -> Self {
        Self { plan: self.plan.centered_on(world), height, ..self }.within_limits()
    }

    /// Moves the picture by `delta_px`, as a drag of the pointer does.
    pub fn panned(self, delta_px: DVec2) -> Self {
        let to = self.ray(self.plan.half_size_px() - delta_px);
        Self { plan: self.at_lattice(to.at + to.per_step * self.height), ..self }
    }

    /// Scales the picture by `factor` and keeps what is at `at_px` in its place.
    pub fn zoomed(self, factor: f64, at_px: DVec2) -> Self {
        let half = self.plan.half_size_px();
        let scaled = Self { plan: self.plan.zoomed(factor, half), ..self }.within_limits();
        let done = scaled.plan.px_per_world() / self.plan.px_per_world();
        scaled.panned((at_px - half) * (1.0 - done))
    }

    fn at_lattice(&self, place: DVec2) -> Camera {
        let lattice = self.plan.lattice();
        self.plan.centered_on(lattice.bounds().min + place * lattice.step())
    }

    /// Returns the pixels by which a lattice step along each axis, and a step of height, moves a point: to
    /// the right, upwards, and towards the viewer.
    pub fn rows(&self) -> [DVec3; 3] {
        let (sin, cos) = libm::sincos(self.direction.altitude.to_radians());
        let away = bearing(self.direction.azimuth);
        let step = self.plan.px_per_step();
        let rise = self.plan.px_per_world() * self.exaggeration * self.scale.step();
        let right = dvec2(away.y, -away.x) * step;
        let away = away * step;
        [
            dvec3(right.x, right.y, 0.0),
            dvec3(sin * away.x, sin * away.y, cos * rise),
            dvec3(-cos * away.x, -cos * away.y, sin * rise),
        ]
    }

    /// Returns the lengths of a lattice step along each axis and of a step of height, in one unit: that of
    /// the longest.
    pub fn shape(&self) -> DVec3 {
        let step = self.plan.lattice().step();
        let shape = dvec3(step.x, step.y, self.exaggeration * self.scale.step());
        shape / shape.max_element()
    }

    /// Returns the direction to the viewer, of length 1.
    pub fn to_viewer(&self) -> DVec3 {
        let (sin, cos) = libm::sincos(self.direction.altitude.to_radians());
        let away = bearing(self.direction.azimuth);
        dvec3(-cos * away.x, -cos * away.y, sin)
    }

    /// Returns the point in the middle as whole steps and the remainder, from 0 to 1.
    pub fn anchor(&self) -> (IVec3, DVec3) {
        let (plane, fraction) = self.plan.anchor();
        let whole = self.height.floor();
        (plane.extend(whole as i32), fraction.extend(self.height - whole))
    }

    /// Returns a function that maps nodes, with their heights in steps, to pixels: to the right of the upper
    /// left corner, below it, and from the middle towards the viewer.
    pub fn screen_map(&self) -> impl Fn(DVec2, f64) -> DVec3 + use<> {
        let (anchor, fraction) = self.anchor();
        let middle = anchor.as_dvec3() + fraction;
        let [right, up, near] = self.rows();
        let half = self.plan.half_size_px();
        move |place: DVec2, height: f64| {
            let steps = place.extend(height) - middle;
            dvec3(half.x + right.dot(steps), half.y - up.dot(steps), near.dot(steps))
        }
    }

    /// Returns the position of a node on the screen, as [`Self::screen_map`] does.
    pub fn screen_from_lattice(&self, p: LatticePoint, steps: u32) -> DVec3 {
        self.screen_map()(p.as_dvec2(), f64::from(steps))
    }

    /// Returns the position of a point of the world with a height, in steps.
    pub fn screen_from_world(&self, world: DVec2, height: f64) -> DVec2 {
        self.screen_map()(self.plan.lattice().lattice_from_world(world), height).truncate()
    }

    /// Returns the points behind a pixel.
    pub fn ray(&self, px: DVec2) -> ViewRay {
        let [right, up, near] = self.rows();
        let inverse = DMat3::from_cols(right, up, near).transpose().inverse();
        let half = self.plan.half_size_px();
        let (anchor, fraction) = self.anchor();
        let from = anchor.as_dvec3() + fraction + inverse * dvec3(px.x - half.x, half.y - px.y, 0.0);
        // Towards the viewer, by one step of height.
        let sight = inverse * DVec3::Z;
        let per_step = sight.truncate() / sight.z;
        ViewRay { at: from.truncate() - per_step * from.z, per_step }
    }

    /// Returns the place in the plane at the height of the middle that a pixel shows, in world units.
    pub fn world_from_screen(&self, px: DVec2) -> DVec2 {
        let ray = self.ray(px);
        let lattice = self.plan.lattice();
        lattice.bounds().min + (ray.at + ray.per_step * self.height) * lattice.step()
    }

    /// Returns the nearest and the farthest position of a point of the surface on the canvas, in pixels from
    /// the middle towards the viewer.
    pub fn depth_range(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.direction.altitude.to_radians());
        let rise = self.plan.px_per_world() * self.exaggeration * self.scale.step();
        let half = self.plan.half_size_px().y + 1.0;
        let [low, high] = self.ends.map(|end| rise * (end - self.height));
        [(high + cos * half) / sin, (low - cos * half) / sin]
    }

    /// Returns a direction in the plane as it is in the picture, y upwards.
    pub fn turned_direction(&self, direction: DVec2) -> DVec2 {
        let sin = libm::sin(self.direction.altitude.to_radians());
        let away = bearing(self.direction.azimuth);
        dvec2(dvec2(away.y, -away.x).dot(direction), sin * away.dot(direction))
    }

    fn within_limits(mut self) -> Self {
        let ViewDirection { azimuth, altitude } = self.direction;
        self.direction.azimuth = if azimuth.is_finite() { azimuth.rem_euclid(360.0) } else { 0.0 };
        self.direction.altitude =
            if altitude.is_nan() { 90.0 } else { altitude.clamp(LOWEST_ALTITUDE, 90.0) };
        let height = if self.height.is_finite() { self.height } else { self.ends[0] };
        self.height = height.clamp(self.ends[0], self.ends[1].max(self.ends[0]));
        let side = self.plan.lattice().bounds().size().max_element() * self.plan.px_per_world();
        if side > LARGEST_SIDE_PX {
            self.plan = self.plan.zoomed(LARGEST_SIDE_PX / side, self.plan.half_size_px());
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(direction: ViewDirection) -> SpaceCamera {
        let bounds = Rect::new(dvec2(-3.0, 7.0), dvec2(10.1, 12.3));
        let lattice = Lattice::covering(bounds, 0.7, 100_000).unwrap();
        let scale = HeightScale::between(-50.0, 300.0);
        SpaceCamera::fit(&lattice, (scale, [0, 1 << 30]), direction, 0.004, [800, 600], 20.0)
    }

    fn directions() -> impl Iterator<Item = ViewDirection> {
        let azimuths = [0.0, 33.0, 90.0, 200.0, 359.0];
        azimuths
            .into_iter()
            .flat_map(|azimuth| [5.0, 30.0, 60.0, 90.0].map(|altitude| ViewDirection { azimuth, altitude }))
    }

    #[test]
    fn from_above_the_view_is_the_plan() {
        let above = camera(ViewDirection { azimuth: 0.0, altitude: 90.0 });
        for place in [dvec2(-3.0, 7.0), dvec2(2.2, 11.0), dvec2(10.1, 12.3)] {
            let px = above.screen_from_world(place, 12_345.0);
            assert!(px.distance(above.plan().screen_from_world(place)) < 1e-6, "{place}");
        }
    }

    #[test]
    fn the_whole_box_is_in_the_picture_and_touches_its_margin() {
        for direction in directions() {
            let camera = camera(direction);
            let bounds = camera.plan().lattice().bounds();
            let corners = [
                bounds.min,
                bounds.max,
                dvec2(bounds.min.x, bounds.max.y),
                dvec2(bounds.max.x, bounds.min.y),
            ];
            let at = corners.into_iter().flat_map(|corner| {
                [0.0, f64::from(1 << 30)].map(|height| camera.screen_from_world(corner, height))
            });
            let (low, high) = at
                .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), px| (low.min(px), high.max(px)));
            assert!(
                low.min_element() > 19.9 && high.x < 780.1 && high.y < 580.1,
                "{direction:?}: {low} {high}"
            );
            assert!(low.min_element() < 20.1, "{direction:?}: {low}");
        }
    }

    #[test]
    fn rays_go_through_what_is_in_their_pixel() {
        for direction in directions() {
            let camera = camera(direction).zoomed(7.0, dvec2(300.0, 200.0));
            for px in [dvec2(0.0, 0.0), dvec2(399.0, 17.5), dvec2(800.0, 600.0)] {
                let ray = camera.ray(px);
                for height in [0.0, 1e8, 9e8] {
                    let back = camera.screen_map()(ray.at + ray.per_step * height, height);
                    assert!(back.truncate().distance(px) < 1e-5, "{direction:?}: {px} became {back}");
                }
                let middle = camera.world_from_screen(px);
                assert!(camera.screen_from_world(middle, camera.height).distance(px) < 1e-5);
            }
        }
    }

    #[test]
    fn zooming_and_panning_keep_points_under_the_pointer() {
        for direction in directions() {
            let pointer = dvec2(301.0, 207.0);
            let mut camera = camera(direction).about(3e8);
            let under = camera.world_from_screen(pointer);
            if !camera.plan().lattice().bounds().contains(under) {
                // The middle stays above the grid.
                continue;
            }
            for _ in 0..6 {
                camera = camera.zoomed(2.0, pointer);
                let now = camera.screen_from_world(under, camera.height);
                assert!(now.distance(pointer) < 1e-3, "{direction:?}: {now}");
            }
            let moved = camera.panned(dvec2(10.0, -4.0));
            let now = moved.screen_from_world(under, camera.height);
            assert!(now.distance(pointer + dvec2(10.0, -4.0)) < 1e-3, "{direction:?}: {now}");
        }
    }

    #[test]
    fn another_height_in_the_middle_leaves_the_picture() {
        for direction in directions() {
            let camera = camera(direction).zoomed(3.0, dvec2(420.0, 280.0));
            let other = camera.about(2e8);
            for (world, height) in [(dvec2(1.0, 8.0), 5e8), (dvec2(4.0, 9.5), 0.0)] {
                let px = camera.screen_from_world(world, height);
                assert!(other.screen_from_world(world, height).distance(px) < 1e-4, "{direction:?}");
            }
        }
    }

    #[test]
    fn every_visible_point_is_within_the_range_of_depths() {
        for direction in directions() {
            let camera = camera(direction).zoomed(4.0, dvec2(500.0, 100.0));
            let [near, far] = camera.depth_range();
            for px in [DVec2::ZERO, dvec2(800.0, 0.0), dvec2(0.0, 600.0), dvec2(800.0, 600.0)] {
                let ray = camera.ray(px);
                for height in camera.ends {
                    let depth = camera.screen_map()(ray.at + ray.per_step * height, height).z;
                    assert!((far..=near).contains(&depth), "{direction:?}: {depth} not in {far} to {near}");
                }
            }
        }
    }

    #[test]
    fn impossible_numbers_give_a_possible_view() {
        let turned = camera(ViewDirection::default()).turned(f64::NAN, f64::NAN);
        assert_eq!(turned.direction(), ViewDirection { azimuth: 0.0, altitude: 90.0 });
        let turned = camera(ViewDirection::default()).turned(-740.0, -400.0);
        assert_eq!(turned.direction(), ViewDirection { azimuth: 0.0, altitude: 5.0 });
        let zoomed = turned.zoomed(1e300, DVec2::ZERO);
        let side = 13.1 * zoomed.plan().px_per_world();
        assert!((side / LARGEST_SIDE_PX - 1.0).abs() < 1e-6, "{side}");
    }

    #[test]
    fn level_ground_has_the_colour_of_its_level_under_any_light() {
        for altitude in [-20.0, 5.0, 45.0, 90.0, 130.0] {
            let light = Light { azimuth: 123.0, altitude };
            let brightness = Light::AMBIENT + light.strength() * light.direction().z as f32;
            assert!((brightness - 1.0).abs() < 1e-6);
            assert!((light.direction().length() - 1.0).abs() < 1e-12);
        }
    }
}
