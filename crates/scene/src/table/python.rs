//! Literals of Python, in which NPY files describe themselves.

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Literal {
    Text(String),
    Whole(u64),
    Flag(bool),
    /// A tuple or a list.
    List(Vec<Literal>),
    Dictionary(Vec<(Literal, Literal)>),
}

impl Literal {
    /// The value of a key in a dictionary.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let Self::Dictionary(pairs) = self else {
            return None;
        };
        let is_key = |pair: &&(Self, Self)| matches!(&pair.0, Self::Text(text) if text == key);
        pairs.iter().find(is_key).map(|pair| &pair.1)
    }

    /// Reads a text that is one value; `None` for anything else.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let mut reader = Reader { rest: text };
        let literal = reader.value(0)?;
        reader.skip_space();
        reader.rest.is_empty().then_some(literal)
    }
}

struct Reader<'t> {
    rest: &'t str,
}

impl Reader<'_> {
    fn value(&mut self, depth: usize) -> Option<Literal> {
        const DEEPEST: usize = 16;
        if depth > DEEPEST {
            return None;
        }
        self.skip_space();
        for (start, end) in [('(', ')'), ('[', ']')] {
            if self.take(start) {
                let items = self.items(end, |reader| reader.value(depth + 1));
                return items.map(Literal::List);
            }
        }
        if self.take('{') {
            let pairs = self.items('}', |reader| {
                let key = reader.value(depth + 1)?;
                reader.skip_space();
                let has_value = reader.take(':');
                Some((key, has_value.then(|| reader.value(depth + 1))??))
            });
            return pairs.map(Literal::Dictionary);
        }
        for quote in ['\'', '"'] {
            if self.take(quote) {
                let (text, rest) = self.rest.split_once(quote)?;
                self.rest = rest;
                return (!text.contains('\\')).then(|| Literal::Text(text.to_owned()));
            }
        }
        let is_word = |c: char| c.is_ascii_alphanumeric();
        let end = self.rest.find(|c| !is_word(c)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        match word {
            "True" => Some(Literal::Flag(true)),
            "False" => Some(Literal::Flag(false)),
            // Python 2 wrote long numbers so.
            _ => word.trim_end_matches('L').parse().ok().map(Literal::Whole),
        }
    }

    /// The items up to `end`, each read by `item`, with commas between them.
    fn items<T>(
        &mut self,
        end: char,
        mut item: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<Vec<T>> {
        let mut items = Vec::new();
        loop {
            self.skip_space();
            if self.take(end) {
                return Some(items);
            }
            items.push(item(self)?);
            self.skip_space();
            if !self.take(',') {
                return self.take(end).then_some(items);
            }
        }
    }

    fn skip_space(&mut self) {
        self.rest = self.rest.trim_ascii_start();
    }

    /// Passes over this character, if it comes next; returns whether it does.
    fn take(&mut self, expected: char) -> bool {
        let rest = self.rest.strip_prefix(expected);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }
}

#[cfg(test)]
mod tests;
