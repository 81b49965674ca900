use std::path::{Path, PathBuf};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::checks::rings;
use super::kinds::LayerKeys;
use super::{
    KeyGroup, LayerData, LayerOrigin, SavedCombine, SavedKind, SavedPolygon, TableEntries, each,
    saved_polygon,
};
use super::{SavedShape, Stored};
use crate::io::lengths::TextContext;
use crate::io::{KeyFault, TextValue};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{DistanceLayer, Layer, LayerId, Threats};

/// A layer as a text has it.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedLayer {
    /// The name of the layer; without one, it is named after its kind.
    pub name: Option<String>,
    /// The keys that layers of all kinds have.
    pub shared: SharedKeys,
    /// The keys of its kind.
    pub keys: LayerKeys,
}

/// The first keys of a layer.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Heading {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    kind: SavedKind,
}

/// The keys that layers of all kinds have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SharedKeys {
    /// A hidden layer asks for nothing.
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    pub visible: bool,
    /// A locked layer cannot be edited.
    #[serde(default, skip_serializing_if = "is_no")]
    pub locked: bool,
    /// How it is combined with the layers below.
    #[serde(default, skip_serializing_if = "SavedCombine::is_default")]
    pub combine: SavedCombine,
    /// Where it counts: polygons, each a list of rings, the outer one first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask: Option<Vec<SavedPolygon>>,
    /// Where it counts: a file with polygons.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask_file: Option<PathBuf>,
}

impl Default for SharedKeys {
    fn default() -> Self {
        Self { visible: true, locked: false, combine: SavedCombine::Finest, mask: None, mask_file: None }
    }
}

/// Which lists of a layer stand beside its other keys. Those that do not are in files, or in parts of a
/// project.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ListsInPlace {
    /// Shapes or threats.
    pub data: bool,
    /// The polygons of its mask.
    pub mask: bool,
}

impl ListsInPlace {
    /// All of them.
    pub const ALL: Self = Self { data: true, mask: true };
}

impl<K: Into<LayerKeys>> From<K> for SavedLayer {
    /// Returns a visible layer that is named after its kind.
    fn from(keys: K) -> Self {
        Self { name: None, shared: SharedKeys::default(), keys: keys.into() }
    }
}

impl SavedLayer {
    /// Reads a layer from its table.
    ///
    /// # Errors
    /// Fails for the first key that no layer of its kind has, is missing, or has a value of another type.
    pub fn of_table(table: TextValue, context: &TextContext) -> Result<Self, KeyFault> {
        let Some(mut entries) = TableEntries::of(table, context) else {
            return Err(KeyFault::here("a layer must be a table."));
        };
        let Heading { name, kind } = Heading::take(&mut entries)?;
        check_keys(kind, &entries)?;
        let shared = SharedKeys::take(&mut entries)?;
        let keys = LayerKeys::take(kind, &mut entries).map_err(|fault| match fault.missing {
            Some(key) if fault.path.is_empty() => {
                KeyFault::entry("kind", format!("a layer of the kind \"{}\" needs `{key}`.", kind.word()))
            }
            _ => fault,
        })?;
        Ok(Self { name, shared, keys })
    }

    /// Returns a layer of a stack, but for data that has no form as text: `file` names where that is.
    pub fn of(layer: &Layer, file: Option<PathBuf>, in_place: ListsInPlace) -> Self {
        let mut keys = LayerKeys::of(layer);
        if let Some(key) = keys.file_key() {
            *key = file;
        }
        if in_place.data {
            keys.set_lists(layer);
        }
        let polygons = layer.mask.as_ref().filter(|_| in_place.mask).map(|mask| mask.polygons());
        let shared = SharedKeys {
            visible: layer.visible,
            locked: layer.locked,
            combine: layer.combine.into(),
            mask: polygons.map(|polygons| polygons.iter().map(saved_polygon).collect()),
            mask_file: None,
        };
        Self { name: Some(layer.name.clone()), shared, keys }
    }

    /// Returns the kind.
    pub fn kind(&self) -> SavedKind {
        self.keys.kind()
    }

    /// Returns the name of the layer, or the default one of its kind.
    pub fn shown_name(&self) -> &str {
        self.name.as_deref().unwrap_or(self.kind().default_name())
    }

    /// Checks every value. Files are not read.
    ///
    /// # Errors
    /// Fails for the first key that is missing, or has a value that cannot be used.
    pub fn check(&self, stored: Stored) -> Result<(), KeyFault> {
        self.mask_in_place()?;
        self.keys.check(stored)
    }

