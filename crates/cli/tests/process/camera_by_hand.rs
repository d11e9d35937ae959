//! A preview whose camera is moved by keys, in a terminal that is simulated by the program `script`.

use std::fs;
use std::io::Write;

use crate::folder::Folder;
use crate::preview::Terminal;
use crate::signals::wait_until;

const SCENE: &str = "( // three balls
    image: (width: 60, height: 40),
    lens: Fov(40), background: 0.5,
    camera: Frame(elevation: 10.0 /* up */), // from above
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 0), radius: 1), (center: (3, 0, 1), radius: 0.5), (center: (1, 2, 0), radius: 0.7)],
)
";
/// The value of the camera after `Left` and `Shift` with `Up`.
const TURNED: (&str, &str) = ("10.0 /* up */", "11 /* up */, azimuth: 5");

const LEFT: &[u8] = b"\x1b[D";
const SHIFT_UP: &[u8] = b"\x1b[1;2A";
const HOME: &[u8] = b"\x1b[H";
/// The sequence at the end of a session.
const LEAVE: &str = "\x1b[?25h\x1b[?1049l";

/// The pictures that were shown, each in place of the one before.
fn pictures(terminal: &Terminal) -> Vec<String> {
    let shown = terminal.shown();
    let screens = shown.split("\x1b[H");
    let pictures = screens.filter_map(|screen| Some(screen.split_once("\x1b[J")?.0.to_owned()));
    pictures.collect()
}

fn press(terminal: &mut Terminal, key: &[u8]) {
    terminal.keyboard.write_all(key).unwrap();
}

/// Waits for a text on the screen, and forgets nothing.
fn wait_for(terminal: &Terminal, text: &str) {
    wait_until(text, || terminal.shown().contains(text));
}

/// Waits until the last picture is this one.
fn wait_for_picture(terminal: &Terminal, picture: &str) {
    let is_last = || {
        pictures(terminal)
            .last()
            .is_some_and(|last| last == picture)
    };
    wait_until("a picture", is_last);
}

/// The best picture of a scene, which follows the quick one.
fn best(folder: &Folder, scene: &str) -> Option<String> {
    let mut terminal = Terminal::run(folder, (60, 20), &format!("preview {scene}"))?;
    wait_until("the best picture", || pictures(&terminal).len() == 2);
    let picture = pictures(&terminal).pop();
    press(&mut terminal, b"q");
    assert_eq!(terminal.end().0, Some(0));
    picture
}

#[test]
fn an_angle_is_found_and_written() {
    let folder = Folder::new();
    let written = SCENE.replace(TURNED.0, TURNED.1);
    fs::write(folder.path("a.ron"), SCENE).unwrap();
    fs::write(folder.path("turned.ron"), &written).unwrap();
    let Some(turned) = best(&folder, "turned.ron") else {
        return;
    };
    let unturned = best(&folder, "a.ron").unwrap();
    assert_ne!(unturned, turned);

    let mut terminal = Terminal::run(&folder, (60, 20), "preview a.ron").unwrap();
    wait_for_picture(&terminal, &unturned);
    press(&mut terminal, LEFT);
    press(&mut terminal, SHIFT_UP);
    wait_for_picture(&terminal, &turned);
    press(&mut terminal, HOME);
    wait_for_picture(&terminal, &unturned);
    assert_eq!(fs::read_to_string(folder.path("a.ron")).unwrap(), SCENE);
    press(&mut terminal, &[LEFT, SHIFT_UP].concat());
    wait_for_picture(&terminal, &turned);
    press(&mut terminal, b"w");
    wait_for(&terminal, "a.ron: the camera is written");
    assert_eq!(fs::read_to_string(folder.path("a.ron")).unwrap(), written);
    // Home is now what was written.
    press(&mut terminal, LEFT);
    press(&mut terminal, HOME);
    wait_for_picture(&terminal, &turned);
    press(&mut terminal, b"p");
    let (code, shown) = terminal.end();
    assert_eq!(code, Some(0));
    let (_, after) = shown.rsplit_once(LEAVE).unwrap();
    let line = format!("camera: Frame(elevation: {}),", TURNED.1);
    assert_eq!(after.trim_end(), line);
    assert_eq!(
        folder
            .names("")
            .iter()
            .filter(|name| name.contains("tmp"))
            .count(),
        0
    );
}

