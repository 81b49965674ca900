//! Strokes, the modes of the brush, and undo.

mod brush;
mod strokes;
