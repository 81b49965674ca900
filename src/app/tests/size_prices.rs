//! Prices of the size before they are applied, and the question before very many triangles.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{
    FREE, TALL, Window, click_button, entries, fingerprint, key, notice, open_tab, send, set, settings,
    stroke, triangles, type_into, value_of, window, window_of,
};
use meshbrush_core::document::{Example, Setting, Settings};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};
use meshbrush_ui::widgets::format;

const KEEP: &str = "Keep the mesh";
const APPLY: &str = "Apply anyway";

/// A diameter for which the first example needs about 75 million triangles.
const FAR_TOO_FINE: Setting = Setting::LargestDiameter(0.0003);

/// The rows in the order of the tab: size and risk, gradation.
fn changes(window: &Window) -> Vec<String> {
    let rows = window.query_all_by_role(Role::Definition);
    let rows = rows.filter(|row| row.accesskit_node().label().is_some_and(|label| label == "Change"));
    rows.filter_map(|row| row.value()).collect()
}

fn has_button(window: &Window, name: &str) -> bool {
    window.query_by_role_and_label(Role::Button, name).is_some()
}

#[test]
fn millions_of_triangles_are_asked_for_before_the_mesh_has_them() {
    let ways: [fn(&mut Window); 2] =
        [|window| click_button(window, KEEP), |window| key(window, Modifiers::NONE, Key::Escape)];
    for keep in ways {
        let mut window = window_of(TALL);
        open_tab(&mut window, Tab::Size);
        let before = (fingerprint(&window), settings(&window).clone(), triangles(&window));
        set(&mut window, FAR_TOO_FINE);
        let asked = notice(&window);
        assert!(
            asked.starts_with("This edit needs about ") && asked.contains(" million triangles."),
            "{asked}"
        );
        assert!(asked.contains("The budgets allow 20,000,000"), "{asked}");
        assert!(triangles(&window) < before.2 + 110_000, "{}", triangles(&window));
        assert!(changes(&window)[0].starts_with("needs about "), "{:?}", changes(&window));
        assert!(value_of(&window, Role::Definition, "Needed").starts_with("about "));
        let gestures = entries(&window);
        keep(&mut window);
        assert_eq!((fingerprint(&window), settings(&window).clone()), (before.0, before.1));
        assert_eq!((notice(&window), entries(&window)), (String::new(), gestures - 1), "one undo step");
        assert!(!has_button(&window, APPLY));
    }
}

#[test]
fn a_smaller_edit_answers_the_question_and_paint_is_kept_with_the_mesh() {
    let mut window = window();
    let largest = settings(&window).transfer.h_max;
    set(&mut window, FAR_TOO_FINE);
    assert!(has_button(&window, KEEP));
    let transfer = settings(&window).transfer;
    assert!(transfer.h_risk < 0.001, "the largest diameter takes the others along");
    set(&mut window, Setting::LargestDiameter(largest));
    set(&mut window, Setting::DiameterAtRiskOne(0.003));
    assert!(!has_button(&window, KEEP) && triangles(&window) < 100_000, "{}", triangles(&window));
    let largest = settings(&window).transfer.h_max;
    set(&mut window, FAR_TOO_FINE);
    let paint = window.state().session().document().paint().clone();
    stroke(&mut window, FREE, FREE);
    let painted = window.state().session().document().paint().clone();
    assert_ne!(painted, paint, "the brush paints while the mesh waits");
    assert!(has_button(&window, KEEP));
    click_button(&mut window, KEEP);
    assert_eq!(settings(&window).transfer.h_max, largest);
    assert_eq!(*window.state().session().document().paint(), painted);
    assert_eq!(window.state().session().mesh().violations(), []);
}

#[test]
fn what_a_person_agrees_to_is_applied() {
    let mut window = window();
    set(&mut window, Setting::MaxTriangles(170_000));
    let before = (fingerprint(&window), settings(&window).clone());
    set(&mut window, Setting::LargestDiameter(0.003));
    assert!(notice(&window).contains("The budgets allow 170,000"), "{}", notice(&window));
    click_button(&mut window, APPLY);
    assert!(notice(&window).contains("170,000") || notice(&window).contains("170000"), "{}", notice(&window));
    assert_eq!((fingerprint(&window), settings(&window).clone()), before, "the budget takes it back");
    set(&mut window, Setting::MaxTriangles(Settings::MAX_TRIANGLES));
    set(&mut window, Setting::LargestDiameter(0.003));
    let need = window.state().session().need().expect("asked: ten times as many").triangles();
    assert!(notice(&window).contains(&format::about(need)), "{}", notice(&window));
    click_button(&mut window, APPLY);
    assert_eq!((notice(&window), settings(&window).transfer.h_max), (String::new(), 0.003));
    let made = triangles(&window) as f64;
    assert!((0.9..1.1).contains(&(need as f64 / made)), "{need} of {made}");
    assert_eq!(window.state().session().need(), None);
}

