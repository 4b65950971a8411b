//! Circles of imports between the files of a crate.
//!
//! An arrow goes from a file to the one that *defines* a name it uses. Re-exports are followed and are no
//! arrows themselves, so a module may re-export what its files define. Of twin files only that of one
//! dimension is read.

use super::source_text::{Source, group, is_word};
use std::collections::{BTreeMap, BTreeSet};

type Path = Vec<String>;

/// A module, in a file of its own or inside of another file's text.
#[derive(Default)]
struct Module {
    path: Path,
    /// The text without `use` and `mod` statements and without inner modules.
    body: String,
    /// Imports: name, whether it is re-exported, path from the crate's root.
    names: BTreeMap<String, (bool, Path)>,
    /// Modules of glob imports.
    globs: Vec<(bool, Path)>,
}

struct File {
    name: String,
    children: BTreeSet<String>,
    defines: BTreeSet<String>,
    /// The file's own module, then those inside of its text.
    modules: Vec<Module>,
}

/// The files of one crate in one dimension.
pub(super) struct Crate {
    files: Vec<File>,
    by_module: BTreeMap<Path, usize>,
}

/// The files that each file uses, with the names it uses them by.
pub(super) type Arrows = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

impl Crate {
    /// The crate with the root file `root`, in dimension `"2d"` or `"3d"`.
    pub(super) fn new(sources: &[Source], root: &str, dimension: &str) -> Self {
        let mut all = Self { files: Vec::new(), by_module: BTreeMap::new() };
        all.add(sources, root, Vec::new(), dimension);
        all
    }

    fn add(&mut self, sources: &[Source], name: &str, path: Path, dimension: &str) {
        let source = sources.iter().find(|s| s.path == name).unwrap_or_else(|| panic!("no file {name}"));
        let (folder, file) = name.rsplit_once('/').expect("files are in folders");
        let stem = file.trim_end_matches(".rs");
        // Submodules are in files beside the file or in its folder; those of a twin are beside it.
        let is_beside = ["lib", "mod"].contains(&stem) || path.last().is_none_or(|module| module != stem);
        let own = if is_beside { folder.to_owned() } else { format!("{folder}/{stem}") };
        let mut parsed = File {
            name: name.to_owned(),
            children: BTreeSet::new(),
            defines: BTreeSet::new(),
            modules: Vec::new(),
        };
        let mut found = Vec::new();
        parse(source, 0..source.shipped.len(), path.clone(), dimension, &mut parsed, &mut found);
        parsed.defines = definitions(&parsed.modules[0].body);
        self.by_module.insert(path.clone(), self.files.len());
        self.files.push(parsed);
        for (child, twin) in found {
            let candidates = match twin {
                Some(twin) => vec![format!("{folder}/{twin}")],
                None => vec![format!("{own}/{child}.rs"), format!("{own}/{child}/mod.rs")],
            };
            let Some(file) = candidates.iter().find(|c| sources.iter().any(|s| s.path == **c)) else {
                panic!("{name} has a module {child} without a file");
            };
            self.add(sources, file, [&path[..], &[child]].concat(), dimension);
        }
    }

    /// The file that defines the name at a path from the crate's root.
    fn resolve(&self, path: &[String], steps: usize) -> usize {
        let depth = (0..=path.len()).rev().find(|n| self.by_module.contains_key(&path[..*n])).unwrap_or(0);
        let at = self.by_module[&path[..depth]];
        let (file, rest) = (&self.files[at], &path[depth..]);
        let Some(name) = rest.first().filter(|n| !file.defines.contains(*n) && steps > 0) else { return at };
        let module = &file.modules[0];
        if let Some((_, target)) = module.names.get(name) {
            return self.resolve(&[target, &rest[1..]].concat(), steps - 1);
        }
        let through = |(_, glob): &(bool, Path)| {
            let target = self.resolve(&[&glob[..], &rest[..1]].concat(), steps - 1);
            self.files[target].defines.contains(name).then_some(target)
        };
        module.globs.iter().find_map(through).unwrap_or(at)
    }

