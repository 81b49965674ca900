//! Runs the commands about paths.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::alternatives::farthest_place;
use super::front::FrontFinder;
use super::keep_out::load;
use super::{
    AlternativesCommand, CORRIDOR, CostKind, FrontCommand, KeepOutCommand, OTHER_PATHS, PATH, PATH_COST,
    PATH_PANEL, PathCommand, Paths, ROLES, entries, export, marks,
};
use meshbrush_core::document::{KeepOut, PathCost, PathPlan, Setting};
use meshbrush_core::field::CostFormula;
use meshbrush_core::path::Weights;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::notices::Offer;
use meshbrush_kit::kit::{Ctx, Feature, Row, nearest_within};
use meshbrush_render::render::path_export::PathFormat;
use meshbrush_ui::widgets::format;
use meshbrush_ui::widgets::shown_keys::with_keys;

impl Feature for Paths {
    type Command = PathCommand;
    const ROW: Row = Row {
        tools: &[&PATH],
        panels: &[&PATH_PANEL, &OTHER_PATHS, &PATH_COST],
        layer_kinds: &[&CORRIDOR],
        roles: &ROLES,
        marks_below: marks::paint,
        entries: entries::entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: PathCommand, ctx: &mut Ctx<'_>) {
        match command {
            PathCommand::Press { at, reach, is_between } => self.press_path(at, reach, is_between, ctx),
            PathCommand::DragTo(to) => self.drag_place(to, ctx),
            PathCommand::StartAt(at) => self.tool.pending = Some(at),
            PathCommand::GoalAt(at) => self.end_path(at, ctx),
            PathCommand::ViaAt(at) => self.add_via(at, ctx),
            PathCommand::Delete => self.delete_place(ctx),
            PathCommand::DeleteAll => self.change_paths(PathPlan::clear, ctx),
            PathCommand::Name(name) => {
                if let Some(route) = self.tool.route_in(plan(ctx)) {
                    self.set_paths(|plan| plan.set_name(route, &name), ctx);
                }
            }
            PathCommand::Swap => {
                if let Some(route) = self.tool.route_in(plan(ctx)) {
                    self.tool.selected = None;
                    self.change_paths(|plan| plan.routes[route].reverse(), ctx);
                }
            }
            PathCommand::KeepFormer(route) => self.keep_former(route, ctx),
            PathCommand::AddCorridor => self.add_corridor(ctx),
            PathCommand::MoveCorridor(id) => self.take_paths(id, ctx),
            PathCommand::Cost(cost) => self.set_paths(|plan| plan.cost = cost, ctx),
            PathCommand::Speed(knots) => self.tool.speed = knots,
            PathCommand::Clearance(clearance) => self.set_paths(|plan| plan.clearance = clearance, ctx),
            PathCommand::CostBy(kind) => self.give_cost_by(kind, ctx),
            PathCommand::ShowDistance(distance) => self.tool.shown_distance = distance,
            PathCommand::ShowCorridor(is_on) => self.finder.corridor.is_on = is_on,
            PathCommand::CorridorShare(share) => self.finder.corridor.share = share,
            PathCommand::Alternatives(command) => self.execute_on_alternatives(command, ctx),
            PathCommand::Front(command) => self.execute_on_front(command, ctx),
            PathCommand::Width(width) => self.finder.set_width(width),
            PathCommand::KeepOut(command) => self.execute_on_keep_out(command, ctx),
            PathCommand::ExportTolerance(tolerance) => self.tool.export_tolerance = tolerance,
            PathCommand::ExportAs(path) => self.export_path_as(path, ctx),
            PathCommand::Export(path) => self.export_path(&path, ctx),
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let route = self.tool.route_in(plan(ctx));
        self.finder.advance(ctx.session, route, ctx.jobs);
        if let Some((number, excess)) = self.finder.take_exchanged() {
            let (name, less) = (plan(ctx).name(number), format::percent_above(excess / (1.0 + excess)));
            let text =
                format!("The proof of {name} found a path that costs {less} less, and shows that one.");
            let command = Command::from(PathCommand::KeepFormer(number));
            ctx.session.notices_mut().tell_with_offer(text, Offer { label: "Keep the former", command });
        }
        false
    }

    fn put_down(&mut self, _: &mut Ctx<'_>) -> bool {
        self.tool.pending.take().is_some()
    }
}

impl Paths {
    fn export_path_as(&mut self, path: PathBuf, ctx: &mut Ctx<'_>) {
        let default = PathFormat::ENDINGS[0];
        let path = if path.extension().is_none() { path.with_extension(default) } else { path };
        let export = Command::from(PathCommand::Export(path.clone()));
        ctx.commands.extend(ctx.project.ask_to_replace(vec![path], export));
    }