#[test]
fn an_ordinary_edit_is_applied_at_once_and_says_what_it_did() {
    let mut window = window_of(TALL);
    open_tab(&mut window, Tab::Size);
    assert_eq!(changes(&window), ["–", "–"]);
    let before = triangles(&window) as i64;
    for h_risk in [0.002, 0.0017] {
        send(&mut window, Command::from(EditCommand::Set(Setting::DiameterAtRiskOne(h_risk))));
        let change = triangles(&window) as i64 - before;
        assert!(change > 1000);
        let text = format!("{} triangles", format::change(change));
        let changes = changes(&window);
        assert!(changes[0].starts_with(&text) && changes[1] == "–", "one gesture: {changes:?} {text}");
    }
    send(&mut window, Command::from(EditCommand::EndGesture));
    set(&mut window, Setting::Gradation(Some(0.3)));
    assert!(changes(&window)[0] == "–" && changes(&window)[1].starts_with('+'), "{:?}", changes(&window));
    let said = changes(&window)[1].clone();
    let (by_gradation, _time) = said.split_once(" triangles").unwrap();
    let before = triangles(&window);
    stroke(&mut window, FREE, FREE);
    assert!(triangles(&window) > before);
    assert_eq!(changes(&window)[1], format!("{by_gradation} triangles"), "a later stroke does not count");
}

#[test]
fn a_number_has_its_price_while_it_is_typed_and_a_choice_under_the_pointer() {
    let mut window = window_of(TALL);
    open_tab(&mut window, Tab::Size);
    let version = window.state().session().document().version();
    window.get_by_role_and_label(Role::TextInput, "h_risk value").focus();
    window.run();
    key(&mut window, Modifiers::COMMAND, Key::A);
    window.get_by_role_and_label(Role::TextInput, "h_risk value").type_text("0.0015");
    window.run();
    let price = changes(&window)[0].clone();
    assert!(price.starts_with("would add "), "{price}");
    assert_eq!(window.state().session().document().version(), version, "nothing is applied");
    let before = triangles(&window);
    key(&mut window, Modifiers::NONE, Key::Enter);
    let change = (triangles(&window) - before) as u64;
    assert_eq!(price, format!("would add {}", format::count(change)));
    window.get_by_role_and_label(Role::CheckBox, "Limit gradation").hover();
    window.run();
    let price = changes(&window)[1].clone();
    let before = triangles(&window);
    window.get_by_role_and_label(Role::CheckBox, "Limit gradation").click();
    window.run();
    let change = (triangles(&window) - before) as u64;
    assert_eq!(price, format!("would add {}", format::count(change)));
}

#[test]
fn the_budgets_say_what_is_used_and_what_would_be_needed() {
    let mut window = window_of(TALL);
    open_tab(&mut window, Tab::Size);
    let count = triangles(&window);
    type_into(&mut window, "Triangle budget", "1M");
    let used = value_of(&window, Role::Definition, "Triangles in memory");
    assert_eq!(used, format!("{} (3.4 %)", format::count(count as u64)), "of 1 million");
    assert_eq!(value_of(&window, Role::Definition, "Needed"), "as many as there are");
    set(&mut window, Setting::MaxTriangles(count + 100));
    stroke(&mut window, FREE, FREE);
    let needed = value_of(&window, Role::Definition, "Needed");
    assert!(needed.starts_with("about ") && needed.ends_with(" GB"), "the stroke stopped: {needed}");
}

#[test]
fn the_budget_counts_triangles_around_the_domain_and_says_so() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    crate::app::tests::wait_for_jobs(&mut window);
    open_tab(&mut window, Tab::Size);
    let in_domain = format::count(window.state().session().triangle_count() as u64);
    let all = format::count(window.state().session().mesh().raw_triangle_count() as u64);
    let used = value_of(&window, Role::Definition, "Triangles in memory");
    assert!(all != in_domain && used.starts_with(&format!("{all} (")), "{used}: {in_domain}");
    let row = window.get_by_role_and_label(Role::Definition, "Triangles in memory");
    let help = row.accesskit_node().description().unwrap_or_default();
    assert!(help.contains(&format!("{in_domain} in the domain")), "{help}");
}
