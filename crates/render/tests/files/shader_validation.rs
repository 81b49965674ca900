//! Every shader is valid WGSL, also on machines where no driver would compile it.
#![cfg(feature = "gpu")]

use meshbrush_render::render::gpu::shaders;
use naga::valid::{Capabilities, ValidationFlags, Validator};

#[test]
fn every_shader_is_valid() {
    for (name, source) in shaders::ALL {
        let module = naga::front::wgsl::parse_str(source)
            .unwrap_or_else(|e| panic!("{}", e.emit_to_string_with_path(source, name)));
        Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|e| panic!("{}", e.emit_to_string_with_path(source, name)));
    }
}

#[test]
fn every_file_of_a_shader_is_used() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/render/gpu");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sources = files.filter(|path| path.extension().is_some_and(|ending| ending == "wgsl"));
    for path in sources {
        let source = std::fs::read_to_string(&path).unwrap();
        assert!(shaders::ALL.iter().any(|(_, all)| all.contains(&source)), "{}", path.display());
    }
}
