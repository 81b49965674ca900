#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

pub mod text;
pub mod geometry;
pub mod mesh;
