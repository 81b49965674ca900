//! Reads the source of the program for the architecture tests: tokens, paths, functions.
//!
//! Comments, doc comments, strings and code under `#[cfg(test)]` are removed first, so words in them do not
//! count as code. This is not a complete parser: it relies on rustfmt's layout and on the style of this
//! crate.

use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::ROOT;

/// A word or a punctuation character of the code, with its line counted from one.
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    pub line: usize,
    /// A name, a number, `::`, `"` for any string or character literal, or a single punctuation character.
    pub text: String,
}

/// A path such as `crate::mesh::Mesh`, complete even if part of it was written in braces. The names of our
/// other packages are replaced by `crate`: no two have a module of the same name.
#[derive(Clone, Debug, PartialEq)]
pub struct PathInCode {
    pub line: usize,
    pub segments: Vec<String>,
}

/// A name that a `use` brings into a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// The name in the file: the last segment, or what stands after `as`.
    pub name: String,
    /// The complete path, as in [`PathInCode`].
    pub segments: Vec<String>,
    /// Whether it has a visibility of its own: other files can import the name from here.
    pub is_reexport: bool,
}

/// A function with a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    pub name: String,
    pub lines: RangeInclusive<usize>,
}

/// A struct, enum, union, trait or type alias of a module.
#[derive(Clone, Debug, PartialEq)]
pub struct TypeInCode {
    pub name: String,
    pub line: usize,
}

/// A source file without comments, strings and tests.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Relative to the root of the repository, with `/`.
    pub path: String,
    /// Path of the module; empty for `lib.rs` and `main.rs`.
    pub module: Vec<String>,
    pub tokens: Vec<Token>,
    /// Lines that are not under `#[cfg(test)]`.
    pub line_count: usize,
    /// Modules under `#[cfg(test)]` that have files of their own.
    test_modules: Vec<Vec<String>>,
}

/// The folders of source, those of the packages that others depend on first.
pub const SOURCES: [&str; 10] = [
    "crates/mesh/src",
    "crates/core/src",
    "crates/fem/src",
    "crates/study/src",
    "crates/io/src",
    "crates/render/src",
    "crates/cli/src",
    "crates/ui/src",
    "crates/kit/src",
    "src",
];

/// Path and text of all Rust files in [`SOURCES`], with their tests, read once.
pub fn read_texts() -> &'static [(String, String)] {
    static TEXTS: LazyLock<Vec<(String, String)>> = LazyLock::new(texts);
    &TEXTS
}

fn texts() -> Vec<(String, String)> {
    let root = Path::new(ROOT);
    let mut paths = Vec::new();
    SOURCES.iter().for_each(|folder| collect(&root.join(folder), &mut paths));
    paths.sort();
    let relative = |path: &Path| {
        let parts: Vec<_> =
            path.strip_prefix(root).unwrap().iter().map(|part| part.to_str().unwrap()).collect();
        parts.join("/")
    };
    paths.iter().map(|path| (relative(path), fs::read_to_string(path).unwrap())).collect()
}

/// Returns all Rust files in [`SOURCES`] in the order of their paths, without those that only tests use.
pub fn read_src() -> &'static [SourceFile] {
    static FILES: LazyLock<Vec<SourceFile>> = LazyLock::new(source_files);
    &FILES
}

fn source_files() -> Vec<SourceFile> {
    let files: Vec<SourceFile> =
        read_texts().iter().map(|(path, text)| SourceFile::new(path, text)).collect();
    let for_tests: Vec<Vec<String>> = files.iter().flat_map(|file| file.test_modules.clone()).collect();
    files.into_iter().filter(|file| !for_tests.iter().any(|module| file.module.starts_with(module))).collect()
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, paths);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            paths.push(path);
        }
    }
}

impl SourceFile {
    pub fn new(path: &str, text: &str) -> Self {
        let module = module_of(path);
        let (tokens, test_lines, names) = without_tests(tokens(text));
        let test_modules = names.into_iter().map(|name| [module.clone(), vec![name]].concat()).collect();
        let line_count = text.lines().count() - test_lines;
        Self { path: path.to_owned(), module, tokens, line_count, test_modules }
    }

    /// Returns the top-level module: the first folder or file in a folder `src`; empty for `lib.rs` and
    /// `main.rs`.
    pub fn top_module(&self) -> &str {
        self.module.first().map_or("", String::as_str)
    }