    /// Returns the polygons of the mask, if they are in place.
    pub(super) fn mask_in_place(&self) -> Result<Option<Vec<Polygon>>, KeyFault> {
        match (&self.shared.mask, &self.shared.mask_file) {
            (None, _) => Ok(None),
            (Some(_), Some(_)) => {
                Err(KeyFault::key("mask_file", "a layer has `mask` or `mask_file`, not both."))
            }
            (Some(polygons), None) if polygons.is_empty() => {
                Err(KeyFault::value("mask", "a mask needs a polygon at least; leave it out to mask nothing."))
            }
            (Some(polygons), None) => {
                each("mask", polygons, |polygon: &SavedPolygon| rings(polygon)).map(Some)
            }
        }
    }

    /// Returns which layer its data belong to.
    pub fn origin(&self) -> LayerOrigin<'_> {
        LayerOrigin { name: self.shown_name(), file: self.keys.file().unwrap_or(Path::new("")) }
    }

    /// Returns the layer, with its data. What is painted is not part of a layer.
    ///
    /// # Errors
    /// Fails with the errors of `data`; when a value cannot be used; and a sentence that names the layer when
    /// its data cannot be used.
    pub fn load<D: LayerData>(&self, id: LayerId, data: &mut D) -> Result<Layer, D::Error> {
        self.check(D::STORED)?;
        let origin = self.origin();
        let kind = self.keys.load(&origin, data)?;
        let mask = match (self.mask_in_place()?, &self.shared.mask_file) {
            (Some(polygons), _) => Some(origin.mask_of_polygons(&polygons)?),
            (None, Some(file)) => Some(data.mask(&origin, file)?),
            (None, None) => None,
        };
        let SharedKeys { visible, locked, combine, .. } = self.shared;
        let (name, combine) = (origin.name.to_owned(), combine.into());
        Ok(Layer { id, name, visible, locked, combine, mask, kind })
    }
}

impl LayerKeys {
    /// Puts the shapes or the threats of a layer of a stack in place.
    fn set_lists(&mut self, layer: &Layer) {
        let shapes = || {
            let shapes = layer.kind.get::<DistanceLayer>()?.to.shapes()?;
            Some(SavedShape::of_list(shapes.list()))
        };
        match self {
            Self::Distance(keys) => keys.target.shapes.shapes = shapes(),
            Self::Corridor(keys) => keys.along.shapes = shapes(),
            Self::Threats(keys) => {
                let list = layer.kind.get::<Threats>().map(Threats::list);
                keys.threats = list.map(|list| list.iter().copied().map(Into::into).collect());
            }
            _ => {}
        }
    }
}

/// Checks that a table has only keys of its kind. The advice names those.
fn check_keys(kind: SavedKind, entries: &TableEntries<'_>) -> Result<(), KeyFault> {
    let (shared, own) = (SharedKeys::names(), kind.keys());
    let is_known = |key: &str| shared.contains(&key) || own.contains(&key);
    let Some(key) = entries.keys().find(|key| !is_known(key)) else { return Ok(()) };
    let others: Vec<&str> =
        SavedKind::ALL.iter().filter(|kind| kind.keys().contains(&key)).map(|kind| kind.word()).collect();
    if others.is_empty() {
        let known = [Heading::names(), shared, own].concat();
        return Err(KeyFault::unknown_key(key, &known).of_key(key));
    }
    let (word, own, others) = (kind.word(), own.join(", "), others.join(", "));
    let sentence = format!(
        "a layer of the kind \"{word}\" has no `{key}`; its own keys are {own}. Kinds with `{key}`: {others}."
    );
    Err(KeyFault::key(key.to_owned(), sentence))
}

impl<'de> Deserialize<'de> for SavedLayer {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let table = TextValue::deserialize(from)?;
        Self::of_table(table, &TextContext::default())
            .map_err(|fault| D::Error::custom(fault.to_string().trim_end_matches('.')))
    }
}

impl Serialize for SavedLayer {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        /// All keys in the order of a text.
        #[derive(Serialize)]
        struct AllKeys<'l> {
            #[serde(flatten)]
            heading: Heading,
            #[serde(flatten)]
            shared: &'l SharedKeys,
            #[serde(flatten)]
            keys: &'l LayerKeys,
        }
        let heading = Heading { name: self.name.clone(), kind: self.kind() };
        AllKeys { heading, shared: &self.shared, keys: &self.keys }.serialize(to)
    }
}

fn yes() -> bool {
    true
}

fn is_yes(value: &bool) -> bool {
    *value
}

fn is_no(value: &bool) -> bool {
    !value
}
