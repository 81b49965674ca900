#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

use meshbrush_core::{build, document, domain, explain, field, layers, outline, raster, surface};
use meshbrush_mesh::{geometry, mesh, text};

pub mod drawing;
pub mod plot;
pub mod steps;
pub mod levels;
pub mod pixels;
pub mod relief;
pub mod report;
pub mod error_plot;

#[cfg(test)]
mod fixture;
