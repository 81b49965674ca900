//! Commands about paths.

use std::sync::Arc;

use glam::DVec2;

use crate::app::App;
use crate::app::paths::PathCommand;
use crate::app::pins::nearest_within;
use crate::document::{PathPlan, Setting};

impl App {
    pub(super) fn execute_on_paths(&mut self, command: PathCommand) {
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
            PathCommand::Cost(cost) => self.set_paths(|plan| plan.cost = cost),
            PathCommand::ShowDistance(distance) => self.tools.path.shown_distance = distance,
            PathCommand::Width(width) => self.paths.set_width(width),
        }
    }

    fn plan(&self) -> &PathPlan {
        &self.session.document().settings().paths
    }

    /// Takes hold of the place at a point. Without one there, the point becomes a place in between, the goal
    /// of the path that was begun, or the start of another one.
    fn press_path(&mut self, at: DVec2, reach: f64, is_between: bool) {
        let numbers = |(route, places): (usize, &Vec<DVec2>)| {
            (0..places.len()).map(move |place| (route, place)).collect::<Vec<_>>()
        };
        let places: Vec<_> = self.plan().routes.iter().enumerate().flat_map(numbers).collect();
        let point = |&(route, place): &(usize, usize)| self.plan().routes[route][place];
        let nearest = nearest_within(places.iter().map(|place| point(place).distance(at)), reach);
        if let Some(place) = nearest.map(|number| places[number]) {
            let grip = point(&place) - at;
            self.tools.path.selected = Some(place);
            self.tools.path.grip = Some(grip);
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
        let place = best.map_or(1, |leg| leg + 1);
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

    /// Changes the plan as a gesture of its own.
    fn change_paths(&mut self, change: impl FnOnce(&mut PathPlan)) {
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
