//! Commands about the window around the document.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec2;

use super::{Command, CommandSet, HelpTopic};
use crate::kit::{DataFile, Keymap, Menu, Tool};

/// One thing to do with tools, dialogs, help and messages.
#[derive(Clone, Debug, PartialEq)]
pub enum ShellCommand {
    /// Selects a tool.
    Use(Tool),
    /// Cancels the current stroke, cut or polygon, or else clears the query and the message.
    Escape,
    /// Opens the list of all commands.
    Palette,
    /// Shows what the program is.
    About,
    /// Opens the question for a place to go to.
    AskPlace,
    /// Asks how exported pictures look.
    AskPicture,
    /// Opens it with a point typed in.
    AskPlaceNear(DVec2),
    /// Asks what a file of data that was read is to be.
    AskRole(Arc<DataFile>),
    /// Closes the open dialog.
    CloseDialog,
    /// Shows a topic of the help.
    ShowHelp(HelpTopic),
    /// Closes the help.
    CloseHelp,
    /// Limits the threads on which the window computes.
    LimitThreads(NonZeroUsize),
    /// Shows a failure.
    Report(String),
    /// Shows news.
    Tell(String),
    /// Shows news, and a button that sends a command.
    Offer(String, &'static str, Box<Command>),
    /// Dismisses the message.
    DismissNotice,
    /// Moves the focus by so many parts of the window: menus, tools, canvas, panel, status bar.
    FocusPart(i32),
    /// Opens a menu of the bar.
    OpenMenu(Menu),
    /// Opens the menu for a point of the canvas: that under the pointer, or the middle.
    MenuOfCanvas,
    /// Changes the keys of entries.
    SetKeys(Keymap),
    /// Writes the changed keys to a file, and asks before another one is replaced.
    ExportKeysAs(PathBuf),
    /// Writes the changed keys to a file.
    ExportKeys(PathBuf),
    /// Reads changed keys from a file.
    ImportKeys(PathBuf),
    /// Copies a text to the clipboard.
    Copy(String),
}

impl CommandSet for ShellCommand {}
