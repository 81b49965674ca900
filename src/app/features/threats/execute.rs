//! What the commands about threats do.

use glam::DVec2;

use super::table::{load_threats, save_threats};
use super::tool::grip_at;
use super::{ROLES, THREATS, THREATS_KIND, ThreatEditor, ThreatGrip, ThreatsCommand, entries, threats_layer};
use meshbrush_core::layers::{Layer, LayerId, LayerKind, Threat, ThreatLaw, Threats};
use meshbrush_kit::kit::command::{Command, LayerCommand};
use meshbrush_kit::kit::notices::Offer;
use meshbrush_kit::kit::{Ctx, Feature, Row};

/// Range of the first threat, as a share of the longer side of the domain.
const DEFAULT_RANGE: f64 = 0.15;
/// Peak of the first threat.
const DEFAULT_PEAK: f64 = 0.8;

impl Feature for ThreatEditor {
    type Command = ThreatsCommand;
    const ROW: Row = Row {
        tools: &[&THREATS],
        layer_kinds: &[&THREATS_KIND],
        roles: &ROLES,
        entries: entries::entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: ThreatsCommand, ctx: &mut Ctx<'_>) {
        match command {
            ThreatsCommand::Press { at, reach, places } => self.press(at, reach, places, ctx),
            ThreatsCommand::DragTo(to) => self.drag(to, ctx),
            ThreatsCommand::Place(at) => {
                self.place(at, ctx);
                ctx.session.end_gesture();
            }
            ThreatsCommand::Select(number) => self.select(number, ctx),
            ThreatsCommand::Delete => self.delete(ctx),
            ThreatsCommand::Open(path) => load_threats(ctx.session, ctx.background, &path),
            ThreatsCommand::SaveAs(path) => {
                let save = |path| Command::from(ThreatsCommand::Save(path));
                ctx.commands.extend(ctx.project.save_table_as(path, save));
            }
            ThreatsCommand::Save(path) => save_threats(ctx.session, ctx.background, &path),
        }
    }
}

impl ThreatEditor {
    /// Takes hold of what is at a point, or places a threat there. A drag from there sets its range.
    fn press(&mut self, at: DVec2, reach: f64, places: bool, ctx: &mut Ctx<'_>) {
        self.grip = None;
        let Some((layer, threats)) = editable_threats(ctx) else { return };
        match grip_at(threats.list(), at, reach).filter(|_| !places) {
            Some((number, grip)) => {
                self.selected = Some((layer, number));
                self.grip = Some(grip);
            }
            None => {
                self.place(at, ctx);
                self.grip = Some(ThreatGrip::Ring);
            }
        }
        ctx.tools.note_use(&THREATS);
    }

    fn drag(&mut self, to: DVec2, ctx: &mut Ctx<'_>) {
        let Some(grip) = self.grip else { return };
        let document = ctx.session.document();
        let Some(number) = self.selected_in(document) else { return };
        let Some((Layer { id, .. }, threats)) = threats_layer(document) else { return };
        let (id, mut threats) = (*id, threats.clone());
        let before = threats.list()[number];
        let threat = match grip {
            ThreatGrip::Middle(offset) => Threat { at: to + offset, ..before },
            // At the middle there is no ring: the last one stays.
            ThreatGrip::Ring if to == before.at => return,
            ThreatGrip::Ring => Threat { range: to.distance(before.at), ..before },
        };
        match threats.set(number, threat) {
            Ok(()) => ctx.session.set_layer_kind(id, threats),
            Err(error) => ctx.session.report(error.to_string()),
        }
    }

    /// Adds a threat like the selected one, and selects it. Further edits join the gesture.
    fn place(&mut self, at: DVec2, ctx: &mut Ctx<'_>) {
        let Some((id, threats)) = editable_threats(ctx) else { return };
        let document = ctx.session.document();
        let extent = document.settings().domain.bounds.size().max_element();
        let default =
            Threat { at, range: DEFAULT_RANGE * extent, peak: DEFAULT_PEAK, law: ThreatLaw::default() };
        let selected = self.selected_in(document).map(|number| threats.list()[number]);
        let threat = Threat { at, ..selected.unwrap_or(default) };
        let list = threats.list().iter().copied().chain([threat]).collect();
        ctx.session.end_gesture();
        replace_threats(id, list, ctx);
        self.selected = Some((id, threats.list().len()));
    }

    fn select(&mut self, number: usize, ctx: &mut Ctx<'_>) {
        let Some((layer, threats)) = threats_layer(ctx.session.document()) else { return };
        let Some(threat) = threats.list().get(number) else { return };
        self.selected = Some((layer.id, number));
        ctx.view.reveal(threat.at);
    }

    fn delete(&mut self, ctx: &mut Ctx<'_>) {
        let Some(number) = self.selected_in(ctx.session.document()) else { return };
        let Some((id, threats)) = editable_threats(ctx) else { return };
        let mut list = threats.list().to_vec();
        list.remove(number);
        ctx.session.end_gesture();
        replace_threats(id, list, ctx);
        ctx.session.end_gesture();
        self.selected = None;
    }
}

/// The threats of the selected layer; they share their data. Where they cannot be edited, says why and
/// offers what would help.
fn editable_threats(ctx: &mut Ctx<'_>) -> Option<(LayerId, Threats)> {
    let (problem, label, command) = match threats_layer(ctx.session.document()) {
        Some((layer, threats)) if !layer.locked => return Some((layer.id, threats.clone())),
        Some((layer, _)) => {
            let problem = format!("The layer \"{}\" is locked, so its threats stay as they are.", layer.name);
            (problem, "Unlock the layer", LayerCommand::Lock(layer.id, false))
        }
        None => {
            let problem = "The selected layer has no threats: select or add a layer of threats.";
            let add = LayerCommand::Add(Box::new(LayerKind::Threats(Threats::default())));
            (problem.to_owned(), "Add a layer of threats", add)
        }
    };
    let offer = Offer { label, command: Command::from(command) };
    ctx.session.notices_mut().report_with_offer(problem, offer);
    None
}

fn replace_threats(id: LayerId, list: Vec<Threat>, ctx: &mut Ctx<'_>) {
    match Threats::new(list) {
        Ok(threats) => ctx.session.set_layer_kind(id, threats),
        Err((_, error)) => ctx.session.report(error.to_string()),
    }
}
