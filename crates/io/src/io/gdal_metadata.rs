//! What GDAL writes about the values of a band: in the tag `GDAL_METADATA` of a GeoTIFF, and in the file
//! `.aux.xml` beside a raster of any format.

use std::ffi::OsString;
use std::io::Read;
use std::path::Path;

use roxmltree::{Document, Node};

use super::disk::File;

/// Most bytes of a description that are read. Statistics and histograms have a few thousand.
const MOST_BYTES: u64 = 1 << 22;

/// What is said about the values of a band.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BandMetadata {
    /// What samples are multiplied by, before `offset` is added.
    pub(super) scale: Option<f64>,
    pub(super) offset: Option<f64>,
    /// The name of the unit of values.
    pub(super) unit: Option<String>,
    /// The number of pixels without a value.
    pub(super) no_data: Option<String>,
}

impl BandMetadata {
    /// Returns what the tag of a GeoTIFF says about a band, counted from 0; nothing where it is damaged.
    pub(super) fn from_tag(xml: &str, band: usize) -> Self {
        let Ok(document) = Document::parse(xml) else { return Self::default() };
        let is_of_band = |item: &Node| {
            item.attribute("sample").and_then(|sample| sample.parse().ok()).unwrap_or(0) == band
        };
        let items = document.descendants().filter(|node| node.has_tag_name("Item")).filter(is_of_band);
        let mut metadata = Self::default();
        for item in items {
            let text = item.text().unwrap_or_default().trim();
            match item.attribute("role") {
                Some("scale") => metadata.scale = text.parse().ok(),
                Some("offset") => metadata.offset = text.parse().ok(),
                Some("unittype") => metadata.unit = Some(text.to_owned()),
                _ => {}
            }
        }
        metadata
    }

    /// Returns what the file beside a raster says about a band, counted from 0; nothing without one.
    pub(super) fn beside(path: &Path, band: usize) -> Self {
        let mut name: OsString = path.file_name().unwrap_or_default().to_owned();
        name.push(".aux.xml");
        let Ok(file) = File::open(path.with_file_name(name)) else { return Self::default() };
        let mut bytes = Vec::new();
        match file.take(MOST_BYTES).read_to_end(&mut bytes) {
            Ok(_) => Self::from_description(&String::from_utf8_lossy(&bytes), band),
            Err(_) => Self::default(),
        }
    }

    fn from_description(xml: &str, band: usize) -> Self {
        let Ok(document) = Document::parse(xml) else { return Self::default() };
        let number = (band + 1).to_string();
        let of_band = |node: &Node| {
            node.has_tag_name("PAMRasterBand") && node.attribute("band").unwrap_or("1") == number
        };
        let Some(described) = document.descendants().find(of_band) else { return Self::default() };
        let text = |name: &str| {
            let child = described.children().find(|child| child.has_tag_name(name));
            child.and_then(|child| child.text()).map(|text| text.trim().to_owned())
        };
        let parsed = |name: &str| text(name).and_then(|text| text.parse().ok());
        Self {
            scale: parsed("Scale"),
            offset: parsed("Offset"),
            unit: text("UnitType"),
            no_data: text("NoDataValue"),
        }
    }

    /// Returns the same, with what `other` says where this says nothing.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            scale: self.scale.or(other.scale),
            offset: self.offset.or(other.offset),
            unit: self.unit.or(other.unit),
            no_data: self.no_data.or(other.no_data),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_is_described_in_the_tag_and_beside_the_file() {
        let tag = r#"<GDALMetadata><Item name="x">1</Item><Item name="SCALE" sample="1" role="scale">0.1</Item>
            <Item name="OFFSET" sample="1" role="offset">-5</Item>
            <Item name="UNITTYPE" sample="1" role="unittype">US survey foot</Item></GDALMetadata>"#;
        let unit = Some("US survey foot".to_owned());
        let expected = BandMetadata { scale: Some(0.1), offset: Some(-5.0), unit, no_data: None };
        assert_eq!(BandMetadata::from_tag(tag, 1), expected);
        assert_eq!(BandMetadata::from_tag(tag, 0), BandMetadata::default());
        let beside = r#"<PAMDataset><PAMRasterBand band="2"><Scale>0.1</Scale><Offset>-5</Offset>
            <UnitType>US survey foot</UnitType></PAMRasterBand></PAMDataset>"#;
        assert_eq!(BandMetadata::from_description(beside, 1), expected);
        for text in ["", "<", "<a/>", "<GDALMetadata>"] {
            assert_eq!(
                BandMetadata::from_tag(text, 0).or(BandMetadata::from_description(text, 0)),
                BandMetadata::default()
            );
        }
    }
}
