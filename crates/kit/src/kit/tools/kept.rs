//! What a person set on the brush, from one run of the program to the next.

use super::Tools;

/// The settings of the brush that do not depend on the document, as numbers: the radius as a share of the
/// longer side of the domain, the strength of the brush and of the eraser, the hardness, the risk, and the
/// smoothing. All are at most 1.
pub type KeptBrush = [f64; 6];

impl Tools {
    /// Returns what is kept of the brush.
    pub fn kept_brush(&self) -> KeptBrush {
        let strengths = [self.paint_strength, self.erase_strength];
        [self.radius / self.extent, strengths[0], strengths[1], self.hardness, self.risk, self.smoothing]
    }

    /// Sets the brush as it was kept. A value that no slider has changes nothing.
    pub fn take_brush(&mut self, kept: KeptBrush) {
        let [radius, paint_strength, erase_strength, hardness, risk, smoothing] = kept;
        if !Self::is_brush(&kept) {
            return;
        }
        self.radius = radius * self.extent;
        (self.paint_strength, self.erase_strength) = (paint_strength, erase_strength);
        (self.hardness, self.risk, self.smoothing) = (hardness, risk, smoothing);
    }

    /// Returns whether a brush can have these settings.
    pub(super) fn is_brush(kept: &KeptBrush) -> bool {
        let is_positive = kept[..3].iter().all(|&value| value > 0.0);
        is_positive && kept.iter().all(|value| (0.0..=1.0).contains(value))
    }
}
