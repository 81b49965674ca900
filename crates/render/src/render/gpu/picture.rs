//! The picture of the mesh, kept as a texture.

use super::error::GpuError;
use super::mesh_pass::MeshPass;
use super::mirror::MeshMirror;
use super::shown_image::ShownImage;
use super::space_pass::SpacePass;
use crate::render::Image;
use crate::render::software::{self, KeptPicture, PxRect};
use crate::scene::{Camera, NodeHeights, ShownMesh, ShownRevision, ShownSurface, SpaceView, Style};

/// Draws the mesh into a texture when something changed, and otherwise only copies the texture to the canvas.
///
/// A window repaints whenever the pointer moves in a panel; that must not redraw a large mesh.
pub(super) struct MeshPicture {
    /// Made for the first picture of a mirror.
    mesh_pass: Option<MeshPass>,
    /// Made for the first picture in space.
    space_pass: Option<SpacePass>,
    format: wgpu::TextureFormat,
    texture: ShownImage,
    drawn: Option<PictureContents>,
    /// The picture that is drawn in software.
    kept: KeptPicture,
    /// The picture in space that was drawn in software.
    in_space: Image,
    /// The part of the kept picture that was drawn since [`Self::take_image`] last returned it.
    taken_from: Option<PxRect>,
    redraws: u64,
}

/// The contents of the picture. When any of it changes, the picture is redrawn.
#[derive(PartialEq)]
struct PictureContents {
    source: Source,
    sight: Sight,
    style: Style,
}

/// From where the mesh is seen.
#[derive(Clone, Copy, PartialEq)]
enum Sight {
    Plan(Camera),
    Space(SpaceView),
}

#[derive(PartialEq)]
enum Source {
    /// The picture shows the mirror at this generation.
    Mirror(u64),
    /// The software renderer drew the mesh and the pieces of this revision, and the texture shows them.
    Software(ShownRevision),
    /// The software renderer drew the mesh and the pieces of this revision, but the texture was not written:
    /// the caller that draws the window takes the picture.
    Image(ShownRevision),
}

impl PictureContents {
    fn is_image_of_plan(&self) -> bool {
        matches!((&self.source, self.sight), (Source::Image(_), Sight::Plan(_)))
    }
}

