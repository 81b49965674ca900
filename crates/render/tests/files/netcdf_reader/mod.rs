//! A reader of NetCDF in its classic form, after the specification: CDF-1 and CDF-2 without a record
//! dimension.

use std::collections::BTreeMap;

/// A file.
#[derive(Debug)]
pub struct NetCdf {
    pub dimensions: BTreeMap<String, usize>,
    pub attributes: BTreeMap<String, Attribute>,
    variables: BTreeMap<String, (BTreeMap<String, Attribute>, Vec<f64>)>,
}

/// The value of an attribute.
#[derive(Debug, PartialEq)]
pub enum Attribute {
    Text(String),
    Numbers(Vec<f64>),
}

impl NetCdf {
    /// Reads a whole file. Every byte of it must belong to something.
    pub fn read(file: &[u8]) -> Self {
        assert!(file.starts_with(b"CDF") && [1, 2].contains(&file[3]));
        let mut header = Header { file, at: 4 };
        assert_eq!(header.number(), 0, "records");
        let lengths: Vec<(String, usize)> =
            header.list(10, |header| (header.name(), header.number() as usize));
        let attributes = header.attributes();
        let entries = header.list(11, |header| {
            let name = header.name();
            let count = header.number();
            let shape: Vec<usize> = (0..count).map(|_| lengths[header.number() as usize].1).collect();
            let attributes = header.attributes();
            let (kind, bytes) = (header.number(), header.number() as usize);
            let begin = if file[3] == 1 { header.number().into() } else { header.long() } as usize;
            (name, shape, attributes, kind, bytes, begin)
        });
        let (mut variables, mut end) = (BTreeMap::new(), header.at);
        for (name, shape, attributes, kind, bytes, begin) in entries {
            assert_eq!(begin, end, "the values of {name} follow those before");
            end += bytes;
            let values = numbers(&file[begin..end], kind);
            assert_eq!(values.len(), shape.iter().product::<usize>(), "{name}");
            assert!(variables.insert(name, (attributes, values)).is_none(), "a name occurs twice");
        }
        assert_eq!(end, file.len());
        Self { dimensions: lengths.into_iter().collect(), attributes, variables }
    }

    pub fn values(&self, variable: &str) -> &[f64] {
        &self.variables.get(variable).unwrap_or_else(|| panic!("{variable}")).1
    }

    pub fn attributes_of(&self, variable: &str) -> &BTreeMap<String, Attribute> {
        &self.variables.get(variable).unwrap_or_else(|| panic!("{variable}")).0
    }
}

fn numbers(bytes: &[u8], kind: u32) -> Vec<f64> {
    match kind {
        4 => bytes.chunks(4).map(|b| i32::from_be_bytes(b.try_into().unwrap()).into()).collect(),
        6 => bytes.chunks(8).map(|b| f64::from_be_bytes(b.try_into().unwrap())).collect(),
        other => panic!("a type {other}"),
    }
}

struct Header<'a> {
    file: &'a [u8],
    at: usize,
}

impl Header<'_> {
    fn take(&mut self, count: usize) -> &[u8] {
        self.at += count;
        &self.file[self.at - count..self.at]
    }

    fn number(&mut self) -> u32 {
        u32::from_be_bytes(self.take(4).try_into().unwrap())
    }

    fn long(&mut self) -> u64 {
        u64::from_be_bytes(self.take(8).try_into().unwrap())
    }

    /// Bytes that are padded with zeros to a multiple of four.
    fn padded(&mut self, count: usize) -> Vec<u8> {
        let bytes = self.take(count).to_vec();
        assert!(self.take(count.next_multiple_of(4) - count).iter().all(|&byte| byte == 0));
        bytes
    }

    fn name(&mut self) -> String {
        let count = self.number() as usize;
        String::from_utf8(self.padded(count)).unwrap()
    }

    fn list<T>(&mut self, kind: u32, mut read: impl FnMut(&mut Self) -> T) -> Vec<T> {
        let (found, count) = (self.number(), self.number());
        assert_eq!(found, if count == 0 { 0 } else { kind });
        (0..count).map(|_| read(self)).collect()
    }

    fn attributes(&mut self) -> BTreeMap<String, Attribute> {
        let read = |header: &mut Self| {
            let name = header.name();
            let (kind, count) = (header.number(), header.number() as usize);
            let value = match kind {
                2 => Attribute::Text(String::from_utf8(header.padded(count)).unwrap()),
                kind => {
                    let bytes = if kind == 4 { 4 * count } else { 8 * count };
                    Attribute::Numbers(numbers(header.take(bytes), kind))
                }
            };
            (name, value)
        };
        self.list(12, read).into_iter().collect()
    }
}
