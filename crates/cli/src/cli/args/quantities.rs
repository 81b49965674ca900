//! The options on further values at the nodes.

use clap::Args;

/// Values at the nodes of files, beside h̄.
#[derive(Clone, Debug, Default, Args)]
pub struct QuantityArguments {
    /// A further value at the nodes, as a formula in x and y, with a name in .vtu, .msh and .csv; may be
    /// repeated
    ///
    /// As in `depth=20 - x`; without a name it is `quantity`. In .node the values are attributes in this
    /// order, and the first is z in .2dm. The formats of coastal solvers take the quantity `depth` as the
    /// depth, positive downwards. In a formula `depth` is that of layers of depths (--depth) at the node, as
    /// in `depth=max(depth, 3)` and `manning=if(depth > 20, 0.02, 0.03)`.
    #[arg(long, value_name = "[NAME=]EXPR", allow_hyphen_values = true)]
    pub quantity: Vec<String>,

    /// A further value at the nodes, from a grid: the mean of the pixels in the cell of each node; may be
    /// repeated
    ///
    /// As in `manning=manning.tif`. The cell of a node is the third of each triangle around it that is
    /// nearest to it. Pixels without a value do not count. A node whose cell has none has the value at its
    /// place, or else that of the nearest pixel within 64.
    #[arg(long, value_name = "NAME=FILE")]
    pub quantity_grid: Vec<String>,

    /// The values of the classes of a grid of --quantity-grid: a table with the columns class and value; may
    /// be repeated
    ///
    /// As in `--quantity-grid manning=landcover.tif --quantity-table manning=classes.csv`. Nodes get the mean
    /// of the values of the pixels in their cells. Classes that the table lacks count as pixels without a
    /// value.
    #[arg(long, value_name = "NAME=FILE.csv")]
    pub quantity_table: Vec<String>,
}
