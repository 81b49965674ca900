//! Runs the commands about the domain.

use super::load::{
    DomainPlane, choose_plane, load_area_of_values, load_contour, load_domain, load_first, load_outline,
    load_sea,
};
use super::{
    DOMAIN, DOMAIN_PANEL, DomainCommand, DomainEditor, FIT, OPEN_DOMAIN, OutlineChange, ROLES, entries,
};
use crate::app::features::domain::DomainTool;
use glam::DVec2;
use meshbrush_core::document::Drawing;
use meshbrush_core::domain::CutShape;
use meshbrush_kit::kit::{Ctx, Feature, Row};

impl Feature for DomainEditor {
    type Command = DomainCommand;
    const ROW: Row = Row {
        tools: &[&DOMAIN],
        files: &[&OPEN_DOMAIN],
        roles: &ROLES,
        panels: &[&DOMAIN_PANEL, &FIT],
        entries: entries::entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: DomainCommand, ctx: &mut Ctx<'_>) {
        let tool = ctx.tools.settings_mut::<DomainTool>();
        match command {
            DomainCommand::Reshape(cut_shape, adds) => reshape(cut_shape, adds, ctx),
            DomainCommand::Fill(point, adds) => fill(point, adds, ctx),
            DomainCommand::AddCorner(corner) => tool.corners.push(corner),
            DomainCommand::MoveCorner(index, corner) => {
                if let Some(place) = tool.corners.get_mut(index) {
                    *place = corner;
                }
            }
            DomainCommand::RemoveCorner => {
                tool.corners.pop();
            }
            DomainCommand::ClosePolygon => close_polygon(ctx),
            DomainCommand::Mode(mode) => {
                ctx.tools.select(&DOMAIN);
                ctx.tools.settings_mut::<DomainTool>().mode = mode;
            }
            DomainCommand::Adds(adds) => tool.adds = adds,
            DomainCommand::Choose(path) => choose_plane(ctx.background, &path),
            DomainCommand::OpenFirst(path) => load_first(ctx.background, &path),
            DomainCommand::Open(path) => load_domain(ctx.background, &path, DomainPlane::OfFile),
            DomainCommand::OpenInMetres(path) => {
                load_domain(ctx.background, &path, DomainPlane::Metres);
            }
            DomainCommand::OpenSea(path) => load_sea(ctx.background, &path),
            DomainCommand::AddOutline(path) => {
                load_outline(ctx.session, ctx.background, &path);
            }
            DomainCommand::UseContour(layer, contour) => {
                load_contour(ctx.session, ctx.background, layer, contour)
            }
            DomainCommand::UseValues(layer) => load_area_of_values(ctx.session, ctx.background, layer),
            DomainCommand::SetOutline(change) => set_outline(*change, ctx),
            DomainCommand::Bounds(bounds) => {
                ctx.session.set_bounds(bounds);
                ctx.tools.note_use(&DOMAIN);
            }
        }
    }

    fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool {
        !std::mem::take(&mut ctx.tools.settings_mut::<DomainTool>().corners).is_empty()
    }
}

fn set_outline(change: OutlineChange, ctx: &mut Ctx<'_>) {
    let OutlineChange { name, before, setting, news } = change;
    let settings = ctx.session.document().settings();
    if settings.domain != before || ctx.session.is_cutting() {
        let problem = "was not added, as the domain was edited in the meantime. Add it again.";
        return ctx.session.report(format!("{name} {problem}"));
    }
    ctx.session.end_gesture();
    ctx.session.set(setting);
    ctx.session.end_gesture();
    let settings = ctx.session.document().settings();
    if settings.domain != before {
        let grows = settings.domain.bounds != before.bounds;
        let frame = if grows { " The frame grew to hold it." } else { "" };
        let added = || format!("The outline {name} was added to the domain.{frame}");
        ctx.session.tell(news.unwrap_or_else(added));
        ctx.view.camera = ctx.view.camera.filter(|_| !grows);
    }
}

fn reshape(cut_shape: CutShape, adds: bool, ctx: &mut Ctx<'_>) {
    ctx.session.reshape(cut_shape, adds);
    ctx.tools.note_use(&DOMAIN);
}

/// Adds the hole of the domain around a point, or removes its part there; says why not.
fn fill(point: DVec2, adds: bool, ctx: &mut Ctx<'_>) {
    let drawing = Drawing::Domain(ctx.session.document().settings().domain.clone());
    match drawing.fill_at(point, adds) {
        Some(area) => {
            reshape(area, adds, ctx);
            ctx.session.end_gesture();
        }
        None if adds => ctx.session.tell("Nothing was added: this place is in no hole of the domain.".into()),
        None => ctx.session.tell("Nothing was removed: the domain has no part here.".into()),
    }
}

fn close_polygon(ctx: &mut Ctx<'_>) {
    if ctx.tools.settings::<DomainTool>().corners.len() < 3 {
        return ctx.session.tell("A polygon needs three corners: click to set another one.".into());
    }
    let ring = std::mem::take(&mut ctx.tools.settings_mut::<DomainTool>().corners);
    reshape(CutShape::Ring(ring), ctx.tools.settings::<DomainTool>().adds, ctx);
    ctx.session.end_gesture();
}
