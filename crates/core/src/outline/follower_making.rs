//! A follower of an outline is made in steps.

use std::ops::ControlFlow;

use super::OutlineFollower;
use super::changes::FittedBand;
use super::line::OutlineOnLattice;
use super::writer::{Writer, Written};
use crate::domain::DomainOnLattice;
use crate::mesh::Mesh;

/// A follower takes in a whole band, some triangles at a time.
pub(super) struct FollowerMaking {
    follower: OutlineFollower,
    written: Written,
    /// How many triangles it has: first those of the band, then those beside it that the outline touches.
    done: usize,
}

impl FollowerMaking {
    /// Begins. Mesh, outline and band are always the same.
    pub fn new(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        outline: &OutlineOnLattice,
        fitted: &FittedBand,
    ) -> Self {
        let follower = OutlineFollower::empty(mesh, domain, outline, fitted);
        Self { follower, written: Written::new(fitted), done: 0 }
    }

    /// Takes in a limited number of triangles. Returns the follower at the end.
    pub fn advance(
        self,
        mesh: &Mesh,
        outline: &OutlineOnLattice,
        fitted: &FittedBand,
        most: usize,
    ) -> ControlFlow<OutlineFollower, Self> {
        let Self { mut follower, written, done } = self;
        let (of_band, beside) = (fitted.band.ids.len(), &fitted.band.touched);
        let end = done.saturating_add(most).min(of_band + beside.len());
        let mut writer = Writer::going_on(mesh, fitted, outline, written);
        for number in done..end {
            match number.checked_sub(of_band) {
                None => writer.write(&mut follower, number as u32),
                Some(number) => {
                    let (id, inside) = beside[number];
                    follower.write_beside(mesh, id, inside);
                }
            }
        }
        if end == of_band + beside.len() {
            return ControlFlow::Break(follower);
        }
        ControlFlow::Continue(Self { follower, written: writer.into_written(), done: end })
    }
}
