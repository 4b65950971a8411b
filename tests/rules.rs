//! Rules of the source tree that no compiler checks: where code may depend on the dimension, the direction of
//! imports, and functions that differ between machines.

mod circles;
mod source_text;

use source_text::{Source, arrows, blank, find_words, is_test_file, lines_in_functions, root, sources};
use std::fs;

/// Maximum number of lines that name a dimension. Larger differences belong in twin files.
const CFG_BUDGET: usize = 80;

/// Maximum number of constants in `kernel/tuning.rs`. What a mechanism decides by itself needs none.
const TUNING_BUDGET: usize = 70;

/// Numbers of the kernel that do not tune: limits of floats, tags, and what follows from geometry.
const NOT_TUNING: [&str; 18] = [
    "FARTHEST",
    "TOUCHING",
    "RELATIVE",
    "NO_PLATFORM",
    "PLATFORM_A",
    "PLATFORM_B",
    "CHORD",
    "TRAVEL_UNITS",
    "STEEP",
    "BALLS",
    "ABSENT",
    "EVEN",
    "LOOSE",
    "MIN_SWING",
    "NO_SWING",
    "NO_PIVOT",
    "SERIES",
    "SMALL",
];

/// The kernel's folders from the bottom up: each may use those before it only.
const KERNEL_FLOORS: [&str; 14] = [
    "math",
    "tuning",
    "data",
    "thread_pool",
    "shape",
    "distance",
    "bvh",
    "graph",
    "manifold",
    "table",
    "contact",
    "ccd",
    "solver",
    "query",
];

/// Float functions whose bits depend on the platform's libm, on the target or on the compiler. The kernel's
/// `math` has its own sine, cosine and arc tangent.
const UNSTABLE_FLOATS: [&str; 22] = [
    ".sin()",
    ".cos()",
    ".tan()",
    ".sin_cos()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".sinh()",
    ".cosh()",
    ".tanh()",
    ".exp()",
    ".exp2()",
    ".ln()",
    ".log2()",
    ".log10()",
    ".powf(",
    ".mul_add(",
    ".recip()",
    ".hypot(",
    ".cbrt()",
    ".to_radians()",
];

/// Other sources of results that depend on more than the input: hash order, clocks, approximations,
/// fused products.
const UNSTABLE_REST: [&str; 7] =
    ["HashMap", "HashSet", "Instant::now", "SystemTime", "_mm_rcp", "_mm_rsqrt", "fmadd"];

#[track_caller]
fn assert_none(found: &[String], rule: &str) {
    assert!(found.is_empty(), "{rule}:\n  {}", found.join("\n  "));
}

fn names_dimension(line: &str) -> bool {
    line.contains("feature = \"2d\"") || line.contains("feature = \"3d\"")
}

#[test]
fn few_lines_depend_on_the_dimension_and_none_inside_of_functions() {
    let mut lines = Vec::new();
    let mut inside = Vec::new();
    for source in sources(&["kernel", "engine", "scenes"]) {
        let in_function = lines_in_functions(&blank(&source.text).1);
        for (number, line) in source.code.lines().enumerate().filter(|(_, l)| names_dimension(l)) {
            let place = format!("{}:{}: {}", source.path, number + 1, line.trim());
            if in_function[number] {
                inside.push(place.clone());
            }
            lines.push(place);
        }
    }
    assert_none(&inside, "a dimension is chosen per module, import, alias or field, not inside of functions");
    let count = lines.len();
    assert!(
        count <= CFG_BUDGET,
        "{count} lines name a dimension, {CFG_BUDGET} may:\n  {}",
        lines.join("\n  ")
    );
}

/// The name of a constant of floats that a line defines.
fn float_constant(line: &str) -> Option<&str> {
    let (name, kind) = line.split_once("const ")?.1.split_once(": ")?;
    let kind = kind.trim_start_matches('[');
    let is_float = kind.starts_with("f32") || kind.starts_with("f64");
    (is_float && !name.contains(' ')).then_some(name)
}

#[test]
fn tuning_constants_are_few_and_stand_on_one_page() {
    let mut count = 0;
    let mut elsewhere = Vec::new();
    for source in sources(&["kernel"]) {
        if source.path == "kernel/tuning.rs" {
            count = source.shipped.matches("pub const ").count();
        }
        if !["manifold", "contact", "ccd", "table", "solver"].contains(&source.room()) {
            continue;
        }
        for name in source.shipped.lines().filter_map(float_constant) {
            if !NOT_TUNING.contains(&name) {
                elsewhere.push(format!("{}: {name}", source.path));
            }
        }
    }
    assert_none(&elsewhere, "what tunes the kernel stands in kernel/tuning.rs");
    assert!((1..=TUNING_BUDGET).contains(&count), "{count} tuning constants, {TUNING_BUDGET} may be");
}

