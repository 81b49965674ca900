//! How the window looks: colours by role, fonts, and egui's style made from them.
//!
//! [`DARK`] and [`LIGHT`] hold the same roles. Widgets ask [`tokens`] for the set that is shown and never
//! name a colour of their own, so both themes stay complete. Sizes are in points and sit on an 8-point grid
//! ([`metrics`]).

use std::sync::Arc;

use egui::epaint::text::{FontData, FontDefinitions};
use egui::style::{HandleShape, ScrollStyle, WidgetVisuals, Widgets};
use egui::{self, Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, TextStyle, Theme, vec2};

use meshbrush_render::colormap::Ground;

/// Ground of a neighbour's number, on any colour of its triangle.
pub const NUMBER_DISC: Color32 = Color32::from_black_alpha(225);

/// Colours by role. [`DARK`] and [`LIGHT`] are the two sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tokens {
    /// Whether light text stands on dark ground.
    pub dark: bool,
    /// Ground of the mesh.
    pub canvas: Color32,
    /// Ground of the menu and status bars.
    pub window: Color32,
    /// Ground of panels.
    pub panel: Color32,
    /// Ground of menus, dialogs, tooltips and floating tags.
    pub popup: Color32,
    /// Hair lines between areas and round controls.
    pub line: Color32,
    /// Outlines of keys, tags, dialogs and the selected segment.
    pub edge: Color32,
    /// Ground of inputs, slider tracks, keys and quiet buttons.
    pub field: Color32,
    /// A field or row under the pointer.
    pub hover: Color32,
    /// Ground of wells: segmented controls, curves, charts.
    pub well: Color32,
    /// The selected segment in a well, and caps of keys.
    pub raised: Color32,
    /// Numbers and values set by the user: the brightest text.
    pub value: Color32,
    /// Normal text.
    pub text: Color32,
    /// Names of values.
    pub label: Color32,
    /// Notes and titles; only on `canvas`, `window`, `panel`, `popup` and `well`.
    pub faint: Color32,
    /// Fills of sliders and curves, focus rings, links.
    pub accent: Color32,
    /// Ground of the selected tool and of the main button.
    pub selected: Color32,
    /// Text and icons on `selected` and on `danger_fill`.
    pub on_selected: Color32,
    /// Text and marks that report an error.
    pub danger: Color32,
    /// Ground of the button that destroys something.
    pub danger_fill: Color32,
    /// The three neighbours of the selected triangle; the bisection neighbour first.
    pub neighbours: [Color32; 3],
    /// The selected triangle's outline.
    pub pick: Color32,
    /// Fill of triangles at level 0, close to the canvas.
    pub level_zero: Color32,
    /// Thumbs of sliders and handles of curves.
    pub thumb: Color32,
    /// Edge of a thumb, to set it off from light ground.
    pub thumb_edge: Color32,
    /// The colour that dims the window behind a dialog.
    pub scrim: Color32,
    /// Shadows under popups.
    pub shadow: Color32,
}

/// Light text on dark ground; the default.
pub const DARK: Tokens = Tokens {
    dark: true,
    canvas: opaque(Ground::Dark.canvas()),
    window: Color32::from_rgb(0x0f, 0x11, 0x15),
    panel: Color32::from_rgb(0x15, 0x18, 0x1e),
    popup: Color32::from_rgb(0x1a, 0x1e, 0x25),
    line: Color32::from_rgb(0x22, 0x26, 0x2e),
    edge: Color32::from_rgb(0x36, 0x3d, 0x4a),
    field: Color32::from_rgb(0x27, 0x2c, 0x36),
    hover: Color32::from_rgb(0x2e, 0x34, 0x40),
    well: Color32::from_rgb(0x0f, 0x11, 0x15),
    raised: Color32::from_rgb(0x2c, 0x32, 0x3e),
    value: Color32::from_rgb(0xe8, 0xeb, 0xf0),
    text: Color32::from_rgb(0xd7, 0xdb, 0xe2),
    label: Color32::from_rgb(0x9a, 0xa3, 0xb2),
    faint: Color32::from_rgb(0x7e, 0x87, 0x96),
    accent: Color32::from_rgb(0x4f, 0x83, 0xff),
    selected: Color32::from_rgb(0x2b, 0x5c, 0xd9),
    on_selected: Color32::WHITE,
    danger: Color32::from_rgb(0xff, 0x7b, 0x72),
    danger_fill: Color32::from_rgb(0xb8, 0x32, 0x32),
    neighbours: neighbours(Ground::Dark),
    pick: Color32::WHITE,
    level_zero: opaque(Ground::Dark.level_0()),
    thumb: Color32::WHITE,
    thumb_edge: Color32::from_rgba_premultiplied(0, 0, 0, 0x60),
    scrim: Color32::from_rgba_premultiplied(0, 0, 0, 0x8c),
    shadow: Color32::from_rgba_premultiplied(0, 0, 0, 0x80),
};

