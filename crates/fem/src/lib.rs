#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

use meshbrush_core::{domain, earth, field};
use meshbrush_mesh::{geometry, mesh, text};

pub mod fem;
