//! Commands about strokes and the brush.

use glam::DVec2;

use super::CommandSet;
use crate::kit::tools::{BrushMode, PaintKind, PenResponse};

/// One thing to do with strokes and the brush.
#[derive(Clone, Debug, PartialEq)]
pub enum BrushCommand {
    /// Selects the brush and what it paints.
    Kind(PaintKind),
    /// Selects the brush and how a stroke changes the paint.
    Mode(BrushMode),
    /// Sets the radius of the brush.
    Radius(f64),
    /// Makes the brush larger or smaller by a factor.
    Scale(f64),
    /// Sets the hardness of the brush, 0 to 1.
    Hardness(f64),
    /// Sets the strength of the selected tool, 0 to 1.
    Strength(f64),
    /// Sets the risk that the brush paints in the mode *Set*, 0 to 1.
    Risk(f64),
    /// Sets the diameter that the brush paints.
    Diameter(f64),
    /// Sets the largest error that the brush paints, in the unit of surfaces.
    Error(f64),
    /// Takes the value at a point as the brush's own.
    Pick(DVec2),
    /// Sets the smoothing of strokes, 0 to 1.
    Smoothing(f64),
    /// Repeats strokes on the other side: left and right.
    MirrorX(bool),
    /// Repeats strokes on the other side: above and below.
    MirrorY(bool),
    /// Sets what the pressure of a pen changes, and how.
    PenResponse(PenResponse),
    /// Selects the brush, and makes it that of a preset, by its number from 0.
    UsePreset(usize),
    /// Keeps the brush as a preset.
    KeepPreset,
    /// Gives a preset another name.
    RenamePreset(usize, String),
    /// Removes a preset.
    RemovePreset(usize),
    /// Notes the pressure of the pen, 0 to 1, or that it was lifted.
    Pen(Option<f64>),
    /// Begins a stroke at a point.
    BeginStroke(DVec2),
    /// Extends the stroke to a point.
    DrawTo(DVec2),
    /// Ends the stroke.
    EndStroke,
    /// Lowers the smallest diameter of the document to the one that was painted; the risk curve stays.
    LowerLimit,
    /// Lowers the smallest diameter and the diameter at risk 1 to the one that was painted.
    LowerLimitAndRisk,
    /// Declines to lower the smallest diameter.
    KeepLimit,
    /// Paints a straight line to a point from where the last stroke ended.
    LineTo(DVec2),
}

impl CommandSet for BrushCommand {}
