//! The program as a person runs it: command line, recipes, projects.

mod causes;
mod check;
mod cli;
mod data_formats;
mod depth;
mod depth_slope;
mod distance_pieces;
mod earth;
mod folder;
mod hostile;
mod layer_files;
mod lengths;
mod lines;
mod located;
mod memory;
mod one_program;
mod path_cli;
mod path_routes;
mod project;
mod quantities;
mod readme;
mod recipe;
mod partition;
mod sequence;
#[path = "../shared/runs.rs"]
mod runs;
mod solver_seas;
mod solve;
mod straits;
mod strips;
mod surface;
mod weirs;
