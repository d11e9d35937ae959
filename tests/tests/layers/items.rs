//! The modules, definitions and imports of one Rust file.

use std::collections::BTreeSet;

use super::tokens::{Token, tokens};

/// A module of a file: the file itself or a module inside it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Module {
    /// Its path below the file's own module.
    pub(crate) path: Vec<String>,
    /// The modules in files of their own.
    pub(crate) children: Vec<String>,
    pub(crate) definitions: BTreeSet<String>,
    pub(crate) uses: Vec<Use>,
    /// The paths in the code, and their lines.
    pub(crate) paths: Vec<(Vec<String>, usize)>,
    /// Every word of the code that is not part of an import, a field or a method.
    pub(crate) words: BTreeSet<String>,
}

/// A name from a `use`.
#[derive(Clone, Debug)]
pub(crate) struct Use {
    pub(crate) path: Vec<String>,
    /// The name in this module; `*` for all of them.
    pub(crate) alias: String,
    pub(crate) line: usize,
    pub(crate) is_public: bool,
}

/// The modules of a file, the file's own first.
pub(crate) fn modules(source: &str) -> Vec<Module> {
    let tokens = tokens(source);
    let mut reader = Reader {
        tokens: &tokens,
        modules: vec![Module::default()],
        open: Vec::new(),
    };
    let mut at = 0;
    while at < tokens.len() {
        at = reader.step(at);
    }
    reader.modules
}

struct Reader<'t> {
    tokens: &'t [Token<'t>],
    modules: Vec<Module>,
    /// The open braces: of a module, with its index, or of something else.
    open: Vec<Option<usize>>,
}

impl Reader<'_> {
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text)
    }

    fn before(&self, at: usize) -> &str {
        at.checked_sub(1).map_or("", |at| self.text(at))
    }

    /// The word at `at`, if there is one.
    fn word(&self, at: usize) -> Option<String> {
        let token = self.tokens.get(at).filter(|token| token.is_word())?;
        Some(token.text.to_owned())
    }

    fn module(&mut self) -> &mut Module {
        let index = self.open.iter().rev().find_map(|&module| module);
        &mut self.modules[index.unwrap_or(0)]
    }

    /// Reads the item at `at`; returns its end.
    fn step(&mut self, at: usize) -> usize {
        match self.text(at) {
            "#" => self.attribute(at),
            "mod" => self.module_declaration(at),
            "use" if self.text(at + 1) != "<" => {
                let is_public = self.is_public(at);
                self.use_tree(at + 1, Vec::new(), is_public) + 1
            }
            "{" => {
                self.open.push(None);
                at + 1
            }
            "}" => {
                self.open.pop();
                at + 1
            }
            _ if self.word(at).is_some() => self.path(at),
            _ => at + 1,
        }
    }

    /// Skips an attribute, and the item after it if it is only for tests.
    fn attribute(&self, at: usize) -> usize {
        let start = at + 1 + usize::from(self.text(at + 1) == "!");
        if self.text(start) != "[" {
            return at + 1;
        }
        let end = self.closing(start) + 1;
        let words: Vec<_> = (start..end).map(|at| self.text(at)).collect();
        let is_for_tests = words.get(1) == Some(&"cfg")
            && words.contains(&"test")
            && !words.contains(&"not")
            && !words.contains(&"any");
        if is_for_tests {
            self.item_end(end)
        } else {
            end
        }
    }

    /// The end of the item, field or statement at `at`.
    fn item_end(&self, mut at: usize) -> usize {
        while self.text(at) == "#" {
            at = self.closing(at + 1) + 1;
        }
        let is_field = self.word(at).is_some() && self.text(at + 1) == ":";
        while at < self.tokens.len() {
            match self.text(at) {
                "{" if !is_field => return self.closing(at) + 1,
                "(" | "[" | "{" => at = self.closing(at) + 1,
                ")" | "]" | "}" => return at,
                ";" => return at + 1,
                "," if is_field => return at + 1,
                _ => at += 1,
            }
        }
        at
    }

    /// The bracket that closes the one at `at`.
    fn closing(&self, at: usize) -> usize {
        let mut depth = 0;
        for (index, token) in self.tokens.iter().enumerate().skip(at) {
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return index;
            }
        }
        self.tokens.len()
    }

    fn module_declaration(&mut self, at: usize) -> usize {
        let Some(name) = self.word(at + 1) else {
            return at + 1;
        };
        match self.text(at + 2) {
            ";" => self.module().children.push(name),
            "{" => {
                let mut path = self.module().path.clone();
                path.push(name);
                self.open.push(Some(self.modules.len()));
                let module = Module {
                    path,
                    ..Module::default()
                };
                self.modules.push(module);
            }
            _ => return at + 1,
        }
        at + 3
    }

    /// Whether `pub` or `pub(…)` stands before `at`.
    fn is_public(&self, at: usize) -> bool {
        let open = (0..at).rev().find(|&at| self.text(at) == "(");
        let is_limited = || open.is_some_and(|open| self.before(open) == "pub");
        self.before(at) == "pub" || self.before(at) == ")" && is_limited()
    }

    /// Reads a part of a `use` declaration; returns its end.
    fn use_tree(&mut self, mut at: usize, mut path: Vec<String>, is_public: bool) -> usize {
        let line = self.tokens.get(at).map_or(0, |token| token.line);
        loop {
            match self.text(at) {
                "{" => {
                    let end = self.closing(at);
                    at += 1;
                    while at < end {
                        at = self.use_tree(at, path.clone(), is_public);
                        at += usize::from(self.text(at) == ",");
                    }
                    return end + 1;
                }
                "::" => at += 1,
                "self" if !path.is_empty() => at += 1,
                "*" => {
                    self.add_use(path, "*".to_owned(), line, is_public);
                    return at + 1;
                }
                "as" => {
                    let alias = self.word(at + 1).unwrap_or_default();
                    self.add_use(path, alias, line, is_public);
                    return at + 2;
                }
                _ => match self.word(at) {
                    Some(word) => {
                        path.push(word);
                        at += 1;
                    }
                    None => {
                        let alias = path.last().cloned().unwrap_or_default();
                        self.add_use(path, alias, line, is_public);
                        return at;
                    }
                },
            }
        }
    }

    fn add_use(&mut self, path: Vec<String>, alias: String, line: usize, is_public: bool) {
        self.module().uses.push(Use {
            path,
            alias,
            line,
            is_public,
        });
    }

    /// Reads a word of the code, with the path that it may start or the name that it defines.
    fn path(&mut self, at: usize) -> usize {
        let Token { text, line } = self.tokens[at];
        if matches!(self.before(at), "." | "::") {
            return at + 1;
        }
        let is_in_module = self.open.last().is_none_or(|open| open.is_some());
        let named = at + 1 + usize::from(text == "macro_rules");
        if is_in_module
            && is_definition(text)
            && let Some(name) = self.word(named)
            && !is_definition(&name)
        {
            self.module().definitions.insert(name);
            return named + 1;
        }
        self.module().words.insert(text.to_owned());
        let mut path = vec![text.to_owned()];
        let mut end = at + 1;
        while self.text(end) == "::"
            && let Some(word) = self.word(end + 1)
        {
            path.push(word);
            end += 2;
        }
        if path.len() > 1 {
            self.module().paths.push((path, line));
        }
        end
    }
}

/// Whether the word precedes the name in a definition.
fn is_definition(word: &str) -> bool {
    let words = [
        "fn",
        "struct",
        "enum",
        "union",
        "trait",
        "type",
        "const",
        "static",
        "macro_rules",
    ];
    words.contains(&word)
}