    fn export_path(&mut self, path: &Path, ctx: &mut Ctx<'_>) {
        let overlay = ctx.picture_overlay();
        let (view, of_paths) = (&*ctx.view, (&self.finder, &self.tool));
        let started = export::export(ctx.session, (view, overlay), of_paths, ctx.background, path);
        if let Err(problem) = started {
            ctx.fail(with_keys(ctx.egui, &problem).into_owned());
        }
    }

    /// Leads a path along the one before its proof, by a place in between.
    fn keep_former(&mut self, route: usize, ctx: &mut Ctx<'_>) {
        let found = self.finder.shown().get(route).and_then(|shown| shown.found.as_ref());
        let place = found.and_then(|found| farthest_place(&found.solution, found.former.as_ref()?));
        if let Some((leg, at)) = place.filter(|_| self.finder.is_current(ctx.session)) {
            self.insert_place((route, leg + 1), at, ctx);
        }
    }

    fn execute_on_alternatives(&mut self, command: AlternativesCommand, ctx: &mut Ctx<'_>) {
        let alternatives = &mut self.finder.alternatives;
        match command {
            AlternativesCommand::Show(is_on) => alternatives.is_on = is_on,
            AlternativesCommand::Point(number) => alternatives.pointed = number,
            AlternativesCommand::Cancel => alternatives.cancel(),
            AlternativesCommand::Take(number) => {
                let place = alternatives.place_on(number).filter(|_| self.finder.is_current(ctx.session));
                if let Some((route, (leg, at))) = self.tool.route_in(plan(ctx)).zip(place) {
                    self.insert_place((route, leg + 1), at, ctx);
                }
            }
        }
    }

    fn execute_on_front(&mut self, command: FrontCommand, ctx: &mut Ctx<'_>) {
        let front = &mut self.finder.front;
        let next = |front: &FrontFinder, is_safer| match &ctx.session.document().settings().paths.cost {
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
            self.change_paths(|plan| plan.cost = PathCost::Weighted(weights), ctx);
        }
    }

    /// Takes hold of the place at a point. Without one there, the point becomes a place in between, the goal
    /// of the path that was begun, or the start of another one.
    fn press_path(&mut self, at: DVec2, reach: f64, is_between: bool, ctx: &mut Ctx<'_>) {
        let distances = plan(ctx).places().map(|(_, point)| point.distance(at));
        let nearest = nearest_within(distances, reach);
        if let Some((place, point)) = nearest.and_then(|number| plan(ctx).places().nth(number)) {
            self.tool.selected = Some(place);
            self.tool.grip = Some(point - at);
            return;
        }
        self.tool.grip = Some(DVec2::ZERO);
        if is_between && !plan(ctx).routes.is_empty() {
            self.add_via(at, ctx);
        } else if self.tool.pending.is_some() {
            self.end_path(at, ctx);
        } else {
            self.tool.grip = None;
            self.tool.selected = None;
            self.tool.pending = Some(at);
        }
    }

    fn drag_place(&mut self, to: DVec2, ctx: &mut Ctx<'_>) {
        let Some(grip) = self.tool.grip else {
            // The start that has no goal yet is no part of the document.
            if self.tool.pending.is_some() {
                self.tool.pending = Some(to);
            }
            return;
        };
        if let Some((route, place)) = self.tool.selected_in(plan(ctx)) {
            self.set_paths(|plan| plan.routes[route][place] = to + grip, ctx);
        }
    }

    /// Makes a path from the pending start to a point.
    fn end_path(&mut self, goal: DVec2, ctx: &mut Ctx<'_>) {
        let Some(start) = self.tool.pending.take() else { return };
        self.tool.selected = Some((plan(ctx).routes.len(), 1));
        self.change_paths(|plan| plan.routes.push(vec![start, goal]), ctx);
    }

