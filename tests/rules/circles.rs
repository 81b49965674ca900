//! Files that import each other in a circle can only be read, tested and compiled together.
//!
//! A file imports another one where a `use` or a path in its code names something of it, outside tests. Names
//! are followed through re-exports to the file that defines them; a re-export alone imports nothing.

use std::collections::{BTreeMap, BTreeSet};

use crate::architecture::assert_none;
use crate::source::{Import, SOURCES, SourceFile, read_src};

/// The largest circle that can still be read at once.
const LARGEST_CIRCLE: usize = 10;

/// How many re-exports a name may pass through.
const MOST_REEXPORTS: usize = 8;

/// The files of a package, with what each of them defines and imports.
struct Package {
    files: Vec<&'static SourceFile>,
    by_module: BTreeMap<Vec<String>, usize>,
    imports: Vec<Vec<Import>>,
    definitions: Vec<BTreeSet<&'static str>>,
}

impl Package {
    fn read(folder: &str) -> Self {
        let inside =
            |file: &&SourceFile| file.path.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'));
        let files: Vec<&SourceFile> = read_src().iter().filter(inside).collect();
        Self {
            by_module: files.iter().enumerate().map(|(index, file)| (file.module.clone(), index)).collect(),
            imports: files.iter().map(|file| file.imports()).collect(),
            definitions: files.iter().map(|file| definitions(file)).collect(),
            files,
        }
    }

    /// Returns the files that each file imports.
    fn graph(&self) -> Vec<BTreeSet<usize>> {
        (0..self.files.len()).map(|file| self.imported_by(file)).collect()
    }

    fn imported_by(&self, file: usize) -> BTreeSet<usize> {
        let words = words_outside_use(self.files[file]);
        let imports = self.imports[file].iter();
        let imports = imports.filter(|import| !import.is_reexport || words.contains(import.name.as_str()));
        let imports = imports.map(|import| import.segments.clone());
        let mut found = BTreeSet::new();
        for path in imports.chain(self.files[file].paths_outside_use()) {
            self.find(file, &path, MOST_REEXPORTS, &mut found);
        }
        found.remove(&file);
        found
    }

    /// Adds the files that define what a path in a file names.
    fn find(&self, file: usize, path: &[String], left: usize, found: &mut BTreeSet<usize>) {
        if left == 0 || path.is_empty() {
            return;
        }
        if path[0] == "crate" {
            self.find_absolute(&path[1..], left, found);
            return;
        }
        let child = [self.files[file].module.clone(), vec![path[0].clone()]].concat();
        if self.by_module.contains_key(&child) {
            let absolute = [&child[..], &path[1..]].concat();
            self.find_absolute(&absolute, left, found);
            return;
        }
        for import in self.imports[file].iter().filter(|import| import.name == path[0]) {
            if import.segments != path {
                self.find(file, &[&import.segments[..], &path[1..]].concat(), left - 1, found);
            }
        }
    }

    fn find_absolute(&self, path: &[String], left: usize, found: &mut BTreeSet<usize>) {
        let Some(length) = (0..=path.len()).rev().find(|&n| self.by_module.contains_key(&path[..n])) else {
            return;
        };
        let file = self.by_module[&path[..length]];
        let Some(name) = path.get(length) else { return };
        if name == "*" || self.definitions[file].contains(name.as_str()) {
            found.insert(file);
            return;
        }
        let before = found.len();
        for import in self.imports[file].iter().filter(|import| import.name == *name) {
            self.find(file, &[&import.segments[..], &path[length + 1..]].concat(), left - 1, found);
        }
        for glob in self.imports[file].iter().filter(|import| import.name == "*" && import.is_reexport) {
            let module = &glob.segments[..glob.segments.len() - 1];
            self.find(file, &[module, &path[length..]].concat(), left - 1, found);
        }
        // A name that a macro defines is in the module itself; at the root it is one of another package.
        let is_imported = self.imports[file].iter().any(|import| import.name == *name);
        if found.len() == before && !is_imported && length > 0 {
            found.insert(file);
        }
    }
}

/// Returns the names of the items of a file.
fn definitions(file: &'static SourceFile) -> BTreeSet<&'static str> {
    let item = ["struct", "enum", "fn", "trait", "type", "const", "static", "union", "macro_rules"];
    let pairs = file.tokens.windows(2).filter(|pair| item.contains(&pair[0].text.as_str()));
    pairs.map(|pair| pair[1].text.as_str()).collect()
}

/// Returns the words of the code that are in no `use` and declare no module.
fn words_outside_use(file: &SourceFile) -> BTreeSet<&str> {
    let (mut found, mut in_use, mut before) = (BTreeSet::new(), false, "");
    for token in &file.tokens {
        in_use |= token.text == "use";
        if !in_use && before != "mod" {
            found.insert(token.text.as_str());
        }
        in_use &= token.text != ";";
        before = &token.text;
    }
    found
}

/// Returns the strongly connected components of a graph that have more than one node, the largest first, by
/// the algorithm of Kosaraju.
fn circles(graph: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let mut reversed = vec![BTreeSet::new(); graph.len()];
    for (from, to) in graph.iter().enumerate().flat_map(|(from, all)| all.iter().map(move |&to| (from, to))) {
        reversed[to].insert(from);
    }
    let mut seen = vec![false; graph.len()];
    let mut order = Vec::new();
    for node in 0..graph.len() {
        visit(node, graph, &mut seen, &mut order);
    }
    seen.fill(false);
    let mut found = Vec::new();
    for node in order.into_iter().rev() {
        let mut component = Vec::new();
        visit(node, &reversed, &mut seen, &mut component);
        component.sort_unstable();
        found.extend((component.len() > 1).then_some(component));
    }
    found.sort_by_key(|component| std::cmp::Reverse(component.len()));
    found
}

/// Adds what is reached from a node and was not seen yet, a node after those that it leads to.
fn visit(node: usize, graph: &[BTreeSet<usize>], seen: &mut [bool], order: &mut Vec<usize>) {
    if std::mem::replace(&mut seen[node], true) {
        return;
    }
    for &next in &graph[node] {
        visit(next, graph, seen, order);
    }
    order.push(node);
}

/// Returns the paths of the files of each circle of a package, the largest circle first.
fn circles_of(folder: &str) -> Vec<Vec<&'static str>> {
    let package = Package::read(folder);
    let path = |file: usize| package.files[file].path.as_str();
    circles(&package.graph()).into_iter().map(|files| files.into_iter().map(path).collect()).collect()
}

#[test]
fn no_more_than_ten_files_import_each_other_in_a_circle() {
    let mut found = Vec::new();
    for folder in SOURCES {
        let circles = circles_of(folder).into_iter().filter(|files| files.len() > LARGEST_CIRCLE);
        found.extend(circles.map(|files| format!("{folder}, {} files: {}", files.len(), files.join(" "))));
    }
    assert_none(found, "a type or a constant that several files need has a file of its own, below them:");
}

#[test]
fn circles_are_found_through_paths_with_several_ways() {
    let edges = |all: &[&[usize]]| -> Vec<BTreeSet<usize>> {
        all.iter().map(|to| to.iter().copied().collect()).collect()
    };
    let graph = edges(&[&[1], &[2, 3], &[0], &[4], &[3, 5], &[]]);
    assert_eq!(circles(&graph), [vec![0, 1, 2], vec![3, 4]]);
    assert!(circles(&edges(&[&[1, 2], &[2], &[]])).is_empty());
}
