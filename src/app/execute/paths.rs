//! Commands about paths.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::Context;
use glam::DVec2;

use crate::app::App;
use crate::app::command::Command;
use crate::app::kit::nearest_within;
use crate::app::path_export;
use crate::app::paths::{AlternativesCommand, CostKind, FrontCommand, FrontFinder, PathCommand};
use meshbrush_core::document::{PathCost, PathPlan, Setting};
use meshbrush_core::field::CostFormula;
use meshbrush_core::path::Weights;
use meshbrush_render::render::path_export::PathFormat;

impl App {
    pub(in crate::app) fn execute_on_paths(&mut self, command: PathCommand, _: &Context) {
        match command {
            PathCommand::Press { at, reach, is_between } => self.press_path(at, reach, is_between),
            PathCommand::DragTo(to) => self.drag_place(to),
            PathCommand::StartAt(at) => self.tools.path.pending = Some(at),
            PathCommand::GoalAt(at) => self.end_path(at),
            PathCommand::ViaAt(at) => self.add_via(at),
            PathCommand::Delete => self.delete_place(),
            PathCommand::DeleteAll => self.change_paths(|plan| plan.routes.clear()),
            PathCommand::Swap => {
                if let Some(route) = self.tools.path.route_in(self.plan()) {
                    self.tools.path.selected = None;
                    self.change_paths(|plan| plan.routes[route].reverse());
                }
            }
            PathCommand::AddCorridor => self.add_corridor(),
            PathCommand::MoveCorridor(id) => self.take_paths(id),
            PathCommand::Cost(cost) => self.set_paths(|plan| plan.cost = cost),
            PathCommand::CostBy(kind) => self.give_cost_by(kind),
            PathCommand::ShowDistance(distance) => self.tools.path.shown_distance = distance,
            PathCommand::ShowCorridor(is_on) => self.paths.corridor.is_on = is_on,
            PathCommand::CorridorShare(share) => self.paths.corridor.share = share,
            PathCommand::Alternatives(command) => self.execute_on_alternatives(command),
            PathCommand::Front(command) => self.execute_on_front(command),
            PathCommand::Width(width) => self.paths.set_width(width),
            PathCommand::KeepOut(command) => self.execute_on_keep_out(command),
            PathCommand::ExportTolerance(tolerance) => self.tools.path.export_tolerance = tolerance,
            PathCommand::ExportAs(path) => self.export_path_as(path),
            PathCommand::Export(path) => self.export_path(&path),
        }
    }

    fn export_path_as(&mut self, path: PathBuf) {
        let usual = PathFormat::ENDINGS[0];
        let path = if path.extension().is_none() { path.with_extension(usual) } else { path };
        let export = Command::Path(PathCommand::Export(path.clone()));
        self.commands.extend(self.project.ask_to_replace(vec![path], export));
    }

    fn export_path(&mut self, path: &Path) {
        let (view, of_paths) = (&self.view, (&self.paths, &self.tools.path));
        let started = path_export::export(&self.session, view, of_paths, &mut self.background, path);
        if let Err(problem) = started {
            self.fail(problem);
        }
    }

    fn execute_on_alternatives(&mut self, command: AlternativesCommand) {
        let alternatives = &mut self.paths.alternatives;
        match command {
            AlternativesCommand::Show(is_on) => alternatives.is_on = is_on,
            AlternativesCommand::Point(number) => alternatives.pointed = number,
            AlternativesCommand::Cancel => alternatives.cancel(),
            AlternativesCommand::Take(number) => {
                let place = alternatives.place_on(number).filter(|_| self.paths.is_current(&self.session));
                if let Some((route, (leg, at))) = self.tools.path.route_in(self.plan()).zip(place) {
                    self.insert_place((route, leg + 1), at);
                }
            }
        }
    }

    fn execute_on_front(&mut self, command: FrontCommand) {
        let front = &mut self.paths.front;
        let next = |front: &FrontFinder, is_safer| match &self.session.document().settings().paths.cost {
            PathCost::Weighted(weights) => front.next(*weights, is_safer),
            PathCost::Formula(_) => None,
        };
        let weights = match command {
            FrontCommand::Show(is_on) => return front.is_on = is_on,
            FrontCommand::Point(number) => return front.pointed = number,
            FrontCommand::Cancel => return front.cancel(),
            FrontCommand::Take(number) => front.points().get(number).map(|point| point.weights),
            FrontCommand::Shorter => next(front, false),
            FrontCommand::Safer => next(front, true),
        };
        if let Some(weights) = weights {
            self.change_paths(|plan| plan.cost = PathCost::Weighted(weights));
        }
    }

