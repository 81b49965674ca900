//! Commands about the document as a whole.

use super::CommandSet;
use meshbrush_core::document::Setting;

/// One thing to do with the document: history, paint, settings.
#[derive(Clone, Debug, PartialEq)]
pub enum EditCommand {
    /// Takes back the last gesture.
    Undo,
    /// Does the last undone gesture again.
    Redo,
    /// Removes all paint.
    ClearPaint,
    /// Changes a setting of the document. Further changes of it join this gesture until
    /// [`Self::EndGesture`].
    Set(Setting),
    /// Ends the gesture, as when a slider is released.
    EndGesture,
    /// Computes the price of a setting without applying it, or of none.
    Consider(Option<Setting>),
    /// Returns to the settings of the mesh, where the document asks for very many triangles.
    KeepMesh,
    /// Lets the mesh have very many triangles.
    ApplyAnyway,
    /// Stops the update of the mesh.
    CancelUpdate,
}

impl CommandSet for EditCommand {}