    /// Arrows: from each file to the files it uses.
    pub(super) fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        for file in &self.files {
            let mut paths: Vec<Path> = Vec::new();
            for module in &file.modules {
                let brought = module.names.iter().filter(|(n, (shown, _))| !shown || uses(&module.body, n));
                paths.extend(brought.map(|(_, (_, path))| path.clone()));
                paths.extend(module.globs.iter().filter(|(shown, _)| !shown).map(|(_, path)| path.clone()));
                paths.extend(paths_in(&module.body).filter_map(|p| absolute(file, module, &p)));
            }
            for path in paths {
                let target = &self.files[self.resolve(&path, 8)].name;
                if *target != file.name {
                    let name = path.last().cloned().unwrap_or_default();
                    let names = arrows.entry(file.name.clone()).or_default().entry(target.clone());
                    names.or_default().insert(name);
                }
            }
        }
        arrows
    }
}

/// Every arrow that lies on a circle, as `file -> file: names`.
pub(super) fn circles(arrows: &Arrows) -> Vec<String> {
    let reach = |from: &str| {
        let mut seen = BTreeSet::new();
        let mut stack = vec![from.to_owned()];
        while let Some(at) = stack.pop() {
            let next = arrows.get(&at).into_iter().flat_map(|targets| targets.keys());
            stack.extend(next.filter(|t| seen.insert((*t).clone())).cloned());
        }
        seen
    };
    let reached: BTreeMap<&String, BTreeSet<String>> =
        arrows.keys().map(|file| (file, reach(file))).collect();
    let mut found = Vec::new();
    for (file, targets) in arrows {
        for (target, names) in targets {
            if reached.get(target).is_some_and(|r| r.contains(file)) {
                let names: Vec<_> = names.iter().map(String::as_str).collect();
                found.push(format!("{file} -> {target}: {}", names.join(", ")));
            }
        }
    }
    found
}

/// Reads one module: its statements, and the modules inside of it. `found` receives the modules in files of
/// their own, with the file of the dimension if one is given.
fn parse(
    source: &Source,
    range: std::ops::Range<usize>,
    path: Path,
    dimension: &str,
    file: &mut File,
    found: &mut Vec<(String, Option<String>)>,
) {
    let (text, code) = (&source.shipped, &source.code);
    let mut module = Module { path, ..Module::default() };
    let (mut at, mut start) = (range.start, range.start);
    let (mut inner, mut uses) = (Vec::new(), Vec::new());
    while at < range.end {
        let begins = at == range.start || !is_word(text.as_bytes()[at - 1]);
        let is =
            |word: &str| begins && text[at..].strip_prefix(word).is_some_and(|t| t.starts_with([' ', '\n']));
        let until = |marks: &[char]| text[at..range.end].find(marks).map_or(range.end - 1, |n| at + n);
        // From the end of the previous statement, for attributes and visibility.
        let head = || &code[start..at];
        if is("mod") {
            let end = until(&[';', '{']);
            let name = text[at + 3..end].trim().to_owned();
            if text[end..].starts_with('{') {
                let body = end + 1..end + group(&text[end..]).len() - 1;
                at = body.end;
                inner.push((body, name));
            } else {
                if is_of(head(), dimension) {
                    let twin = head().split_once(&format!("feature = \"{dimension}\", path = \""));
                    let twin = twin.and_then(|(_, rest)| rest.split('"').next()).map(str::to_owned);
                    file.children.insert(name.clone());
                    found.push((name, twin));
                }
                at = end;
            }
            start = at + 1;
        } else if is("use") {
            let end = until(&[';']);
            if is_of(head(), dimension) {
                let mut tree = Vec::new();
                expand(&text[at + 3..end], &[], &mut tree);
                uses.extend(tree.into_iter().map(|(path, name)| (head().contains("pub"), path, name)));
            }
            (at, start) = (end, end + 1);
        } else {
            let byte = text.as_bytes()[at];
            module.body.push(char::from(byte));
            if matches!(byte, b';' | b'{' | b'}') {
                start = at + 1;
            }
        }
        at += 1;
    }
    bring_in(uses, file, &mut module);
    let own = module.path.clone();
    file.modules.push(module);
    for (body, name) in inner {
        parse(source, body, [&own[..], &[name]].concat(), dimension, file, &mut Vec::new());
    }
}