/// Dark text on light ground, in the same roles.
pub const LIGHT: Tokens = Tokens {
    dark: false,
    canvas: opaque(Ground::Light.canvas()),
    window: Color32::from_rgb(0xf0, 0xf2, 0xf5),
    panel: Color32::from_rgb(0xfa, 0xfb, 0xfc),
    popup: Color32::from_rgb(0xff, 0xff, 0xff),
    line: Color32::from_rgb(0xd8, 0xdc, 0xe3),
    edge: Color32::from_rgb(0xc6, 0xcc, 0xd6),
    field: Color32::from_rgb(0xe4, 0xe8, 0xee),
    hover: Color32::from_rgb(0xd8, 0xde, 0xe7),
    well: Color32::from_rgb(0xec, 0xef, 0xf3),
    raised: Color32::from_rgb(0xff, 0xff, 0xff),
    value: Color32::from_rgb(0x0f, 0x14, 0x1c),
    text: Color32::from_rgb(0x22, 0x2a, 0x37),
    label: Color32::from_rgb(0x48, 0x52, 0x62),
    faint: Color32::from_rgb(0x5c, 0x66, 0x76),
    accent: Color32::from_rgb(0x2a, 0x62, 0xe4),
    selected: Color32::from_rgb(0x2b, 0x5c, 0xd9),
    on_selected: Color32::WHITE,
    danger: Color32::from_rgb(0xb4, 0x26, 0x26),
    danger_fill: Color32::from_rgb(0xb8, 0x32, 0x32),
    neighbours: neighbours(Ground::Light),
    pick: Color32::from_rgb(0x0f, 0x14, 0x1c),
    level_zero: opaque(Ground::Light.level_0()),
    thumb: Color32::WHITE,
    thumb_edge: Color32::from_rgb(0x9a, 0xa4, 0xb4),
    scrim: Color32::from_rgba_premultiplied(0x0a, 0x0d, 0x13, 0x66),
    shadow: Color32::from_rgba_premultiplied(0x04, 0x05, 0x07, 0x2c),
};

const fn opaque([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

const fn neighbours(ground: Ground) -> [Color32; 3] {
    let [first, second, third] = ground.neighbours();
    [opaque(first), opaque(second), opaque(third)]
}

impl Tokens {
    /// Returns the set of a theme.
    pub const fn of(theme: Theme) -> &'static Self {
        match theme {
            Theme::Dark => &DARK,
            Theme::Light => &LIGHT,
        }
    }

    /// Returns a hair line between areas.
    pub fn hairline(&self) -> Stroke {
        Stroke::new(1.0, self.line)
    }

    /// Returns the small shadow under tags over the canvas.
    pub fn tag_shadow(&self) -> Shadow {
        Shadow { offset: [0, 2], blur: 8, spread: 0, color: self.shadow }
    }

    /// Returns the shadow under dialogs and popups.
    pub fn popup_shadow(&self) -> Shadow {
        Shadow { offset: [0, 8], blur: 24, spread: 0, color: self.shadow }
    }
}

/// Returns the colours shown in `ui`.
pub fn tokens(ui: &egui::Ui) -> &'static Tokens {
    if ui.visuals().dark_mode { &DARK } else { &LIGHT }
}

/// Returns the colours shown in `ctx`, for dialogs, which have no `Ui` of their own yet.
pub fn tokens_of(ctx: &egui::Context) -> &'static Tokens {
    Tokens::of(ctx.theme())
}

