//! Reflection: every public type of the engine that derives `Reflect` is registered, and resources and
//! components can be used through it.

use avian::{PhysicsTypeRegistrationPlugin, prelude::*};
use bevy_app::App;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent, ReflectResource};
use bevy_time::Time;
use std::{any::TypeId, fs, path::Path};

fn app() -> App {
    let mut app = App::empty();
    app.init_resource::<AppTypeRegistry>().add_plugins(PhysicsTypeRegistrationPlugin);
    app
}

/// The paths of all registered types.
pub fn registered() -> Vec<&'static str> {
    let app = app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    registry.iter().map(|registration| registration.type_info().type_path()).collect()
}

#[test]
fn clocks_are_registered() {
    let app = app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    for id in [
        TypeId::of::<Time<Physics>>(),
        TypeId::of::<Time<Substeps>>(),
        TypeId::of::<Physics>(),
        TypeId::of::<Substeps>(),
    ] {
        assert!(registry.contains(id));
    }
    assert!(registry.get_type_data::<ReflectResource>(TypeId::of::<Time<Physics>>()).is_some());
}

#[test]
fn components_and_resources_reflect_as_such() {
    let app = app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    assert!(registry.get_type_data::<ReflectResource>(TypeId::of::<Gravity>()).is_some());
    assert!(registry.get_type_data::<ReflectResource>(TypeId::of::<SubstepCount>()).is_some());
    assert!(registry.get_type_data::<ReflectComponent>(TypeId::of::<SpeculativeMargin>()).is_some());
}

/// Names of the public types in the engine's sources whose derives include `Reflect`, with the data they
/// should reflect.
fn reflected_types(folder: &Path, found: &mut Vec<Reflected>) {
    // The other dimension is not part of this package.
    let other = if env!("CARGO_PKG_NAME").contains("2d") { "dim3" } else { "dim2" };
    let mut entries: Vec<_> =
        fs::read_dir(folder).expect("sources").map(|e| e.expect("entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.file_stem().is_some_and(|stem| stem == other) {
            continue;
        }
        if path.is_dir() {
            reflected_types(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let source = fs::read_to_string(&path).expect("readable source");
            let code = source.split("#[cfg(test)]").next().unwrap_or_default();
            reflected_types_in(code, found);
        }
    }
}

struct Reflected {
    name: String,
    component: bool,
    resource: bool,
}

fn reflected_types_in(code: &str, found: &mut Vec<Reflected>) {
    for (start, _) in code.match_indices("#[derive(") {
        let rest = &code[start + "#[derive(".len()..];
        let Some(end) = rest.find(")]") else { continue };
        let derives: Vec<_> = rest[..end].split(',').map(str::trim).collect();
        // The item the derive belongs to is the next one that starts a line.
        let item = rest.lines().find(|line| {
            ["pub struct ", "pub enum ", "pub(", "struct ", "enum "].iter().any(|key| line.starts_with(key))
        });
        let name =
            item.and_then(|line| line.strip_prefix("pub struct ").or_else(|| line.strip_prefix("pub enum ")));
        if let Some(name) = name.filter(|name| !name.contains('<'))
            && derives.contains(&"Reflect")
        {
            let name = name.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
            found.push(Reflected {
                name: name.to_owned(),
                component: derives.contains(&"Component"),
                resource: derives.contains(&"Resource"),
            });
        }
    }
}

#[test]
fn every_public_reflected_type_is_registered() {
    let app = app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let mut expected = Vec::new();
    reflected_types(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../engine"), &mut expected);
    assert!(expected.iter().any(|found| found.name == "Gravity"), "the sources were not read");

    let mut missing = Vec::new();
    for Reflected { name, component, resource } in &expected {
        let Some(registration) = registry.iter().find(|registration| {
            let path = registration.type_info().type_path_table();
            path.short_path() == name && path.crate_name().is_some_and(|krate| krate.starts_with("avian"))
        }) else {
            missing.push(format!("{name} is not registered"));
            continue;
        };
        if *component && registration.data::<ReflectComponent>().is_none() {
            missing.push(format!("{name} lacks #[reflect(Component)]"));
        }
        if *resource && registration.data::<ReflectResource>().is_none() {
            missing.push(format!("{name} lacks #[reflect(Resource)]"));
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}
