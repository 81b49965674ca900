//! The features of the window, a folder each. A feature sees the rest of the window through a
//! [`Ctx`], and never another feature: it sends the command of another one instead.

pub mod boundary;
pub mod domain;
pub mod inspection;
pub mod layers;
pub mod painting;
pub mod paths;
pub mod picture;
pub mod pins;
pub mod plots;
pub mod regions;
pub mod report;
pub mod statistics;
pub mod stepping;
pub mod threats;

use eframe::egui::Context;

use super::App;
use super::command::{EditCommand, FileCommand, ShellCommand, ViewCommand};
use super::kit::{Ctx, Feature, Row};
use boundary::Boundary;
use domain::DomainEditor;
use inspection::Inspector;
use layers::LayerEditor;
use painting::Painting;
use paths::Paths;
use picture::BackgroundPicture;
use pins::Pins;
use plots::Plots;
use regions::Regions;
use report::Report;
use statistics::Statistics;
use stepping::Stepping;
use threats::ThreatEditor;

/// Writes from one list what knows all features: their state, the commands with what runs them, and the
/// rows. What the window does itself has its commands and the methods that run them in the second list.
macro_rules! features {
    (
        features { $( $(#[$doc:meta])* $field:ident: $Feature:ty as $Command:ident, )* }
        window { $( $(#[$window_doc:meta])* $Window:ident($command:ty) => $run:ident, )* }
    ) => {
        /// The state of all features.
        #[derive(Default)]
        pub struct Features {
            $( $(#[$doc])* pub $field: $Feature, )*
        }

        /// The parts of each feature that the window shows.
        pub static ROWS: &[Row] = &[ $( <$Feature as Feature>::ROW, )* ];

        /// One thing to do. Lengths and points are in world units.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Command {
            $( $(#[$doc])* $Command(<$Feature as Feature>::Command), )*
            $( $(#[$window_doc])* $Window($command), )*
        }

        impl Features {
            /// Takes and starts work that takes longer than a frame. Returns whether some is left.
            pub fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
                let mut left = false;
                $( left |= self.$field.follow(ctx); )*
                left
            }

            /// Puts down what was begun with a tool. Returns whether there was something.
            pub fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool {
                let mut had_something = false;
                $( had_something |= self.$field.put_down(ctx); )*
                had_something
            }

            /// Returns what is left when another document is opened.
            pub fn for_next_document(self) -> Self {
                Self { $( $field: self.$field.for_next_document(), )* }
            }
        }

        impl App {
            /// Runs one command.
            pub(super) fn run(&mut self, command: Command, egui: &Context) {
                match command {
                    $( Command::$Command(command) => {
                        let (features, mut ctx) = self.features_in_context(egui);
                        features.$field.execute(command, &mut ctx);
                    } )*
                    $( Command::$Window(command) => self.$run(command, egui), )*
                }
            }
        }
    };
}

// Menus, side panel, tool strip and canvas show the features in this order.
features! {
    features {
        /// Strokes and the brush.
        painting: Painting as Brush,
        /// The domain.
        domain: DomainEditor as Domain,
        /// The layers of the size field.
        layers: LayerEditor as Layer,
        /// Regions drawn by hand.
        regions: Regions as Region,
        /// The paths of the document.
        paths: Paths as Path,
        /// The queried point and its triangle.
        inspection: Inspector as Inspect,
        /// The steps of the refinement.
        stepping: Stepping as Steps,
        /// The threats of the selected layer.
        threats: ThreatEditor as Threats,
        /// The pieces of the boundary.
        boundary: Boundary as Boundary,
        /// The picture behind the mesh.
        picture: BackgroundPicture as Picture,
        /// Points whose triangles and values are followed.
        pins: Pins as Pins,
        /// The figures of the mesh.
        statistics: Statistics as Statistics,
        /// Plots of the mesh, and of the time that meshes take.
        plots: Plots as Plots,
        /// The figures of the report.
        report: Report as Figure,
    }
    window {
        /// Documents and their files.
        File(FileCommand) => execute_on_files,
        /// History, paint and settings of the document.
        Edit(EditCommand) => execute_on_document,
        /// Commands about the view.
        View(ViewCommand) => execute_on_view,
        /// Tools, dialogs, help and messages.
        Shell(ShellCommand) => execute_on_shell,
    }
}