    /// Returns every path with at least two segments; `use` trees are expanded. `self` and `super` are
    /// resolved to paths that begin with `crate`.
    pub fn paths(&self) -> Vec<PathInCode> {
        self.named().into_iter().map(|(path, _)| path).collect()
    }

    /// Returns the segments of the paths that are in no `use`.
    pub fn paths_outside_use(&self) -> Vec<Vec<String>> {
        let named = self.named().into_iter().filter(|(_, import)| import.is_none());
        named.map(|(path, _)| path.segments).collect()
    }

    /// Returns what the `use` trees of the file bring into it.
    pub fn imports(&self) -> Vec<Import> {
        let with_path = |(path, import): (PathInCode, Option<Import>)| {
            let mut segments = path.segments;
            // `a::b::{self}` imports `a::b`.
            segments.pop_if(|last| last == "self");
            Some(Import { segments, ..import? })
        };
        self.named().into_iter().filter_map(with_path).collect()
    }

    /// Returns every path, and where it is of a `use` what it imports, still without segments.
    fn named(&self) -> Vec<(PathInCode, Option<Import>)> {
        let mut found = Vec::new();
        let mut inline: Vec<(String, usize)> = Vec::new();
        let (mut depth, mut at) = (0, 0);
        while at < self.tokens.len() {
            let module = || -> Vec<String> {
                self.module.iter().cloned().chain(inline.iter().map(|(name, _)| name.clone())).collect()
            };
            match self.text(at) {
                "mod" if self.text(at + 2) == "{" => inline.push((self.text(at + 1).to_owned(), depth)),
                "{" => depth += 1,
                "}" => {
                    depth -= 1;
                    inline.retain(|&(_, outside)| outside < depth);
                }
                "use" if is_name(self.text(at + 1)) || matches!(self.text(at + 1), "{" | "::") => {
                    let is_reexport = at > 0 && matches!(self.text(at - 1), "pub" | ")");
                    let mut leaves = Vec::new();
                    at = self.use_tree(at + 1, &mut Vec::new(), &mut leaves);
                    found.extend(leaves.into_iter().map(|(path, name)| {
                        let import = Import { name, segments: Vec::new(), is_reexport };
                        (resolved(path, &module()), Some(import))
                    }));
                    continue;
                }
                _ if self.begins_path(at) => {
                    let mut path =
                        PathInCode { line: self.tokens[at].line, segments: vec![self.text(at).into()] };
                    while self.text(at + 1) == "::" && is_name(self.text(at + 2)) {
                        path.segments.push(self.text(at + 2).to_owned());
                        at += 2;
                    }
                    found.push((resolved(path, &module()), None));
                }
                _ => {}
            }
            at += 1;
        }
        found
    }

    /// Returns every function with a body, from the line of its name to the closing brace.
    pub fn functions(&self) -> Vec<Function> {
        let named = (0..self.tokens.len()).filter(|&at| self.text(at) == "fn" && is_name(self.text(at + 1)));
        named.filter_map(|at| self.function(at)).collect()
    }

    /// Returns the types that modules declare: neither associated types nor those inside functions.
    pub fn types(&self) -> Vec<TypeInCode> {
        let mut types = Vec::new();
        let mut at = 0;
        while at < self.tokens.len() {
            match self.text(at) {
                "struct" | "enum" | "union" | "trait" | "type" if is_name(self.text(at + 1)) => {
                    let Token { line, text } = self.tokens[at + 1].clone();
                    types.push(TypeInCode { name: text, line });
                }
                // What is in a module inside the file belongs to the file.
                "{" if at < 2 || self.text(at - 2) != "mod" => at = end_of_group(&self.tokens, at),
                _ => {}
            }
            at += 1;
        }
        types
    }

    fn function(&self, at: usize) -> Option<Function> {
        let open = self.at_depth_0(at + 1, &["{", ";"])?;
        if self.text(open) == ";" {
            return None;
        }
        let close = end_of_group(&self.tokens, open);
        let lines = self.tokens[at].line..=self.tokens[close].line;
        Some(Function { name: self.text(at + 1).to_owned(), lines })
    }

    /// Returns the first of `signs` from `at` on outside parentheses and brackets.
    fn at_depth_0(&self, at: usize, signs: &[&str]) -> Option<usize> {
        let mut depth = 0;
        (at..self.tokens.len()).find(|&i| {
            match self.text(i) {
                "(" | "[" => depth += 1,
                ")" | "]" => depth -= 1,
                _ => {}
            }
            depth == 0 && signs.contains(&self.text(i))
        })
    }

