//! The manual, and the list of keys and gestures.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{Window, choose, key, notice, open_menu, window};

fn has_heading(window: &Window, text: &str) -> bool {
    window.query_by_role_and_label(Role::Heading, text).is_some()
}

fn rows(window: &Window) -> Vec<String> {
    window.query_all_by_role(Role::ListItem).filter_map(|node| node.accesskit_node().label()).collect()
}

#[test]
fn the_manual_opens_by_key_and_its_links_lead_to_other_pages() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::F1);
    assert!(has_heading(&window, "First steps"));
    window.get_by_role_and_label(Role::Link, "Painting").click_accesskit();
    window.run();
    assert!(has_heading(&window, "Painting") && !has_heading(&window, "First steps"));
    window.get_by_role_and_label(Role::Button, "Limits and problems").click();
    window.run();
    assert!(has_heading(&window, "Why did an island or a strait vanish?"));
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!has_heading(&window, "Limits and problems"));
}

#[test]
fn how_it_works_shows_its_picture_and_the_glossary_its_words() {
    let mut window = window();
    choose(&mut window, "Help", "How it works");
    assert!(has_heading(&window, "How it works"));
    let pictures = window.query_all_by_role(Role::Image).filter_map(|node| node.accesskit_node().label());
    assert!(pictures.into_iter().any(|text| text.contains("Middle: the level that the target diameter")));
    key(&mut window, Modifiers::NONE, Key::Escape);
    choose(&mut window, "Help", "Glossary");
    assert!(window.query_by_label_contains("barycentric coordinates").is_some());
}

#[test]
fn keys_and_gestures_are_found_by_what_they_do_and_by_their_name() {
    let mut window = window();
    key(&mut window, Modifiers::SHIFT, Key::F1);
    assert!(rows(&window).len() > 60, "{:?}", rows(&window));
    let mut search = |text: &str| {
        window.get_by_role_and_label(Role::TextInput, "Search for a key").focus();
        window.run();
        key(&mut window, Modifiers::COMMAND, Key::A);
        window.get_by_role_and_label(Role::TextInput, "Search for a key").type_text(text);
        window.run();
        rows(&window).into_iter().filter(|row| !row.starts_with("Level ")).collect::<Vec<_>>()
    };
    assert_eq!(search("pick the value"), ["Pick the value under the pointer Alt+click"]);
    assert_eq!(search("undo"), ["Undo Ctrl+Z"]);
    assert!(search("shift+drag").contains(&"Size of the brush Shift+drag".to_owned()));
    assert!(search("no such thing").is_empty());
}

#[test]
fn the_menu_names_the_gestures_of_painting_and_says_how_they_are_made() {
    let mut window = window();
    open_menu(&mut window, "Tool");
    for entry in [
        "Pick the value under the pointer Alt+click",
        "Straight line from the last point Shift+click",
        "Size of the brush Shift+drag",
    ] {
        assert!(window.query_by_role_and_label(Role::Button, entry).is_some(), "{entry}");
    }
    window.get_by_role_and_label(Role::Button, "Straight line from the last point Shift+click").click();
    window.run();
    assert!(notice(&window).contains("Hold Shift and click"), "{}", notice(&window));
}

#[test]
fn about_names_the_report() {
    let mut window = window();
    choose(&mut window, "Help", "About Meshbrush");
    assert!(window.query_by_label_contains("Local Bisection Refinement of Triangulated Grids").is_some());
}

#[test]
fn the_page_of_keys_is_the_list_in_the_window() {
    let window = window();
    let page = crate::app::help::keys_page(&crate::app::catalog::catalog(&window.state().state(None)));
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/keys.md");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(path).unwrap_or_default();
    assert!(written == page, "docs/keys.md is not the list of keys: UPDATE_DOCS=1 cargo test --lib keys");
}

#[test]
fn the_manual_is_searched_and_a_result_opens_at_its_heading() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::F1);
    window.get_by_role_and_label(Role::TextInput, "Search the manual").focus();
    window.run();
    window.get_by_role_and_label(Role::TextInput, "Search the manual").type_text("gaussian radar");
    window.run();
    assert!(!has_heading(&window, "First steps"), "the results are in place of the page");
    window.get_by_role_and_label(Role::Link, "Size and risk › Risks of threats").click();
    window.run();
    let heading = window.get_by_role_and_label(Role::Heading, "Risks of threats").rect();
    let title = window.get_by_role_and_label(Role::Heading, "Size and risk").rect();
    let field = window.get_by_role_and_label(Role::TextInput, "Search the manual").rect();
    assert!((heading.top() - field.top()).abs() < 60.0, "{heading:?} is at the top, {field:?}");
    assert!(title.bottom() < field.top(), "the page is scrolled: {title:?}");
    window.get_by_role_and_label(Role::TextInput, "Search the manual").focus();
    window.run();
    window.get_by_role_and_label(Role::TextInput, "Search the manual").type_text("nosuchword");
    window.run();
    assert!(window.query_by_label_contains("No page has all of these words").is_some());
}