#[test]
fn the_kernel_knows_no_bevy() {
    assert_none(
        &find_words(&sources(&["kernel"]), &["use bevy", "bevy_", "bevy::"]),
        "the kernel is free of Bevy",
    );
}

#[test]
fn preludes_are_for_users() {
    let mut found = Vec::new();
    for source in sources(&["kernel", "engine"]) {
        for statement in source.shipped.split([';', '}']) {
            let statement = statement.trim_start();
            let own = ["use crate::", "use super::", "use self::"].iter().any(|u| statement.starts_with(u));
            if (own && statement.contains("prelude")) || statement.contains("crate::prelude") {
                found.push(format!("{}: {statement}", source.path));
            }
        }
    }
    assert_none(&found, "inside of the crates names are imported from where they are defined");
}

#[test]
fn the_kernel_calls_nothing_that_differs_between_machines() {
    let kernel = sources(&["kernel"]);
    let words = [&UNSTABLE_FLOATS[..], &UNSTABLE_REST[..]].concat();
    let mut found = find_words(&kernel, &words);
    // Idle threads read the clock to decide when to park; results do not depend on it.
    found.retain(|f| !(f.starts_with("kernel/thread_pool/sync.rs") && f.ends_with("Instant::now")));
    assert_none(&found, "the same input gives the same bits");
}

#[test]
fn the_engine_calls_no_float_function_that_differs_between_machines() {
    assert_none(&find_words(&sources(&["engine"]), &UNSTABLE_FLOATS), "the same input gives the same bits");
}

/// The operations of eight lanes need AVX2, which no signature can ask for: the type stays in the crate, and
/// only the files whose entry points hold an `Avx2` name it.
#[test]
fn eight_lanes_stay_behind_their_entry_points() {
    let kernel = sources(&["kernel"]);
    let named = find_words(&kernel, &["F32x8"]);
    let may = [
        "math/mod.rs",
        "math/lane_avx.rs",
        "math/entry.rs",
        "solver/all_rows.rs",
        "solver/compression.rs",
        "solver/integrate.rs",
        "solver/joint/tree.rs",
        "contact/recycle.rs",
    ];
    let strange: Vec<_> = named
        .iter()
        .filter(|f| !may.iter().any(|file| f.starts_with(&format!("kernel/{file}:"))))
        .cloned()
        .collect();
    assert_none(&strange, "eight lanes are named where an `Avx2` is in hand");
    let public: Vec<_> = kernel
        .iter()
        .flat_map(|source| source.shipped.lines().map(move |line| (source, line.trim())))
        .filter(|(_, line)| line.starts_with("pub ") && (line.contains("F32x8") || line.contains("Mask8")))
        .map(|(source, line)| format!("{}: {line}", source.path))
        .collect();
    assert_none(&public, "eight lanes are private to the kernel");
}

#[test]
fn arrows_in_the_kernel_go_down() {
    let floor = |room: &str| KERNEL_FLOORS.iter().position(|f| *f == room);
    let mut up = Vec::new();
    for source in sources(&["kernel"]).iter().filter(|s| s.path != "kernel/lib.rs") {
        let Some(own) = floor(source.room()) else {
            up.push(format!("{}: has no floor yet", source.path));
            continue;
        };
        for target in arrows(source) {
            match floor(&target) {
                Some(floor) if floor <= own => {}
                _ => up.push(format!("{} uses {target}", source.path)),
            }
        }
    }
    assert_none(&up, "a floor uses the floors below it");
}

#[test]
fn no_circles() {
    let mut found = Vec::new();
    for folder in ["kernel", "engine"] {
        let sources = sources(&[folder]);
        for dimension in ["2d", "3d"] {
            let arrows = circles::Crate::new(&sources, &format!("{folder}/lib.rs"), dimension).arrows();
            found.extend(circles::circles(&arrows));
        }
    }
    found.sort();
    found.dedup();
    assert_none(&found, "no file imports another in a circle: what both need goes to a file below them");
}

