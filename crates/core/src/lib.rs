#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

use meshbrush_mesh::{geometry, mesh, text};

pub mod earth;
pub mod raster;
pub mod field;
pub mod domain;
pub mod layers;
pub mod surface;
pub mod outline;
pub mod paint;
pub mod build;
pub mod path;
pub mod explain;
pub mod cells;
pub mod quality;
pub mod document;
