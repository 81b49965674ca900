//! The unit of a document, wherever a length is shown or typed.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

use crate::app::features::domain::DomainCommand;
use crate::app::features::inspection::InspectCommand;
use crate::app::tests::{
    FREE, TALL, Window, entries, find, fingerprint, folder, key, move_to, open_section, open_tab, send, set,
    settings, triangles, type_into, value_of, wait_until, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_mesh::text::LengthUnit;

fn in_metres() -> Window {
    let mut window = window_of(TALL);
    set(&mut window, Setting::LengthUnit(LengthUnit::Metre));
    window
}

#[test]
fn the_unit_is_chosen_in_the_domain_panel_and_undone() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Domain");
    let (mesh, before) = (fingerprint(&window), entries(&window));
    window.get_by_role_and_label(Role::ComboBox, "Unit").click();
    window.run();
    window.get_by_label("Kilometres (km)").click();
    window.run();
    assert_eq!(settings(&window).unit, LengthUnit::Kilometre);
    assert_eq!(value_of(&window, Role::TextInput, "Left"), "0 km");
    assert_eq!((fingerprint(&window), entries(&window)), (mesh, before + 1), "the mesh is the same");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(settings(&window).unit, LengthUnit::None);
    assert_eq!(value_of(&window, Role::TextInput, "Left"), "0");
}

#[test]
fn every_length_carries_the_unit() {
    let mut window = in_metres();
    send(&mut window, Command::from(InspectCommand::Query(FREE)));
    crate::app::tests::select_base(&mut window);
    move_to(&mut window, FREE);
    for name in ["Radius value", "h_max value", "h_min value", "Spacing δ value", "Diameter"] {
        if name.starts_with("Spacing") {
            open_section(&mut window, "Mesh");
        }
        find(&mut window, Role::TextInput, name);
        let value = window.get_by_role_and_label(Role::TextInput, name);
        let value = egui_kittest::kittest::NodeT::accesskit_node(&value).value().unwrap();
        assert!(value.ends_with(" m"), "{name}: {value}");
    }
    open_tab(&mut window, Tab::Inspect);
    move_to(&mut window, FREE);
    for name in ["x", "y", "h̄", "Diameter", "Interpolated"] {
        let value = value_of(&window, Role::Definition, name);
        assert!(value.ends_with(" m"), "{name}: {value}");
    }
}

#[test]
fn a_typed_unit_is_understood_and_converted() {
    let mut window = in_metres();
    type_into(&mut window, "h_max value", "0.3 m");
    assert_eq!(settings(&window).transfer.h_max, 0.3);
    type_into(&mut window, "h_max value", "0.0004 km");
    assert_eq!(settings(&window).transfer.h_max, 0.4);
    type_into(&mut window, "h_max value", "5 px");
    assert_eq!(settings(&window).transfer.h_max, 0.4, "not a length");
}

#[test]
fn examples_and_domains_from_files_have_their_unit() {
    let mut window = window_of(TALL);
    for (example, unit) in [
        (Example::Threats, LengthUnit::None),
        (Example::Terrain, LengthUnit::Kilometre),
        (Example::Heights, LengthUnit::Degree),
        (Example::Aegean, LengthUnit::Degree),
        (Example::CelticSea, LengthUnit::Metre),
    ] {
        send(&mut window, Command::from(FileCommand::OpenExample(example)));
        assert_eq!(settings(&window).unit, unit, "{}", example.name());
    }
    let file = folder("unit", "domain").join("utm.geojson");
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32635"}}"#;
    let ring = "[[[0,0],[4000,0],[0,4000],[0,0]]]";
    fs::write(&file, format!(r#"{{"type":"Polygon",{crs},"coordinates":{ring}}}"#)).unwrap();
    send(&mut window, Command::from(DomainCommand::Open(file)));
    wait_until(&mut window, |window| settings(window).name == "utm");
    assert_eq!(settings(&window).unit, LengthUnit::Metre);
    assert!(triangles(&window) > 100);
}