    fn begins_path(&self, at: usize) -> bool {
        is_name(self.text(at)) && self.text(at + 1) == "::" && is_name(self.text(at + 2))
    }

    /// Expands the tree of a `use` that begins at `at`, with the names that it imports. Returns where it ends.
    fn use_tree(
        &self,
        mut at: usize,
        before: &mut Vec<String>,
        leaves: &mut Vec<(PathInCode, String)>,
    ) -> usize {
        let kept = before.len();
        let line = self.tokens.get(at).map_or(0, |token| token.line);
        let mut alias = None;
        loop {
            match self.text(at) {
                "::" => at += 1,
                "{" => {
                    at += 1;
                    while self.text(at) != "}" {
                        at = self.use_tree(at, before, leaves);
                        at += usize::from(self.text(at) == ",");
                    }
                    before.truncate(kept);
                    return at + 1;
                }
                "as" => {
                    alias = Some(self.text(at + 1).to_owned());
                    at += 2;
                }
                name if is_name(name) || name == "*" => {
                    before.push(name.to_owned());
                    at += 1;
                }
                _ => break,
            }
        }
        // `a::b::{self}` is the name `b`.
        let name = before.iter().rev().find(|name| *name != "self").cloned().unwrap_or_default();
        leaves.push((PathInCode { line, segments: before.clone() }, alias.unwrap_or(name)));
        before.truncate(kept);
        at
    }

    /// Returns the text of a token; empty beyond the end.
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| &token.text)
    }
}

fn module_of(path: &str) -> Vec<String> {
    let (_, inner) = path.rsplit_once("src/").unwrap_or_else(|| panic!("{path} is in no folder src"));
    let inner = inner.trim_end_matches(".rs");
    let mut module: Vec<String> = inner.split('/').map(str::to_owned).collect();
    if matches!(module.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        module.pop();
    }
    module
}

fn resolved(mut path: PathInCode, module: &[String]) -> PathInCode {
    if path.segments.first().is_some_and(|first| first.starts_with("meshbrush_")) {
        path.segments[0] = "crate".to_owned();
    }
    let supers = path.segments.iter().take_while(|segment| *segment == "super").count();
    let first = path.segments.first().map_or("", String::as_str);
    let kept = if supers > 0 { module.len().saturating_sub(supers) } else { module.len() };
    if supers == 0 && first != "self" {
        return path;
    }
    let rest = path.segments.into_iter().skip(supers.max(1));
    let base = ["crate".to_owned()].into_iter().chain(module[..kept].iter().cloned());
    PathInCode { line: path.line, segments: base.chain(rest).collect() }
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Returns the code without tests, the number of lines of the tests, and the names of test modules in other
/// files.
fn without_tests(tokens: Vec<Token>) -> (Vec<Token>, usize, Vec<String>) {
    let (mut kept, mut lines, mut names) = (Vec::new(), 0, Vec::new());
    let mut at = 0;
    while at < tokens.len() {
        let attribute = attribute_end(&tokens, at);
        let for_tests = attribute.is_some_and(|end| {
            let words: Vec<&str> = tokens[at..end].iter().map(|token| token.text.as_str()).collect();
            words.contains(&"cfg") && words.contains(&"test") && !words.contains(&"not")
        });
        if !for_tests {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let end = item_end(&tokens, attribute.unwrap_or(at));
        if tokens[end].text == ";" && tokens[end - 2].text == "mod" {
            names.push(tokens[end - 1].text.clone());
        }
        lines += tokens[end].line + 1 - tokens[at].line;
        at = end + 1;
    }
    (kept, lines, names)
}

/// Returns the token after the attribute that begins at `at`, if there is one.
fn attribute_end(tokens: &[Token], at: usize) -> Option<usize> {
    let begins = tokens[at].text == "#" && tokens.get(at + 1).is_some_and(|token| token.text == "[");
    begins.then(|| end_of_group(tokens, at + 1) + 1)
}

/// Returns the last token of the item at `at`, which may have more attributes. A field ends no later than
/// what it is in.
fn item_end(tokens: &[Token], mut at: usize) -> usize {
    while let Some(end) = attribute_end(tokens, at) {
        at = end;
    }
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            ";" => return at,
            "{" => return end_of_group(tokens, at),
            "(" | "[" => at = end_of_group(tokens, at),
            ")" | "]" | "}" => return at - 1,
            _ => {}
        }
        at += 1;
    }
    tokens.len() - 1
}

