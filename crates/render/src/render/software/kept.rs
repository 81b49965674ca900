//! The picture of a mesh that is edited. After an edit, only the part where the mesh changed is redrawn.

use super::corners::Corners;
use super::damage::{Damage, PxRect};
use super::groups::TriangleGroups;
use super::painter::{Painter, TriangleArrays, ground};
use super::rasterizer;
use super::threads::on_drawing_threads;
use crate::render::Image;
use crate::render::draw_flags::DrawFlags;
use crate::scene::{Camera, Detail, ShownMesh, ShownRevision, Style};
use meshbrush_mesh::mesh::{Changes, Mesh};

/// A picture of a mesh, kept from frame to frame.
///
/// The owner must report every edit of the mesh with [`Self::note_changes`] or [`Self::forget_mesh`] before
/// the next [`Self::update`]. A picture that was drawn in parts equals the one that [`draw`](super::draw)
/// makes, pixel by pixel.
#[derive(Debug)]
pub struct KeptPicture {
    image: Image,
    drawn: Option<DrawnContents>,
    since: Since,
    groups: TriangleGroups,
    corners: Corners,
}

/// The contents of the picture.
#[derive(Debug)]
struct DrawnContents {
    revision: ShownRevision,
    camera: Camera,
    style: Style,
}

/// The changes of the mesh since it was drawn.
#[derive(Debug)]
enum Since {
    Unchanged,
    Within(Changes),
    Replaced,
}

impl Default for KeptPicture {
    fn default() -> Self {
        let image = Image { size: [0, 0], rgba: Vec::new() };
        let (groups, corners) = (TriangleGroups::default(), Corners::default());
        Self { image, drawn: None, since: Since::Replaced, groups, corners }
    }
}

impl KeptPicture {
    /// Returns the picture.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Notes which entries of `mesh` changed. `mesh` is the mesh after the change.
    pub fn note_changes(&mut self, changes: &Changes, mesh: &Mesh) {
        match &mut self.since {
            Since::Unchanged => self.since = Since::Within(changes.clone()),
            Since::Within(earlier) => earlier.extend(changes, mesh),
            Since::Replaced => {}
        }
    }

    /// Notes that the mesh was replaced by another one.
    pub fn forget_mesh(&mut self) {
        self.since = Since::Replaced;
    }

    /// Returns the picture and drops everything else.
    pub(super) fn into_image(self) -> Image {
        self.image
    }

    /// Draws again the part that changed since the last call: nothing, the part of an edit, or everything.
    /// Returns the smallest rectangle that contains this part, or `None` for nothing.
    pub fn update(
        &mut self,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Option<PxRect> {
        on_drawing_threads(|| self.update_here(shown, revision, camera, style))
    }

    fn update_here(
        &mut self,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Option<PxRect> {
        let mesh = shown.mesh;
        let since = std::mem::replace(&mut self.since, Since::Unchanged);
        let since = self.checked(since, revision);
        self.follow(&since, mesh, camera);
        let damage = self.damage(&since, mesh, revision, camera, style);
        self.drawn = Some(DrawnContents { revision, camera: *camera, style: style.clone() });
        if self.image.size != camera.size_px() {
            self.image = Image::filled(camera.size_px(), ground(style));
        }
        let bounds = damage.bounds()?;
        self.draw(&damage, shown, camera, style);
        Some(bounds)
    }

    /// Updates the groups and corners of the triangles for mesh and camera.
    fn follow(&mut self, since: &Since, mesh: &Mesh, camera: &Camera) {
        let same_camera = self.drawn.as_ref().is_some_and(|drawn| drawn.camera == *camera);
        let camera = camera.on_lattice(mesh.lattice());
        let (nodes, triangles) = (mesh.raw_nodes(), mesh.raw_triangles());
        match since {
            Since::Unchanged => {}
            Since::Within(changes) => self.groups.follow(nodes, triangles, &changes.triangles),
            Since::Replaced => self.groups = TriangleGroups::new(nodes, triangles),
        }
        match since {
            Since::Unchanged if same_camera => {}
            Since::Within(changes) if same_camera => {
                self.corners.follow(nodes, &changes.nodes, &camera);
            }
            _ => self.corners.map(nodes, &camera),
        }
    }

    /// Returns the changes of the mesh. If none were reported but the revision differs, the mesh was
    /// replaced.
    fn checked(&self, since: Since, revision: ShownRevision) -> Since {
        let drawn = self.drawn.as_ref().map(|drawn| drawn.revision.mesh);
        match since {
            Since::Unchanged if drawn != Some(revision.mesh) => Since::Replaced,
            since => since,
        }
    }

    fn damage(
        &self,
        since: &Since,
        mesh: &Mesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Damage {
        let size = camera.size_px();
        let is_kept = self.drawn.as_ref().is_some_and(|drawn| {
            drawn.revision.pieces == revision.pieces && drawn.camera == *camera && drawn.style == *style
        });
        match since {
            Since::Unchanged if is_kept => Damage::nothing(size),
            Since::Within(changes) if is_kept => self.damage_of(changes, mesh, size, style),
            _ => Damage::everything(size),
        }
    }

    /// Returns the pixels that an edit of a mesh can change.
    ///
    /// Together, the triangles of the changed entries cover the area that the former ones covered, since the
    /// other triangles are unchanged. Beyond that, an edge can become a boundary edge or cease to be one,
    /// which changes the pixels beside it in an unchanged triangle; and where triangles are merged, another
    /// one can represent an ancestor, which reaches beyond the changed triangles.
    fn damage_of(&self, changes: &Changes, mesh: &Mesh, size: [u32; 2], style: &Style) -> Damage {
        let mut damage = Damage::nothing(size);
        let edge_px = (style.edge_reach_px() + style.rim_px()).ceil() as i32;
        let margin_px = edge_px.max(Detail::reach_px(style));
        let triangles = mesh.raw_triangles();
        for range in &changes.triangles {
            for triangle in &triangles[range.start.min(triangles.len())..range.end.min(triangles.len())] {
                let corners = triangle.vertices.map(|v| self.corners.of_node(v.index()));
                let [columns, rows] = rasterizer::pixels_around(&corners, margin_px);
                damage.add(columns, rows);
            }
        }
        damage
    }

    /// Draws the damaged part of the picture again.
    fn draw(&mut self, damage: &Damage, shown: ShownMesh, camera: &Camera, style: &Style) {
        let ShownMesh { mesh, pieces } = shown;
        let camera = camera.on_lattice(mesh.lattice());
        let none = DrawFlags::default();
        let flags = pieces.map(|pieces| DrawFlags::from_pieces(pieces, mesh.raw_triangle_count()));
        let of_pieces = pieces.map(|pieces| {
            let (nodes, triangles) = (pieces.nodes(), pieces.triangles());
            (nodes, triangles, TriangleGroups::new(nodes, triangles), Corners::new(nodes, &camera))
        });
        let mut arrays = vec![TriangleArrays {
            nodes: mesh.raw_nodes(),
            corners: &self.corners,
            triangles: mesh.raw_triangles(),
            groups: &self.groups,
            flags: flags.as_ref().unwrap_or(&none),
            are_of_mesh: true,
        }];
        if let Some((nodes, triangles, groups, corners)) = &of_pieces {
            let flags = &none;
            arrays.push(TriangleArrays { nodes, corners, triangles, groups, flags, are_of_mesh: false });
        }
        Painter::new(camera, style).draw(&mut self.image, damage, &arrays);
    }
}
