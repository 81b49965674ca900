//! Finds the differences between the pictures of the window in this frame and in the previous one.

use std::ops::Range;

use eframe::egui::epaint::{ClippedPrimitive, Primitive, Vertex};
use eframe::egui::{Mesh, Rect};

use meshbrush_render::render::software::Damage;

/// How far ahead a primitive that is not at its place is looked for.
const LOOK_AHEAD: usize = 12;

/// Returns a rectangle in points as columns and rows of pixels, as the graphics driver clips.
pub fn px_rect(rect: Rect, px_per_point: f32) -> [Range<i32>; 2] {
    let px = |points: f32| (points * px_per_point).round() as i32;
    [px(rect.min.x)..px(rect.max.x), px(rect.min.y)..px(rect.max.y)]
}

/// Adds the pixels where two lists of primitives can look different. The canvas is not looked into.
pub fn compare(
    former: &[ClippedPrimitive],
    present: &[ClippedPrimitive],
    px_per_point: f32,
    damage: &mut Damage,
) {
    let mut marks = Marks { px_per_point, damage };
    let (mut old, mut new) = (former, present);
    while let ([a, old_rest @ ..], [b, new_rest @ ..]) = (old, new) {
        if are_alike(a, b) {
            marks.compare(a, b);
            (old, new) = (old_rest, new_rest);
        } else if let Some(ahead) = new.iter().take(LOOK_AHEAD).position(|b| are_alike(a, b)) {
            new[..ahead].iter().for_each(|b| marks.add_all(b));
            new = &new[ahead..];
        } else {
            marks.add_all(a);
            old = old_rest;
        }
    }
    old.iter().chain(new).for_each(|primitive| marks.add_all(primitive));
}

/// Returns whether one primitive can be the other one after a change.
fn are_alike(a: &ClippedPrimitive, b: &ClippedPrimitive) -> bool {
    a.clip_rect == b.clip_rect
        && match (&a.primitive, &b.primitive) {
            (Primitive::Mesh(a), Primitive::Mesh(b)) => a.texture_id == b.texture_id,
            (Primitive::Callback(a), Primitive::Callback(b)) => a.rect == b.rect,
            _ => false,
        }
}

struct Marks<'a> {
    px_per_point: f32,
    damage: &'a mut Damage,
}

impl Marks<'_> {
    fn compare(&mut self, a: &ClippedPrimitive, b: &ClippedPrimitive) {
        let (Primitive::Mesh(old), Primitive::Mesh(new)) = (&a.primitive, &b.primitive) else { return };
        if old == new {
            return;
        }
        let clip = px_rect(a.clip_rect, self.px_per_point);
        let pairs = || triangles(old).zip(triangles(new));
        if old.indices.len() == new.indices.len() {
            for (a, b) in pairs().filter(|(a, b)| a != b) {
                self.add(a, &clip);
                self.add(b, &clip);
            }
            return;
        }
        let least = old.indices.len().min(new.indices.len()) / 3;
        let first = pairs().take_while(|(a, b)| a == b).count();
        let from_end = triangles(old).rev().zip(triangles(new).rev());
        let last = from_end.take(least - first).take_while(|(a, b)| a == b).count();
        for mesh in [old, new] {
            let middle = mesh.indices.len() / 3 - first - last;
            triangles(mesh).skip(first).take(middle).for_each(|corners| self.add(corners, &clip));
        }
    }

    fn add_all(&mut self, primitive: &ClippedPrimitive) {
        let clip = px_rect(primitive.clip_rect, self.px_per_point);
        match &primitive.primitive {
            Primitive::Mesh(mesh) => triangles(mesh).for_each(|corners| self.add(corners, &clip)),
            Primitive::Callback(_) => {
                let [columns, rows] = clip;
                self.damage.add(columns, rows);
            }
        }
    }

    fn add(&mut self, corners: [&Vertex; 3], clip: &[Range<i32>; 2]) {
        let mut around = Rect::NOTHING;
        corners.iter().for_each(|corner| around.extend_with(corner.pos));
        let [columns, rows] = px_rect(around, self.px_per_point);
        let within = |range: Range<i32>, clip: &Range<i32>| {
            range.start.saturating_sub(1).max(clip.start)..range.end.saturating_add(1).min(clip.end)
        };
        self.damage.add(within(columns, &clip[0]), within(rows, &clip[1]));
    }
}

fn triangles(mesh: &Mesh) -> impl DoubleEndedIterator<Item = [&Vertex; 3]> + ExactSizeIterator {
    mesh.indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|index| &mesh.vertices[index as usize]))
}