/// Only plugins use plugins.
#[test]
fn only_plugins_know_plugins() {
    let mut found = Vec::new();
    let sources = sources(&["engine"]);
    for dimension in ["2d", "3d"] {
        for (from, targets) in circles::Crate::new(&sources, "engine/lib.rs", dimension).arrows() {
            let may = from.ends_with("/plugin.rs") || from.ends_with("/plugins.rs");
            let plugins = targets.keys().filter(|to| !may && to.ends_with("/plugin.rs"));
            found.extend(plugins.map(|to| format!("{from} uses {to}")));
        }
    }
    assert_none(&found, "a plugin is named by other plugins only");
}

#[test]
fn the_lowest_floor_of_the_engine_uses_nothing_above_it() {
    let mut up = Vec::new();
    for source in sources(&["engine"]).iter().filter(|s| ["math", "schedule"].contains(&s.room())) {
        let above = arrows(source)
            .into_iter()
            .filter(|t| ["dynamics", "collision", "collider_tree"].contains(&t.as_str()));
        up.extend(above.map(|target| format!("{} uses {target}", source.path)));
    }
    assert_none(&up, "numbers and schedules come before bodies and colliders");
}

#[test]
fn nothing_is_left_for_later_in_the_code() {
    let words =
        [concat!("to", "do!("), concat!("unimple", "mented!("), concat!("FIX", "ME"), concat!("TO", "DO")];
    let mut found = Vec::new();
    for source in sources(&["kernel", "engine", "scenes", "testbed", "examples", "crates", "tests"]) {
        for (number, line) in
            source.text.lines().enumerate().filter(|(_, l)| words.iter().any(|w| l.contains(w)))
        {
            found.push(format!("{}:{}: {}", source.path, number + 1, line.trim()));
        }
    }
    assert_none(&found, "what is missing is missing openly, not as a mark in the code");
}

/// The front page is for somebody who decides in a minute.
#[test]
fn the_front_page_is_short() {
    for (path, most) in [("README.md", 90), ("CHANGELOG.md", 40)] {
        let lines =
            fs::read_to_string(root().join(path)).expect("the file stands in the tree").lines().count();
        assert!(lines <= most, "{path} has {lines} lines");
    }
}

/// The examples of READMEs and of the crate's page compile: they are examples of the packages, verbatim.
#[test]
fn the_readme_shows_an_example() {
    let read = |path: &str| fs::read_to_string(root().join(path)).expect("the file stands in the tree");
    for (readme, dimension) in
        [("README.md", 3), ("crates/avian3d/README.md", 3), ("crates/avian2d/README.md", 2)]
    {
        let readme = read(readme);
        let shown = readme.split("```rust\n").nth(1).and_then(|rest| rest.split("```").next());
        let example = read(&format!("examples/examples{dimension}d/examples/readme.rs"));
        assert_eq!(shown, example.split_once("\n\n").map(|(_, code)| code));
    }
    // Rustdoc cannot compile it: the package has no renderer.
    let docs: Vec<String> =
        read("engine/lib.rs").lines().map(|line| line.trim_start_matches("//!").to_owned()).collect();
    let shown =
        docs.iter().skip_while(|line| *line != " ```ignore").skip(1).take_while(|line| *line != " ```");
    let shown: String = shown.map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned() + "\n").collect();
    let example = read("examples/examples3d/examples/readme.rs");
    assert_eq!(Some(shown.as_str()), example.split_once("\n\n").map(|(_, code)| code));
}

/// A newcomer finds every example in the index.
#[test]
fn examples_are_listed() {
    let index = fs::read_to_string(root().join("examples/README.md")).expect("the examples have an index");
    let mut unlisted = Vec::new();
    for source in sources(&["examples/examples2d/examples", "examples/examples3d/examples"]) {
        let path = source.path.trim_start_matches("examples/");
        if !index.contains(&format!("({path})")) {
            unlisted.push(path.to_owned());
        }
    }
    assert_none(&unlisted, "examples/README.md lists all examples");
}

/// An example says on the screen what to look at. The first example of the README is its snippet.
#[test]
fn examples_have_a_hint() {
    let mut silent = Vec::new();
    for source in sources(&["examples/examples2d/examples", "examples/examples3d/examples"]) {
        let says = ["with_hint(", "Hint(", "Text::new("].iter().any(|text| source.text.contains(text));
        if !says && !source.path.ends_with("/readme.rs") {
            silent.push(source.path);
        }
    }
    assert_none(&silent, "examples say what to look at");
}

