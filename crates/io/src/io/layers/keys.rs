//! Which keys a layer may have, by its kind: for advice that can be followed.

use serde::Deserialize;

use super::SavedKind;
use crate::io::{KeyFault, TextValue};

/// The keys of all kinds.
const COMMON: [&str; 7] = ["kind", "name", "visible", "locked", "combine", "mask", "mask_file"];

/// Checks that a table of a layer has no key that no layer has. The advice names keys of its own kind.
///
/// # Errors
/// Fails with the first such key.
pub fn check_keys(layer: &TextValue) -> Result<(), KeyFault> {
    let TextValue::Table(table) = layer else { return Ok(()) };
    let kind = table.iter().find(|(key, _)| key == "kind");
    let Some(kind) = kind.and_then(|(_, word)| SavedKind::deserialize(word).ok()) else { return Ok(()) };
    let is_known = |key: &str| COMMON.contains(&key) || !kinds_with(key).is_empty();
    let Some((key, _)) = table.iter().find(|(key, _)| !is_known(key)) else { return Ok(()) };
    let known: Vec<&str> = COMMON.iter().chain(kind.keys()).copied().collect();
    Err(KeyFault::unknown_key(key, &known).of_key(key))
}

/// Checks the tables of a text that is a whole document, as [`check_keys`] does.
///
/// # Errors
/// Fails with the first key that no layer has.
pub fn check_keys_of_all(tables: &TextValue) -> Result<(), KeyFault> {
    let TextValue::Table(tables) = tables else { return Ok(()) };
    let Some((_, TextValue::List(layers))) = tables.iter().find(|(key, _)| key == "layer") else {
        return Ok(());
    };
    let in_list = |(index, layer)| check_keys(layer).map_err(|fault| fault.within(index).within("layer"));
    layers.iter().enumerate().try_for_each(in_list)
}

/// Returns the kinds that have a key of their own.
pub fn kinds_with(key: &str) -> Vec<&'static str> {
    SavedKind::ALL.into_iter().filter(|kind| kind.keys().contains(&key)).map(SavedKind::word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sentence(kind: &str, key: &str) -> Option<String> {
        let table = vec![
            ("kind".to_owned(), TextValue::Text(kind.to_owned())),
            (key.to_owned(), TextValue::Number(1.0)),
        ];
        let tables = vec![("layer".to_owned(), TextValue::List(vec![TextValue::Table(table)]))];
        check_keys_of_all(&TextValue::Table(tables)).err().map(|fault| fault.to_string())
    }

    #[test]
    fn advice_names_only_keys_that_the_kind_has() {
        let raster = sentence("raster", "boundz").unwrap();
        assert!(raster.starts_with("layer 1, boundz: there is no key `boundz` here"), "{raster}");
        assert!(raster.ends_with("did you mean `bounds`?"), "{raster}");
        let formula = sentence("formula", "boundz").unwrap();
        assert!(
            formula.ends_with(
                "the keys here are kind, name, visible, locked, combine, mask, mask_file, quantity, formula."
            ),
            "{formula}"
        );
        assert!(sentence("straits", "width").is_none(), "a key of another kind has a sentence of its own");
        for kind in SavedKind::ALL {
            for key in kind.keys().iter().chain(&COMMON) {
                assert_eq!(sentence(kind.word(), key), None);
                let wrong = sentence(kind.word(), &format!("{key}z"));
                let Some((_, advice)) = wrong.as_deref().and_then(|wrong| wrong.split_once("did you mean `"))
                else {
                    continue;
                };
                let advice = advice.trim_end_matches("`?");
                assert!(kind.keys().contains(&advice) || COMMON.contains(&advice), "{kind:?}: {advice}");
            }
        }
    }
}
