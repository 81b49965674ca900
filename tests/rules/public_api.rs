//! The public interface is what `docs/public-api.txt` records: every name at the root of the crate with its
//! signature, its public fields, variants, methods and traits.
//!
//! Every type in such a signature has a name there too.
//!
//! `UPDATE_PUBLIC_API=1 cargo test -p meshbrush-rules` rewrites the file. A change in it is a change for
//! users.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::ROOT;
use crate::source::SOURCES;
use quote::ToTokens;
use syn::{Attribute, Fields, ImplItem, Item, ItemImpl, TraitItem, Type, UseTree, Visibility};

const RECORD: &str = "docs/public-api.txt";

/// A name at the root of the crate and the path that it re-exports, without the package: no two of ours have
/// a module of the same name.
struct Export {
    name: String,
    path: Vec<String>,
}

/// The items of one module, without tests.
struct Module {
    path: Vec<String>,
    items: Vec<Item>,
}

/// Every export with the lines that describe it, and all public types of the packages.
struct Interface {
    exports: Vec<(Export, Vec<String>)>,
    types: BTreeSet<String>,
}

/// Read once, for all tests.
static INTERFACE: LazyLock<Interface> = LazyLock::new(|| {
    let root = Path::new(ROOT);
    let modules: Vec<Module> = SOURCES.iter().flat_map(|folder| modules(&root.join(folder))).collect();
    let described = |export: Export| {
        let lines = description(&export, &modules);
        (export, lines)
    };
    Interface {
        exports: exports(&root.join("src/lib.rs")).into_iter().map(described).collect(),
        types: modules.iter().flat_map(|module| &module.items).filter_map(public_type).collect(),
    }
});

#[test]
fn the_public_interface_is_the_recorded_one() {
    let root = Path::new(ROOT);
    let entries: BTreeMap<&str, &[String]> =
        INTERFACE.exports.iter().map(|(export, lines)| (export.name.as_str(), lines.as_slice())).collect();
    let text: String = entries.into_values().map(|lines| lines.join("\n") + "\n\n").collect();
    if std::env::var_os("UPDATE_PUBLIC_API").is_some() {
        fs::write(root.join(RECORD), &text).unwrap();
    }
    let recorded = fs::read_to_string(root.join(RECORD)).unwrap_or_default();
    let difference = text.lines().zip(recorded.lines().chain([""; 1000])).find(|(now, then)| now != then);
    assert!(
        text == recorded,
        "the public interface differs from {RECORD}, first at {difference:?}; if the change is intended, run \
         UPDATE_PUBLIC_API=1 cargo test -p meshbrush-rules"
    );
}

/// A function that takes or returns a type without a name can be called, but its values cannot be stored.
#[test]
fn everything_in_a_public_signature_has_a_public_name() {
    let Interface { exports, types } = &*INTERFACE;
    // An export can have another name at the root than where it is defined.
    let both = |(export, _): &'static (Export, _)| [Some(&export.name), export.path.last()];
    let named: BTreeSet<&str> = exports.iter().flat_map(both).flatten().map(String::as_str).collect();
    let mut unnamed = Vec::new();
    for (export, line) in
        exports.iter().flat_map(|(export, lines)| lines.iter().map(move |line| (export, line)))
    {
        // A trait without a public name is one between our packages: nobody else can call its functions.
        if line.trim().strip_prefix("impl ").is_some_and(|name| types.contains(name) && !named.contains(name))
        {
            continue;
        }
        let missing = words_of_types(line).filter(|word| types.contains(*word) && !named.contains(word));
        unnamed.extend(missing.map(|word| format!("{word}: {}: {}", export.name, line.trim())));
    }
    assert!(types.len() > 100, "{} types were found", types.len());
    assert!(unnamed.is_empty(), "no public name for\n{}", unnamed.join("\n"));
}

/// Returns the name of a public type or trait.
fn public_type(item: &Item) -> Option<String> {
    let (ident, visibility) = match item {
        Item::Struct(item) => (&item.ident, &item.vis),
        Item::Enum(item) => (&item.ident, &item.vis),
        Item::Type(item) => (&item.ident, &item.vis),
        Item::Trait(item) => (&item.ident, &item.vis),
        _ => return None,
    };
    is_public(visibility).then(|| ident.to_string())
}

