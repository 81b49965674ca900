//! Brushes that a person keeps under a name.

use super::{BrushMode, KeptBrush, PaintKind, PenResponse, Tools};

/// A brush under a name. What it is does not depend on a document: lengths are shares of the longer side of
/// the domain.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushPreset {
    /// The name.
    pub name: String,
    /// What it paints, and how; `None` where it leaves that as it is.
    paint: Option<(PaintKind, BrushMode)>,
    /// Radius, strengths, hardness, risk and smoothing.
    brush: KeptBrush,
    /// The diameter that it paints, as a share of the longer side of the domain; `None` where it leaves that
    /// as it is.
    diameter: Option<f64>,
    /// What the pressure of a pen changes.
    pen: PenResponse,
}

/// A preset as it is stored: name, kind of paint and mode by their names (both empty for none), the settings
/// of the brush, the diameter, and the pen as [`KeptPen`].
pub type KeptPreset = (String, [String; 2], KeptBrush, Option<f64>, KeptPen);
/// The response to a pen as it is stored: whether it changes radius and strength, and the exponent.
pub type KeptPen = (bool, bool, f64);

/// Greatest number of presets: a list that can be overlooked.
pub const MOST_PRESETS: usize = 24;
/// Greatest length of a name, in characters.
const LONGEST_NAME: usize = 40;

/// The kinds of paint by their names in the storage.
const KINDS: [(PaintKind, &str); 3] =
    [(PaintKind::Risk, "risk"), (PaintKind::Diameter, "diameter"), (PaintKind::Error, "error")];

impl BrushPreset {
    /// Returns the presets that there are at first.
    pub fn first() -> Vec<Self> {
        let tip = |name: &str, radius, strength, hardness| Self {
            name: name.to_owned(),
            paint: None,
            brush: [radius, strength, 1.0, hardness, 0.5, 0.0],
            diameter: None,
            pen: PenResponse::default(),
        };
        vec![
            tip("Broad and soft", 0.12, 0.4, 0.0),
            tip("Hard edge", 0.06, 1.0, 1.0),
            tip("Fine tip", 0.01, 0.8, 0.6),
        ]
    }

    /// Returns the preset as it is stored.
    pub fn kept(&self) -> KeptPreset {
        let name_of = |kind| KINDS.iter().find(|(known, _)| *known == kind).map_or("", |(_, name)| name);
        let mode_of =
            |mode| BrushMode::ALL.iter().find(|(known, _)| *known == mode).map_or("", |(_, name)| name);
        let paint = self.paint.map_or(["", ""], |(kind, mode)| [name_of(kind), mode_of(mode)]);
        (self.name.clone(), paint.map(str::to_owned), self.brush, self.diameter, kept_pen(&self.pen))
    }

    /// Returns a preset that was stored; `None` where it has a value that no brush has.
    pub fn of_kept((name, [kind, mode], brush, diameter, pen): KeptPreset) -> Option<Self> {
        let kind = KINDS.iter().find(|(_, known)| *known == kind).map(|(kind, _)| *kind);
        let mode = BrushMode::ALL.iter().find(|(_, known)| *known == mode).map(|(mode, _)| *mode);
        let is_brush = Tools::is_brush(&brush) && diameter.is_none_or(|share| share > 0.0 && share <= 1.0);
        let pen = pen_of_kept(pen)?;
        let name = tidy(&name)?;
        is_brush.then_some(Self { name, paint: kind.zip(mode), brush, diameter, pen })
    }

    /// Returns whether the brush of `own`, which leaves nothing open, is this one; names do not count.
    /// Lengths are shares that were multiplied and divided again.
    fn is_same_brush(&self, own: &Self) -> bool {
        let is_same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a;
        let has_diameter = || self.diameter.zip(own.diameter).is_none_or(|(a, b)| is_same(a, b));
        let has_amounts = || self.brush.iter().zip(&own.brush).all(|(&a, &b)| is_same(a, b));
        let has_paint = self.paint.is_none() || self.paint == own.paint;
        has_paint && self.pen == own.pen && has_diameter() && has_amounts()
    }
}

/// Returns a response to a pen as it is stored.
pub fn kept_pen(pen: &PenResponse) -> KeptPen {
    (pen.changes_radius, pen.changes_strength, pen.exponent)
}

/// Returns a response to a pen that was stored; `None` where no curve has its exponent.
pub fn pen_of_kept((changes_radius, changes_strength, exponent): KeptPen) -> Option<PenResponse> {
    let is_known = PenResponse::EXPONENTS.contains(&exponent);
    is_known.then_some(PenResponse { changes_radius, changes_strength, exponent })
}

/// Returns a name without what no line of a list can show; `None` where nothing is left.
fn tidy(name: &str) -> Option<String> {
    let shown: String = name.trim().chars().filter(|c| !c.is_control()).take(LONGEST_NAME).collect();
    (!shown.is_empty()).then_some(shown)
}

impl Tools {
    /// Returns the presets, in the order in which they were kept.
    pub fn presets(&self) -> &[BrushPreset] {
        &self.presets
    }

    /// Takes the presets of another run of the program.
    pub fn take_presets(&mut self, presets: Vec<BrushPreset>) {
        self.presets = presets;
        self.presets.truncate(MOST_PRESETS);
    }

    /// Returns the number of the preset that the brush is now.
    pub fn chosen_preset(&self) -> Option<usize> {
        let own = self.as_preset(String::new());
        self.presets.iter().position(|preset| preset.is_same_brush(&own))
    }

    /// Makes the brush that of a preset. A number without a preset changes nothing.
    pub fn use_preset(&mut self, number: usize) {
        let Some(preset) = self.presets.get(number).cloned() else { return };
        if let Some((kind, mode)) = preset.paint {
            (self.kind, self.mode) = (kind, mode);
        }
        self.take_brush(preset.brush);
        if let Some(share) = preset.diameter {
            self.diameter = share * self.extent;
        }
        self.pen.response = preset.pen;
    }

    /// Keeps the brush under a name that says what it is, after the other presets. Returns whether there was
    /// room for it.
    pub fn keep_preset(&mut self) -> bool {
        let has_room = self.presets.len() < MOST_PRESETS;
        if has_room {
            let names: Vec<&str> = self.presets.iter().map(|preset| &*preset.name).collect();
            let free = (1..).map(|number| format!("Brush {number}")).find(|name| !names.contains(&&**name));
            let preset = self.as_preset(free.unwrap_or_default());
            self.presets.push(preset);
        }
        has_room
    }

    /// Gives a preset another name. An empty name changes nothing.
    pub fn rename_preset(&mut self, number: usize, name: &str) {
        if let Some((preset, name)) = self.presets.get_mut(number).zip(tidy(name)) {
            preset.name = name;
        }
    }

    /// Removes a preset. The brush stays as it is.
    pub fn remove_preset(&mut self, number: usize) {
        if number < self.presets.len() {
            self.presets.remove(number);
        }
    }

    fn as_preset(&self, name: String) -> BrushPreset {
        BrushPreset {
            name,
            paint: Some((self.kind, self.mode)),
            brush: self.kept_brush(),
            diameter: Some(self.diameter / self.extent),
            pen: self.pen.response,
        }
    }
}