    fn plan(&self) -> &PathPlan {
        &self.session.document().settings().paths
    }

    /// Takes hold of the place at a point. Without one there, the point becomes a place in between, the goal
    /// of the path that was begun, or the start of another one.
    fn press_path(&mut self, at: DVec2, reach: f64, is_between: bool) {
        let distances = self.plan().places().map(|(_, point)| point.distance(at));
        let nearest = nearest_within(distances, reach);
        if let Some((place, point)) = nearest.and_then(|number| self.plan().places().nth(number)) {
            self.tools.path.selected = Some(place);
            self.tools.path.grip = Some(point - at);
            return;
        }
        self.tools.path.grip = Some(DVec2::ZERO);
        if is_between && !self.plan().routes.is_empty() {
            self.add_via(at);
        } else if self.tools.path.pending.is_some() {
            self.end_path(at);
        } else {
            self.tools.path.grip = None;
            self.tools.path.selected = None;
            self.tools.path.pending = Some(at);
        }
    }

    fn drag_place(&mut self, to: DVec2) {
        let Some(grip) = self.tools.path.grip else {
            // The start that has no goal yet is no part of the document.
            if self.tools.path.pending.is_some() {
                self.tools.path.pending = Some(to);
            }
            return;
        };
        if let Some((route, place)) = self.tools.path.selected_in(self.plan()) {
            self.set_paths(|plan| plan.routes[route][place] = to + grip);
        }
    }

    /// Makes a path from the pending start to a point.
    fn end_path(&mut self, goal: DVec2) {
        let Some(start) = self.tools.path.pending.take() else { return };
        self.tools.path.selected = Some((self.plan().routes.len(), 1));
        self.change_paths(|plan| plan.routes.push(vec![start, goal]));
    }

    /// Adds a place in between to the shown path, where it makes the straight way longer by the least.
    fn add_via(&mut self, at: DVec2) {
        let Some(route) = self.tools.path.route_in(self.plan()) else { return };
        let places = &self.plan().routes[route];
        let detour = |n: &usize| {
            let [from, to] = [places[*n], places[*n + 1]];
            from.distance(at) + at.distance(to) - from.distance(to)
        };
        let best = (0..places.len() - 1).min_by(|a, b| detour(a).total_cmp(&detour(b)));
        self.insert_place((route, best.map_or(1, |leg| leg + 1)), at);
    }

    /// Adds a place to a route, and selects it.
    fn insert_place(&mut self, (route, place): (usize, usize), at: DVec2) {
        self.tools.path.selected = Some((route, place));
        self.change_paths(|plan| plan.routes[route].insert(place, at));
    }

    /// Deletes the selected place in between, or the whole path of a selected start or goal.
    fn delete_place(&mut self) {
        let Some((route, place)) = self.tools.path.selected_in(self.plan()) else { return };
        self.tools.path.selected = None;
        self.change_paths(|plan| {
            let places = &mut plan.routes[route];
            if place == 0 || place + 1 == places.len() {
                plan.routes.remove(route);
            } else {
                places.remove(place);
            }
        });
    }

    /// Gives the cost in another way. The formula is that of the weights.
    fn give_cost_by(&mut self, kind: CostKind) {
        let cost = match (kind, &self.plan().cost) {
            (CostKind::Weights, PathCost::Formula(_)) => PathCost::default(),
            (CostKind::Formula, PathCost::Weighted(weights)) => PathCost::Formula(formula_of(*weights)),
            _ => return,
        };
        self.change_paths(|plan| plan.cost = cost);
    }

    /// Changes the plan as a gesture of its own.
    pub(super) fn change_paths(&mut self, change: impl FnOnce(&mut PathPlan)) {
        self.session.end_gesture();
        self.set_paths(change);
        self.session.end_gesture();
    }

    fn set_paths(&mut self, change: impl FnOnce(&mut PathPlan)) {
        let mut plan = self.plan().clone();
        change(&mut plan);
        self.session.set(Setting::Paths(Arc::new(plan)));
    }
}

/// Returns the formula that is equal to weights.
fn formula_of(Weights { length, risk }: Weights) -> CostFormula {
    CostFormula::parse(&format!("{length} + {risk}*risk"))
        .expect("a sum of numbers and the risk is a formula")
}