/// Paths between backticks or in links, with `{a,b}` written out.
fn paths_in(document: &str) -> Vec<String> {
    let ticks = document.split('`').skip(1).step_by(2);
    let links = document.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let mut paths = Vec::new();
    for path in ticks.chain(links).filter(|path| path.contains('/') && !path.contains("://")) {
        match (path.find('{'), path.find('}')) {
            (Some(open), Some(close)) if open < close => {
                let parts = path[open + 1..close].split(',');
                paths.extend(
                    parts.map(|part| format!("{}{}{}", &path[..open], part.trim(), &path[close + 1..])),
                );
            }
            _ => paths.push(path.to_owned()),
        }
    }
    paths
}

#[test]
fn documents_name_files_that_exist() {
    let mut names = ["README.md", "CONTRIBUTING.md", "examples/README.md"].map(str::to_owned).to_vec();
    for folder in ["docs", "docs/design", "docs/benchmarks"] {
        let entries = fs::read_dir(root().join(folder)).expect("a folder can be listed");
        names.extend(
            entries.map(|e| format!("{folder}/{}", e.expect("an entry").file_name().to_string_lossy())),
        );
    }
    let folders =
        ["kernel/", "engine/", "tests/", "tools/", "benches/", "scenes/", "testbed/", "crates/", "docs/"];
    let mut missing = Vec::new();
    for name in names.iter().filter(|name| name.ends_with(".md")) {
        let text = fs::read_to_string(root().join(name)).expect("a document can be read");
        let folder = root().join(name).parent().expect("a file is in a folder").to_owned();
        for path in paths_in(&text).iter().map(|path| path.split('#').next().unwrap_or_default()) {
            let from_root = folders.iter().any(|folder| path.starts_with(folder));
            let is_link = [".md", ".rs", ".png", ".svg", ".webp"].iter().any(|end| path.ends_with(end));
            let exists = root().join(path).exists() || folder.join(path).exists();
            if (from_root || is_link) && !path.contains(['*', ' ', '<']) && !exists {
                missing.push(format!("{name}: {path}"));
            }
        }
    }
    assert_none(&missing, "documents name files that exist");
}

/// The workspace of the f64 tests locks the versions of the main one, so that Bevy is compiled once.
#[test]
fn both_workspaces_lock_the_same_versions() {
    let locked = |path: &str| -> Vec<String> {
        let text = fs::read_to_string(root().join(path)).expect("a lock file stands beside its manifest");
        let packages = text.split("[[package]]\n").filter(|package| package.contains("source = "));
        packages.map(|package| package.lines().take(2).collect::<Vec<_>>().join(" ")).collect()
    };
    let all = locked("Cargo.lock");
    let mut f64s = locked("crates/far_f64/Cargo.lock");
    assert!(f64s.iter().any(|package| package.contains("\"bevy_ecs\"")));
    f64s.retain(|package| !all.contains(package));
    assert_none(&f64s, "what crates/far_f64/Cargo.lock has is in Cargo.lock too");
}

/// The rules must find something, or any tree would pass.
#[test]
fn what_is_shipped_is_told_from_what_is_not() {
    let text = "use crate::{math::Vector, solver::{self, Row}};\n\
        /* x.sin() */ // x.cos()\n\
        fn f<'a>(x: &'a str) -> char { let _ = r#\"\"x.tan()\"#; if x == \"\\\"x.exp()\" { '\"' } else { 'ü' } }\n\
        #[cfg(test)]\nmod oracle;\n\
        fn g(x: f32) -> f32 { super::super::graph::h(x).recip() }\n\
        #[cfg(test)]\nmod tests {\n    use crate::query;\n    fn k() { 1.0.ln(); }\n}\n\
        fn last() {}\n";
    let source = Source::new("kernel/shape/ball.rs".to_owned(), text.to_owned());
    assert_eq!(source.text.len(), source.code.len(), "blanks keep places");
    assert_eq!(arrows(&source), ["graph", "math", "solver"]);
    assert_eq!(source.room(), "shape");
    assert!(source.shipped.contains("fn last") && source.code.contains("fn k"));
    assert!(!source.shipped.contains("fn k") && !source.shipped.contains("oracle"));
    let inside = lines_in_functions("struct A {\n    a: fn(u8),\n}\nfn f() {\n    g();\n}\nuse b;\n");
    assert_eq!(inside, [false, false, false, true, true, true, false, false]);
    let found = find_words(&[source], &UNSTABLE_FLOATS);
    assert_eq!(found, ["kernel/shape/ball.rs:6: .recip()"]);
    assert!(is_test_file("kernel/bvh/measure.rs") && is_test_file("engine/x/tests/dim2.rs"));
    assert!(!is_test_file("tests/rules.rs") && !is_test_file("kernel/shape/hull3/mesh.rs"));
}
