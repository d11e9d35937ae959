//! Palettes and categories that leave something out, or show it alike.

use super::*;

fn table(categories: usize, name: impl Fn(usize) -> String) -> String {
    let rows = (0..categories).map(|row| format!("{row},0,0,{}\n", name(row)));
    String::from("x,y,z,chain\n") + &rows.collect::<String>()
}

#[test]
fn palettes_that_match_nothing_are_told() {
    let chains = table(2, |row| ["first", "second"][row].to_owned());
    let told = |fields: &str| {
        warnings(&scene(
            "a.csv",
            &chains,
            &format!("radius: 1, value: \"chain\", {fields}"),
        ))
    };
    assert_eq!(
        told("palette: {\"fist\": 1, \"second\": 0}"),
        "scene.ron:2:62: `palette` has colors for \"fist\", which match no row of \"chain\": its categories \
         are \"first\" and \"second\", did you mean \"first\"?"
    );
    assert_eq!(told("palette: {\"first\": 1, \"second\": 0}"), "");
    assert_eq!(told("palette: {\"first\": 1}"), "");
    let of_elements = warnings(&scene(
        "a.xyz",
        "1\n\nO 0 0 0\n",
        "palette: {\"o\": 1, \"Zn\": 0}",
    ));
    assert!(
        of_elements.contains("\"Zn\", which match no row of \"element\""),
        "{of_elements}"
    );
}

#[test]
fn categories_that_share_colors_are_told() {
    let told = |categories: usize, fields: &str| {
        let chains = table(categories, |row| {
            format!("chain {}", (b'A' + row as u8) as char)
        });
        warnings(&scene(
            "a.csv",
            chains,
            &format!("radius: 1, value: \"chain\"{fields}"),
        ))
    };
    assert_eq!(told(12, ""), "");
    assert_eq!(
        told(14, ""),
        "scene.ron:2:17: \"chain\" has 14 categories and 12 colors: 4 of them share colors (use `palette` to give \
         each its own color)"
    );
    // The palette may have two alike, as whoever wrote it wants.
    assert_eq!(told(2, ", palette: {\"chain A\": 1, \"chain B\": 1}"), "");
}

#[test]
fn numbers_by_the_thousand_are_no_categories() {
    let dates = table(30, |row| format!("2020-06-{:02}", row + 1));
    let told = warnings(&scene(
        "a.csv",
        &dates,
        "radius: 1, value: \"chain\", color: Category",
    ));
    assert!(
        told.contains("30 categories and 12 colors") && told.contains("`color: Value`"),
        "{told}"
    );
    let times = table(2000, |row| format!("{}", 1.5 * row as f64));
    let told = warnings(&scene(
        "a.csv",
        &times,
        "radius: 1, value: \"chain\", color: Category",
    ));
    assert!(
        told.contains("2000 categories and 12 colors: 2000 of them share colors"),
        "{told}"
    );
    assert!(told.contains("`color: Value`"), "{told}");
}

/// A palette is one of elements where nothing else is named.
#[test]
fn palettes_choose_categories_or_elements() {
    let csv = "x,y,z,element,value\n0,0,0,O,a\n0,0,0,H,b\n";
    let by_value = scene("a.csv", csv, "radius: 1, palette: {\"a\": 0.5}");
    assert_eq!(albedos(&by_value)[0], DVec3::splat(0.5));
    let by_element = scene(
        "a.csv",
        csv.replace("value", "other"),
        "radius: 1, palette: {\"O\": 0.5}",
    );
    assert_eq!(albedos(&by_element), [DVec3::splat(0.5), Color::ONE]);
    let both = scene(
        "a.csv",
        csv,
        "radius: 1, color: Element, palette: {\"O\": 0.5}",
    );
    assert_eq!(albedos(&both), [DVec3::splat(0.5), Color::ONE]);
}
