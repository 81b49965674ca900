use crate::mesh::kernel::{NodeId, TriangleId};

/// The numbers that triangles and nodes have in an [`Extract`](crate::mesh::Extract), and so in files,
/// without making one.
///
/// A [`Survey`](crate::mesh::Survey) finds them in slices. They take a quarter of a byte for each triangle
/// and node.
#[derive(Clone, Debug)]
pub struct Numbering {
    pub(in crate::mesh) triangles: RankBits,
    pub(in crate::mesh) nodes: RankBits,
}

impl Numbering {
    /// The number of a triangle; `None` for one that lies outside the domain.
    ///
    /// # Panics
    /// When the id is not of the mesh that was surveyed.
    pub fn triangle(&self, id: TriangleId) -> Option<TriangleId> {
        self.triangles.rank(id.index()).map(TriangleId::from_index)
    }

    /// The number of a node; `None` for one that only triangles outside the domain have.
    ///
    /// # Panics
    /// When the id is not of the mesh that was surveyed.
    pub fn node(&self, id: NodeId) -> Option<NodeId> {
        self.nodes.rank(id.index()).map(NodeId::from_index)
    }
}

/// A rank bit vector: bits, with the count of ones before each word.
#[derive(Clone, Debug, Default)]
pub(in crate::mesh) struct RankBits {
    count: usize,
    yes: u32,
    /// 64 answers at a time, and how often yes came before them.
    words: Vec<(u64, u32)>,
}

impl RankBits {
    pub(in crate::mesh) fn push(&mut self, answer: bool) {
        if self.count.is_multiple_of(64) {
            self.words.push((0, self.yes));
        }
        let (bits, _) = self.words.last_mut().expect("just pushed, or not full");
        *bits |= u64::from(answer) << (self.count % 64);
        self.yes += u32::from(answer);
        self.count += 1;
    }

    fn rank(&self, index: usize) -> Option<usize> {
        let (bits, before) = self.words[index / 64];
        let below = bits & ((1 << (index % 64)) - 1);
        (bits >> (index % 64) & 1 == 1).then_some(before as usize + below.count_ones() as usize)
    }
}

impl FromIterator<bool> for RankBits {
    fn from_iter<I: IntoIterator<Item = bool>>(answers: I) -> Self {
        let mut ranks = Self::default();
        answers.into_iter().for_each(|answer| ranks.push(answer));
        ranks
    }
}
