//! The features of the window, whichever they are.

use std::any::{Any, TypeId};

use super::{Ctx, Feature, FeatureStates, LayerKindRow, Row, Tool};
use crate::kit::command::Command;
use crate::kit::tools::PAN;

/// Returns the tools of all features, and the one that moves the view, in the order of the tool strip.
pub fn all_tools(rows: &'static [Row]) -> Vec<Tool> {
    let of_features = rows.iter().flat_map(|row| row.tools).copied();
    let mut tools: Vec<Tool> = of_features.chain([&PAN]).collect();
    tools.sort_by_key(|tool| tool.place);
    tools
}

/// Returns the kinds of all features, as menus list them.
pub fn kinds_of_layers(rows: &'static [Row]) -> Vec<&'static LayerKindRow> {
    let mut kinds: Vec<_> = rows.iter().flat_map(|row| row.layer_kinds).copied().collect();
    kinds.sort_by_key(|kind| kind.place);
    kinds
}

/// The state of all features.
#[derive(Default)]
pub struct Features(Vec<Box<dyn AnyFeature>>);

/// A feature without its type.
trait AnyFeature: Any {
    /// Runs a command if it is one of the feature's. Returns whether it is.
    fn run(&mut self, command: &Command, ctx: &mut Ctx<'_>) -> bool;
    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool;
    fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool;
    fn for_next_document(self: Box<Self>) -> Box<dyn AnyFeature>;
}

impl<F: Feature> AnyFeature for F {
    fn run(&mut self, command: &Command, ctx: &mut Ctx<'_>) -> bool {
        let own = command.get::<F::Command>();
        own.is_some_and(|own| {
            self.execute(own.clone(), ctx);
            true
        })
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        Feature::follow(self, ctx)
    }

    fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool {
        Feature::put_down(self, ctx)
    }

    fn for_next_document(self: Box<Self>) -> Box<dyn AnyFeature> {
        Box::new(Feature::for_next_document(*self))
    }
}

impl Features {
    /// Adds a feature in its first state.
    #[must_use]
    pub fn with<F: Feature>(mut self) -> Self {
        self.0.push(Box::new(F::default()));
        self
    }

    /// Returns the state of a feature.
    ///
    /// # Panics
    /// Panics where the window has no such feature.
    pub fn get<F: Feature>(&self) -> &F {
        self.state(TypeId::of::<F>()).and_then(<dyn Any>::downcast_ref).expect("the window has the feature")
    }

    /// Returns the state of a feature, to be changed.
    ///
    /// # Panics
    /// Panics where the window has no such feature.
    pub fn get_mut<F: Feature>(&mut self) -> &mut F {
        let mut all = self.0.iter_mut().map(|feature| &mut **feature as &mut dyn Any);
        all.find_map(|feature| feature.downcast_mut()).expect("the window has the feature")
    }

    /// Runs a command of a feature. Returns whether there is a feature with such commands.
    pub fn run(&mut self, command: &Command, ctx: &mut Ctx<'_>) -> bool {
        self.0.iter_mut().any(|feature| feature.run(command, ctx))
    }

    /// Takes and starts work that takes longer than a frame. Returns whether some is left.
    pub fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        self.0.iter_mut().fold(false, |left, feature| feature.follow(ctx) | left)
    }

    /// Puts down what was begun with a tool. Returns whether there was something.
    pub fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool {
        self.0.iter_mut().fold(false, |had_something, feature| feature.put_down(ctx) | had_something)
    }

    /// Returns what is left when another document is opened.
    #[must_use]
    pub fn for_next_document(self) -> Self {
        Self(self.0.into_iter().map(AnyFeature::for_next_document).collect())
    }
}

impl FeatureStates for Features {
    fn state(&self, id: TypeId) -> Option<&dyn Any> {
        let mut all = self.0.iter().map(|feature| &**feature as &dyn Any);
        all.find(|state| (*state).type_id() == id)
    }
}
