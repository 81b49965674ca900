//! The pages of the manual, and its pictures.

use crate::app::host::asset;

/// A page of `docs/manual`.
#[derive(Debug, PartialEq, Eq)]
pub struct Page {
    /// Name in the list of pages.
    pub title: &'static str,
    /// The name of the page's file in `docs/manual`.
    pub file: &'static str,
    /// The text of the page, as Markdown.
    pub text: &'static str,
}

macro_rules! page {
    ($title:literal, $file:literal) => {
        Page { title: $title, file: $file, text: include_str!(concat!("../../../docs/manual/", $file)) }
    };
}

/// All pages, in reading order.
pub static PAGES: [Page; 14] = [
    page!("First steps", "first-steps.md"),
    page!("How it works", "how-it-works.md"),
    page!("Painting", "painting.md"),
    page!("Size and risk", "risk-and-diameter.md"),
    page!("Domains and outlines", "domains.md"),
    page!("Boundary", "boundary.md"),
    page!("Reading the mesh", "reading-the-mesh.md"),
    page!("Paths", "paths.md"),
    page!("Solving", "solving.md"),
    page!("Files and export", "files.md"),
    page!("Command line", "command-line.md"),
    page!("The method", "method.md"),
    page!("Limits and problems", "limits.md"),
    page!("Glossary", "glossary.md"),
];

/// The pictures, PNG files, as the pages name them.
static PICTURES: [&str; 5] = [
    "pictures/window.png",
    "pictures/how-it-works.png",
    "pictures/panel.png",
    "pictures/boundary.png",
    "pictures/triangle.png",
];

/// Returns the page of a file.
pub fn page_of(file: &str) -> Option<&'static Page> {
    PAGES.iter().find(|page| page.file == file)
}

/// Returns the pictures of a page that are not here yet: a browser fetches them.
pub fn missing_pictures(page: &Page) -> Vec<&'static str> {
    let is_used = |name: &&str| page.text.contains(&format!("({name})"));
    PICTURES.into_iter().filter(is_used).filter(|name| asset(name).is_none()).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::app::help::markdown::{Block, Span, blocks};

    const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/manual");

    fn spans(block: &Block) -> Vec<&Span> {
        match block {
            Block::Heading(_, spans) | Block::Paragraph(spans) | Block::Item(_, _, spans) => {
                spans.iter().collect()
            }
            Block::Table(rows) => rows.iter().flatten().flatten().collect(),
            Block::Code(_) | Block::Picture(..) => Vec::new(),
        }
    }

    #[test]
    fn every_file_of_the_manual_is_a_page() {
        let files =
            fs::read_dir(FOLDER).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut files: Vec<String> = files.filter(|name| name.ends_with(".md")).collect();
        let mut pages: Vec<&str> = PAGES.iter().map(|page| page.file).collect();
        files.sort();
        pages.sort_unstable();
        assert_eq!(files, pages);
    }

    #[test]
    fn every_link_and_picture_of_the_manual_exists_and_every_picture_is_used() {
        let mut used = Vec::new();
        for page in &PAGES {
            for block in blocks(page.text) {
                for link in spans(&block).into_iter().filter_map(|span| span.link.as_deref()) {
                    assert!(page_of(link).is_some(), "{} links to {link}", page.file);
                }
                if let Block::Picture(file, description) = block {
                    assert!(asset(&file).is_some(), "{} shows {file}", page.file);
                    assert!(description.len() > 20, "{file} has a description");
                    used.push(file);
                }
            }
        }
        assert!(PICTURES.iter().all(|name| used.iter().any(|used| used == name)), "{used:?}");
    }

    #[test]
    fn every_page_begins_with_its_title() {
        for page in &PAGES {
            assert!(page.text.starts_with(&format!("# {}\n", page.title)), "{}", page.file);
        }
    }

    #[test]
    fn the_pictures_are_small() {
        let bytes: usize = PICTURES.iter().map(|name| asset(name).unwrap().len()).sum();
        assert!(bytes < 1_000_000, "{bytes} bytes");
    }
}
