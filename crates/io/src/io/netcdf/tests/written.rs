//! Classic files, written by the rules of the format without any code of the reader.

/// The value of an attribute: text, or numbers of the type with this code.
#[derive(Clone)]
pub(crate) enum Of {
    Text(&'static str),
    Numbers(u32, Vec<f64>),
}

/// A variable.
#[derive(Clone)]
pub(crate) struct Written {
    pub(crate) name: &'static str,
    /// The code of its type.
    pub(crate) code: u32,
    /// The numbers of its dimensions.
    pub(crate) dimensions: Vec<usize>,
    pub(crate) attributes: Vec<(&'static str, Of)>,
    pub(crate) samples: Vec<f64>,
}

/// A file.
#[derive(Clone)]
pub(crate) struct File {
    /// 1, 2 or 5.
    pub(crate) version: u8,
    pub(crate) dimensions: Vec<(&'static str, usize)>,
    /// The dimension that is written record by record.
    pub(crate) record: Option<usize>,
    pub(crate) attributes: Vec<(&'static str, Of)>,
    pub(crate) variables: Vec<Written>,
}

impl File {
    /// Returns a file in CDF-1 of the values of a variable `z`, row by row in the order of `lat`.
    pub(crate) fn grid(lon: &[f64], lat: &[f64], code: u32, samples: Vec<f64>) -> Self {
        let axis = |name, dimension, unit, samples: &[f64]| Written {
            name,
            code: 6,
            dimensions: vec![dimension],
            attributes: vec![("units", Of::Text(unit))],
            samples: samples.to_vec(),
        };
        let z = Written { name: "z", code, dimensions: vec![0, 1], attributes: Vec::new(), samples };
        Self {
            version: 1,
            dimensions: vec![("lat", lat.len()), ("lon", lon.len())],
            record: None,
            attributes: vec![("Conventions", Of::Text("CF-1.8"))],
            variables: vec![axis("lat", 0, "degrees_north", lat), axis("lon", 1, "degrees_east", lon), z],
        }
    }

    /// Returns the file with an attribute of `z`.
    pub(crate) fn with(mut self, name: &'static str, value: Of) -> Self {
        self.z().attributes.push((name, value));
        self
    }

    /// The variable `z`, which is the last.
    pub(crate) fn z(&mut self) -> &mut Written {
        self.variables.last_mut().unwrap()
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        let length = self.header(&vec![0; self.variables.len()]).len();
        let is_record = |variable: &&Written| {
            self.record.is_some() && variable.dimensions.first() == self.record.as_ref()
        };
        let records = self.record.map_or(0, |dimension| self.dimensions[dimension].1);
        let alone = self.variables.iter().filter(is_record).count() == 1;
        let mut data = Vec::new();
        let mut begins = vec![0; self.variables.len()];
        let whole = self.variables.iter().enumerate().filter(|(_, variable)| !is_record(variable));
        for (number, variable) in whole {
            begins[number] = length + data.len();
            variable.samples.iter().for_each(|&sample| data.extend(encoded(variable.code, sample)));
            data.resize(data.len().next_multiple_of(4), 0);
        }
        for record in 0..records {
            for (number, variable) in
                self.variables.iter().enumerate().filter(|(_, variable)| is_record(variable))
            {
                if record == 0 {
                    begins[number] = length + data.len();
                }
                let part = variable.samples.len() / records;
                let samples = &variable.samples[record * part..][..part];
                samples.iter().for_each(|&sample| data.extend(encoded(variable.code, sample)));
                if !alone {
                    data.resize(data.len().next_multiple_of(4), 0);
                }
            }
        }
        [self.header(&begins), data].concat()
    }

    fn header(&self, begins: &[usize]) -> Vec<u8> {
        let mut header = Put { bytes: vec![b'C', b'D', b'F', self.version], is_long: self.version == 5 };
        header.count(self.record.map_or(0, |dimension| self.dimensions[dimension].1));
        header.list(10, self.dimensions.len());
        for (number, (name, length)) in self.dimensions.iter().enumerate() {
            header.name(name);
            header.count(if self.record == Some(number) { 0 } else { *length });
        }
        header.attributes(&self.attributes);
        header.list(11, self.variables.len());
        for (variable, begin) in self.variables.iter().zip(begins) {
            header.name(variable.name);
            header.count(variable.dimensions.len());
            variable.dimensions.iter().for_each(|&dimension| header.count(dimension));
            header.attributes(&variable.attributes);
            header.u32(variable.code as usize);
            header.count(0); // The size, which readers work out themselves.
            match self.version {
                1 => header.u32(*begin),
                _ => header.bytes.extend((*begin as u64).to_be_bytes()),
            }
        }
        header.bytes
    }
}

/// A header that grows.
struct Put {
    bytes: Vec<u8>,
    is_long: bool,
}

impl Put {
    fn u32(&mut self, number: usize) {
        self.bytes.extend((number as u32).to_be_bytes());
    }

    fn count(&mut self, number: usize) {
        if self.is_long { self.bytes.extend((number as u64).to_be_bytes()) } else { self.u32(number) }
    }

    fn list(&mut self, kind: usize, count: usize) {
        self.u32(if count == 0 { 0 } else { kind });
        self.count(count);
    }

    fn name(&mut self, name: &str) {
        self.count(name.len());
        self.bytes.extend(name.bytes());
        self.pad();
    }

    fn pad(&mut self) {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    fn attributes(&mut self, attributes: &[(&'static str, Of)]) {
        self.list(12, attributes.len());
        for (name, value) in attributes {
            self.name(name);
            match value {
                Of::Text(text) => {
                    self.u32(2);
                    self.name(text);
                }
                Of::Numbers(code, numbers) => {
                    self.u32(*code as usize);
                    self.count(numbers.len());
                    numbers.iter().for_each(|&number| self.bytes.extend(encoded(*code, number)));
                    self.pad();
                }
            }
        }
    }
}

/// Returns a number in the type with a code.
pub(crate) fn encoded(code: u32, number: f64) -> Vec<u8> {
    match code {
        1 => (number as i8).to_be_bytes().to_vec(),
        3 => (number as i16).to_be_bytes().to_vec(),
        4 => (number as i32).to_be_bytes().to_vec(),
        5 => (number as f32).to_be_bytes().to_vec(),
        6 => number.to_be_bytes().to_vec(),
        7 => (number as u8).to_be_bytes().to_vec(),
        8 => (number as u16).to_be_bytes().to_vec(),
        9 => (number as u32).to_be_bytes().to_vec(),
        10 => (number as i64).to_be_bytes().to_vec(),
        _ => (number as u64).to_be_bytes().to_vec(),
    }
}