/// Whether an item with these attributes is compiled in a dimension.
fn is_of(attributes: &str, dimension: &str) -> bool {
    let other = if dimension == "2d" { "3d" } else { "2d" };
    !attributes.contains(&format!("cfg(feature = \"{other}\")"))
}

/// Sorts imports into names and globs. Paths may begin with a name that another statement imports.
fn bring_in(uses: Vec<(bool, Path, String)>, file: &File, module: &mut Module) {
    let mut rest = uses;
    for _ in 0..2 {
        let mut unknown = Vec::new();
        for (shown, path, name) in rest {
            match absolute(file, module, &path) {
                Some(path) if name == "*" => module.globs.push((shown, path)),
                Some(path) => {
                    module.names.insert(name, (shown, path));
                }
                None => unknown.push((shown, path, name)),
            }
        }
        rest = unknown;
    }
}

/// A path from the crate's root; `None` if it leads out of the crate.
fn absolute(file: &File, module: &Module, path: &[String]) -> Option<Path> {
    let first = path.first()?.as_str();
    let climbs = path.iter().take_while(|p| *p == "super").count();
    let is_own = file.modules.is_empty() || file.modules[0].path == module.path;
    let base = match first {
        "crate" => return Some(path[1..].to_vec()),
        "self" => return Some([&module.path[..], &path[1..]].concat()),
        "super" => &module.path[..module.path.len().checked_sub(climbs)?],
        _ if is_own && file.children.contains(first) => &module.path[..],
        _ => return Some([&module.names.get(first)?.1[..], &path[1..]].concat()),
    };
    Some([base, &path[climbs..]].concat())
}

/// The paths of a `use` tree, each with its local name; `*` for all.
fn expand(tree: &str, before: &[String], out: &mut Vec<(Path, String)>) {
    let (head, inside) = match tree.find('{') {
        Some(open) => (&tree[..open], Some(group(&tree[open..]))),
        None => (tree, None),
    };
    let (head, alias) = head.split_once(" as ").map_or((head, None), |(head, alias)| (head, Some(alias)));
    let steps =
        head.split("::").map(str::trim).filter(|s| !s.is_empty() && (*s != "self" || before.is_empty()));
    let mut path: Path = before.iter().cloned().chain(steps.map(str::to_owned)).collect();
    let Some(inside) = inside else {
        if let Some(last) = path.last().cloned() {
            if last == "*" {
                path.pop();
            }
            out.push((path, alias.map_or(last, |a| a.trim().to_owned())));
        }
        return;
    };
    let (mut depth, mut start) = (0, 1);
    for (i, c) in inside.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if (c == ',' && depth == 1) || depth == 0 {
            let part = inside[start..i].trim();
            if !part.is_empty() {
                expand(part, &path, out);
            }
            start = i + 1;
        }
    }
}

/// The names that a module's text defines, outside of blocks.
fn definitions(body: &str) -> BTreeSet<String> {
    let mut open = 0;
    let outside = |c: char| {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            _ => {}
        }
        if open > 0 || !is_word(c as u8) { ' ' } else { c }
    };
    let outside: String = body.chars().map(outside).collect();
    let words: Vec<&str> = outside.split_whitespace().collect();
    let kinds = ["struct", "enum", "fn", "trait", "type", "const", "static", "union", "macro_rules"];
    let defined = words.windows(2).filter(|pair| kinds.contains(&pair[0]));
    defined.map(|pair| pair[1].to_owned()).collect()
}

