//! The figures of the mesh.

mod command;

pub use command::StatisticsCommand;
