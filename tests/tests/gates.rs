//! No code in `exact` compares a tolerance, a claim or light with a constant, except in the places listed below.
//!
//! Goals inside `exact` are multiples of the world's contrast (`model/light_unit.rs`), so that such a comparison does
//! not depend on the brightness of a world. A comparison may affect the cost of a pixel, but never its claim; the list
//! says which cost. The search is textual: it recognizes the names below, comparisons, and methods that choose the
//! smaller or the larger of two numbers. It misses a constant that is first bound to a lower-case name.

use std::path::{Path, PathBuf};

/// Words in the names of quantities that have the unit of light.
const OF_LIGHT: [&str; 7] = [
    "tolerance",
    "contrast",
    "claims",
    "claimed",
    "allowed",
    "lost",
    "brightest",
];

const COMPARISONS: [&str; 6] = ["<", "<=", ">", ">=", "==", "!="];

const METHODS: [&str; 9] = [
    ".max",
    ".min",
    ".clamp",
    ".simd_lt",
    ".simd_le",
    ".simd_gt",
    ".simd_ge",
    ".total_cmp",
    ".partial_cmp",
];

/// The file, the comparison, and its effect.
const GATES: [[&str; 3]; 14] = [
    [
        "context.rs",
        "contrast.max ( LEAST )",
        "cost: how well mean normals are known",
    ],
    [
        "edged/boundary/kinks.rs",
        "self.tolerance > FINE",
        "cost: looks on a chord",
    ],
    [
        "edged/boxes/mod.rs",
        "tolerance < LOOSE",
        "cost: which crowds boxes try",
    ],
    [
        "edged/boxes/mod.rs",
        "tolerance < LEAST_TOLERANCE",
        "cost: where boxes are tried",
    ],
    [
        "edged/boxes/mod.rs",
        "tolerance < LOOSE",
        "cost: how many boxes",
    ],
    [
        "edged/boxes/mod.rs",
        "tolerance < LOOSEST",
        "cost: which crowds boxes try",
    ],
    [
        "edged/boxes/mod.rs",
        "tolerance < TIGHT",
        "cost: how many boxes",
    ],
    [
        "edged/parts.rs",
        "context.tolerance.max ( LOST )",
        "cost: when samples take over, a share of the contrast",
    ],
    [
        "edged/parts.rs",
        "context.tolerance.max ( LOST_TO_ROUNDING )",
        "cost: the same",
    ],
    ["integrator.rs", "contrast.max ( 1.0 )", "the unit of alpha"],
    [
        "interior/average.rs",
        "self.tolerance >= LOOSE",
        "cost: where one sample is tried",
    ],
    [
        "interior/cell.rs",
        "self.tolerance >= LOOSE",
        "cost: parts before strata",
    ],
    [
        "interior/cell.rs",
        "self.tolerance < FINE",
        "cost: how many parts",
    ],
    [
        "interior/middle.rs",
        "self.tolerance >= LOOSE_ON_BUMPS",
        "cost: where one sample is tried",
    ],
];

/// The names, numbers and operators of a source, without comments and strings.
fn tokens(source: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    for line in source.lines() {
        let code = line.split("//").next().unwrap_or_default();
        let mut rest = code.trim_start();
        while let Some(first) = rest.chars().next() {
            let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
            let length = if is_name(first) {
                rest.find(|c| !is_name(c)).unwrap_or(rest.len())
            } else {
                let two = rest.get(..2).unwrap_or_default();
                let is_pair = [
                    "<=", ">=", "==", "!=", "&&", "||", "->", "=>", "::", "<<", ">>",
                ];
                if is_pair.contains(&two) {
                    2
                } else {
                    first.len_utf8()
                }
            };
            let (token, after) = rest.split_at(length);
            // Methods on lines of their own belong to the name before.
            match tokens.last_mut() {
                Some(last) if token.starts_with('.') && ends_in_name(last) => *last += token,
                _ => tokens.push(token.to_owned()),
            }
            rest = after.trim_start();
        }
    }
    tokens
}

