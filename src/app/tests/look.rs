use std::sync::Arc;
use eframe::egui::{Event, Key, Modifiers, vec2, ThemePreference};
use egui_kittest::Harness;
use super::{Window, key, send};
use crate::app::App;
use crate::app::command::Command;

fn drawn() -> Window {
    let mut setup = egui_kittest::wgpu::default_wgpu_setup();
    if let eframe::egui_wgpu::WgpuSetup::CreateNew(create) = &mut setup {
        create.device_descriptor = Arc::new(crate::render::gpu::device_descriptor);
    }
    let mut window = Harness::builder().with_size(vec2(1280.0, 800.0)).with_max_steps(4000).with_render_cursor(false)
        .wgpu_setup(setup).build_eframe(|cc| App::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref()).unwrap());
    window.run();
    window
}
fn save(window: &mut Window, name: &str) {
    window.run();
    window.render().unwrap().save(format!("/tmp/look-{name}.png")).unwrap();
}
fn text(window: &mut Window, t: &str) { window.event(Event::Text(t.into())); window.run(); }

#[test]
fn look() {
    let mut w = drawn();
    key(&mut w, Modifiers::COMMAND, Key::O);
    text(&mut w, "/work/main/assets");
    key(&mut w, Modifiers::NONE, Key::Enter);
    std::thread::sleep(std::time::Duration::from_millis(100));
    w.run();
    key(&mut w, Modifiers::NONE, Key::ArrowDown);
    save(&mut w, "open");
    send(&mut w, Command::Theme(ThemePreference::Light));
    text(&mut w, "missing.png");
    key(&mut w, Modifiers::NONE, Key::Enter);
    std::thread::sleep(std::time::Duration::from_millis(200));
    save(&mut w, "error");
    key(&mut w, Modifiers::NONE, Key::Escape);
    key(&mut w, Modifiers::COMMAND, Key::E);
    std::thread::sleep(std::time::Duration::from_millis(100));
    save(&mut w, "export");
    send(&mut w, Command::Theme(ThemePreference::Dark));
    use egui_kittest::kittest::Queryable as _;
    w.get_by_role_and_label(eframe::egui::accesskit::Role::ComboBox, "Format").click();
    w.run();
    save(&mut w, "formats");
}
