//! The options on the depths that files get.

use clap::Args;

use super::numbers::{finite, share};

/// What is changed of the depths of layers or of a quantity.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct DepthArguments {
    /// Least depth in files, in metres: nodes that are less deep are written with it
    ///
    /// As in 3: at the shore depths are 0, and such nodes fall dry. The mesh stays as it is. Headers say it,
    /// and the report says how many nodes have it.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = finite)]
    pub least_depth: Option<f64>,

    /// Smooth the depths in files until no edge has an r-factor above this: the difference of the depths of
    /// its ends by their sum
    ///
    /// As in 0.2, for models with terrain-following layers, such as SCHISM and FVCOM. Water moves from the
    /// deeper ends of steep edges to the shallower ones, and what is still too steep then is deepened. The
    /// least depth counts first, and is kept; edges with a dry end do not count. The mesh stays as it is.
    /// Headers say it, and the report says how many nodes have another depth, and the largest change.
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = share)]
    pub depth_slope: Option<f64>,
}