fn ends_in_name(token: &str) -> bool {
    token.ends_with(|c: char| c.is_alphanumeric() || c == '_')
}

/// Whether one side of a comparison consists only of a number or a constant.
fn is_bare(side: &[String]) -> bool {
    let is_constant = |token: &str| {
        let is_upper = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        token.chars().all(is_upper) || token.starts_with(|c: char| c.is_ascii_digit())
    };
    let mut names = side.iter().filter(|token| ends_in_name(token)).peekable();
    names.peek().is_some() && names.all(|token| is_constant(token))
}

fn is_of_light(side: &[String]) -> bool {
    side.iter()
        .any(|token| OF_LIGHT.iter().any(|word| token.contains(word)))
}

/// The comparisons with constants in a source, as operands and operators separated by spaces.
fn gates(source: &str) -> Vec<String> {
    const ENDS: [&str; 17] = [
        "&&", "||", "(", ")", "{", "}", "[", "]", ",", ";", "=", "|", "if", "while", "return",
        "=>", "?",
    ];
    let tokens = tokens(source);
    let is_end = |token: &String| ENDS.contains(&token.as_str());
    let mut found = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        let (before, after) = (&tokens[..index], &tokens[index + 1..]);
        let method = METHODS.iter().any(|method| token.ends_with(method));
        let (left, right) = if COMPARISONS.contains(&token.as_str()) {
            let start = before.iter().rposition(is_end).map_or(0, |end| end + 1);
            let end = after.iter().position(is_end).unwrap_or(after.len());
            (&before[start..], &after[..end])
        } else if method && after.first().is_some_and(|token| token == "(") {
            let end = after.iter().position(|token| token == ")");
            (
                &tokens[index..=index],
                &after[1..end.unwrap_or(after.len())],
            )
        } else {
            continue;
        };
        let is_gate = |one: &[String], other: &[String]| is_of_light(one) && is_bare(other);
        if is_gate(left, right) || is_gate(right, left) {
            let parts = match method {
                true => [
                    left.join(" "),
                    "(".to_owned(),
                    right.join(" "),
                    ")".to_owned(),
                ]
                .join(" "),
                false => [left.join(" "), token.clone(), right.join(" ")].join(" "),
            };
            found.push(parts);
        }
    }
    found
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if !path.ends_with("tests") {
                sources(&path, into);
            }
        } else if path.extension().is_some_and(|ending| ending == "rs")
            && !path.ends_with("tests.rs")
        {
            into.push(path);
        }
    }
}

#[test]
fn only_listed_gates_compare_light_with_numbers() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/core/src/exact");
    let mut paths = Vec::new();
    sources(&folder, &mut paths);
    assert!(paths.len() > 50);
    let mut found = Vec::new();
    for path in paths {
        let name = path
            .strip_prefix(&folder)
            .unwrap()
            .to_str()
            .unwrap()
            .replace('\\', "/");
        let source = std::fs::read_to_string(&path).unwrap();
        found.extend(gates(&source).into_iter().map(|gate| [name.clone(), gate]));
    }
    found.sort();
    let mut listed = GATES
        .map(|[name, gate, _]| [name.to_owned(), gate.to_owned()])
        .to_vec();
    listed.sort();
    assert_eq!(found, listed);
}

#[test]
fn a_gate_is_found_however_it_is_written() {
    for source in [
        "if self.tolerance < 1e-3 {",
        "if 2.0 * context.tolerance >= FINE && is_open {",
        "let is_low = 1e-5 > goal.tolerance;",
        "contrast.max(0.25)",
        "self\n    .contrast\n    .max(LEAST)",
        "light.simd_gt(tolerance); claims.simd_lt(LEAST);",
    ] {
        assert_eq!(gates(source).len(), 1, "{source} {:?}", gates(source));
    }
    for source in [
        "if error <= tolerance {",
        "// tolerance < 1e-3",
        "let shared = tolerance * 0.5;",
        "fn divide(tolerance: f64) -> Vec<f64> {",
        "error > SHARE * goal.tolerance",
    ] {
        assert!(gates(source).is_empty(), "{source} {:?}", gates(source));
    }
}
