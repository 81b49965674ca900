//! The features of the window, a folder each.

pub mod boundary;
pub mod domain;
pub mod inspection;
pub mod layers;
pub mod painting;
pub mod picture;
pub mod pins;
pub mod statistics;
pub mod threats;
