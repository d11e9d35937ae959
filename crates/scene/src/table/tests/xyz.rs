//! Atoms, by elements or by properties.

use super::*;

#[test]
fn xyz_is_read() {
    let text = " 2 \r\nwater\nO 1 -2.5 3e-3 0.7 more\n  h\t4  5 6\n2\nthe next frame\nX\n";
    let scene = scene("a.xyz", text, "");
    let [oxygen, hydrogen] = TWO.map(|[x, y, z, _]| [x, y, z]);
    let expected = [
        [oxygen[0], oxygen[1], oxygen[2], 1.52],
        [hydrogen[0], hydrogen[1], hydrogen[2], 1.1],
    ];
    assert_eq!(spheres(&scene), expected);
    assert_eq!(albedos(&scene), [from_srgb(0xff0d0d), Color::ONE]);
    let covalent = self::scene("a.xyz", text, "radii: Covalent");
    assert_eq!(spheres(&covalent)[0][3], 0.66);
    let fixed = self::scene("a.xyz", text, "radius: 3, color: Material");
    assert_eq!(spheres(&fixed)[0][3], 3.0);
    assert_eq!(albedos(&fixed)[0], Color::ONE);
    // What is no element does where none is needed.
    let beads = self::scene("a.xyz", "1\n\nbead 1 2 3\n", "radius: 3, color: Material");
    assert_eq!(spheres(&beads), [[1.0, 2.0, 3.0, 3.0]]);
    assert!(spheres(&self::scene("a.xyz", "0\n\n", "")).is_empty());
}

#[test]
fn a_material_is_the_finish_and_elements_have_their_colors() {
    let folder = Folder::new();
    fs::write(folder.0.join("a.xyz"), "1\n\nO 1 2 3").unwrap();
    for (fields, expected) in [
        ("", 0xff0d0d),
        (", color: Element", 0xff0d0d),
        (", color: Material", 0x102030),
    ] {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), materials: {{\"m\": \
             (albedo: \"#102030\")}}, clouds: [(file: \"a.xyz\", material: \"m\"{fields})])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        assert_eq!(albedos(&scene), [from_srgb(expected)]);
    }
}

#[test]
fn extended_xyz_is_read() {
    let text = "2\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=id:I:1:species:S:1:pos:R:3:force:R:2:\
                radius:R:1:color:R:3 Time=0\n7 A 1 -2.5 3e-3 9 9 0.5 1 0.5 0\n\
                8 B 4 5 6 9 8 7 0 0 1\n";
    let scene = scene("a.xyz", text, "");
    assert_eq!(spheres(&scene), TWO);
    assert_eq!(albedos(&scene), [Color::new(1.0, 0.5, 0.0), Color::Z]);
    let by_force = self::scene("a.extxyz", text, "value: \"force_2\", colormap: Grey");
    assert_eq!(albedos(&by_force), [Color::ONE, Color::ZERO]);
    let elements = "1\nProperties=species:S:1:pos:R:3\nAr 0 0 0\n";
    assert_eq!(spheres(&self::scene("a.xyz", elements, ""))[0][3], 1.88);
}

#[test]
fn xyz_is_refused_at_its_place() {
    for (text, expected) in [
        (
            "",
            "a.xyz:1:1: expected the number of atoms, found the end of the file",
        ),
        (
            "\n",
            "a.xyz:1:1: expected the number of atoms, found the end of the line",
        ),
        (
            " two\n",
            "a.xyz:1:2: expected the number of atoms, found `two`",
        ),
        ("-2\n", "a.xyz:1:1: expected the number of atoms, found -2"),
        (
            "2\n",
            "a.xyz:2:1: expected a comment, found the end of the file",
        ),
        (
            "3\n\nO 1 2 3\nO 1 2 3\n",
            "a.xyz:5:1: expected 3 atoms, according to the first line (2 read), found the end \
             of the file",
        ),
        (
            "18446744073709551615\n\nO 1 2 3\n",
            "a.xyz:4:1: expected 18446744073709551615 atoms, according to the first line (1 read), \
             found the end of the file",
        ),
        (
            "2\n\nO 1 2 3\n\nO 1 2 3\n",
            "a.xyz:4:1: expected an element for `element`, found the end of the line",
        ),
        (
            "1\n\nO 1 2  \n",
            "a.xyz:3:6: expected a number for `z`, found the end of the line",
        ),
        (
            "1\n\nO 1 x 3\n",
            "a.xyz:3:5: expected a number for `y`, found `x`",
        ),
        (
            "1\nProperties=species:S:1:pos:R\n",
            "a.xyz:2:12: expected properties `name:type:columns`, of type S, R, I or L, found `pos:R`",
        ),
        (
            "1\nProperties=species:S:1:pos:R:99999999999\n",
            "a.xyz:2:12: expected properties `name:type:columns`, of type S, R, I or L, found `pos:R:99999999999`",
        ),
        (
            "1\nProperties=species:S:1\n",
            "a.xyz:2:1: expected a column `x`, found `species`",
        ),
        (
            "1\nProperties=species:S:1:pos:R:3\nO 1 2 3 4\n",
            "a.xyz:3:9: expected the end of the line after 4 columns, found 4",
        ),
    ] {
        assert_eq!(refusal("a.xyz", text, ""), expected);
    }
}
