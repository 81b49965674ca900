//! The field as colours, drawn over the mesh.

use super::super::view::FieldOverlay;
use crate::colormap::LevelColors;
use crate::document::{Document, Follower};
use crate::scene::Overlay;

/// How strongly h̄ covers the mesh, 0 to 1.
const TARGET_OPACITY: f32 = 0.75;

/// The colours of an overlay, computed again only when what they show has changed.
#[derive(Debug, Default)]
pub struct OverlayColors {
    rgba: Vec<[u8; 4]>,
    size: [u32; 2],
    /// What the colours were made from.
    made_from: Option<(FieldOverlay, u64, u64, LevelColors)>,
    revision: u64,
}

impl OverlayColors {
    /// The overlay to draw, if any.
    pub fn overlay<'a>(
        &'a mut self,
        kind: FieldOverlay,
        document: &Document,
        follower: &Follower,
        colors: LevelColors,
    ) -> Option<Overlay<'a>> {
        if kind == FieldOverlay::None {
            self.made_from = None;
            return None;
        }
        let wanted = Some((kind, document.revision(), follower.revision(), colors.clone()));
        if self.made_from != wanted {
            self.made_from = wanted;
            self.revision += 1;
            match kind {
                FieldOverlay::Risk => self.fill_with_risk(document),
                _ => self.fill_with_target(follower, &colors),
            }
        }
        let opacity = if kind == FieldOverlay::Risk { 1.0 } else { TARGET_OPACITY };
        let [columns, rows] = self.size;
        let bounds = document.settings().domain.bounds;
        Some(Overlay { bounds, columns, rows, rgba: &self.rgba, opacity, revision: self.revision })
    }

    fn fill_with_risk(&mut self, document: &Document) {
        let risk = &document.paint().risk;
        self.size = risk.size();
        let table: [[u8; 4]; 256] = std::array::from_fn(|i| risk_color(i as u8));
        self.rgba.clear();
        self.rgba.extend(risk.values().iter().map(|&risk| table[(risk * 255.0) as usize]));
    }

    fn fill_with_target(&mut self, follower: &Follower, colors: &LevelColors) {
        let levels = follower.field().levels();
        self.size = levels.size();
        self.rgba.clear();
        let all = follower.field().target().all();
        self.rgba.extend(all.pixels().map(|(x, y)| colors.of(levels.get(x, y).min(63))));
    }
}

/// From nothing to a warm red; alpha carries the risk.
pub fn risk_color(risk: u8) -> [u8; 4] {
    [0xff, 0x5a - risk / 6, 0x3c, (f32::from(risk) * 0.8) as u8]
}
