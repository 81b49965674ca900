//! A command of any part of the window.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};

/// The commands of one part of the window: of a feature, or those about files, edits, the view or the shell.
pub trait CommandSet: Clone + Debug + PartialEq + Send + Sync + 'static {
    /// Returns whether the command closes the document.
    fn closes_document(&self) -> bool {
        false
    }
}

/// One thing to do, of whichever part of the window. Lengths and points are in world units.
pub struct Command(Box<dyn AnyCommand>);

/// What every command can do, without its type.
trait AnyCommand: Any + Debug + Send + Sync {
    fn copy(&self) -> Box<dyn AnyCommand>;
    fn equals(&self, other: &dyn AnyCommand) -> bool;
    fn closes_document(&self) -> bool;
}

impl<C: CommandSet> AnyCommand for C {
    fn copy(&self) -> Box<dyn AnyCommand> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn AnyCommand) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }

    fn closes_document(&self) -> bool {
        CommandSet::closes_document(self)
    }
}

impl Command {
    /// Returns the command, if it is one of these.
    pub fn get<C: CommandSet>(&self) -> Option<&C> {
        (&*self.0 as &dyn Any).downcast_ref()
    }

    /// Returns the command, to be changed, if it is one of these.
    pub fn get_mut<C: CommandSet>(&mut self) -> Option<&mut C> {
        (&mut *self.0 as &mut dyn Any).downcast_mut()
    }

    /// Returns whether the command closes the document.
    pub fn closes_document(&self) -> bool {
        self.0.closes_document()
    }
}

impl<C: CommandSet> From<C> for Command {
    fn from(command: C) -> Self {
        Self(Box::new(command))
    }
}

impl Clone for Command {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}

impl PartialEq for Command {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(&*other.0)
    }
}

impl Debug for Command {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
