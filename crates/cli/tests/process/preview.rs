//! Pictures in a terminal, which is simulated by the program `script`.

use std::fs;
use std::io::{Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::folder::{BALL, Folder};
use crate::signals::wait_until;

/// `marbles` in a terminal, and the output so far.
pub(crate) struct Terminal {
    script: Child,
    pub(crate) keyboard: ChildStdin,
    shown: Arc<Mutex<Vec<u8>>>,
    reader: Option<JoinHandle<()>>,
}

impl Terminal {
    /// A terminal of this size; `None` if it is not available.
    pub(crate) fn run(folder: &Folder, size: (u32, u32), arguments: &str) -> Option<Self> {
        Self::run_beside(folder, size, ":", arguments)
    }

    /// The same, after another command.
    pub(crate) fn run_beside(
        folder: &Folder,
        (columns, rows): (u32, u32),
        other: &str,
        arguments: &str,
    ) -> Option<Self> {
        let marbles = folder.marbles(arguments);
        let program = marbles.get_program().to_str().unwrap();
        let size = format!("stty cols {columns} rows {rows}");
        let command = format!("{size} && {{ {{ {other}; }} & exec '{program}' {arguments}; }}");
        let script = Command::new("script")
            .args(["-qec", &command, "/dev/null"])
            .current_dir(&folder.0)
            .env("TERM", "xterm-256color")
            .env_remove("TERM_PROGRAM")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let Ok(mut script) = script else {
            eprintln!("skipped: this test needs the program `script`");
            return None;
        };
        let keyboard = script.stdin.take().unwrap();
        let mut screen = script.stdout.take().unwrap();
        let shown = Arc::new(Mutex::new(Vec::new()));
        let all = Arc::clone(&shown);
        let reader = thread::spawn(move || {
            let mut some = [0; 4096];
            while let Ok(count @ 1..) = screen.read(&mut some) {
                all.lock().unwrap().extend_from_slice(&some[..count]);
            }
        });
        Some(Self {
            script,
            keyboard,
            shown,
            reader: Some(reader),
        })
    }

    /// The complete screens: each ends with these words.
    fn screens(&self) -> Vec<String> {
        let shown = self.shown();
        let mut screens: Vec<String> = shown.split("q quits").map(str::to_owned).collect();
        screens.pop();
        screens
    }

    pub(crate) fn shown(&self) -> String {
        String::from_utf8_lossy(&self.shown.lock().unwrap()).into_owned()
    }

    /// Waits for the end of `marbles`, but not forever; returns the exit code and all output.
    pub(crate) fn end(mut self) -> (Option<i32>, String) {
        /// Ending takes no time, except when other processes use the processors.
        const LIMIT: Duration = Duration::from_secs(60);
        let started = Instant::now();
        let status = loop {
            if let Some(status) = self.script.try_wait().unwrap() {
                break status;
            }
            let is_late = started.elapsed() > LIMIT;
            assert!(!is_late, "it did not end, and showed {:?}", self.shown());
            thread::sleep(Duration::from_millis(5));
        };
        self.reader.take().unwrap().join().unwrap();
        (status.code(), self.shown())
    }
}

/// A failing test leaves no process behind.
impl Drop for Terminal {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.script.kill();
        let _ = self.script.wait();
    }
}

#[test]
fn a_picture_fills_the_terminal() {
    let folder = Folder::new();
    for (size, expected) in [((40, 12), (20, 10)), ((7, 12), (7, 4)), ((1, 1), (1, 1))] {
        let Some(terminal) = Terminal::run(&folder, size, "preview ball.ron --once") else {
            return;
        };
        let (code, shown) = terminal.end();
        assert_eq!(code, Some(0), "{shown}");
        let lines: Vec<usize> = shown
            .lines()
            .map(|line| line.matches('▀').count())
            .filter(|&blocks| blocks > 0)
            .collect();
        assert_eq!(lines, vec![expected.0; expected.1], "{size:?}");
    }
}

#[test]
fn what_is_saved_is_shown() {
    let folder = Folder::new();
    let Some(mut terminal) = Terminal::run(&folder, (60, 20), "preview ball.ron --watch") else {
        return;
    };
    let save = |text: &str| {
        // As editors do that never leave half a file.
        fs::write(folder.path("ball.ron~"), text).unwrap();
        fs::rename(folder.path("ball.ron~"), folder.path("ball.ron")).unwrap();
    };
    wait_until("a picture", || terminal.screens().len() == 1);
    save(&BALL.replace("radius: 300", "radius: -300"));
    wait_until("a message", || terminal.screens().len() == 2);
    save(&BALL.replace("radius: 300", "radius: 350"));
    wait_until("another picture", || terminal.screens().len() == 3);
    fs::write(folder.path("ball.ron"), BALL).unwrap();
    wait_until("the first picture", || terminal.screens().len() == 4);

    let screens = terminal.screens();
    let blocks = |screen: &String| screen.matches('▀').count();
    let counts: Vec<usize> = screens.iter().map(blocks).collect();
    assert_eq!(counts, [38 * 19, 0, 38 * 19, 38 * 19]);
    for part in [
        "ball.ron:6:45:",
        " expected a radius greater than 0, found -300",
    ] {
        assert!(screens[1].contains(part), "{}", screens[1]);
    }
    // What came before the first picture is not part of it.
    let picture = |screen: &String| screen[screen.find("\x1b[H").unwrap()..].to_owned();
    assert_eq!(picture(&screens[0]), picture(&screens[3]));
    assert_ne!(picture(&screens[0]), picture(&screens[2]));

    let (enter, leave) = ("\x1b[?1049h\x1b[?25l", "\x1b[?25h\x1b[?1049l");
    assert!(screens[0].contains(enter));
    terminal.keyboard.write_all(b"\x03").unwrap();
    let (code, shown) = terminal.end();
    assert_eq!(code, Some(130));
    assert!(shown.ends_with(leave), "{shown:?}");
}

