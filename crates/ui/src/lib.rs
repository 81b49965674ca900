#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

pub mod theme;
pub mod lettering;
pub mod widgets;
