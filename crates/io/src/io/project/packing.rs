//! A project is packed in slices: in a page, between two frames.

use std::io::{self, Write};

use super::archive::{ArchiveWriter, Packing};
use super::part_names::{NewParts, PartNames};
use super::{Project, parts};

/// The work of [`write()`](super::write()), in slices. The bytes are the same.
pub struct ProjectPacking {
    project: Project,
    names: PartNames,
    new: NewParts,
    /// How many parts are packed.
    packed: usize,
    /// The part that is being packed.
    part: Option<Part>,
    archive: Option<ArchiveWriter<Vec<u8>>>,
}

struct Part {
    name: String,
    bytes: Vec<u8>,
    /// How many bytes are packed.
    done: usize,
    packing: Packing,
}

impl ProjectPacking {
    /// Begins to pack a project.
    pub fn new(project: Project) -> Self {
        let mut names = PartNames::default();
        let new = names.add(&project.settings);
        let archive = Some(ArchiveWriter::new(Vec::new()));
        Self { project, names, new, packed: 0, part: None, archive }
    }

    /// Packs about so many bytes. Returns those of the file once all are packed, and nothing after that.
    ///
    /// # Errors
    /// Fails when a part cannot be written, or the file would be larger than 4 GiB.
    pub fn advance(&mut self, bytes: usize) -> io::Result<Option<Vec<u8>>> {
        let Some(mut archive) = self.archive.take() else { return Ok(None) };
        match self.part.take() {
            Some(mut part) => {
                let end = part.done.saturating_add(bytes.max(1)).min(part.bytes.len());
                part.packing.write_all(&part.bytes[part.done..end])?;
                part.done = end;
                if end < part.bytes.len() {
                    self.part = Some(part);
                } else {
                    archive.add_packed(&part.name, part.packing)?;
                    self.packed += 1;
                }
            }
            None => {
                let parts = parts(&self.project, &self.names, &self.new);
                let Some((name, write)) = parts.get(self.packed) else { return archive.finish().map(Some) };
                let mut bytes = Vec::new();
                write(&mut bytes)?;
                self.part = Some(Part { name: name.to_string(), bytes, done: 0, packing: Packing::new() });
            }
        }
        self.archive = Some(archive);
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use meshbrush_core::document::Example;

    use super::super::write;
    use super::*;

    #[test]
    fn slices_of_any_size_pack_the_same_bytes() {
        for example in [Example::Threats, Example::Diamond, Example::Path] {
            let project = Project::of(&example.without_data());
            let mut expected = Vec::new();
            write(&mut expected, &project).unwrap();
            for slice in [1000, 77_777, usize::MAX] {
                let mut packing = ProjectPacking::new(project.clone());
                let mut slices = 1;
                let found = loop {
                    match packing.advance(slice).unwrap() {
                        Some(found) => break found,
                        None => slices += 1,
                    }
                };
                assert!(found == expected, "{}, slices of {slice} bytes", example.name());
                assert!(slices > 2, "{slices}");
                assert!(packing.advance(slice).unwrap().is_none());
            }
        }
    }
}