impl MeshPicture {
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        Self {
            mesh_pass: None,
            space_pass: None,
            format,
            texture: ShownImage::new(device, format),
            drawn: None,
            kept: KeptPicture::default(),
            in_space: Image { size: [0, 0], rgba: Vec::new() },
            taken_from: None,
            redraws: 0,
        }
    }

    /// Does the work of [`GpuRenderer::prepare`](super::GpuRenderer::prepare), without the overlay.
    pub(super) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        mirror: &MeshMirror,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        let source = Source::Mirror(mirror.generation());
        let Some(wanted) = self.if_not_drawn(source, Sight::Plan(*camera), style) else { return Ok(()) };
        self.drawn = None;
        self.texture.fit(device, camera.size_px())?;
        if let Some(view) = self.texture.view() {
            let new_pass = || MeshPass::new(device, self.format, mirror);
            let mesh_pass = self.mesh_pass.get_or_insert_with(new_pass);
            let mut pass = begin_pass(encoder, view, style.clear_color());
            mesh_pass.draw(queue, &mut pass, mirror, camera, style);
        }
        self.keep(wanted);
        Ok(())
    }

    /// Does the work of [`GpuRenderer::prepare_in_software`](super::GpuRenderer::prepare_in_software),
    /// without the overlay.
    pub(super) fn prepare_in_software(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        let Some(wanted) = self.if_not_drawn(Source::Software(revision), Sight::Plan(*camera), style) else {
            return Ok(());
        };
        let follows = self.drawn.take().is_some_and(|drawn| {
            matches!((drawn.source, drawn.sight), (Source::Software(_), Sight::Plan(_)))
        });
        let is_other = self.texture.fit(device, camera.size_px())?;
        let changed = self.kept.update(shown, revision, camera, style);
        let image = self.kept.image();
        // The whole texture is written when it shows something else.
        let part = if follows && !is_other { changed } else { Some(PxRect::whole(image.size)) };
        if let Some(part) = part {
            self.texture.write(queue, image, &part);
        }
        self.keep(wanted);
        Ok(())
    }

    /// Does the work of [`GpuRenderer::draw_image`](super::GpuRenderer::draw_image).
    pub(super) fn draw_image(
        &mut self,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) {
        let Some(wanted) = self.if_not_drawn(Source::Image(revision), Sight::Plan(*camera), style) else {
            return;
        };
        if !self.drawn.as_ref().is_some_and(PictureContents::is_image_of_plan) {
            self.taken_from = Some(PxRect::whole(camera.size_px()));
        }
        if let Some(part) = self.kept.update(shown, revision, camera, style) {
            self.taken_from =
                Some(self.taken_from.take().map_or(part.clone(), |earlier| earlier.with(&part)));
        }
        self.keep(wanted);
    }

    /// Does the work of [`GpuRenderer::prepare_in_space`](super::GpuRenderer::prepare_in_space).
    pub(super) fn prepare_in_space(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        mirror: &MeshMirror,
        view: &SpaceView,
        style: &Style,
    ) -> Result<(), GpuError> {
        let Some(space_pass) = &mut self.space_pass else { return Ok(()) };
        let wanted = PictureContents {
            source: Source::Mirror(mirror.generation()),
            sight: Sight::Space(*view),
            style: style.clone(),
        };
        if self.drawn.as_ref() == Some(&wanted) && !space_pass.has_news() {
            return Ok(());
        }
        self.drawn = None;
        self.texture.fit(gpu.0, view.camera.size_px())?;
        if let Some(target) = self.texture.view() {
            space_pass.draw(gpu, encoder, target, mirror, view, style);
        }
        self.keep(wanted);
        Ok(())
    }

    /// Does the work of [`GpuRenderer::set_heights`](super::GpuRenderer::set_heights).
    pub(super) fn set_heights(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        mirror: &MeshMirror,
        heights: &NodeHeights,
        revision: u64,
    ) -> Result<(), GpuError> {
        let space_pass = match &mut self.space_pass {
            Some(space_pass) => space_pass,
            None => self.space_pass.insert(SpacePass::new(device, self.format, mirror)?),
        };
        space_pass.set_heights(device, queue, heights, revision)
    }

    /// Does the work of
    /// [`GpuRenderer::prepare_in_space_in_software`](super::GpuRenderer::prepare_in_space_in_software), into
    /// the texture where there is a device.
    pub(super) fn prepare_in_space_in_software(
        &mut self,
        gpu: Option<(&wgpu::Device, &wgpu::Queue)>,
        shown: ShownSurface,
        revision: ShownRevision,
        view: &SpaceView,
        style: &Style,
    ) -> Result<(), GpuError> {
        let source = if gpu.is_some() { Source::Software(revision) } else { Source::Image(revision) };
        let Some(wanted) = self.if_not_drawn(source, Sight::Space(*view), style) else { return Ok(()) };
        self.drawn = None;
        self.in_space = software::draw_surface(shown, view, style);
        let whole = PxRect::whole(self.in_space.size);
        match gpu {
            Some((device, queue)) => {
                self.texture.fit(device, view.camera.size_px())?;
                self.texture.write(queue, &self.in_space, &whole);
            }
            None => self.taken_from = Some(whole),
        }
        self.keep(wanted);
        Ok(())
    }

    /// Does the work of [`GpuRenderer::take_image`](super::GpuRenderer::take_image).
    pub(super) fn take_image(&mut self) -> Option<(&Image, Option<PxRect>, bool)> {
        let drawn = self.drawn.as_ref().filter(|drawn| matches!(drawn.source, Source::Image(_)))?;
        let image = if drawn.is_image_of_plan() { self.kept.image() } else { &self.in_space };
        Some((image, self.taken_from.take(), drawn.style.is_opaque()))
    }

    /// Returns the picture that is drawn in software. It must be told of every edit of the mesh.
    pub(super) fn kept_mut(&mut self) -> &mut KeptPicture {
        &mut self.kept
    }

    /// Returns the contents to draw, or `None` if the picture already shows them.
    fn if_not_drawn(&self, source: Source, sight: Sight, style: &Style) -> Option<PictureContents> {
        let wanted = PictureContents { source, sight, style: style.clone() };
        (self.drawn.as_ref() != Some(&wanted)).then_some(wanted)
    }

    fn keep(&mut self, drawn: PictureContents) {
        self.drawn = Some(drawn);
        self.redraws += 1;
    }

    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        let is_opaque = self.drawn.as_ref().is_some_and(|drawn| drawn.style.is_opaque());
        self.texture.paint(pass, is_opaque);
    }

    pub(super) fn redraws(&self) -> u64 {
        self.redraws
    }
}

/// Begins a render pass onto one texture, which is first cleared to `color`, premultiplied.
pub(super) fn begin_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    color: [f32; 4],
) -> wgpu::RenderPass<'e> {
    let [r, g, b, a] = color.map(f64::from);
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..wgpu::RenderPassDescriptor::default()
    })
}