#[test]
fn keys_and_signals_end_the_preview() {
    let folder = Folder::new();
    for (key, expected) in [(b"q", 0), (b"\x1b", 0), (b"\x03", 130)] {
        let Some(mut terminal) = Terminal::run(&folder, (60, 20), "preview ball.ron") else {
            return;
        };
        wait_for(&terminal, " q quit");
        press(&mut terminal, key);
        let (code, shown) = terminal.end();
        assert_eq!(code, Some(expected), "{key:?}");
        assert!(shown.ends_with(LEAVE), "{shown:?}");
        assert!(shown.contains("\x1b[?1049h\x1b[?25l"));
    }
}

#[test]
fn a_camera_that_cannot_be_turned_says_why() {
    let folder = Folder::new();
    let keys = "animation: Keyframes(keys: [(frame: 1, azimuth: 3), (frame: 5, azimuth: 9)]),\n)";
    fs::write(
        folder.path("keyed.ron"),
        SCENE.replace("\n)", &format!("\n{keys}")),
    )
    .unwrap();
    let Some(mut terminal) = Terminal::run(&folder, (100, 20), "preview keyed.ron") else {
        return;
    };
    let reason = "it cannot be turned: the keys of the animation move the camera; q quits";
    wait_for(&terminal, reason);
    wait_until("the best picture", || pictures(&terminal).len() == 2);
    let picture = pictures(&terminal).pop();
    press(&mut terminal, &[LEFT, b"w"].concat());
    wait_until("an answer", || terminal.shown().matches(reason).count() > 2);
    assert_eq!(pictures(&terminal).pop(), picture);
    press(&mut terminal, b"p+q");
    assert_eq!(terminal.end().0, Some(0));
    let text = fs::read_to_string(folder.path("keyed.ron")).unwrap();
    assert!(text.contains("10.0 /* up */"));
}

#[test]
fn the_camera_of_a_table_is_printed() {
    let folder = Folder::new();
    fs::write(
        folder.path("water.xyz"),
        "3\n\nO 0 0 0.1\nH 0 0.8 -0.5\nH 0 -0.8 -0.5\n",
    )
    .unwrap();
    let Some(mut terminal) = Terminal::run(&folder, (99, 20), "preview water.xyz") else {
        return;
    };
    wait_for(&terminal, " q quit");
    press(&mut terminal, b"w");
    wait_for(
        &terminal,
        "water.xyz is a table, which has no camera: p prints the one that you see",
    );
    press(&mut terminal, &[LEFT, b"++++p"].concat());
    let (code, shown) = terminal.end();
    assert_eq!(code, Some(0));
    let (_, after) = shown.rsplit_once(LEAVE).unwrap();
    let lines: Vec<&str> = after.lines().collect();
    assert_eq!(lines.len(), 2, "{after:?}");
    assert!(
        lines[0].starts_with("camera: Frame(azimuth: "),
        "{}",
        lines[0]
    );
    assert!(lines[0].ends_with("), zoom: 2,"), "{}", lines[0]);
    // What is printed can be run.
    let command = lines[1].strip_prefix("marbles ").unwrap();
    assert!(command.ends_with(" --set zoom=2"), "{command}");
    let output = folder.run(&format!("{command} --size 30x20 --samples 1"));
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn a_terminal_of_another_size_is_filled_again() {
    let folder = Folder::new();
    let resize = "until [ -e smaller ]; do sleep 0.05; done; stty -F /dev/tty cols 30 rows 10";
    let Some(mut terminal) = Terminal::run_beside(&folder, (60, 20), resize, "preview ball.ron")
    else {
        return;
    };
    let blocks = |terminal: &Terminal| {
        pictures(terminal)
            .last()
            .map(|last| last.matches('▀').count())
    };
    wait_until("a picture", || blocks(&terminal) == Some(38 * 19));
    fs::write(folder.path("smaller"), "").unwrap();
    wait_until("a smaller one", || blocks(&terminal) == Some(18 * 9));
    wait_for(&terminal, "\x1b[10;1Harrows + - r Home w p q\x1b[K");
    press(&mut terminal, b"q");
    assert_eq!(terminal.end().0, Some(0));
}
