//! Source files as text: without comments, literals or tests, and what they import.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A file of the tree.
pub(super) struct Source {
    /// Path from the root, with `/`.
    pub(super) path: String,
    pub(super) text: String,
    /// The text without comments.
    pub(super) code: String,
    /// The text without comments, literals and code that is compiled for tests only.
    pub(super) shipped: String,
}

impl Source {
    pub(super) fn new(path: String, text: String) -> Self {
        let (code, mut shipped) = blank(&text);
        if is_test_file(&path) {
            shipped = blank_range(&shipped, 0..shipped.len());
        }
        while let Some(part) = test_part(&shipped) {
            shipped = blank_range(&shipped, part);
        }
        Self { path, text, code, shipped }
    }

    /// The module's depth below the crate's root, that of a file directly in `kernel/` or `engine/` being 1.
    fn depth(&self) -> usize {
        let folders = self.path.matches('/').count();
        folders - usize::from(self.path.ends_with("/mod.rs"))
    }

    /// The folder or file directly below the crate's root that this file is or is in.
    pub(super) fn room(&self) -> &str {
        let inside = self.path.split_once('/').map_or("", |(_, rest)| rest);
        inside.split(['/', '.']).next().unwrap_or("")
    }
}

pub(super) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// All Rust files in some folders of the root, in the order of their paths.
pub(super) fn sources(folders: &[&str]) -> Vec<Source> {
    let mut paths = Vec::new();
    for folder in folders {
        collect(&root().join(folder), (*folder).to_owned(), &mut paths);
    }
    paths.sort();
    assert!(!paths.is_empty(), "the source tree stands beside the crate");
    paths
        .into_iter()
        .map(|path| {
            let text = fs::read_to_string(root().join(&path)).expect("a source file can be read");
            Source::new(path, text)
        })
        .collect()
}

fn collect(folder: &Path, name: String, out: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|e| panic!("{name}: {e}")) {
        let entry = entry.expect("a folder can be listed");
        let file = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{name}/{file}");
        if entry.path().is_dir() {
            if file != "target" {
                collect(&entry.path(), path, out);
            }
        } else if file.ends_with(".rs") {
            out.push(path);
        }
    }
}

/// Whether a file is compiled for tests only, by its name.
pub(super) fn is_test_file(path: &str) -> bool {
    let is_test = |part: &str| {
        part.starts_with("tests") || ["oracle", "bench", "measure"].contains(&part.trim_end_matches(".rs"))
    };
    path.split('/').skip(1).any(is_test)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Token {
    Code,
    Comment,
    Literal,
}

/// The text without comments, and the same without the content of literals. Lines and columns are kept.
pub(super) fn blank(text: &str) -> (String, String) {
    let bytes = text.as_bytes();
    let (mut code, mut bare) = (Vec::with_capacity(bytes.len()), Vec::with_capacity(bytes.len()));
    let mut at = 0;
    while at < bytes.len() {
        let (token, len) = next_token(bytes, at);
        let end = (at + len).min(bytes.len());
        for &byte in &bytes[at..end] {
            let space = if byte == b'\n' { b'\n' } else { b' ' };
            code.push(if token == Token::Comment { space } else { byte });
            bare.push(if token == Token::Code { byte } else { space });
        }
        at = end;
    }
    let whole = |bytes| String::from_utf8(bytes).expect("characters are blanked as a whole");
    (whole(code), whole(bare))
}

/// The token at a byte, and its length: a comment, a literal, or one byte of code.
fn next_token(bytes: &[u8], at: usize) -> (Token, usize) {
    let rest = &bytes[at..];
    let until = |from: usize, end: &[u8]| {
        let tail = rest.get(from..).unwrap_or(&[]);
        tail.windows(end.len()).position(|w| w == end).map_or(rest.len(), |p| from + p + end.len())
    };
    match rest {
        [b'/', b'/', ..] => (Token::Comment, until(2, b"\n") - 1),
        [b'/', b'*', ..] => (Token::Comment, until(2, b"*/")),
        [b'"', ..] => (Token::Literal, string_length(rest)),
        [b'r', b'"' | b'#', ..] if at == 0 || !is_word(bytes[at - 1]) => {
            let hashes = rest[1..].iter().take_while(|b| **b == b'#').count();
            if rest.get(1 + hashes) != Some(&b'"') {
                return (Token::Code, 1); // a raw identifier
            }
            let end: Vec<u8> = std::iter::once(b'"').chain(std::iter::repeat_n(b'#', hashes)).collect();
            (Token::Literal, until(2 + hashes, &end))
        }
        [b'\'', b'\\', ..] => (Token::Literal, until(3, b"'")),
        [b'\'', _, b'\'', ..] => (Token::Literal, 3),
        [b'\'', 0x80..=0xFF, ..] => (Token::Literal, until(2, b"'")),
        _ => (Token::Code, 1),
    }
}

/// The length of a string literal with its quotes.
fn string_length(rest: &[u8]) -> usize {
    let mut at = 1;
    while at < rest.len() {
        match rest[at] {
            b'\\' => at += 2,
            b'"' => return at + 1,
            _ => at += 1,
        }
    }
    rest.len()
}

pub(super) fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

fn blank_range(text: &str, range: Range<usize>) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for byte in bytes[range].iter_mut().filter(|b| **b != b'\n') {
        *byte = b' ';
    }
    String::from_utf8(bytes).expect("characters are blanked as a whole")
}