/// Returns the bracket that closes the group opened at `open`.
fn end_of_group(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    panic!("line {}: a bracket is never closed", tokens[open].line)
}

/// Returns the tokens of the code, without comments and without the contents of literals.
fn tokens(text: &str) -> Vec<Token> {
    let mut reader = Reader { chars: text.chars().collect(), at: 0, line: 1, tokens: Vec::new() };
    while reader.at < reader.chars.len() {
        reader.next();
    }
    reader.tokens
}

struct Reader {
    chars: Vec<char>,
    at: usize,
    line: usize,
    tokens: Vec<Token>,
}

impl Reader {
    fn peek(&self, ahead: usize) -> char {
        self.chars.get(self.at + ahead).copied().unwrap_or('\0')
    }

    fn skip(&mut self, count: usize) {
        for _ in 0..count {
            self.line += usize::from(self.peek(0) == '\n');
            self.at += 1;
        }
    }

    fn push(&mut self, text: impl Into<String>) {
        self.tokens.push(Token { line: self.line, text: text.into() });
    }

    fn next(&mut self) {
        match (self.peek(0), self.peek(1)) {
            ('/', '/') => self.skip_while(|c| c != '\n'),
            ('/', '*') => self.skip_block_comment(),
            ('"', _) => self.string(),
            ('\'', _) => self.character_or_lifetime(),
            (':', ':') => {
                self.push("::");
                self.skip(2);
            }
            (c, _) if c.is_alphanumeric() || c == '_' => self.word(),
            (c, _) => {
                if !c.is_whitespace() {
                    self.push(c);
                }
                self.skip(1);
            }
        }
    }

    fn skip_while(&mut self, skipped: impl Fn(char) -> bool) {
        while self.at < self.chars.len() && skipped(self.peek(0)) {
            self.skip(1);
        }
    }

    /// Block comments nest.
    fn skip_block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.chars.len() {
            match (self.peek(0), self.peek(1)) {
                ('/', '*') => depth += 1,
                ('*', '/') => depth -= 1,
                _ => {
                    self.skip(1);
                    continue;
                }
            }
            self.skip(2);
            if depth == 0 {
                return;
            }
        }
    }

    /// A name or a number, or a string with its prefix (`r`, `b`, `br`, `c`).
    fn word(&mut self) {
        let start = self.at;
        let mut end = start;
        while self.chars.get(end).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
            end += 1;
        }
        let word: String = self.chars[start..end].iter().collect();
        let hashes = self.chars[end..].iter().take_while(|c| **c == '#').count();
        let quoted = self.chars.get(end + hashes) == Some(&'"');
        let raw = matches!(word.as_str(), "r" | "br" | "cr");
        if quoted && raw {
            self.skip(end - start + hashes);
            self.raw_string(hashes);
        } else if quoted && hashes == 0 && matches!(word.as_str(), "b" | "c") {
            self.skip(end - start);
            self.string();
        } else {
            self.push(word);
            self.skip(end - start);
        }
    }

    fn string(&mut self) {
        self.push('"');
        self.skip(1);
        while self.at < self.chars.len() && self.peek(0) != '"' {
            let escaped = usize::from(self.peek(0) == '\\');
            self.skip(1 + escaped);
        }
        self.skip(1);
    }

    fn raw_string(&mut self, hashes: usize) {
        self.push('"');
        self.skip(1);
        while self.at < self.chars.len() {
            let closed = self.peek(0) == '"' && (1..=hashes).all(|ahead| self.peek(ahead) == '#');
            self.skip(1 + if closed { hashes } else { 0 });
            if closed {
                return;
            }
        }
    }

    /// `'a'` and `'\n'` are characters, `'a` is a lifetime.
    fn character_or_lifetime(&mut self) {
        let length = match (self.peek(1), self.peek(2)) {
            ('\\', _) => {
                (3..).find(|&ahead| matches!(self.peek(ahead), '\'' | '\0')).map_or(1, |end| end + 1)
            }
            (_, '\'') => 3,
            _ => 1,
        };
        if length > 1 {
            self.push('"');
        }
        self.skip(length);
    }
}
