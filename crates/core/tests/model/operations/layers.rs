//! Changes of the stack of layers.

use meshbrush_core::document::{Document, Setting};
use meshbrush_core::layers::{Combine, Layer, LayerKind, Mask};

use super::kinds::{layer_kind, mask, small_constant, tweaked};
use super::{Bytes, Choices, Operation, Scale};

/// A change of the stack of layers. Layers are counted from the bottom, round and round.
#[derive(Clone, Debug)]
pub enum LayerEdit {
    Add(Box<LayerKind>, Combine),
    Delete(usize),
    /// Moves one to the place of another.
    Move(usize, usize),
    Show(usize, bool),
    Combine(usize, Combine),
    /// Adds one that counts in a mask only.
    AddMasked(Box<LayerKind>, Combine, Mask),
    /// Gives a layer of numbers others.
    Replace(usize, Box<LayerKind>),
    /// Changes one number, as the drag of a control does. The choices are bytes, as they depend on the layer.
    Tweak(usize, Vec<u8>, Scale),
    Mask(usize, Option<Mask>),
    Rename(usize),
    /// The brush paints on it from now on, if it can.
    Activate(usize),
}

impl LayerEdit {
    pub fn choose(choices: &mut impl Choices, scale: Scale) -> Self {
        let place = choices.below(8);
        match choices.below(18) {
            0..3 => Self::Add(Box::new(layer_kind(choices, scale)), combine(choices)),
            3 | 4 => match (small_constant(choices, scale), mask(choices, scale)) {
                (kind, Some(mask)) => Self::AddMasked(Box::new(kind), combine(choices), mask),
                (_, None) => Self::Delete(place),
            },
            5 => Self::Delete(place),
            6 => Self::Move(place, choices.below(8)),
            7 | 8 => Self::Show(place, choices.below(3) > 0),
            9 => Self::Combine(place, combine(choices)),
            10 => Self::Replace(place, Box::new(layer_kind(choices, scale))),
            11..15 => Self::Tweak(place, (0..12).map(|_| choices.below(256) as u8).collect(), scale),
            15 => {
                let mask = if choices.below(3) == 0 { None } else { mask(choices, scale) };
                Self::Mask(place, mask)
            }
            16 => Self::Rename(place),
            _ => Self::Activate(place),
        }
    }

    pub fn apply(self, document: &mut Document) {
        let mut layers = document.settings().layers.clone();
        let count = layers.len().max(1);
        match self {
            // More layers say no more, and take longer.
            Self::Add(..) | Self::AddMasked(..) if count > 6 => return,
            Self::Add(kind, combine) => {
                let id = document.unused_layer_id();
                layers.push(Layer { combine, ..Layer::new(id, kind.label(), *kind) });
            }
            Self::AddMasked(kind, combine, mask) => {
                let id = document.unused_layer_id();
                layers.push(Layer { combine, mask: Some(mask), ..Layer::new(id, kind.label(), *kind) });
            }
            Self::Move(from, to) if !layers.is_empty() => {
                let layer = layers.remove(from % count);
                layers.insert(to % count, layer);
            }
            Self::Delete(place) if !layers.is_empty() => _ = layers.remove(place % count),
            Self::Activate(place) => {
                return layers
                    .get(place % count)
                    .into_iter()
                    .for_each(|layer| document.activate_layer(layer.id));
            }
            Self::Move(..) | Self::Delete(_) => return,
            Self::Show(place, _)
            | Self::Combine(place, _)
            | Self::Replace(place, _)
            | Self::Tweak(place, ..)
            | Self::Mask(place, _)
            | Self::Rename(place) => {
                let Some(layer) = layers.get_mut(place % count) else { return };
                self.change(layer);
            }
        }
        Operation::Set(Setting::Layers(layers)).apply(document);
    }

    /// Changes one layer. Paint stays paint: it has pixels.
    fn change(self, layer: &mut Layer) {
        match self {
            Self::Show(_, visible) => layer.visible = visible,
            Self::Combine(_, combine) => layer.combine = combine,
            Self::Replace(_, kind) if layer.paints().is_none() && !matches!(*kind, LayerKind::Paint(_)) => {
                layer.kind = *kind
            }
            Self::Tweak(_, bytes, scale) => {
                if let Some(kind) = tweaked(&layer.kind, &mut Bytes(&bytes), scale) {
                    layer.kind = kind;
                }
            }
            Self::Mask(_, mask) => layer.mask = mask,
            Self::Rename(_) => layer.name.push('x'),
            _ => {}
        }
    }
}

fn combine(choices: &mut impl Choices) -> Combine {
    [Combine::Finest, Combine::Finest, Combine::Floor, Combine::Replace][choices.below(4)]
}
