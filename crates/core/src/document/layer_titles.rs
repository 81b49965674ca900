//! Names of changes of the layers, for the history.

use crate::layers::Layer;

/// Returns a title of one or two words for the change of a stack of layers; "layers" for several changes.
pub(super) fn layers_title(before: &[Layer], after: &[Layer]) -> &'static str {
    let has = |layers: &[Layer], layer: &Layer| layers.iter().any(|other| other.id == layer.id);
    let adds = !after.iter().all(|layer| has(before, layer));
    let deletes = !before.iter().all(|layer| has(after, layer));
    match (adds, deletes) {
        (true, false) => return "add layer",
        (false, true) => return "delete layer",
        (true, true) => return "layers",
        (false, false) => {}
    }
    let pairs = || before.iter().zip(after);
    if pairs().any(|(before, after)| before.id != after.id) {
        return "move layer";
    }
    let mut changed = pairs().filter(|(before, after)| before != after);
    match (changed.next(), changed.next()) {
        (Some((before, after)), None) => layer_title(before, after),
        _ => "layers",
    }
}

/// Returns a title for the change of one layer.
fn layer_title(before: &Layer, after: &Layer) -> &'static str {
    let changes = [
        (before.name != after.name, "rename layer"),
        (before.visible != after.visible, if after.visible { "show layer" } else { "hide layer" }),
        (before.locked != after.locked, if after.locked { "lock layer" } else { "unlock layer" }),
        (before.combine != after.combine, "layer combination"),
        (before.mask != after.mask, if after.mask.is_some() { "mask layer" } else { "remove mask" }),
        (before.kind != after.kind, after.kind.change_title()),
    ];
    let mut changes = changes.into_iter().filter(|(is_changed, _)| *is_changed);
    match (changes.next(), changes.next()) {
        (Some((_, title)), None) => title,
        _ => "layer",
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::layers::{Combine, DistanceLayer, DistanceTo, LayerId, LayerKind, Mask, Quantity, Threats};

    fn title(edit: impl FnOnce(&mut Vec<Layer>)) -> &'static str {
        let before = Layer::default_stack(LayerKind::constant(0.2));
        let mut after = before.clone();
        edit(&mut after);
        layers_title(&before, &after)
    }

    #[test]
    fn changes_of_the_stack_are_named() {
        let another = || Layer::new(LayerId(9), "Another", LayerKind::constant(0.1));
        assert_eq!(title(|layers| layers.insert(1, another())), "add layer");
        assert_eq!(title(|layers| drop(layers.remove(1))), "delete layer");
        assert_eq!(title(|layers| layers.rotate_left(1)), "move layer");
        assert_eq!(title(|layers| layers[0] = another()), "layers");
        assert_eq!(title(|layers| layers.iter_mut().for_each(|layer| layer.visible = false)), "layers");
    }

    #[test]
    fn changes_of_a_layer_are_named() {
        assert_eq!(title(|layers| layers[1].name = "Sea".into()), "rename layer");
        assert_eq!(title(|layers| layers[1].visible = false), "hide layer");
        assert_eq!(title(|layers| layers[1].locked = true), "lock layer");
        assert_eq!(title(|layers| layers[1].combine = Combine::Floor), "layer combination");
        let corners = vec![dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)];
        let mask = Mask::new(&[vec![corners]]).unwrap();
        assert_eq!(title(|layers| layers[1].mask = Some(mask)), "mask layer");
        let both = |layers: &mut Vec<Layer>| {
            layers[1].visible = false;
            layers[1].name = "Sea".into();
        };
        assert_eq!(title(both), "layer");
    }

    #[test]
    fn changes_back_are_named_too() {
        let mut before = Layer::stack([LayerKind::constant(0.2)]);
        let after = before.clone();
        before[0].visible = false;
        assert_eq!(layers_title(&before, &after), "show layer");
        before[0] = Layer { locked: true, ..after[0].clone() };
        assert_eq!(layers_title(&before, &after), "unlock layer");
        let corners = vec![dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)];
        let mask = Some(Mask::new(&[vec![corners]]).unwrap());
        before[0] = Layer { mask, ..after[0].clone() };
        assert_eq!(layers_title(&before, &after), "remove mask");
    }

    #[test]
    fn changes_of_what_a_layer_asks_for_have_the_name_of_its_kind() {
        let to = DistanceTo::Outline;
        let distance = LayerKind::Distance(DistanceLayer { to, at_zero: 0.1, slope: 0.3, range: 1.0 });
        for (kind, expected) in [
            (LayerKind::constant(0.3), "formula"),
            (LayerKind::Threats(Threats::default()), "threats"),
            (LayerKind::paint(Quantity::Risk), "paint layer"),
            (distance, "distance"),
        ] {
            assert_eq!(title(|layers| layers[0].kind = kind), expected);
        }
    }
}
