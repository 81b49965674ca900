//! A project is packed in slices: in a page, between two frames, and in little time.

use std::io::{self, Write};

use super::archive::{ArchiveWriter, Packing};
use super::limits::Limits;
use super::part_names::{PartData, PartNames};
use super::{Project, parts};

/// The work of [`write()`](super::write()), in slices. The file has the same content, and more bytes: it is
/// packed in half the time.
pub struct ProjectPacking {
    project: Project,
    names: PartNames,
    new: Vec<(String, PartData)>,
    /// How many parts are packed.
    packed: usize,
    /// The part that is being packed.
    part: Option<PackedPart>,
    archive: Option<ArchiveWriter<Vec<u8>>>,
}

struct PackedPart {
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
        let archive = Some(ArchiveWriter::new(Vec::new(), Limits::PROJECT));
        Self { project, names, new, packed: 0, part: None, archive }
    }

    /// Packs about so many bytes. Returns those of the file once all are packed, and nothing after that.
    ///
    /// # Errors
    /// Fails when a part cannot be written, or is beyond its limit.
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
                self.part =
                    Some(PackedPart { name: name.to_string(), bytes, done: 0, packing: Packing::quick() });
            }
        }
        self.archive = Some(archive);
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use meshbrush_core::document::Example;

    use super::super::{from_bytes, write};
    use super::*;

    #[test]
    fn slices_of_any_size_pack_the_same_bytes_with_the_content_of_a_file() {
        for example in [Example::Threats, Example::Diamond, Example::Path] {
            let project = Project::of(&example.without_data());
            let packed = |slice: usize| {
                let mut packing = ProjectPacking::new(project.clone());
                let mut slices = 1;
                loop {
                    if let Some(found) = packing.advance(slice).unwrap() {
                        assert!(slices > 2, "{slices}");
                        assert!(packing.advance(slice).unwrap().is_none());
                        return found;
                    }
                    slices += 1;
                }
            };
            let file = |project: &Project| {
                let mut file = Vec::new();
                write(&mut file, project).unwrap();
                file
            };
            let (expected, whole) = (file(&project), packed(usize::MAX));
            assert!(whole.len() < 2 * expected.len(), "{} {}", whole.len(), expected.len());
            let read = from_bytes(&whole, Path::new("packed.meshbrush")).unwrap();
            assert!(file(&read) == expected, "{}", example.name());
            for slice in [1000, 77_777] {
                assert!(packed(slice) == whole, "{}, slices of {slice} bytes", example.name());
            }
        }
    }
}
