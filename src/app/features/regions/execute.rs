//! Runs the commands about regions drawn by hand.

use std::sync::Arc;

use glam::DVec2;

use super::gestures::GESTURES;
use super::{REGION, RegionCommand, RegionShape, RegionTarget, Regions, entries};
use crate::app::features::regions::RegionTool;
use meshbrush_core::document::{Drawing, DrawnPart, DrawnShape, KeepOut, PathPlan, Setting, Settings};
use meshbrush_core::domain::CutShape;
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer, LayerKind};
use meshbrush_kit::kit::command::{Command, LayerCommand};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::{Ctx, Feature, Row};

impl Feature for Regions {
    type Command = RegionCommand;
    const ROW: Row = Row { tools: &[&REGION], gestures: &GESTURES, entries: entries::entries, ..Row::EMPTY };

    fn execute(&mut self, command: RegionCommand, ctx: &mut Ctx<'_>) {
        let tool = ctx.tools.settings_mut::<RegionTool>();
        match command {
            RegionCommand::Draw(shape, adds) => draw(shape, adds, ctx),
            RegionCommand::Fill(point, adds) => fill(point, adds, ctx),
            RegionCommand::AddCorner(corner) => tool.corners.push(corner),
            RegionCommand::MoveCorner(index, corner) => {
                if let Some(place) = tool.corners.get_mut(index) {
                    *place = corner;
                }
            }
            RegionCommand::RemoveCorner => _ = tool.corners.pop(),
            RegionCommand::Close => close(ctx),
            RegionCommand::Target(target) => {
                tool.target = target;
                // Another part begins with adding to it.
                tool.cuts = false;
                use_tool(ctx);
            }
            RegionCommand::Shape(shape) => {
                tool.chosen_shape = shape;
                use_tool(ctx);
            }
            RegionCommand::Cuts(cuts) => tool.cuts = cuts,
            RegionCommand::KeepOut(number) => tool.keep_out = number,
            RegionCommand::Rename(number, name) => edit_keep_out(ctx, |regions| {
                if let Some(region) = regions.get_mut(number) {
                    region.name =
                        name.chars().filter(|c| !c.is_control()).take(PathPlan::LONGEST_NAME).collect();
                }
            }),
            RegionCommand::Clear => clear(ctx),
        }
    }

    fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool {
        !std::mem::take(&mut ctx.tools.settings_mut::<RegionTool>().corners).is_empty()
    }
}

/// Selects the tool. As with any selection, what was begun for another target or shape is dropped.
fn use_tool(ctx: &mut Ctx<'_>) {
    ctx.tools.select(&REGION);
}

/// Draws a shape on the target of the tool, or says why it has none.
fn draw(shape: DrawnShape, adds: bool, ctx: &mut Ctx<'_>) {
    ctx.tools.note_use(&REGION);
    match part_to_draw_on(&shape, adds, ctx) {
        Ok(Some(part)) => ctx.session.draw(part, shape, adds),
        Ok(None) => add_layer_of(&shape, ctx),
        Err(problem) => ctx.session.report(problem),
    }
}

/// Fills the hole of the target around a point, or cuts away its part there; says why not.
fn fill(point: DVec2, adds: bool, ctx: &mut Ctx<'_>) {
    choose_keep_out_to_fill(point, adds, ctx);
    let part = match part_to_draw_on(&DrawnShape::Point(point), adds, ctx) {
        Ok(part) => part,
        Err(problem) => return ctx.session.report(problem),
    };
    let drawing = part.and_then(|part| part.drawing(ctx.session.document().settings()));
    match drawing.and_then(|drawing| drawing.fill_at(point, adds)) {
        Some(area) => {
            draw(DrawnShape::Area(area), adds, ctx);
            ctx.session.end_gesture();
        }
        None if adds => ctx.session.tell(
            "Nothing was filled: no outline of the region encloses this place. Draw one around it first."
                .into(),
        ),
        None => ctx.session.tell("Nothing was removed: no part of the region is here.".into()),
    }
}

/// Where keep-out regions are filled and none is chosen, chooses the one that can be filled at a point.
fn choose_keep_out_to_fill(point: DVec2, adds: bool, ctx: &mut Ctx<'_>) {
    let settings = ctx.session.document().settings();
    let can_fill = |number: &usize| {
        let drawing = DrawnPart::KeepOut(*number).drawing(settings);
        drawing.is_some_and(|drawing| drawing.fill_at(point, adds).is_some())
    };
    let tool = ctx.tools.settings_mut::<RegionTool>();
    if tool.target == RegionTarget::KeepOut && tool.keep_out.is_none() {
        tool.keep_out = (0..settings.paths.keep_out.len()).find(can_fill);
    }
}

/// Returns the part of the document that the tool draws on; `None` where what is added makes a layer of its
/// own.
fn part_to_draw_on(
    shape: &DrawnShape,
    adds: bool,
    ctx: &mut Ctx<'_>,
) -> Result<Option<DrawnPart>, &'static str> {
    match ctx.tools.settings::<RegionTool>().target {
        RegionTarget::Mask => layer_to_draw_on(ctx.session).map(|layer| Some(DrawnPart::Mask(layer.id))),
        RegionTarget::KeepOut => keep_out_to_draw_on(shape, adds, ctx).map(Some),
        RegionTarget::Shapes => match layer_of_shapes(ctx.session)? {
            Some(layer) => Ok(Some(DrawnPart::Shapes(layer.id))),
            None if adds => Ok(None),
            None => Err("Nothing can be cut: select a layer of the distance to shapes first."),
        },
    }
}

