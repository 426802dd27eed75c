//! The source files of all crates as text, as if they were modules of one: what each declares, names and passes on.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// `crate::a::b` as `["a", "b"]`.
pub type ModulePath = Vec<String>;

/// A source file.
pub struct Source {
    pub path: PathBuf,
    module: ModulePath,
    /// Its text without comments and tests.
    pub code: String,
    /// What it passes on under a name of its own: `pub use`.
    exports: BTreeMap<String, ModulePath>,
}

/// The files that each file names.
pub type Arrows = BTreeMap<ModulePath, BTreeSet<ModulePath>>;

/// All files that are reached by `mod` from the root, tests apart.
pub struct Sources(pub BTreeMap<ModulePath, Source>);

/// A text without comments and without the items that are compiled for tests only.
pub fn production(text: &str) -> String {
    let mut code = String::new();
    let mut lines = text.lines().map(|line| line.split("//").next().unwrap());
    while let Some(line) = lines.next() {
        if line.trim() != "#[cfg(test)]" {
            code += line;
            code.push('\n');
            continue;
        }
        let item = lines.find(|line| !line.trim().starts_with("#[")).unwrap();
        let indent = item.len() - item.trim_start().len();
        let end = format!("{}}}", &item[..indent]);
        if !item.ends_with([';', '}']) {
            lines.find(|line| line.starts_with(&end)).unwrap();
        }
    }
    code
}

/// A code without `pub(in path)`: it names who may see an item, and needs nothing of it.
fn without_visibility(code: &str) -> String {
    const SEEN: &str = "pub(in ";
    let mut parts = code.split(SEEN);
    let first = parts.next().unwrap_or_default();
    let rest = parts.map(|part| &part[part.find(')').map_or(0, |at| at + 1)..]);
    std::iter::once(first).chain(rest).collect()
}

/// The paths of a `use` with the names that they get: `a::{b, c as d}` is `a::b` as `b` and `a::c` as `d`.
pub fn expand(tree: &str, before: &[String]) -> Vec<(ModulePath, String)> {
    let tree = tree.trim();
    let (head, group) = match tree.find('{') {
        Some(at) => (&tree[..at], Some(&tree[at + 1..tree.rfind('}').unwrap()])),
        None => (tree, None),
    };
    let (path, name) = head.split_once(" as ").unwrap_or((head, ""));
    let names = path
        .split("::")
        .map(str::trim)
        .filter(|name| !name.is_empty());
    let all: ModulePath = before
        .iter()
        .cloned()
        .chain(names.map(str::to_owned))
        .collect();
    let Some(group) = group else {
        let all = if all.last().is_some_and(|last| last == "self") && all.len() > 1 {
            all[..all.len() - 1].to_vec()
        } else {
            all
        };
        let local_name = if name.is_empty() {
            all.last().unwrap().clone()
        } else {
            name.trim().to_owned()
        };
        return vec![(all, local_name)];
    };
    let (mut depth, mut start, mut result) = (0, 0, Vec::new());
    for (at, c) in group.char_indices().chain([(group.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                let part = group[start..at].trim();
                result.extend((!part.is_empty()).then(|| expand(part, &all)));
                start = at + 1;
            }
            _ => {}
        }
    }
    result.into_iter().flatten().collect()
}

/// The `use` statements of a code: whether they pass on, and what they name.
fn uses(code: &str) -> Vec<(bool, &str)> {
    let mut result = Vec::new();
    for (at, _) in code.match_indices("use ") {
        let line = code[..at].rsplit('\n').next().unwrap().trim();
        if line.is_empty() || line.starts_with("pub") && line.len() < 12 {
            let rest = &code[at + 4..];
            result.push((!line.is_empty(), &rest[..rest.find(';').unwrap()]));
        }
    }
    result
}

impl Source {
    /// A path in this file from the root of the crate; `None` for one of another package or of a local name.
    fn absolute(
        &self,
        path: &[String],
        children: &dyn Fn(&ModulePath) -> bool,
    ) -> Option<ModulePath> {
        let ups = path.iter().take_while(|name| *name == "super").count();
        let child = || {
            self.module
                .iter()
                .cloned()
                .chain([path[0].clone()])
                .collect()
        };
        let (base, rest) = match path.first()?.as_str() {
            "crate" => (&[][..], &path[1..]),
            "self" => (&self.module[..], &path[1..]),
            "super" => (
                &self.module[..self.module.len().checked_sub(ups)?],
                &path[ups..],
            ),
            _ if children(&child()) => (&self.module[..], path),
            _ => return None,
        };
        Some(base.iter().chain(rest).cloned().collect())
    }

