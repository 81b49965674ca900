//! The messages of serde and of the TOML parser, as sentences for the writer of a recipe.

use meshbrush_mesh::text::excerpt;

/// What the message is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Context {
    /// The text as TOML.
    Syntax,
    /// Keys and values.
    Values,
}

/// The message as a sentence.
pub fn sentence(message: &str, context: Context) -> String {
    let worded = match context {
        Context::Syntax => None,
        Context::Values => unknown_key(message)
            .or_else(|| unknown_word(message))
            .or_else(|| missing_key(message))
            .or_else(|| wrong_type(message)),
    };
    worded.unwrap_or_else(|| {
        let message = excerpt(300, message.trim());
        match context {
            Context::Syntax => format!("this is not valid TOML: {message}."),
            Context::Values => format!("this cannot be used: {message}."),
        }
    })
}

fn unknown_key(message: &str) -> Option<String> {
    let (key, known) = given_and_possible(message, "unknown field ")?;
    let advice = match nearest(key, &known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the keys here are {}.", known.join(", ")),
    };
    Some(format!("there is no key `{}` here; {advice}", excerpt(40, key)))
}

fn unknown_word(message: &str) -> Option<String> {
    let (word, known) = given_and_possible(message, "unknown variant ")?;
    let advice = match nearest(word, &known) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("write one of {}.", known.join(", ")),
    };
    Some(format!("\"{}\" is not possible here; {advice}", excerpt(40, word)))
}

fn missing_key(message: &str) -> Option<String> {
    let key = message.strip_prefix("missing field `")?.split('`').next()?;
    Some(format!("the key `{key}` is missing here."))
}

/// The word after `prefix`, and the possible ones: all are between backquotes.
fn given_and_possible<'m>(message: &'m str, prefix: &str) -> Option<(&'m str, Vec<&'m str>)> {
    let rest = message.strip_prefix(prefix)?.strip_prefix('`')?;
    // The given one may hold backquotes itself.
    let (given, rest) = rest.rsplit_once("`, expected ")?;
    Some((given, rest.split('`').skip(1).step_by(2).collect()))
}

fn wrong_type(message: &str) -> Option<String> {
    if message == "wanted string or table" {
        return Some("this must be one of the words of this key, in quotation marks.".into());
    }
    let is_length = message.starts_with("invalid length ");
    let prefix = ["invalid type: ", "invalid value: ", "invalid length "]
        .into_iter()
        .find_map(|prefix| message.strip_prefix(prefix))?;
    let (given, expected) = prefix.rsplit_once(", expected ")?;
    let given = match given.split_once(' ') {
        _ if is_length => format!("{given} values"),
        Some(("string", text)) => format!("the text {}", excerpt(40, text).replace("\\\"", "\"")),
        Some(("integer" | "floating", number)) => number.trim_start_matches("point ").replace('`', ""),
        Some(("boolean", value)) => value.replace('`', ""),
        _ => match given {
            "map" => "a table".into(),
            "sequence" => "a list".into(),
            other => excerpt(60, other),
        },
    };
    let expected = match expected {
        "f64" => "a number",
        "usize" | "u32" | "u64" => "a whole number from 0",
        "a string" => "a text in quotation marks",
        "a boolean" => "true or false",
        "a sequence" => "a list",
        "an array of length 2" => "a list of 2 numbers",
        "an array of length 4" => "a list of 4 numbers",
        other if other.starts_with("enum ") || other.contains("variant") => "one of the words of this key",
        other => other,
    };
    Some(format!("this must be {expected}, not {given}."))
}

/// The known word that is nearest to a given one, if one is near.
fn nearest<'k>(given: &str, known: &[&'k str]) -> Option<&'k str> {
    let near = |word: &&&str| edits(given, word) <= 1 + word.len() / 4;
    known.iter().filter(near).min_by_key(|word| edits(given, word)).copied()
}

/// How many letters must be added, removed or replaced to get from one word to the other (Levenshtein).
fn edits(from: &str, to: &str) -> usize {
    // Long words are not compared: the file decides how long they are.
    let from: Vec<char> = from.chars().take(40).collect();
    let mut previous: Vec<usize> = (0..=from.len()).collect();
    for (row, letter) in to.chars().enumerate() {
        let mut current = vec![row + 1];
        for (column, other) in from.iter().enumerate() {
            let replaced = previous[column] + usize::from(*other != letter);
            current.push(replaced.min(previous[column + 1] + 1).min(current[column] + 1));
        }
        previous = current;
    }
    previous[from.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_counted() {
        for (from, to, count) in
            [("", "", 0), ("abc", "abc", 0), ("abc", "", 3), ("spcing", "spacing", 1), ("hmin", "h_min", 1)]
        {
            assert_eq!((edits(from, to), edits(to, from)), (count, count), "{from} {to}");
        }
    }

    #[test]
    fn the_nearest_key_is_proposed_only_where_one_is_near() {
        let known = ["spacing", "rule", "max_triangles"];
        assert_eq!(nearest("spcaing", &known), Some("spacing"));
        assert_eq!(nearest("max_triangle", &known), Some("max_triangles"));
        assert_eq!(nearest("colour", &known), None);
    }
}