/// The first item that only tests compile, with its attribute.
fn test_part(bare: &str) -> Option<Range<usize>> {
    let start = ["#[cfg(test)]", "#[cfg(all(test"].iter().filter_map(|a| bare.find(a)).min()?;
    let body = start + bare[start..].find(['{', ';']).unwrap_or(bare.len() - start - 1);
    let end = if bare[body..].starts_with('{') { body + group(&bare[body..]).len() } else { body + 1 };
    Some(start..end)
}

/// From an opening brace to the closing one.
pub(super) fn group(text: &str) -> &str {
    let mut open = 0;
    for (i, c) in text.char_indices() {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            _ => {}
        }
        if open == 0 {
            return &text[..=i];
        }
    }
    text
}

/// The top-level folders and files of the crate that a file names by `crate::` or by enough `super::`.
pub(super) fn arrows(source: &Source) -> Vec<String> {
    let text = &source.shipped;
    let mut found = Vec::new();
    for (at, _) in text.match_indices("crate::") {
        let whole = at == 0 || !is_word(text.as_bytes()[at - 1]);
        if whole {
            names_after(&text[at + "crate::".len()..], &mut found);
        }
    }
    let climb = "super::".repeat(source.depth());
    for (at, _) in text.match_indices(&climb) {
        let starts = at == 0 || !(is_word(text.as_bytes()[at - 1]) || text.as_bytes()[at - 1] == b':');
        if starts {
            names_after(&text[at + climb.len()..], &mut found);
        }
    }
    found.sort();
    found.dedup();
    found
}

/// The first name of a path, or those of a group of paths.
fn names_after(path: &str, out: &mut Vec<String>) {
    let name =
        |text: &str| -> String { text.trim_start().chars().take_while(|c| is_word(*c as u8)).collect() };
    if !path.starts_with('{') {
        out.push(name(path));
        return;
    }
    let inside = group(path);
    let mut open = 0;
    for (i, c) in inside.char_indices() {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            _ => {}
        }
        if open == 1 && (c == '{' || c == ',') {
            out.push(name(&inside[i + 1..]));
        }
    }
    out.retain(|n| !n.is_empty());
}

/// Every line of shipped code with one of `words`, as `path:line: word`.
pub(super) fn find_words(sources: &[Source], words: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for source in sources {
        for (number, line) in source.shipped.lines().enumerate() {
            for word in words.iter().filter(|w| line.contains(**w)) {
                found.push(format!("{}:{}: {word}", source.path, number + 1));
            }
        }
    }
    found
}

/// Which lines have a part inside of a function.
pub(super) fn lines_in_functions(bare: &str) -> Vec<bool> {
    let (mut blocks, mut header): (Vec<bool>, usize) = (Vec::new(), 0);
    let mut lines = vec![false];
    for (i, c) in bare.char_indices() {
        match c {
            '{' => {
                let inside = blocks.last() == Some(&true);
                blocks.push(inside || bare[header..i].split(|c| !is_word(c as u8)).any(|w| w == "fn"));
            }
            '}' => {
                blocks.pop();
            }
            '\n' => lines.push(false),
            _ => {}
        }
        if matches!(c, '{' | '}' | ';') {
            header = i + 1;
        }
        if blocks.last() == Some(&true)
            && let Some(line) = lines.last_mut()
        {
            *line = true;
        }
    }
    lines
}
