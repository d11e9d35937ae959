//! The contents of columns, where nothing else of a table is wanted.

use super::categories::Categories;

/// The most columns whose contents are looked at.
pub(crate) const MOST: usize = u64::BITS as usize;

/// The contents of a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Contents {
    /// All are finite numbers, or missing.
    Numbers(Numbers),
    /// Something else was found in a column in which numbers were looked for.
    NoNumbers,
    /// The different texts.
    Texts(Categories),
    /// Neither, or too many texts.
    Other,
}

/// What the numbers of a column are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Numbers {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) missing: u64,
    /// Some are written as times, and stand for seconds.
    pub(crate) are_times: bool,
}

impl Numbers {
    const NONE: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
        missing: 0,
        are_times: false,
    };
}

impl Contents {
    /// Of so many columns; those whose bit is set in `texts` have texts.
    pub(crate) fn of_columns(count: usize, texts: u64) -> Vec<Self> {
        let of = |column| match texts >> column & 1 {
            0 => Self::Numbers(Numbers::NONE),
            _ => Self::Texts(Categories::default()),
        };
        (0..count.min(MOST)).map(of).collect()
    }

    /// Adds a number, which is NaN where it is missing, or `None` where there is none.
    #[inline(always)]
    pub(crate) fn add_number(&mut self, number: Option<f64>) {
        let Self::Numbers(all) = self else {
            return;
        };
        match number {
            Some(number) if number.is_finite() => {
                all.low = all.low.min(number);
                all.high = all.high.max(number);
            }
            Some(number) if number.is_nan() => all.missing += 1,
            _ => *self = Self::NoNumbers,
        }
    }

    /// Adds a text.
    pub(crate) fn add_text(&mut self, text: &[u8]) {
        if let Self::Texts(texts) = self
            && texts.index(text).is_none()
        {
            *self = Self::Other;
        }
    }

    /// Adds those of rows that follow.
    pub(crate) fn append(&mut self, others: Self) {
        match (&mut *self, others) {
            (Self::Numbers(own), Self::Numbers(others)) => {
                own.low = own.low.min(others.low);
                own.high = own.high.max(others.high);
                own.missing += others.missing;
                own.are_times |= others.are_times;
            }
            (Self::Texts(own), Self::Texts(others)) => {
                if own.append(others) {
                    *self = Self::Other;
                }
            }
            (Self::NoNumbers | Self::Other, _) => {}
            (_, others) => *self = others,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(texts: u64, rows: &[&str]) -> Contents {
        let mut contents = Contents::of_columns(1, texts).remove(0);
        for row in rows {
            match texts {
                0 => contents.add_number(row.parse().ok()),
                _ => contents.add_text(row.as_bytes()),
            }
        }
        contents
    }

    #[test]
    fn parts_have_the_contents_of_the_whole() {
        let columns: [&[&str]; 5] = [
            &["3", "NaN", "-2.5", "7"],
            &["NaN", "NaN", "NaN"],
            &["1", "x", "2"],
            &["1", "inf"],
            &[],
        ];
        for rows in columns {
            for texts in [0, 1] {
                let whole = of(texts, rows);
                for cut in 0..=rows.len() {
                    let mut parts = of(texts, &rows[..cut]);
                    parts.append(of(texts, &rows[cut..]));
                    assert_eq!(parts, whole, "{rows:?} {cut}");
                }
            }
        }
        let Contents::Numbers(numbers) = of(0, columns[0]) else {
            panic!("these are numbers");
        };
        assert_eq!((numbers.low, numbers.high, numbers.missing), (-2.5, 7.0, 1));
        assert_eq!(of(0, columns[2]), Contents::NoNumbers);
        assert_eq!(of(0, columns[3]), Contents::NoNumbers);
        let Contents::Texts(texts) = of(1, columns[2]) else {
            panic!("these are texts");
        };
        assert_eq!(texts.names, ["1", "x", "2"]);
    }

    #[test]
    fn too_many_texts_are_not_told() {
        let mut contents = Contents::of_columns(1, 1).remove(0);
        for text in 0..=Categories::MOST {
            contents.add_text(text.to_string().as_bytes());
        }
        assert_eq!(contents, Contents::Other);
    }
}