/// Whether a name is in a text, other than as a field or method.
fn uses(body: &str, name: &str) -> bool {
    body.match_indices(name).any(|(at, _)| {
        let (before, after) = (&body.as_bytes()[..at], &body[at + name.len()..]);
        let starts = before.last().is_none_or(|b| !is_word(*b) && *b != b'.');
        let ends = after.bytes().next().is_none_or(|b| !is_word(b));
        starts && ends && (!after.starts_with(':') || after.starts_with("::"))
    })
}

/// The paths of two or more names in a text, without those of visibilities.
fn paths_in(body: &str) -> impl Iterator<Item = Path> + '_ {
    let is_part = |c: char| is_word(c as u8) || c == ':';
    let parts = body.split(move |c: char| !is_part(c));
    let mut before = "";
    parts.filter(|p| !p.is_empty()).filter_map(move |part| {
        let is_visibility = core::mem::replace(&mut before, part) == "in";
        let names: Path = part.trim_end_matches(':').split("::").map(str::to_owned).collect();
        (names.len() > 1 && !is_visibility && names.iter().all(|n| !n.is_empty() && !n.contains(':')))
            .then_some(names)
    })
}

/// The rule must find something, or any tree would pass.
#[test]
fn a_circle_is_found_through_re_exports_twins_and_inner_modules() {
    let sources: Vec<Source> = [
        ("engine/lib.rs", "mod a;\nmod b;\npub mod prelude {\n    pub use crate::{a::*, b::Plugin};\n}\n"),
        (
            "engine/a/mod.rs",
            "#[cfg_attr(feature = \"2d\", path = \"dim2.rs\")]\n\
             #[cfg_attr(feature = \"3d\", path = \"dim3.rs\")]\nmod dim;\nmod leaf;\n\
             #[cfg(feature = \"3d\")]\nmod tensor;\n\
             pub use dim::*;\npub use leaf::{Leaf, Other as Twig};\n\
             #[cfg(test)]\nmod tests {\n    use crate::b::Plugin;\n}\n",
        ),
        ("engine/a/dim2.rs", "pub struct Turn;\nimpl Turn {\n    fn leaf() -> super::Leaf {}\n}\n"),
        ("engine/a/dim3.rs", "use crate::b::Plugin;\npub struct Turn(Plugin);\n"),
        ("engine/a/leaf.rs", "pub struct Leaf;\npub(in super::super) enum Other {}\n"),
        ("engine/a/tensor.rs", "use super::Turn;\n"),
        (
            "engine/b.rs",
            "use crate::a::{self, Turn};\npub struct Plugin { leaf: a::Twig }\n\
             mod inner {\n    use super::Plugin;\n    fn f(x: crate::a::Turn) {}\n}\n",
        ),
    ]
    .map(|(path, text)| Source::new(path.to_owned(), text.to_owned()))
    .into();
    let of = |dimension| Crate::new(&sources, "engine/lib.rs", dimension).arrows();
    let targets = |arrows: &Arrows, file: &str| -> Vec<String> {
        arrows.get(file).into_iter().flat_map(|t| t.keys().cloned()).collect()
    };
    let plane = of("2d");
    assert_eq!(targets(&plane, "engine/b.rs"), ["engine/a/dim2.rs", "engine/a/leaf.rs", "engine/a/mod.rs"]);
    assert_eq!(targets(&plane, "engine/a/dim2.rs"), ["engine/a/leaf.rs"]);
    assert!(targets(&plane, "engine/a/mod.rs").is_empty() && targets(&plane, "engine/lib.rs").is_empty());
    assert!(circles(&plane).is_empty());
    let space = of("3d");
    assert_eq!(targets(&space, "engine/a/tensor.rs"), ["engine/a/dim3.rs"]);
    let expected = ["engine/a/dim3.rs -> engine/b.rs: Plugin", "engine/b.rs -> engine/a/dim3.rs: Turn"];
    assert_eq!(circles(&space), expected);
}
