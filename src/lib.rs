//! Paint where detail matters; the mesh follows the brush.
//!
//! Mesh generation by local bisection refinement of triangulated grids (Maubach's method). Rooms, lowest first; a room
//! imports only from rooms above it in this list. ARCHITECTURE.md draws the house.

#![deny(unsafe_code)]

pub mod text;
pub mod geometry;
pub mod mesh;
pub mod raster;
pub mod field;
pub mod domain;
pub mod paint;
pub mod build;
pub mod document;
pub mod io;
pub mod colormap;
pub mod scene;
pub mod render;
pub mod cli;
#[cfg(feature = "gui")]
pub mod app;

/// The examples of the README, compiled and run with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