fn layer_to_draw_on(session: &Session) -> Result<&Layer, &'static str> {
    let layer = session.document().active_layer();
    let layer = layer.ok_or("No mask can be drawn: select the layer that it is for first.")?;
    if layer.locked { Err("The selected layer is locked: unlock it to draw its mask.") } else { Ok(layer) }
}

/// Returns the selected layer, if it measures the distance to shapes.
fn layer_of_shapes(session: &Session) -> Result<Option<&Layer>, &'static str> {
    let has_shapes = |layer: &&Layer| {
        matches!(layer.kind.get(), Some(DistanceLayer { to: DistanceTo::Shapes { .. }, .. }))
    };
    match session.document().active_layer().filter(has_shapes) {
        Some(layer) if layer.locked => Err("The selected layer is locked: unlock it to draw its shapes."),
        layer => Ok(layer),
    }
}

/// Returns the chosen keep-out region. What is added to a new one makes it the chosen one; what is cut goes
/// from the region where it begins.
fn keep_out_to_draw_on(shape: &DrawnShape, adds: bool, ctx: &mut Ctx<'_>) -> Result<DrawnPart, &'static str> {
    let regions = &ctx.session.document().settings().paths.keep_out;
    let first = match shape {
        DrawnShape::Area(CutShape::Stroke { path, .. }) => path.first().copied(),
        DrawnShape::Area(CutShape::Ring(ring)) => ring.first().copied(),
        DrawnShape::Line(line) => line.first().copied(),
        DrawnShape::Point(point) => Some(*point),
    };
    // The number after the last one belongs to a region that is on its way to the document.
    let chosen = ctx.tools.settings::<RegionTool>().keep_out.filter(|&number| number < regions.len() || adds);
    let under = || regions.iter().position(|region| first.is_some_and(|first| region.mask.contains(first)));
    let number = match chosen.filter(|&number| number <= regions.len()) {
        Some(number) => number,
        None if adds => regions.len(),
        None => under().or(regions.len().checked_sub(1)).ok_or(NO_KEEP_OUT)?,
    };
    ctx.tools.settings_mut::<RegionTool>().keep_out = Some(number);
    Ok(DrawnPart::KeepOut(number))
}

const NO_KEEP_OUT: &str = "Nothing can be cut: there is no keep-out region yet. Add one first.";

/// Adds a layer of the distance to a shape, above the selected one. Further shapes join the gesture.
fn add_layer_of(shape: &DrawnShape, ctx: &mut Ctx<'_>) {
    let shapes = match Drawing::Shapes(None).edited(shape, true) {
        Ok(Some(Drawing::Shapes(Some(shapes)))) => shapes,
        Ok(_) => return,
        Err(error) => return ctx.session.report(error),
    };
    let to = DistanceTo::Shapes { name: String::new(), shapes };
    let transfer = &ctx.session.document().settings().transfer;
    let kind = LayerKind::distance_to(to, transfer, Settings::DEFAULT_GRADATION);
    let id = ctx.session.insert_layer(kind);
    ctx.session.document_mut().activate_layer(id);
}

/// Closes the polygon, or ends the line, and draws it.
fn close(ctx: &mut Ctx<'_>) {
    let tool = ctx.tools.settings::<RegionTool>();
    let is_line = tool.shape() == RegionShape::Line;
    let (least, problem) = if is_line {
        (2, "A line needs two corners: click to set another one.")
    } else {
        (3, "A polygon needs three corners: click to set another one.")
    };
    if tool.corners.len() < least {
        return ctx.session.tell(problem.into());
    }
    let adds = !tool.cuts;
    let corners = std::mem::take(&mut ctx.tools.settings_mut::<RegionTool>().corners);
    let shape = if is_line { DrawnShape::Line(corners) } else { DrawnShape::Area(CutShape::Ring(corners)) };
    draw(shape, adds, ctx);
    ctx.session.end_gesture();
}

/// Removes the mask of the selected layer, or the chosen keep-out region.
fn clear(ctx: &mut Ctx<'_>) {
    match ctx.tools.settings::<RegionTool>().target {
        RegionTarget::Mask => match layer_to_draw_on(ctx.session).map(|layer| layer.id) {
            Ok(id) => ctx.send(Command::from(LayerCommand::Mask(id, None))),
            Err(problem) => ctx.session.report(problem),
        },
        RegionTarget::KeepOut => {
            let count = ctx.session.document().settings().paths.keep_out.len();
            match ctx.tools.settings_mut::<RegionTool>().keep_out.take().filter(|&number| number < count) {
                Some(number) => edit_keep_out(ctx, |regions| _ = regions.remove(number)),
                None => ctx.session.tell("Choose the keep-out region that is to go first.".into()),
            }
        }
        RegionTarget::Shapes => {}
    }
}

/// Edits the keep-out regions as a gesture of its own.
fn edit_keep_out(ctx: &mut Ctx<'_>, edit: impl FnOnce(&mut Vec<KeepOut>)) {
    let mut plan = (*ctx.session.document().settings().paths).clone();
    let mut regions = plan.keep_out.to_vec();
    edit(&mut regions);
    plan.keep_out = regions.into();
    ctx.session.end_gesture();
    ctx.session.set(Setting::Paths(Arc::new(plan)));
    ctx.session.end_gesture();
}