    /// All paths in the code, as they stand there.
    fn named(&self) -> BTreeSet<ModulePath> {
        let mut code = without_visibility(&self.code);
        let mut all = BTreeSet::new();
        for (passes_on, tree) in uses(&self.code) {
            code = code.replacen(&format!("use {tree};"), "", 1);
            if !passes_on {
                all.extend(expand(tree, &[]).into_iter().map(|(path, _)| path));
            }
        }
        let words = code.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
        let paths = words.filter(|word| word.contains("::"));
        let split = |path: &str| path.split("::").map(str::to_owned).collect();
        all.extend(paths.map(|path| split(path.trim_matches(':'))));
        all
    }
}

impl Sources {
    /// Those of the crates in `src`, `validation` and `crates`, whose top modules have one name everywhere.
    pub fn of_workspace() -> Self {
        let mut sources = Self(BTreeMap::new());
        let crates = fs::read_dir("crates").unwrap();
        let mut roots: Vec<PathBuf> = crates.map(|entry| entry.unwrap().path()).collect();
        roots.extend([PathBuf::from("validation"), PathBuf::new()]);
        for root in roots {
            sources.read(&root.join("src/lib.rs"), Vec::new());
        }
        assert!(sources.0.len() > 100, "run from the root of the repository");
        let modules: BTreeSet<ModulePath> = sources.0.keys().cloned().collect();
        for source in sources.0.values_mut() {
            for (_, tree) in uses(&source.code)
                .into_iter()
                .filter(|(passes_on, _)| *passes_on)
            {
                for (path, name) in expand(tree, &[]) {
                    let path = source.absolute(&path, &|path| modules.contains(path));
                    source.exports.extend(path.map(|path| (name, path)));
                }
            }
        }
        sources
    }

    fn read(&mut self, path: &Path, module: ModulePath) {
        let text = fs::read_to_string(path).unwrap();
        let code = production(&text);
        let declared = code.lines().filter_map(|line| {
            let (before, name) = line.trim().strip_suffix(';')?.split_once("mod ")?;
            (before.is_empty() || before.starts_with("pub")).then(|| name.to_owned())
        });
        for child in declared.collect::<Vec<_>>() {
            let folder = if module.is_empty() {
                path.with_file_name("")
            } else {
                path.with_extension("")
            };
            let file = folder.join(&child).with_extension("rs");
            self.read(&file, module.iter().cloned().chain([child]).collect());
        }
        let source = Source {
            path: path.to_owned(),
            module: module.clone(),
            code,
            exports: BTreeMap::new(),
        };
        self.0.insert(module, source);
    }

    /// The module of the file in which a path ends, re-exports followed.
    fn file_of(&self, mut path: ModulePath) -> ModulePath {
        for _ in 0..8 {
            let mut length = path.len();
            while !self.0.contains_key(&path[..length]) {
                length -= 1;
            }
            let name = path.get(length);
            match name.and_then(|name| self.0[&path[..length]].exports.get(name)) {
                Some(export) if **export != path[..=length] => {
                    path = export.iter().chain(&path[length + 1..]).cloned().collect();
                }
                _ => return path[..length].to_vec(),
            }
        }
        panic!("re-exports in a circle: {path:?}");
    }

    /// The files that each file names.
    pub fn arrows(&self) -> Arrows {
        let of = |source: &Source| {
            let absolute =
                |path: &ModulePath| source.absolute(path, &|path| self.0.contains_key(path));
            let named = source.named();
            let named = named
                .iter()
                .filter_map(absolute)
                .map(|path| self.file_of(path));
            named
                .filter(|other| *other != source.module && !other.is_empty())
                .collect()
        };
        self.0
            .values()
            .map(|source| (source.module.clone(), of(source)))
            .collect()
    }
}

/// The functions of a code with their numbers of lines.
pub fn functions(code: &str) -> Vec<(&str, usize)> {
    let lines: Vec<&str> = code.lines().collect();
    let of = |(at, line): (usize, &&'_ str)| -> Option<(usize, usize)> {
        let head = line.trim_start();
        let name = head
            .find("fn ")
            .filter(|at| *at == 0 || head[..*at].ends_with(' '))?;
        let plain = head[..name]
            .chars()
            .all(|c| c.is_alphanumeric() || " ()_:\"".contains(c));
        let end = format!("{}}}", &line[..line.len() - head.len()]);
        let length = lines[at..].iter().position(|line| *line == end)?;
        let complete = lines[at..=at + length]
            .iter()
            .any(|line| line.ends_with('{'));
        (plain && complete).then_some((at, length + 1))
    };
    let result = lines.iter().enumerate().filter_map(of);
    result
        .map(|(at, length)| (lines[at].trim(), length))
        .collect()
}
