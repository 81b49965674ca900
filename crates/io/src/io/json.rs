//! JSON of our own files, with errors for a person.

use serde::de::DeserializeOwned;

use super::KeyFault;
use super::values::{TextReader, TextValue};

/// Why a text in JSON cannot be used.
pub(super) struct JsonFlaw {
    /// A sentence without a capital letter, which ends with a full stop or a question mark.
    pub sentence: String,
    /// Counted from one.
    pub line: usize,
    /// Counted from one.
    pub column: usize,
}

/// Reads a value.
///
/// # Errors
/// Fails with the place, and the key that is unknown or whose value has another type.
pub(super) fn parse<T: DeserializeOwned>(text: &[u8]) -> Result<T, JsonFlaw> {
    serde_json::from_slice(text).map_err(|error| JsonFlaw {
        sentence: fault_of::<T>(text).unwrap_or_else(|| format!("{}.", problem(&error))),
        line: error.line().max(1),
        column: error.column(),
    })
}

/// Most bytes of a text whose mistake is explained: its values take up to thirty times as much memory. Of a
/// longer one, the parser says what is wrong.
const MOST_EXPLAINED: usize = 4 << 20;

/// Returns the mistake in a text that is valid JSON, as a sentence.
fn fault_of<T: DeserializeOwned>(text: &[u8]) -> Option<String> {
    if text.len() > MOST_EXPLAINED {
        return None;
    }
    let value: TextValue = serde_json::from_slice(text).ok()?;
    let found: Result<T, KeyFault> = T::deserialize(TextReader::plain(&value));
    found.err().map(|fault| fault.to_string())
}

/// Returns the text of a parser error without the place at its end.
pub(super) fn problem(error: &serde_json::Error) -> String {
    let (text, place) = (error.to_string(), format!(" at line {} column {}", error.line(), error.column()));
    text.strip_suffix(&place).unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Line {
        sides: Vec<[f64; 2]>,
        kind: Kind,
        #[serde(default)]
        rows: Option<u32>,
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(rename_all = "snake_case")]
    enum Kind {
        Round,
        Square { side: f64 },
        Named(String),
    }

    #[test]
    fn faults_have_the_key_and_the_line() {
        for (text, line, sentence) in [
            ("{\n\"side\": 1}", 2, "side: there is no key `side` here; did you mean `sides`?"),
            (
                "{\"sides\": [[1, 2],\n[1, \"b\"]]}",
                2,
                "sides 2 2: this must be a number, not the text \"b\".",
            ),
            ("{\"sides\": [[1]]}", 1, "sides 1: this must be a list of 2 numbers, not 1 values."),
            ("{\"sides\": []\n}", 2, "the key `kind` is missing here."),
            ("{\"kind\": \"rund\"}", 1, "kind: \"rund\" is not possible here; did you mean \"round\"?"),
            ("{\"kind\": 3}", 1, "kind: this must be one of the words of this key, in quotation marks."),
            ("{\"kind\": {\"named\": 4}}", 1, "kind, named: this must be a text in quotation marks, not 4."),
            ("{\"kind\": {\"square\": {}}}", 1, "kind, square: the key `side` is missing here."),
            ("{\"rows\": -1}", 1, "rows: this must be a whole number from 0, not -1."),
            ("{\"rows\": 1.5}", 1, "rows: this must be a whole number from 0, not 1.5."),
            ("{\"rows\": 1, \"rows\": 1}", 1, "the key `rows` is here twice."),
            ("{\"rows\": 1\n,,}", 2, "key must be a string."),
        ] {
            let Err(flaw) = parse::<Line>(text.as_bytes()) else { panic!("{text}") };
            assert_eq!((flaw.line, flaw.sentence.as_str()), (line, sentence), "{text}");
        }
        let text = "{\"sides\": [], \"kind\": {\"square\": {\"side\": 2}}, \"rows\": null}";
        let line = Line { sides: Vec::new(), kind: Kind::Square { side: 2.0 }, rows: None };
        assert_eq!(parse::<Line>(text.as_bytes()).map_err(|flaw| flaw.sentence), Ok(line));
    }
}
