//! A document as the part of a link after `#`, with how it is looked at.
//!
//! ```text
//! 1.p.PROJECT.VIEW     the bytes of a project in base64 for addresses, and the view, as JSON in base64
//! 1.g.GESTURES.VIEW    what was done since the document was opened, where its pixels would be too long
//! ```

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use serde::{Deserialize, Serialize};

use super::project::{self, Project};
use super::recording::gestures;
use meshbrush_core::document::Document;
use meshbrush_mesh::text::Grouped;

/// The version that is written, and the newest that is read.
const VERSION: u32 = 1;
/// Most characters of a link that is written: browsers and mail programs pass on so many.
pub const MOST_CHARACTERS: usize = 30_000;
/// Most characters of a link that is read.
const MOST_READ: usize = 8 << 20;
/// Most characters of a view that is read.
const MOST_OF_VIEW: usize = 4096;

const DAMAGED: &str = "The link is damaged: a part of it is missing or changed. Ask for it again, or for the project as a file.";

/// How a document is looked at. What is left out is as after opening a file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LinkView {
    /// The part of the plane on the canvas: x₀, y₀, x₁, y₁ in world units; the whole domain where it is left
    /// out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub area: Option<[f64; 4]>,
    /// The name of the tool.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tool: Option<String>,
    /// The number of steps of the refinement that are done, where steps are shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
    /// The view in space; the plan where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub space: Option<LinkSpace>,
}

/// How a view in space looks. Its middle and its scale are those of the area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LinkSpace {
    /// Where one looks, in degrees: clockwise from the y axis, and how high the viewer is above the horizon.
    pub direction: [f64; 2],
    /// The factor for heights, where a person chose one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exaggeration: Option<f64>,
    /// The height in the middle, in units of height; half way up where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
}

impl LinkSpace {
    /// Returns whether there is such a view.
    fn is_possible(&self) -> bool {
        let [azimuth, altitude] = self.direction;
        azimuth.is_finite()
            && (0.0..=90.0).contains(&altitude)
            && self.exaggeration.is_none_or(|factor| factor > 0.0 && factor.is_finite())
            && self.height.is_none_or(f64::is_finite)
    }
}

/// What a link holds.
#[derive(Debug)]
pub struct Linked {
    /// The document.
    pub document: Document,
    /// How it is looked at.
    pub view: LinkView,
}

/// Returns the document as the part of a link after `#`. Where its pixels are too long, and it records its
/// edits, these are taken if they are shorter.
///
/// # Errors
/// Fails with a sentence when it needs more than [`MOST_CHARACTERS`].
pub fn write(document: &Document, view: &LinkView) -> Result<String, String> {
    let mut bytes = Vec::new();
    project::write(&mut bytes, &Project::of(document))
        .map_err(|error| format!("The document cannot be packed: {error}."))?;
    let link = with_view('p', &bytes, view)?;
    if link.len() <= MOST_CHARACTERS {
        return Ok(link);
    }
    let gestures = gestures::write(document).map(|bytes| with_view('g', &bytes, view)).transpose()?;
    gestures.filter(|link| link.len() <= MOST_CHARACTERS).ok_or_else(|| {
        format!(
            "The document takes {} characters in a link, and browsers and mail programs pass on {}. Save the project and \
             send the file.",
            Grouped(link.len()),
            Grouped(MOST_CHARACTERS)
        )
    })
}

fn with_view(kind: char, bytes: &[u8], view: &LinkView) -> Result<String, String> {
    let packed = URL_SAFE_NO_PAD.encode(bytes);
    let view = serde_json::to_vec(view).map_err(|error| format!("The view cannot be packed: {error}."))?;
    Ok(format!("{VERSION}.{kind}.{packed}.{}", URL_SAFE_NO_PAD.encode(view)))
}

/// Returns the document of the part of a link after `#`.
///
/// # Errors
/// Fails with a sentence when the link is damaged or too long, or was made by a newer program.
pub fn read(link: &str) -> Result<Linked, String> {
    if link.len() > MOST_READ {
        return Err(format!(
            "The link has {} characters, and at most {} are read. Ask for the project as a file.",
            Grouped(link.len()),
            Grouped(MOST_READ)
        ));
    }
    let (version, packed) = link.split_once('.').ok_or(DAMAGED)?;
    let version: u32 = version.parse().map_err(|_| DAMAGED)?;
    if version > VERSION {
        return Err(format!(
            "The link was made by a newer Meshbrush (version {version} of links, and this one reads up to {VERSION}). Load \
             the page again to get the newest."
        ));
    }
    let parts: Vec<&str> = packed.splitn(3, '.').collect();
    let &[kind, packed, view] = &parts[..] else { return Err(DAMAGED.into()) };
    let view = if view.len() <= MOST_OF_VIEW { decoded(view)? } else { return Err(DAMAGED.into()) };
    let view: LinkView = serde_json::from_slice(&view).map_err(|_| DAMAGED)?;
    let is_number = |side: &f64| side.is_finite();
    if !view.area.is_none_or(|area| area.iter().all(is_number) && area[0] < area[2] && area[1] < area[3]) {
        return Err(DAMAGED.into());
    }
    if !view.space.is_none_or(|space| space.is_possible()) {
        return Err(DAMAGED.into());
    }
    let document = match kind {
        "p" => of_project(packed)?,
        // No longer ones are written: to do edits again takes time.
        "g" if packed.len() <= MOST_CHARACTERS => {
            gestures::read(&decoded(packed)?).map_err(|problem| format!("{DAMAGED} ({problem})"))?
        }
        _ => return Err(DAMAGED.into()),
    };
    Ok(Linked { document, view })
}