/// Sizes in points.
pub mod metrics {
    /// The grid that everything sits on.
    pub const GRID: f32 = 8.0;
    /// Margin between a panel's edge and its contents.
    pub const PANEL_MARGIN: f32 = 16.0;
    /// Width that the docks have at first, for which their rows are drawn.
    pub const PANEL_WIDTH: f32 = 320.0;
    /// Height of a row in a panel.
    pub const ROW: f32 = 24.0;
    /// Space between rows.
    pub const ROW_GAP: f32 = 4.0;
    /// Width of the column of names before sliders and fields.
    pub const LABEL_WIDTH: f32 = 88.0;
    /// Width of the column of numbers after sliders.
    pub const VALUE_WIDTH: f32 = 72.0;
    /// Side of a tool button.
    pub const TOOL: f32 = 40.0;
    /// Corner radius of controls.
    pub const RADIUS_CONTROL: u8 = 6;
    /// Corner radius of panels and dialogs.
    pub const RADIUS_PANEL: u8 = 8;
    /// Corner radius of floating tags and pills.
    pub const RADIUS_TAG: u8 = 8;
    /// Height of the strip above the canvas.
    pub const STRIP: f32 = 40.0;
    /// Height of the menu bar.
    pub const MENU_BAR: f32 = 36.0;
    /// Height of the status bar.
    pub const STATUS_BAR: f32 = 28.0;
}

/// The files of the fonts with letters.
pub(crate) const INTER: &[u8] = include_bytes!("../assets/fonts/Inter-Regular.ttf");
pub(crate) const INTER_SEMIBOLD: &[u8] = include_bytes!("../assets/fonts/Inter-SemiBold.ttf");
pub(crate) const JETBRAINS_MONO: &[u8] = include_bytes!("../assets/fonts/JetBrainsMono-Regular.ttf");

/// The fonts, by use.
pub mod font {
    use super::{FontFamily, FontId};

    /// Name of the semi-bold text family.
    pub const SEMIBOLD: &str = "semibold";
    /// Name of the icon family.
    pub const ICONS: &str = "icons";

    /// Returns the text and names of values.
    pub fn body() -> FontId {
        FontId::new(13.0, FontFamily::Proportional)
    }
    /// Emphasis in running text, dialog titles.
    pub fn strong() -> FontId {
        FontId::new(13.0, FontFamily::Name(SEMIBOLD.into()))
    }
    /// Small caps titles of sections.
    pub fn title() -> FontId {
        FontId::new(11.0, FontFamily::Name(SEMIBOLD.into()))
    }
    /// Notes beside titles and below fields.
    pub fn caption() -> FontId {
        FontId::new(11.5, FontFamily::Proportional)
    }
    /// Returns the numbers and formulas.
    pub fn value() -> FontId {
        FontId::new(12.0, FontFamily::Monospace)
    }
    /// Returns the numbers beside bars and in keys.
    pub fn small_value() -> FontId {
        FontId::new(11.0, FontFamily::Monospace)
    }
    /// Returns the numbers along an axis.
    pub fn axis() -> FontId {
        FontId::new(10.0, FontFamily::Monospace)
    }
    /// Icons of `size` points.
    pub fn icon(size: f32) -> FontId {
        FontId::new(size, FontFamily::Name(ICONS.into()))
    }
}

/// Installs fonts and the styles of both themes. Call once, before the first frame.
///
/// Which theme is shown stays egui's choice: `ctx.set_theme(ThemePreference::…)`. Animation time and the
/// cursor's blinking are left as they are, so that tests can switch them off.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    // Entries of the menus have these keys: they are listed, and can be changed.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| apply(style, Tokens::of(theme)));
    }
}

