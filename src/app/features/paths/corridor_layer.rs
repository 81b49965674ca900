//! Corridors: layers along the paths as they were when they were taken.

use super::{NO_PATH, Paths};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::{DistanceLayer, DistanceTo, LayerId, LayerKind, ShapeList, Shapes};
use meshbrush_kit::kit::Ctx;
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand};
use meshbrush_ui::widgets::shown_keys::with_keys;

impl Paths {
    /// Adds a corridor along the paths as they are.
    pub(super) fn add_corridor(&mut self, ctx: &mut Ctx<'_>) {
        let Some(lines) = self.current_paths(ctx) else { return };
        let settings = ctx.session.document().settings();
        let extent = settings.domain.bounds.size().max_element();
        let kind = LayerKind::corridor(lines, extent, &settings.transfer, Settings::DEFAULT_GRADATION);
        ctx.send(Command::from(LayerCommand::Add(Box::new(kind))));
        ctx.send(Command::from(EditCommand::EndGesture));
    }

    /// Moves a corridor to the paths as they are. Its numbers stay.
    pub(super) fn take_paths(&mut self, id: LayerId, ctx: &mut Ctx<'_>) {
        let layers = &ctx.session.document().settings().layers;
        let corridor = layers.iter().find(|layer| layer.id == id).and_then(|layer| layer.kind.get());
        let Some(&DistanceLayer { to: DistanceTo::Corridor { width, .. }, .. }) = corridor else { return };
        if let Some(lines) = self.current_paths(ctx) {
            ctx.send(Command::from(LayerCommand::MeasureTo(id, DistanceTo::Corridor { lines, width })));
        }
    }

    /// Returns the paths of the document as lines. Says why there are none yet.
    fn current_paths(&mut self, ctx: &mut Ctx<'_>) -> Option<Shapes> {
        let plan = &ctx.session.document().settings().paths;
        if plan.routes.is_empty() {
            ctx.session.report(with_keys(ctx.egui, NO_PATH));
            return None;
        }
        let shown = self.finder.shown();
        let is_found = |number: usize| shown.get(number).is_some_and(|path| path.problem.is_none());
        if !self.finder.is_current(ctx.session) || !(0..plan.routes.len()).all(is_found) {
            let text = "A corridor needs paths that are up to date; the panel Path says what is missing.";
            ctx.session.report(text);
            return None;
        }
        let lines = shown.iter().filter_map(|path| Some(path.found.as_ref()?.solution.points.clone()));
        let list = ShapeList { lines: lines.collect(), ..ShapeList::default() };
        Shapes::new(list, true).ok()
    }
}
