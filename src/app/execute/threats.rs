//! Commands about the threats of the selected layer.

use glam::DVec2;

use crate::app::App;
use crate::app::command::{Command, LayerCommand, ThreatsCommand};
use crate::app::layer_files;
use crate::app::notices::Offer;
use crate::app::tools::{THREATS, ThreatGrip, ThreatsTool, grip_at};
use meshbrush_core::layers::{Layer, LayerId, LayerKind, Threat, ThreatLaw, Threats};

/// Range of the first threat, as a share of the longer side of the domain.
const USUAL_RANGE: f64 = 0.15;
/// Peak of the first threat.
const USUAL_PEAK: f64 = 0.8;

impl App {
    pub(super) fn execute_on_threats(&mut self, command: ThreatsCommand) {
        match command {
            ThreatsCommand::Press { at, reach, places } => self.press_threats(at, reach, places),
            ThreatsCommand::DragTo(to) => self.drag_threat(to),
            ThreatsCommand::Place(at) => {
                self.place_threat(at);
                self.session.end_gesture();
            }
            ThreatsCommand::Select(number) => self.select_threat(number),
            ThreatsCommand::Delete => self.delete_threat(),
            ThreatsCommand::Open(path) => {
                layer_files::load_threats(&self.session, &mut self.background, &path);
            }
            ThreatsCommand::SaveAs(path) => {
                let save = |path| Command::Threats(ThreatsCommand::Save(path));
                self.commands.extend(self.project.save_table_as(path, save));
            }
            ThreatsCommand::Save(path) => {
                layer_files::save_threats(&self.session, &mut self.background, &path);
            }
        }
    }

    /// Takes hold of what is at a point, or places a threat there. A drag from there sets its range.
    fn press_threats(&mut self, at: DVec2, reach: f64, places: bool) {
        self.tools.threats.grip = None;
        let Some((layer, threats)) = self.editable_threats() else { return };
        match grip_at(threats.list(), at, reach).filter(|_| !places) {
            Some((number, grip)) => {
                self.tools.threats.selected = Some((layer, number));
                self.tools.threats.grip = Some(grip);
            }
            None => {
                self.place_threat(at);
                self.tools.threats.grip = Some(ThreatGrip::Ring);
            }
        }
        self.tools.note_use(&THREATS);
    }

    fn drag_threat(&mut self, to: DVec2) {
        let Some(grip) = self.tools.threats.grip else { return };
        let document = self.session.document();
        let Some(number) = self.tools.threats.selected_in(document) else { return };
        let Some((Layer { id, .. }, threats)) = ThreatsTool::layer(document) else { return };
        let (id, mut threats) = (*id, threats.clone());
        let before = threats.list()[number];
        let threat = match grip {
            ThreatGrip::Middle(offset) => Threat { at: to + offset, ..before },
            // At the middle there is no ring: the last one stays.
            ThreatGrip::Ring if to == before.at => return,
            ThreatGrip::Ring => Threat { range: to.distance(before.at), ..before },
        };
        match threats.set(number, threat) {
            Ok(()) => self.set_threats(id, threats),
            Err(error) => self.session.report(error.to_string()),
        }
    }

    /// Adds a threat like the selected one, and selects it. Further edits join the gesture.
    fn place_threat(&mut self, at: DVec2) {
        let Some((id, threats)) = self.editable_threats() else { return };
        let document = self.session.document();
        let extent = document.settings().domain.bounds.size().max_element();
        let usual = Threat { at, range: USUAL_RANGE * extent, peak: USUAL_PEAK, law: ThreatLaw::default() };
        let selected = self.tools.threats.selected_in(document).map(|number| threats.list()[number]);
        let threat = Threat { at, ..selected.unwrap_or(usual) };
        let list = threats.list().iter().copied().chain([threat]).collect();
        self.session.end_gesture();
        self.replace_threats(id, list);
        self.tools.threats.selected = Some((id, threats.list().len()));
    }

    fn select_threat(&mut self, number: usize) {
        let Some((layer, threats)) = ThreatsTool::layer(self.session.document()) else { return };
        let Some(threat) = threats.list().get(number) else { return };
        self.tools.threats.selected = Some((layer.id, number));
        self.view.reveal(threat.at);
    }

    fn delete_threat(&mut self) {
        let Some(number) = self.tools.threats.selected_in(self.session.document()) else { return };
        let Some((id, threats)) = self.editable_threats() else { return };
        let mut list = threats.list().to_vec();
        list.remove(number);
        self.session.end_gesture();
        self.replace_threats(id, list);
        self.session.end_gesture();
        self.tools.threats.selected = None;
    }

    /// The threats of the selected layer; they share their data. Where they cannot be edited, says why and
    /// offers what would help.
    fn editable_threats(&mut self) -> Option<(LayerId, Threats)> {
        let (problem, label, command) = match ThreatsTool::layer(self.session.document()) {
            Some((layer, threats)) if !layer.locked => return Some((layer.id, threats.clone())),
            Some((layer, _)) => {
                let problem =
                    format!("The layer \"{}\" is locked, so its threats stay as they are.", layer.name);
                (problem, "Unlock the layer", LayerCommand::Lock(layer.id, false))
            }
            None => {
                let problem = "The selected layer has no threats: select or add a layer of threats.";
                let add = LayerCommand::Add(Box::new(LayerKind::Threats(Threats::default())));
                (problem.to_owned(), "Add a layer of threats", add)
            }
        };
        let offer = Offer { label, command: Command::Layer(command) };
        self.session.notices_mut().report_with_offer(problem, offer);
        None
    }

    fn replace_threats(&mut self, id: LayerId, list: Vec<Threat>) {
        match Threats::new(list) {
            Ok(threats) => self.set_threats(id, threats),
            Err((_, error)) => self.session.report(error.to_string()),
        }
    }

    fn set_threats(&mut self, id: LayerId, threats: Threats) {
        self.set_kind(id, LayerKind::Threats(threats));
    }
}