/// Inter, Inter SemiBold, JetBrains Mono and the icons; each family falls back on the others, so that Greek,
/// arrows, subscripts and h̄ are drawn everywhere.
fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    let mut add = |name: &str, data: FontData| fonts.font_data.insert(name.to_owned(), Arc::new(data));
    add("inter", FontData::from_static(INTER));
    add("inter-semibold", FontData::from_static(INTER_SEMIBOLD));
    add("mono", FontData::from_static(JETBRAINS_MONO));
    add("icons", FontData::from_static(include_bytes!("../assets/fonts/MaterialSymbols.ttf")));
    for (family, chain) in [
        (FontFamily::Proportional, ["inter", "mono", "icons"].as_slice()),
        (FontFamily::Monospace, &["mono", "inter", "icons"]),
        (FontFamily::Name(font::SEMIBOLD.into()), &["inter-semibold", "inter", "mono", "icons"]),
        (FontFamily::Name(font::ICONS.into()), &["icons", "inter"]),
    ] {
        fonts.families.insert(family, chain.iter().map(|&name| name.to_owned()).collect());
    }
    fonts
}

fn apply(style: &mut egui::Style, tokens: &Tokens) {
    style.text_styles = [
        (TextStyle::Small, font::caption()),
        (TextStyle::Body, font::body()),
        (TextStyle::Button, font::body()),
        (TextStyle::Heading, FontId::new(16.0, FontFamily::Name(font::SEMIBOLD.into()))),
        (TextStyle::Monospace, font::value()),
    ]
    .into();
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.4;
    style.compact_menu_style = true;
    apply_spacing(&mut style.spacing);
    apply_visuals(&mut style.visuals, tokens);
}

fn apply_spacing(spacing: &mut egui::Spacing) {
    spacing.item_spacing = vec2(metrics::GRID, metrics::ROW_GAP);
    spacing.button_padding = vec2(8.0, 4.0);
    spacing.interact_size = vec2(40.0, metrics::ROW);
    spacing.menu_margin = Margin::same(6);
    spacing.window_margin = Margin::same(16);
    spacing.menu_spacing = 4.0;
    spacing.icon_width = 16.0;
    spacing.icon_width_inner = 10.0;
    spacing.icon_spacing = 8.0;
    spacing.slider_rail_height = 4.0;
    spacing.tooltip_width = 320.0;
    spacing.combo_height = 320.0;
    spacing.scroll = ScrollStyle { bar_width: 8.0, floating_width: 3.0, ..ScrollStyle::floating() };
}

fn apply_visuals(visuals: &mut egui::Visuals, tokens: &Tokens) {
    let radius = CornerRadius::same(metrics::RADIUS_PANEL);
    visuals.dark_mode = tokens.dark;
    visuals.widgets = widget_visuals(tokens);
    visuals.selection.bg_fill = tokens.accent.gamma_multiply(if tokens.dark { 0.45 } else { 0.28 });
    visuals.selection.stroke = Stroke::new(1.0, tokens.value);
    visuals.weak_text_color = Some(tokens.label);
    visuals.hyperlink_color = tokens.accent;
    visuals.faint_bg_color = tokens.well;
    visuals.extreme_bg_color = tokens.field;
    visuals.code_bg_color = tokens.field;
    visuals.warn_fg_color = tokens.neighbours[0];
    visuals.error_fg_color = tokens.danger;
    visuals.window_corner_radius = radius;
    visuals.menu_corner_radius = radius;
    visuals.window_fill = tokens.popup;
    visuals.window_stroke = Stroke::new(1.0, tokens.edge);
    visuals.panel_fill = tokens.panel;
    visuals.window_shadow = tokens.popup_shadow();
    visuals.popup_shadow = tokens.popup_shadow();
    visuals.text_cursor.stroke = Stroke::new(1.5, tokens.accent);
    visuals.handle_shape = HandleShape::Circle;
    visuals.slider_trailing_fill = true;
    visuals.disabled_alpha = 0.4;
}

