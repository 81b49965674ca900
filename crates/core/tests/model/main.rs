//! Fields, layers, domains, outlines, paths and documents.

mod blocks;
mod boundary;
mod certificate;
mod cleaning;
#[path = "../../../../tests/shared/closure/mod.rs"]
mod closure;
mod depth_slope;
mod depths;
mod distance_to_pieces;
mod document;
mod earth;
mod edits;
mod exact_paths;
mod exact_segments;
mod fit_quality;
mod fitted;
mod follower;
#[path = "../../../../tests/shared/formula_mesh/mod.rs"]
mod formula_mesh;
mod golden;
mod guards;
mod layers;
mod many_directions;
mod mirrored;
mod node_means;
mod open_boundary;
mod operations;
mod outline;
mod outline_follower;
mod paint_areas;
mod path;
mod path_bounds;
mod path_choices;
mod path_coast;
mod path_edits;
mod path_ground;
mod path_random;
mod path_referees;
mod path_threads;
mod path_valleys;
mod path_walls;
mod quality;
mod random_coast;
mod random_costs;
mod project_limits;
mod remade_prices;
mod replay;
#[path = "../../../../tests/shared/runs.rs"]
mod runs;
mod size_field;
mod size_price;
mod slabs;
mod smallest_diameter;
mod stacks;
mod surface;
mod symmetry;
