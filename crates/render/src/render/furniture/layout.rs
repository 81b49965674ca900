//! Where map and furniture go: around the map or below it, in a size of text that leaves room for the map.

use glam::DVec2;

use super::axes::MapTick;
use super::blocks::GAP;
use super::choice::Furniture;
use super::content::SheetContent;
use super::drawing::Drawing;
use super::glyphs;
use super::scale_bar::ScaleBar;
use super::sheet::Sheet;
use super::space_axes::SpaceFrame;
use crate::scene::Camera;

/// Space around everything, in heights of the text.
const PAD: f64 = 1.0;
/// Least space between labels and what stands beside the map, in heights of the text.
const LEAST_GAP: f64 = 0.5;
/// Longest scale bar, in heights of the text.
const LONGEST_BAR: f64 = 9.0;
/// Smallest text, in pixels.
const SMALLEST_TEXT: f64 = 7.0;
/// Share of its area without furniture that the map keeps, or else the text gets smaller.
const ENOUGH: f64 = 0.36;
/// Share that it must keep, and its shortest side in pixels.
const LEAST: (f64, u32) = (0.08, 24);

/// How often the size of the map is found from the room of its labels, and how often at most until it fits.
const ROUNDS: u32 = 4;
const MOST_ROUNDS: u32 = 12;

/// The size of a picture.
pub struct SheetRequest<'a> {
    /// Its width in pixels.
    pub width: u32,
    /// Its height in pixels; `None` where it follows from the map.
    pub height: Option<u32>,
    /// The largest height where it follows from the map, in pixels.
    pub most_height: u32,
    /// Height of the map as a share of its width.
    pub proportion: f64,
    /// Height of the text in pixels: less where there is little room.
    pub text_px: f64,
    /// The camera of a map of a width and a height in pixels.
    pub camera: &'a dyn Fn([u32; 2]) -> Camera,
}

/// The error for a picture that is too small for its furniture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture {width} pixels wide{} has no room for {furniture} beside the map; make it larger, or leave some of them out",
    .height.map_or(String::new(), |height| format!(" and {height} high"))
)]
pub struct NoRoom {
    width: u32,
    height: Option<u32>,
    furniture: Furniture,
}

/// Where legend, scale bar and arrow are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// To the right of the map.
    Right,
    /// Below the map.
    Below,
}

/// Sizes of what is around the map, in pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Margins {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
    /// Width of what stands beside the map, or height of what stands below it, without the gap.
    pub(super) block: f64,
}

/// Places for everything.
#[derive(Clone, Debug)]
pub(super) struct SheetPlaces {
    pub(super) side: Side,
    pub(super) text_px: f64,
    pub(super) size: [u32; 2],
    pub(super) map_at: [u32; 2],
    pub(super) map_size: [u32; 2],
    pub(super) around: Surroundings,
}

/// What depends on the size of the map.
#[derive(Clone, Debug)]
pub(super) struct Surroundings {
    pub(super) ticks: [Vec<MapTick>; 2],
    pub(super) space: Option<SpaceFrame>,
    pub(super) margins: Margins,
    pub(super) bar: Option<ScaleBar>,
    /// Rows of the legend below each other.
    pub(super) legend_rows: usize,
}

impl Sheet {
    /// Returns the places of a map and of what stands around it.
    ///
    /// # Errors
    /// Fails when the map would be too small.
    pub fn lay_out(request: &SheetRequest<'_>, content: &SheetContent) -> Result<Self, NoRoom> {
        let no_room = NoRoom { width: request.width, height: request.height, furniture: content.furniture() };
        let bare = request.bare_area();
        let mut text_px = request.text_px.max(SMALLEST_TEXT);
        loop {
            let found = [Side::Right, Side::Below]
                .into_iter()
                .filter_map(|side| SheetPlaces::new(request, content, side, text_px))
                .reduce(|a, b| if b.share_of_map() > a.share_of_map() { b } else { a });
            let kept = found.as_ref().map_or(0.0, |found| found.map_area() / bare);
            match found {
                Some(found) if kept >= ENOUGH => return Ok(Drawing::of(&found, content).into_sheet()),
                Some(found) if text_px == SMALLEST_TEXT => {
                    let is_large = kept >= LEAST.0 && found.map_size.iter().all(|&side| side >= LEAST.1);
                    return is_large.then(|| Drawing::of(&found, content).into_sheet()).ok_or(no_room);
                }
                None if text_px == SMALLEST_TEXT => return Err(no_room),
                _ => text_px = (0.92 * text_px).max(SMALLEST_TEXT),
            }
        }
    }
}

impl SheetRequest<'_> {
    /// Returns the size of the largest map in a room, in pixels.
    fn map_in(&self, width: f64, height: f64) -> Option<[u32; 2]> {
        let width = width.min(height / self.proportion).floor();
        let size = [width, (width * self.proportion).round().max(1.0)];
        (width >= 1.0).then(|| size.map(|side| side as u32))
    }

    /// Returns the area of the map without furniture.
    fn bare_area(&self) -> f64 {
        let height = self.height.unwrap_or(self.most_height);
        self.map_in(self.width.into(), height.into()).map_or(1.0, area)
    }
}

impl SheetContent {
    fn furniture(&self) -> Furniture {
        Furniture {
            legend: self.legend.is_some(),
            axes: self.axes.is_some() || self.space_axes.is_some(),
            scale: self.bar.is_some(),
            north: self.north.is_some(),
        }
    }

    /// Returns the bar on a map.
    fn bar_on(&self, camera: &Camera, text_px: f64) -> Option<ScaleBar> {
        let bar = self.bar?;
        ScaleBar::new(camera.px_per_world() * bar.world_per_length, LONGEST_BAR * text_px, bar.unit)
    }
}