fn of_project(packed: &str) -> Result<Document, String> {
    let project = project::from_bytes(&decoded(packed)?, Path::new("The link"));
    project.map_err(|error| format!("{DAMAGED} ({error})")).and_then(Project::into_document)
}

fn decoded(text: &str) -> Result<Vec<u8>, String> {
    URL_SAFE_NO_PAD.decode(text).map_err(|_| DAMAGED.to_owned())
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use meshbrush_core::document::{Example, Settings};
    use meshbrush_core::paint::{Brush, Medium};

    fn document() -> Document {
        Document::new(Settings::default(), None).unwrap()
    }

    fn view() -> LinkView {
        LinkView {
            area: Some([0.1, 0.25, 0.3, 0.5]),
            tool: Some("Brush".into()),
            step: Some(12),
            space: Some(space()),
        }
    }

    fn space() -> LinkSpace {
        LinkSpace { direction: [120.0, 30.0], exaggeration: Some(2.5), height: Some(-7.0) }
    }

    fn is_of_a_link(link: &str) -> bool {
        link.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte))
    }

    /// The default document of the window with some strokes, as a person paints them.
    fn painted(strokes: u32) -> Document {
        let mut document = Example::Threats.without_data();
        document.record();
        for n in 0..strokes {
            let brush = Brush { medium: Medium::Risk(0.8), radius: 0.03, hardness: 0.4, strength: 0.7 };
            document.begin_stroke(brush);
            for step in 0..40 {
                let at = 0.1 + 0.02 * f64::from(step);
                document.extend_stroke(dvec2(at, 0.2 + 0.1 * f64::from(n) + 0.03 * (9.0 * at).sin()));
            }
            document.end_stroke();
        }
        document.undo();
        document
    }

    #[test]
    fn a_link_is_read_as_the_document_that_it_was_made_from() {
        for view in [LinkView::default(), view()] {
            let link = write(&document(), &view).unwrap();
            assert!(is_of_a_link(&link), "{link}");
            let read = read(&link).unwrap();
            assert_eq!((Project::of(&read.document), read.view), (Project::of(&document()), view));
        }
    }

    #[test]
    fn paint_that_is_too_long_is_sent_as_the_gestures_that_made_it() {
        let painted = painted(4);
        let link = write(&painted, &view()).unwrap();
        assert!(link.starts_with("1.g.") && is_of_a_link(&link), "{}", &link[..20]);
        assert!(link.len() < 10_000, "{} characters", link.len());
        let read = read(&link).unwrap();
        assert_eq!((Project::of(&read.document), read.view), (Project::of(&painted), view()));
        assert!(read.document.history().is_empty(), "nothing is left to undo");
        // Without a recording there are only the pixels.
        let mut project = Project::of(&painted).into_document().unwrap();
        assert!(write(&project, &view()).unwrap_err().contains("Save the project"));
        project.record();
        assert!(write(&project, &view()).unwrap_err().contains("Save the project"));
    }

    #[test]
    fn a_link_that_is_damaged_newer_or_too_long_is_refused_with_a_sentence() {
        let whole = [
            write(&document(), &LinkView::default()).unwrap(),
            write(&document(), &view()).unwrap(),
            write(&painted(2), &view()).unwrap(),
        ];
        for link in whole {
            let parts = link.rfind('.').unwrap();
            for cut in [0, 1, 2, 10, link.len() / 2, parts, link.len() - 1] {
                let problem = read(&link[..cut]).unwrap_err();
                assert!(problem.starts_with("The link is damaged"), "{cut}: {problem}");
            }
            let mut changed = link.clone().into_bytes();
            let middle = changed.len() / 3;
            changed[middle] = if changed[middle] == b'A' { b'B' } else { b'A' };
            let changed = String::from_utf8(changed).unwrap();
            assert!(read(&changed).unwrap_err().starts_with("The link is damaged"));
            let newer = format!("9{}", &link[1..]);
            assert!(read(&newer).unwrap_err().contains("newer Meshbrush"), "{newer}");
        }
        for area in ["[0,0,0,1]", "[0,0,1e999,1]", "[0,0,1]"] {
            let view = URL_SAFE_NO_PAD.encode(format!("{{\"area\":{area}}}"));
            let packed = write(&document(), &LinkView::default()).unwrap();
            let (project, _) = packed.rsplit_once('.').unwrap();
            let problem = read(&format!("{project}.{view}")).unwrap_err();
            assert!(problem.starts_with("The link is damaged"), "{area}: {problem}");
        }
        let long = format!("1.{}", "A".repeat(MOST_READ));
        let problem = read(&long).unwrap_err();
        assert!(problem.contains("at most 8,388,608 are read"), "{problem}");
    }
}
