//! A recipe as text, in one form: equal recipes give equal texts.

use serde::Serialize;
use toml::{Table, Value};

use super::super::Number;
use super::super::settings::SavedSettings;

/// Columns of a list that stays on one line.
const WIDEST_LIST: usize = 90;

const HEADER: &str =
    "# A Meshbrush recipe. Keys: docs/recipe.md. Files are named from the folder of this one.\n";
const BEFORE_LAYERS: &str = "\n# The size field, from the bottom layer to the top one.\n";

/// Returns the text of a recipe.
pub fn to_text(recipe: &SavedSettings) -> String {
    let SavedSettings {
        domain,
        mesh,
        limits,
        layer,
        paths,
        keep_out,
        line,
        problem,
        pins,
        output,
        lengths: _,
    } = recipe;
    let mut text = HEADER.to_owned();
    write_table(&mut text, "[domain]", domain);
    write_table(&mut text, "[mesh]", mesh);
    write_table(&mut text, "[limits]", limits);
    if !layer.is_empty() {
        text.push_str(BEFORE_LAYERS);
    }
    for (index, layer) in layer.iter().enumerate() {
        // The comment belongs to the first layer.
        let heading = if index == 0 { "[[layer]]" } else { "\n[[layer]]" };
        write_entries(&mut text, heading, layer, |_| true);
    }
    write_table(&mut text, "[paths]", paths);
    keep_out.iter().for_each(|region| write_table(&mut text, "[[keep_out]]", region));
    line.iter().for_each(|line| write_table(&mut text, "[[line]]", line));
    write_table(&mut text, "[problem]", problem);
    write_table(&mut text, "[pins]", pins);
    output.iter().for_each(|output| write_table(&mut text, "[[output]]", output));
    text
}

/// A table after a blank line, unless it has no entry. A list without entries is as good as none there; in a
/// layer it says that there are none.
fn write_table(text: &mut String, heading: &str, table: &impl Serialize) {
    write_entries(text, &format!("\n{heading}"), table, |value| {
        value.as_array().is_none_or(|list| !list.is_empty())
    });
}

/// Writes the entries whose values say something, in the order of the fields of `table`.
fn write_entries(text: &mut String, heading: &str, table: &impl Serialize, says: impl Fn(&Value) -> bool) {
    let Ok(mut table) = Table::try_from(table) else { return };
    table.retain(|_, value| says(value));
    if table.is_empty() {
        return;
    }
    text.push_str(&format!("{heading}\n"));
    for (key, value) in table {
        text.push_str(&format!("{key} = "));
        write_value(text, &value, 0);
        text.push('\n');
    }
}

/// A value after `indent` columns: on one line where that is not too long, else a list with a line for each
/// entry.
fn write_value(text: &mut String, value: &Value, indent: usize) {
    let line = on_one_line(value);
    match value {
        Value::Array(list) if line.chars().count() > WIDEST_LIST => {
            text.push_str("[\n");
            for entry in list {
                text.push_str(&" ".repeat(indent + 2));
                write_value(text, entry, indent + 2);
                text.push_str(",\n");
            }
            text.push_str(&" ".repeat(indent));
            text.push(']');
        }
        _ => text.push_str(&line),
    }
}

fn on_one_line(value: &Value) -> String {
    match value {
        Value::Boolean(value) => value.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => Number(*number).to_string(),
        Value::Datetime(date) => date.to_string(),
        Value::String(string) => quoted(string),
        Value::Array(list) => {
            let entries: Vec<String> = list.iter().map(on_one_line).collect();
            format!("[{}]", entries.join(", "))
        }
        Value::Table(table) => {
            let entries = table.iter().map(|(key, value)| format!("{key} = {}", on_one_line(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}

/// Returns a basic string of TOML.
fn quoted(string: &str) -> String {
    let mut text = String::from("\"");
    for c in string.chars() {
        match c {
            '"' => text.push_str("\\\""),
            '\\' => text.push_str("\\\\"),
            '\n' => text.push_str("\\n"),
            '\t' => text.push_str("\\t"),
            c if c.is_control() => text.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => text.push(c),
        }
    }
    text + "\""
}