    /// Adds a place in between to the shown path, where it makes the straight way longer by the least.
    fn add_via(&mut self, at: DVec2, ctx: &mut Ctx<'_>) {
        let Some(route) = self.tool.route_in(plan(ctx)) else { return };
        let places = &plan(ctx).routes[route];
        let detour = |n: &usize| {
            let [from, to] = [places[*n], places[*n + 1]];
            from.distance(at) + at.distance(to) - from.distance(to)
        };
        let best = (0..places.len() - 1).min_by(|a, b| detour(a).total_cmp(&detour(b)));
        self.insert_place((route, best.map_or(1, |leg| leg + 1)), at, ctx);
    }

    /// Adds a place to a route, and selects it.
    fn insert_place(&mut self, (route, place): (usize, usize), at: DVec2, ctx: &mut Ctx<'_>) {
        self.tool.selected = Some((route, place));
        self.change_paths(|plan| plan.routes[route].insert(place, at), ctx);
    }

    /// Deletes the selected place in between, or the whole path of a selected start or goal.
    fn delete_place(&mut self, ctx: &mut Ctx<'_>) {
        let Some((route, place)) = self.tool.selected_in(plan(ctx)) else { return };
        self.tool.selected = None;
        self.change_paths(
            |plan| {
                let places = &mut plan.routes[route];
                if place == 0 || place + 1 == places.len() {
                    plan.remove(route);
                } else {
                    places.remove(place);
                }
            },
            ctx,
        );
    }

    /// Gives the cost in another way. The formula is that of the weights.
    fn give_cost_by(&mut self, kind: CostKind, ctx: &mut Ctx<'_>) {
        let cost = match (kind, &plan(ctx).cost) {
            (CostKind::Weights, PathCost::Formula(_)) => PathCost::default(),
            (CostKind::Formula, PathCost::Weighted(weights)) => PathCost::Formula(formula_of(*weights)),
            _ => return,
        };
        self.change_paths(|plan| plan.cost = cost, ctx);
    }

    /// Changes the plan as a gesture of its own.
    fn change_paths(&mut self, change: impl FnOnce(&mut PathPlan), ctx: &mut Ctx<'_>) {
        ctx.session.end_gesture();
        self.set_paths(change, ctx);
        ctx.session.end_gesture();
    }

    fn set_paths(&mut self, change: impl FnOnce(&mut PathPlan), ctx: &mut Ctx<'_>) {
        let mut plan = plan(ctx).clone();
        change(&mut plan);
        ctx.session.set(Setting::Paths(Arc::new(plan)));
    }

    fn execute_on_keep_out(&mut self, command: KeepOutCommand, ctx: &mut Ctx<'_>) {
        match command {
            KeepOutCommand::Open(path) => load(ctx.session, ctx.background, &path),
            KeepOutCommand::Add(region) => self.change_keep_out(|regions| regions.push(region), ctx),
            KeepOutCommand::AddMask => {
                if let Some(region) = KeepOutCommand::mask_to_add(ctx.session) {
                    self.change_keep_out(|regions| regions.push(region), ctx);
                }
            }
            KeepOutCommand::Remove(number) => self.change_keep_out(
                |regions| {
                    if number < regions.len() {
                        regions.remove(number);
                    }
                },
                ctx,
            ),
            KeepOutCommand::RemoveAll => self.change_keep_out(Vec::clear, ctx),
        }
    }

    fn change_keep_out(&mut self, change: impl FnOnce(&mut Vec<KeepOut>), ctx: &mut Ctx<'_>) {
        self.change_paths(
            |plan| {
                let mut regions = plan.keep_out.to_vec();
                change(&mut regions);
                plan.keep_out = regions.into();
            },
            ctx,
        );
    }
}

fn plan<'a>(ctx: &'a Ctx<'_>) -> &'a PathPlan {
    &ctx.session.document().settings().paths
}

/// Returns the formula that is equal to weights.
fn formula_of(Weights { length, risk }: Weights) -> CostFormula {
    CostFormula::parse(&format!("{length} + {risk}*risk"))
        .expect("a sum of numbers and the risk is a formula")
}
