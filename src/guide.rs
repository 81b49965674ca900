//! How to do each task with the library. The examples of every page are compiled and run as tests.

#[doc = include_str!("../docs/build.md")]
pub mod build {}

#[doc = include_str!("../docs/paint.md")]
pub mod paint {}

#[doc = include_str!("../docs/locate.md")]
pub mod locate {}

#[doc = include_str!("../docs/path.md")]
pub mod path {}

#[doc = include_str!("../docs/export.md")]
pub mod export {}

#[doc = include_str!("../docs/references.md")]
pub mod references {}
