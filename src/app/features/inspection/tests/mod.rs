//! The queried triangle, its cause and its neighbours.

mod query;
mod triangle;
mod walks;
mod why;
