//! The command as it was typed, to be noted in files.

use std::ffi::OsString;

/// The option that decides how fast the work is done, and nothing about its result.
const THREADS: &str = "--threads";

/// Returns the program's name and its arguments, quoted so that a shell reads them as they were given.
///
/// The name is without the folder that the program is in. The number of threads is left out: it changes no
/// mesh, and files are the same for any number.
pub fn command_line(arguments: &[OsString]) -> String {
    let mut words = vec!["meshbrush".to_owned()];
    let mut given = arguments.iter().skip(1).map(|argument| argument.to_string_lossy());
    while let Some(argument) = given.next() {
        match argument.strip_prefix(THREADS) {
            // The number follows as the next argument, or after an equals sign.
            Some("") => drop(given.next()),
            Some(number) if number.starts_with('=') => {}
            _ => words.push(quoted(&argument)),
        }
    }
    words.join(" ")
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

    #[test]
    fn the_number_of_threads_is_left_out() {
        for threads in ["mesh -o a.vtu --threads 3", "--threads=3 mesh -o a.vtu", "mesh --threads 2 -o a.vtu"]
        {
            let arguments: Vec<OsString> =
                ["meshbrush"].into_iter().chain(threads.split(' ')).map(OsString::from).collect();
            assert_eq!(command_line(&arguments), "meshbrush mesh -o a.vtu", "{threads}");
        }
    }
}
