//! The settings of the tools of features, whichever they are.

use std::any::Any;
use std::fmt::Debug;

/// Settings of a tool that its feature reads and changes.
pub trait ToolSettings: Clone + Debug + Default + PartialEq + 'static {
    /// Returns whether a person chose otherwise than in `other`: what the tool does, not what was drawn with
    /// it.
    fn differs_in_choice(&self, other: &Self) -> bool;
}

/// The settings of one tool, without their type.
pub trait AnySettings: Any + Debug {
    /// Returns a copy.
    fn copy(&self) -> Box<dyn AnySettings>;
    /// Returns whether others are the same.
    fn equals(&self, other: &dyn AnySettings) -> bool;
    /// Returns whether a person chose otherwise than in others of the same tool.
    fn differs_in_choice(&self, other: &dyn AnySettings) -> bool;
}

impl<S: ToolSettings> AnySettings for S {
    fn copy(&self) -> Box<dyn AnySettings> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn AnySettings) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }

    fn differs_in_choice(&self, other: &dyn AnySettings) -> bool {
        let other = (other as &dyn Any).downcast_ref();
        other.is_some_and(|other| ToolSettings::differs_in_choice(self, other))
    }
}

/// Returns the settings that a tool has at first.
pub fn first_settings<S: ToolSettings>() -> Box<dyn AnySettings> {
    Box::new(S::default())
}

/// The settings of all tools that have some.
#[derive(Debug)]
pub struct SettingsOfTools(Vec<Box<dyn AnySettings>>);

impl SettingsOfTools {
    /// Collects the settings of tools.
    pub fn new(all: impl Iterator<Item = Box<dyn AnySettings>>) -> Self {
        Self(all.collect())
    }

    /// Returns settings by their type.
    pub fn get<S: ToolSettings>(&self) -> Option<&S> {
        self.0.iter().find_map(|settings| (&**settings as &dyn Any).downcast_ref())
    }

    /// Returns settings by their type, to be changed.
    pub fn get_mut<S: ToolSettings>(&mut self) -> Option<&mut S> {
        self.0.iter_mut().find_map(|settings| (&mut **settings as &mut dyn Any).downcast_mut())
    }

    /// Returns whether a person chose otherwise than in others of the same tools.
    pub fn differ_in_choice(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).any(|(own, other)| own.differs_in_choice(&**other))
    }
}

impl Clone for SettingsOfTools {
    fn clone(&self) -> Self {
        Self(self.0.iter().map(|settings| settings.copy()).collect())
    }
}

impl PartialEq for SettingsOfTools {
    fn eq(&self, other: &Self) -> bool {
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(|(own, other)| own.equals(&**other))
    }
}
