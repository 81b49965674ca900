#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

pub mod colormap;
pub mod scene;
pub mod render;
