//! The command as it was typed, to be noted in files.

use std::ffi::OsString;

/// The program's name and its arguments, quoted so that a shell reads them as they were given. The name is
/// without the folder that the program is in.
pub fn command_line(arguments: &[OsString]) -> String {
    let given = arguments.iter().skip(1).map(|argument| quoted(&argument.to_string_lossy()));
    std::iter::once("meshbrush".to_owned()).chain(given).collect::<Vec<_>>().join(" ")
}

fn quoted(argument: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:,=+@%".contains(c);
    if !argument.is_empty() && argument.chars().all(is_plain) {
        return argument.to_owned();
    }
    format!("'{}'", argument.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_reads_the_arguments_back() {
        let arguments =
            ["/usr/local/bin/meshbrush", "mesh", "--target", "0.1 + x", "-o", "it's.vtu", "", "ä=1"];
        let line = command_line(&arguments.map(OsString::from));
        assert_eq!(line, r"meshbrush mesh --target '0.1 + x' -o 'it'\''s.vtu' '' ä=1");
    }
}
