//! Strokes, the modes of the brush, and undo.

mod brush;
mod limit;
mod strokes;