/// Returns the words of a line that can be names of types: those in capitals outside of attributes and texts,
/// without the variant of an enum that the line may begin with.
fn words_of_types(line: &str) -> impl Iterator<Item = &str> {
    let member = line.strip_prefix("    ");
    let is_variant = |rest: &str| rest.starts_with(|c: char| c.is_ascii_uppercase());
    let text = match member {
        Some(rest) if is_variant(rest) => rest.split_once(['(', '{']).map_or("", |(_, fields)| fields),
        Some(rest) => rest,
        None => line.rsplit_once("] ").map_or(line, |(_, item)| item),
    };
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase()))
}

fn modules(src: &Path) -> Vec<Module> {
    let mut found = Vec::new();
    let mut folders: Vec<(PathBuf, Vec<String>)> = vec![(src.to_owned(), Vec::new())];
    while let Some((folder, module)) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
            let inner = [module.clone(), vec![stem.clone()]].concat();
            if path.is_dir() && stem == "app" {
                // The window is not public.
            } else if path.is_dir() {
                folders.push((path, inner));
            } else if path.extension().is_some_and(|ending| ending == "rs") && stem != "main" {
                let own = if matches!(stem.as_str(), "mod" | "lib") { module.clone() } else { inner };
                let file = syn::parse_file(&fs::read_to_string(path).unwrap()).unwrap();
                found.push(Module { path: own, items: file.items.into_iter().map(in_macro).collect() });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// Returns the item that a macro takes whole, if it does that.
fn in_macro(item: Item) -> Item {
    match &item {
        Item::Macro(call) => syn::parse2(call.mac.tokens.clone()).unwrap_or(item),
        _ => item,
    }
}

/// Everything public in `src/lib.rs` but the module `guide`, which is prose.
fn exports(lib: &Path) -> Vec<Export> {
    let mut found = Vec::new();
    for item in &syn::parse_file(&fs::read_to_string(lib).unwrap()).unwrap().items {
        match item {
            Item::Use(item) if is_public(&item.vis) => collect(&item.tree, &mut Vec::new(), &mut found),
            Item::Fn(item) if is_public(&item.vis) => {
                let name = item.sig.ident.to_string();
                found.push(Export { path: vec![name.clone()], name });
            }
            _ => {}
        }
    }
    assert!(found.len() > 30, "{} names were found in lib.rs", found.len());
    found
}

fn collect(tree: &UseTree, before: &mut Vec<String>, found: &mut Vec<Export>) {
    match tree {
        UseTree::Path(tree) if tree.ident.to_string().starts_with("meshbrush_") => {
            collect(&tree.tree, before, found);
        }
        UseTree::Path(tree) => {
            before.push(tree.ident.to_string());
            collect(&tree.tree, before, found);
            before.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| collect(tree, before, found)),
        UseTree::Name(tree) => {
            let name = tree.ident.to_string();
            found.push(Export { path: [before.clone(), vec![name.clone()]].concat(), name });
        }
        UseTree::Rename(tree) => {
            let path = [before.clone(), vec![tree.ident.to_string()]].concat();
            found.push(Export { name: tree.rename.to_string(), path });
        }
        UseTree::Glob(_) => panic!("a glob would hide what is public"),
    }
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// Returns the lines that describe an export: the item, and below it fields, variants, methods and traits.
fn description(export: &Export, modules: &[Module]) -> Vec<String> {
    let (name, outer) = export.path.split_last().unwrap();
    let inside = |module: &&Module| module.path.starts_with(outer);
    let item =
        modules.iter().filter(inside).flat_map(|module| &module.items).find(|item| defines(item, name));
    let Some(item) = item else { return vec![format!("use {}", export.path.join("::"))] };
    let mut lines = described_item(item);
    if export.name != *name {
        lines[0] += &format!(" as {}", export.name);
    }
    if matches!(item, Item::Struct(_) | Item::Enum(_)) {
        let layer = outer.first();
        let blocks =
            modules.iter().filter(|module| module.path.first() == layer).flat_map(|module| &module.items);
        let mut members: Vec<String> = blocks
            .filter_map(|item| match item {
                Item::Impl(block) if implements_for(block, name) => Some(described_impl(block)),
                _ => None,
            })
            .flatten()
            .collect();
        members.sort();
        lines.extend(members);
    }
    lines
}

fn defines(item: &Item, name: &str) -> bool {
    let (ident, visibility) = match item {
        Item::Struct(item) => (&item.ident, &item.vis),
        Item::Enum(item) => (&item.ident, &item.vis),
        Item::Fn(item) => (&item.sig.ident, &item.vis),
        Item::Const(item) => (&item.ident, &item.vis),
        Item::Type(item) => (&item.ident, &item.vis),
        Item::Trait(item) => (&item.ident, &item.vis),
        _ => return false,
    };
    ident == name && is_public(visibility)
}

fn described_item(item: &Item) -> Vec<String> {
    match item {
        Item::Struct(item) => {
            let (ident, generics) = (&item.ident, &item.generics);
            let mut lines = vec![marks(&item.attrs) + &plain(quote::quote!(pub struct #ident #generics))];
            let fields = item.fields.iter().filter(|field| is_public(&field.vis));
            lines.extend(fields.map(|field| {
                let (ident, ty) = (&field.ident, &field.ty);
                format!("    {}", plain(quote::quote!(#ident: #ty)))
            }));
            lines
        }
        Item::Enum(item) => {
            let (ident, generics) = (&item.ident, &item.generics);
            let mut lines = vec![marks(&item.attrs) + &plain(quote::quote!(pub enum #ident #generics))];
            lines.extend(item.variants.iter().map(|variant| {
                let mut fields = variant.fields.clone();
                without_attributes(&mut fields);
                format!("    {}{}", variant.ident, plain(fields.to_token_stream()))
            }));
            lines
        }
        Item::Fn(item) => vec![plain(item.sig.to_token_stream())],
        Item::Const(item) => {
            let (ident, ty) = (&item.ident, &item.ty);
            vec![plain(quote::quote!(const #ident: #ty))]
        }
        Item::Trait(item) => vec![described_trait(item.clone())],
        other => vec![plain(other.to_token_stream())],
    }
}

/// A trait without documentation and without the bodies of its functions.
fn described_trait(mut item: syn::ItemTrait) -> String {
    item.attrs.clear();
    for member in &mut item.items {
        match member {
            TraitItem::Fn(function) => {
                function.attrs.clear();
                function.default = None;
            }
            TraitItem::Type(ty) => ty.attrs.clear(),
            TraitItem::Const(constant) => constant.attrs.clear(),
            _ => {}
        }
    }
    plain(item.to_token_stream())
}

fn without_attributes(fields: &mut Fields) {
    fields.iter_mut().for_each(|field| field.attrs.clear());
}

/// `#[non_exhaustive]` and derived traits.
fn marks(attributes: &[Attribute]) -> String {
    let wanted = attributes
        .iter()
        .filter(|attribute| ["non_exhaustive", "derive"].iter().any(|name| attribute.path().is_ident(name)));
    wanted.map(|attribute| plain(attribute.to_token_stream()) + " ").collect()
}

fn implements_for(block: &ItemImpl, name: &str) -> bool {
    match &*block.self_ty {
        Type::Path(ty) => ty.path.segments.last().is_some_and(|segment| segment.ident == name),
        _ => false,
    }
}

fn described_impl(block: &ItemImpl) -> Vec<String> {
    if let Some(implemented) = &block.trait_ {
        return vec![format!("    impl {}", plain(implemented.0.to_token_stream()))];
    }
    let public = block.items.iter().filter_map(|item| match item {
        ImplItem::Fn(item) if is_public(&item.vis) => Some(plain(item.sig.to_token_stream())),
        ImplItem::Const(item) if is_public(&item.vis) => {
            let (ident, ty) = (&item.ident, &item.ty);
            Some(plain(quote::quote!(const #ident: #ty)))
        }
        _ => None,
    });
    public.map(|line| format!("    {line}")).collect()
}

/// Tokens with the usual spaces.
fn plain(tokens: impl ToTokens) -> String {
    let mut text = tokens.to_token_stream().to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    for (spaced, usual) in [
        (" ,", ","),
        (" ;", ";"),
        (" :", ":"),
        (": :", "::"),
        (":: ", "::"),
        (" (", "("),
        ("( ", "("),
        (" )", ")"),
        (" [", "["),
        ("[ ", "["),
        (" ]", "]"),
        ("& ", "&"),
        (" <", "<"),
        ("< ", "<"),
        (" >", ">"),
        ("# [", "#["),
        (",)", ")"),
        ("->(", "-> ("),
        (":[", ": ["),
        (",&", ", &"),
        ("impl<", "impl <"),
    ] {
        text = text.replace(spaced, usual);
    }
    text
}