fn area([width, height]: [u32; 2]) -> f64 {
    f64::from(width) * f64::from(height)
}

impl SheetPlaces {
    /// Returns the arrangement with a map as large as possible; `None` where there is no room for one.
    fn new(request: &SheetRequest<'_>, content: &SheetContent, side: Side, text_px: f64) -> Option<Self> {
        let pad = PAD * text_px;
        let total = [f64::from(request.width), f64::from(request.height.unwrap_or(request.most_height))];
        let mut map_size = request.map_in(0.7 * total[0], 0.7 * total[1])?;
        // Labels and the bar depend on the size of the map, which depends on their room.
        for round in 0..MOST_ROUNDS {
            let around = Surroundings::new(request, content, side, text_px, map_size)?;
            let [beside, below] = around.margins.sums(side, text_px);
            let fitting = request.map_in(total[0] - 2.0 * pad - beside, total[1] - 2.0 * pad - below)?;
            // In space, labels come and go with the size: from some round on the map only becomes smaller.
            if round >= ROUNDS && fitting[0] >= map_size[0] {
                break;
            }
            map_size = fitting;
        }
        let around = Surroundings::new(request, content, side, text_px, map_size)?;
        let margins = around.margins;
        let [beside, below] = margins.sums(side, text_px);
        let [map_width, map_height] = map_size.map(f64::from);
        let stands = if side == Side::Right { content.stack_height(text_px) } else { 0.0 };
        let needed = [map_width + beside, (map_height + below).max(margins.top + stands)];
        let height = (needed[1] + 2.0 * pad).ceil();
        if height > total[1] {
            return None;
        }
        let size = [request.width, request.height.unwrap_or(height as u32)];
        let from = |axis: usize| 0.5 * (f64::from(size[axis]) - needed[axis]);
        let map_at = [from(0) + margins.left, from(1) + margins.top].map(|side| side.round().max(0.0) as u32);
        Some(Self { side, text_px, size, map_at, map_size, around })
    }

    fn map_area(&self) -> f64 {
        area(self.map_size)
    }

    /// Returns the share of the picture that is the map.
    fn share_of_map(&self) -> f64 {
        self.map_area() / area(self.size)
    }
}

impl Margins {
    /// Returns the room that labels take around a map of a size.
    fn around(frame: &SpaceFrame, map_size: [u32; 2]) -> Self {
        let size = DVec2::from(map_size.map(f64::from));
        let mut before = [DVec2::ZERO; 2];
        for [from, to] in frame.labels.iter().map(|label| label.place) {
            before = [before[0].max(-from), before[1].max(to - size)];
        }
        let [DVec2 { x: left, y: top }, DVec2 { x: right, y: bottom }] = before;
        Self { left, right, top, bottom, block: 0.0 }
    }

    /// Returns the width of everything beside the map, and the height of everything above and below it.
    fn sums(&self, side: Side, text_px: f64) -> [f64; 2] {
        let [beside, below] = match side {
            _ if self.block == 0.0 => [self.right, 0.0],
            Side::Right => [self.gap_to_block(text_px) + self.block, 0.0],
            Side::Below => [self.right, self.block + GAP * text_px],
        };
        [self.left + beside, self.top + self.bottom + below]
    }

    /// Returns from the map to what stands beside it: labels at the right end reach into the gap.
    pub(super) fn gap_to_block(&self, text_px: f64) -> f64 {
        text_px * GAP.max(self.right / text_px + LEAST_GAP)
    }
}

impl Surroundings {
    /// Returns what is around a map of a size; `None` where the legend has no room.
    fn new(
        request: &SheetRequest<'_>,
        content: &SheetContent,
        side: Side,
        text_px: f64,
        map_size: [u32; 2],
    ) -> Option<Self> {
        let camera = (request.camera)(map_size);
        let ticks = content.axes.as_ref().map(|axes| axes.ticks(&camera, text_px)).unwrap_or_default();
        let bar = content.bar_on(&camera, text_px);
        let space = content.space_axes.as_ref().map(|axes| axes.frame(map_size, text_px));
        let mut margins = match &space {
            Some(frame) => Margins::around(frame, map_size),
            None => content.axes_margins(&ticks, text_px),
        };
        let legend_rows = match side {
            Side::Right => content.legend.as_ref().map_or(0, |legend| legend.list().len()),
            Side::Below => {
                let room = f64::from(map_size[0]) - content.aside_width(bar.as_ref(), text_px);
                content.rows_in(room, text_px)?
            }
        };
        margins.block = match side {
            Side::Right => content.stack_width(bar.as_ref(), text_px),
            Side::Below => content.block_height(legend_rows, text_px),
        };
        Some(Self { ticks, space, margins, bar, legend_rows })
    }
}

impl SheetContent {
    /// Returns the room that axes take.
    fn axes_margins(&self, [across, upwards]: &[Vec<MapTick>; 2], text_px: f64) -> Margins {
        let Some(axes) = &self.axes else { return Margins::default() };
        let widest = |ticks: &[MapTick]| {
            ticks.iter().map(|tick| glyphs::width(&tick.label, text_px)).fold(0.0, f64::max)
        };
        let half_below = 0.5 * widest(across);
        let title = if axes.titles().is_some() { Drawing::TITLE } else { 0.0 };
        Margins {
            left: (widest(upwards) + Drawing::TO_LABEL * text_px).max(half_below),
            right: half_below,
            top: (0.5 + title) * text_px,
            bottom: (Drawing::TO_LABEL + glyphs::CAPITAL + title) * text_px,
            block: 0.0,
        }
    }
}
