//! Menus opened by keyboard: their first entry gets the focus, and what had it before gets it back.

use egui::{Context, Id, Key, KeyboardShortcut, Modifiers, Popup, Response};

/// The keys that open the menu of what has the focus.
pub const MENU_KEYS: KeyboardShortcut = KeyboardShortcut::new(Modifiers::SHIFT, Key::F10);

/// A menu that was opened by keyboard, in egui's memory under the menu's id.
#[derive(Clone, Copy)]
struct KeyMenu {
    /// What had the focus.
    from: Id,
    /// Whether the focus went to the first entry.
    is_entered: bool,
}

fn data_id(menu: Id) -> Id {
    menu.with("opened by keyboard")
}

/// Opens the menu of a control with the focus, if the keys for it are pressed.
fn open_menu_by_keys(menu: Id, control: &Response) {
    let ctx = &control.ctx;
    if control.has_focus() && ctx.input_mut(|input| input.consume_shortcut(&MENU_KEYS)) {
        open_menu_from(ctx, menu, control.id);
    }
}

/// Returns the menu of a control, opened by the secondary button, or by keyboard while the control has the
/// focus. Its id is [`Popup::default_response_id`].
pub fn menu_of(control: &Response) -> Popup<'_> {
    let id = Popup::default_response_id(control);
    open_menu_by_keys(id, control);
    match is_key_menu(&control.ctx, id) {
        true => Popup::menu(control).open_memory(None),
        false => Popup::context_menu(control),
    }
}

/// Opens a menu from what has the focus.
pub fn open_menu_from(ctx: &Context, menu: Id, from: Id) {
    ctx.data_mut(|data| data.insert_temp(data_id(menu), KeyMenu { from, is_entered: false }));
    Popup::open_id(ctx, menu);
    ctx.request_repaint();
}

/// Returns whether a menu is open, and was opened by keyboard. One that has closed gives the focus back.
pub fn is_key_menu(ctx: &Context, menu: Id) -> bool {
    let Some(KeyMenu { from, .. }) = ctx.data(|data| data.get_temp(data_id(menu))) else { return false };
    if Popup::is_id_open(ctx, menu) {
        return true;
    }
    ctx.data_mut(|data| data.remove::<KeyMenu>(data_id(menu)));
    ctx.memory_mut(|memory| memory.request_focus(from));
    false
}

/// Gives the focus to the first of a menu's `entries` that is enabled, once after it was opened by keyboard.
pub fn enter_menu(ctx: &Context, menu: Id, entries: &[Response]) {
    let Some(opened) = ctx.data(|data| data.get_temp::<KeyMenu>(data_id(menu))) else { return };
    let first = entries.iter().find(|entry| entry.enabled());
    if let Some(first) = first.filter(|_| !opened.is_entered) {
        first.request_focus();
        let opened = KeyMenu { is_entered: true, ..opened };
        ctx.data_mut(|data| data.insert_temp(data_id(menu), opened));
    }
}
