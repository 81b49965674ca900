//! The keys of commands, for tooltips and hints: the key that is shown is the key that works.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Context, Id};

/// The keys of entries, by id; entries without a key are missing.
type KeysByEntry = Arc<BTreeMap<String, String>>;

fn id() -> Id {
    Id::unique("keys of entries")
}

/// Says which keys entries have, from now on.
pub fn publish(ctx: &Context, keys: BTreeMap<String, String>) {
    ctx.data_mut(|data| data.insert_temp::<KeysByEntry>(id(), Arc::new(keys)));
}

/// Returns the key of an entry, by its id.
pub(super) fn key_of(ctx: &Context, entry: &str) -> Option<String> {
    ctx.data(|data| data.get_temp::<KeysByEntry>(id())).and_then(|keys| keys.get(entry).cloned())
}

/// Replaces entries in braces by their keys: `Removes it[; {delete} does so too].` What is in brackets is
/// left out where an entry in it has no key.
pub fn with_keys<'a>(ctx: &Context, text: &'a str) -> Cow<'a, str> {
    if !text.contains('{') {
        return Cow::Borrowed(text);
    }
    let mut result = String::new();
    for part in text.split('[') {
        match part.split_once(']') {
            Some((inside, after)) => {
                result += &filled(ctx, inside).unwrap_or_default();
                result += after;
            }
            None => result += part,
        }
    }
    Cow::Owned(result)
}

/// Returns the text with keys in place of entries, or `None` where one has no key.
fn filled(ctx: &Context, text: &str) -> Option<String> {
    let mut result = String::new();
    for part in text.split('{') {
        match part.split_once('}') {
            Some((entry, after)) => {
                result += &key_of(ctx, entry)?;
                result += after;
            }
            None => result += part,
        }
    }
    Some(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clause_without_a_key_is_left_out() {
        let ctx = Context::default();
        publish(&ctx, BTreeMap::from([("undo".to_owned(), "Ctrl+Z".to_owned())]));
        assert_eq!(with_keys(&ctx, "Takes it back[; {undo}]."), "Takes it back; Ctrl+Z.");
        assert_eq!(with_keys(&ctx, "Does it again[; {redo}]."), "Does it again.");
        assert_eq!(with_keys(&ctx, "Between [0 and 1]."), "Between [0 and 1].");
    }
}