#[test]
fn keys_end_the_watch() {
    let folder = Folder::new();
    for key in [b"q".as_slice(), b"\x1b"] {
        let arguments = "preview ball.ron --watch";
        let Some(mut terminal) = Terminal::run(&folder, (60, 20), arguments) else {
            return;
        };
        wait_until("a picture", || terminal.screens().len() == 1);
        // An arrow, whose first byte is that of Esc, and letters without a meaning.
        terminal.keyboard.write_all(b"\x1b[Ax").unwrap();
        fs::write(folder.path("ball.ron"), BALL.replace("300", "301")).unwrap();
        wait_until("another picture", || terminal.screens().len() == 2);
        terminal.keyboard.write_all(key).unwrap();
        let (code, shown) = terminal.end();
        assert_eq!(code, Some(0), "{key:?}");
        assert!(shown.ends_with("\x1b[?25h\x1b[?1049l"), "{shown:?}");
        fs::write(folder.path("ball.ron"), BALL).unwrap();
    }
}

#[test]
fn a_terminal_of_another_size_is_filled_again() {
    let folder = Folder::new();
    let resize = "until [ -e smaller ]; do sleep 0.05; done; stty -F /dev/tty cols 80 rows 10";
    let arguments = "preview ball.ron --watch";
    let Some(mut terminal) = Terminal::run_beside(&folder, (60, 20), resize, arguments) else {
        return;
    };
    wait_until("a picture", || terminal.screens().len() == 1);
    fs::write(folder.path("smaller"), "").unwrap();
    wait_until("a smaller one", || terminal.screens().len() == 2);
    let screens = terminal.screens();
    let blocks: Vec<usize> = screens.iter().map(|s| s.matches('▀').count()).collect();
    assert_eq!(blocks, [38 * 19, 18 * 9]);
    terminal.keyboard.write_all(b"\x03").unwrap();
    assert_eq!(terminal.end().0, Some(130));
}

#[test]
fn tables_are_watched_as_well() {
    const CLOUD: &str = "(
    image: (width: 60, height: 60),
    lens: Fov(40),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    clouds: [(file: \"table.csv\", radius: 1)],
    animation: Keyframes(frames: (1, 2), keys: [(frame: 1, pan: 180), (frame: 2, pan: 0)]),
)
";
    let folder = Folder::new();
    fs::write(folder.path("cloud.ron"), CLOUD).unwrap();
    let save = |row: &str| {
        fs::write(folder.path("table.csv~"), format!("x,y,z\n{row}\n")).unwrap();
        fs::rename(folder.path("table.csv~"), folder.path("table.csv")).unwrap();
    };
    // It is wrong at first, so that nothing is known of the scene but this table.
    save("0,0");
    let arguments = "preview cloud.ron --watch --frame 2";
    let Some(mut terminal) = Terminal::run(&folder, (60, 20), arguments) else {
        return;
    };
    wait_until("a message", || terminal.screens().len() == 1);
    save("0,0,5");
    wait_until("a picture", || terminal.screens().len() == 2);
    save("0,1,5");
    wait_until("another picture", || terminal.screens().len() == 3);
    save("0,0,five");
    wait_until("another message", || terminal.screens().len() == 4);
    let screens = terminal.screens();
    for (index, message) in [(0, "found the end of the line"), (3, "table.csv:2:5:")] {
        assert!(screens[index].contains(message), "{}", screens[index]);
    }
    // Where the camera looks away there is one color.
    let colors = |screen: &String| screen.matches("\x1b[38;2;").count();
    assert!(colors(&screens[1]) > 2 * 19, "{}", screens[1]);
    assert_ne!(screens[1], screens[2]);
    terminal.keyboard.write_all(b"\x03").unwrap();
    assert_eq!(terminal.end().0, Some(130));

    // And where it was right from the start.
    save("0,0,5");
    let terminal = Terminal::run(&folder, (60, 20), arguments).unwrap();
    wait_until("a picture", || terminal.screens().len() == 1);
    save("0,1,5");
    wait_until("another picture", || terminal.screens().len() == 2);
}
