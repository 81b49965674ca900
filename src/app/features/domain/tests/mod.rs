//! Cutting the domain, outlines from files, and the unit of lengths.

mod edits;
mod outline;
mod polygon;
mod unit;