fn widget_visuals(tokens: &Tokens) -> Widgets {
    let state = |fill: Color32, edge: Color32, ink: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, edge),
        corner_radius: CornerRadius::same(metrics::RADIUS_CONTROL),
        fg_stroke: Stroke::new(1.0, ink),
        expansion: 0.0,
    };
    Widgets {
        noninteractive: state(tokens.panel, tokens.line, tokens.text),
        inactive: state(tokens.field, Color32::TRANSPARENT, tokens.text),
        hovered: state(tokens.hover, Color32::TRANSPARENT, tokens.value),
        active: state(tokens.hover, tokens.accent, tokens.value),
        open: state(tokens.hover, Color32::TRANSPARENT, tokens.value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_render::colormap::{Colormap, LevelColors};

    /// Returns the relative luminance as WCAG 2 defines it.
    fn luminance(color: Color32) -> f64 {
        let linear = |byte: u8| {
            let c = f64::from(byte) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(color.r()) + 0.7152 * linear(color.g()) + 0.0722 * linear(color.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    fn both() -> [&'static Tokens; 2] {
        [&DARK, &LIGHT]
    }

    #[track_caller]
    fn readable(what: &str, tokens: &Tokens, ink: Color32, ground: Color32) {
        let ratio = contrast(ink, ground);
        assert!(ratio >= 4.5, "{what}, dark {}: {ink:?} on {ground:?} is only {ratio:.2}", tokens.dark);
    }

    #[test]
    fn text_stands_out_from_every_ground_it_is_used_on() {
        for t in both() {
            for ground in [t.canvas, t.window, t.panel, t.popup, t.well, t.field, t.hover, t.raised] {
                readable("value", t, t.value, ground);
                readable("text", t, t.text, ground);
                readable("label", t, t.label, ground);
            }
            for ground in [t.canvas, t.window, t.panel, t.popup, t.well] {
                readable("faint", t, t.faint, ground);
            }
        }
    }

    #[test]
    fn colored_text_stands_out_from_its_ground() {
        for t in both() {
            readable("on selected", t, t.on_selected, t.selected);
            readable("on danger", t, t.on_selected, t.danger_fill);
            for ground in [t.panel, t.popup] {
                readable("danger", t, t.danger, ground);
                readable("accent", t, t.accent, ground);
            }
        }
    }

    #[test]
    fn numbers_on_the_canvas_stand_out_from_every_level() {
        for (map, ground) in Colormap::ALL
            .into_iter()
            .flat_map(|map| [Ground::Dark, Ground::Light].map(|ground| (map, ground)))
        {
            let colors = LevelColors::new(map, ground, 20);
            for level in 0..=20 {
                let [r, g, b, _] = colors.of(level);
                let disc = Color32::from_rgb(r, g, b).blend(NUMBER_DISC);
                for number in DARK.neighbours {
                    readable(map.name(), &DARK, number, disc);
                }
            }
        }
    }

    #[test]
    fn marks_stand_out_from_their_ground() {
        for t in both() {
            for mark in t.neighbours.iter().chain([&t.accent, &t.pick]) {
                for ground in [t.canvas, t.panel, t.level_zero] {
                    assert!(contrast(*mark, ground) >= 2.7, "{mark:?} on {ground:?}, dark {}", t.dark);
                }
            }
        }
    }

    #[test]
    fn level_zero_stays_close_to_the_canvas() {
        for t in both() {
            assert!(contrast(t.level_zero, t.canvas) < 1.35);
        }
    }

    #[test]
    fn the_icon_font_has_every_icon() {
        let ctx = egui::Context::default();
        install(&ctx);
        ctx.run_ui(Default::default(), |_| {}).drop_without_applying_deltas();
        let source = include_str!("widgets/display/icon.rs");
        let points = source.split("\\u{").skip(1).map(|rest| rest.split('}').next().unwrap());
        let icons: Vec<u32> = points.map(|point| u32::from_str_radix(point, 16).unwrap()).collect();
        assert!(icons.len() > 40);
        for icon in icons {
            let icon = char::from_u32(icon).unwrap();
            assert!(ctx.fonts_mut(|f| f.has_glyph(&font::icon(16.0), icon)), "{icon:?}: run make.py");
        }
    }

    #[test]
    fn every_sign_the_window_writes_has_a_glyph() {
        let ctx = egui::Context::default();
        install(&ctx);
        ctx.run_ui(Default::default(), |_| {}).drop_without_applying_deltas();
        let signs = "ABCxyz0123456789,.+−×·–—…≤≥≈²³°µδζ₁₂₃hθπ∞√→←↑↓↵⇧⌘∈";
        for font in [font::body(), font::strong(), font::title(), font::caption(), font::value()] {
            for sign in signs.chars() {
                assert!(ctx.fonts_mut(|f| f.has_glyph(&font, sign)), "{sign} in {font:?}");
            }
        }
    }
}
