//! The terminal that shows pictures: its abilities and its size.

use std::env;
use std::io;

use console::Term;

use super::picture::Picture;
use super::{blocks, kitty, sixel};
use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::terminal::console::Console;
use crate::terminal::keyboard::Keyboard;

/// Columns and rows of text if the output is not a terminal.
const PLAIN: (u32, u32) = (80, 24);
/// The largest number of columns or rows. Larger pictures would take too long.
const MOST_CELLS: u32 = 1000;
/// The same limit in pixels.
const MOST_PIXELS: u32 = 8192;
/// The same limit for sixels, of which xterm shows no more.
const MOST_SIXELS: u32 = 1000;

/// Asks the terminal for its attributes, which the answer lists up to its last byte.
const ASK_ATTRIBUTES: &str = "\x1b[c";
const END_OF_ATTRIBUTES: u8 = b'c';
/// The attribute of terminals that show sixels.
const SIXELS: &[u8] = b"4";

const HOME: &str = "\x1b[H";
const CLEAR: &str = "\x1b[H\x1b[2J";
const CLEAR_BELOW: &str = "\x1b[J";

/// The screen on which pictures are shown.
pub(super) struct Screen {
    pub(super) is_terminal: bool,
    graphics: Graphics,
}

/// The way in which pictures are shown.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Graphics {
    /// Half blocks.
    Blocks,
    /// Kitty's graphics protocol.
    Kitty,
    Sixel,
}

/// Room for a picture, in pixels.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Area {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Whether smaller pictures are enlarged to fill the area.
    pub(super) enlarges: bool,
}

impl Screen {
    /// The screen of stdout.
    ///
    /// # Errors
    /// Refuses terminals that can only print characters.
    pub(super) fn of(console: &Console) -> Result<Self, Failure> {
        let is_terminal = console.shows_results();
        let terminal = |name| env::var(name).unwrap_or_default();
        let (term, program) = (terminal("TERM"), terminal("TERM_PROGRAM"));
        if is_terminal && term == "dumb" {
            return Err(Failure::Work(
                "this terminal cannot show pictures: TERM is `dumb`".to_owned(),
            ));
        }
        let graphics = if !is_terminal || term == PLAIN_TERM || cell_pixels().is_none() {
            Graphics::Blocks
        } else if speaks_kitty(&term, &program) {
            Graphics::Kitty
        } else if has_sixels(&Keyboard::ask(ASK_ATTRIBUTES, END_OF_ATTRIBUTES)) {
            Graphics::Sixel
        } else {
            Graphics::Blocks
        };
        Ok(Self {
            is_terminal,
            graphics,
        })
    }

    /// Columns and rows.
    pub(super) fn cells(&self) -> (u32, u32) {
        let size = Term::stdout().size_checked().filter(|_| self.is_terminal);
        let (columns, rows) = size.map_or(PLAIN, |(rows, cols)| (cols.into(), rows.into()));
        (columns.clamp(1, MOST_CELLS), rows.clamp(1, MOST_CELLS))
    }

    /// The area for a picture if this many lines of a terminal stay free.
    pub(super) fn area(&self, free_lines: u32) -> Area {
        let (columns, rows) = self.cells();
        let free_lines = if self.is_terminal { free_lines } else { 0 };
        let rows = rows.saturating_sub(free_lines).max(1);
        let most = match self.graphics {
            Graphics::Blocks => None,
            Graphics::Kitty => Some(MOST_PIXELS),
            Graphics::Sixel => Some(MOST_SIXELS),
        };
        if let (Some(most), Some((width, height))) = (most, cell_pixels()) {
            return Area {
                width: (columns * width).min(most),
                height: (rows * height).min(most),
                enlarges: false,
            };
        }
        Area {
            width: columns,
            height: 2 * rows,
            enlarges: true,
        }
    }

    /// The text that shows the picture at the cursor, and moves the cursor below it.
    pub(super) fn show(&self, picture: &Picture) -> Result<String, Failure> {
        match self.graphics {
            Graphics::Blocks => Ok(blocks::text(picture, "\n")),
            Graphics::Kitty => kitty::text(picture),
            Graphics::Sixel => Ok(sixel::text(picture)),
        }
    }

    /// The text that clears the screen and shows the picture.
    pub(super) fn replace(&self, picture: &Picture) -> Result<String, Failure> {
        match self.graphics {
            Graphics::Blocks => self.follow(picture),
            Graphics::Kitty | Graphics::Sixel => Ok(format!("{CLEAR}{}", self.show(picture)?)),
        }
    }

    /// The text that shows the picture in place of one of the same size.
    pub(super) fn follow(&self, picture: &Picture) -> Result<String, Failure> {
        // Over what is there, so that nothing flickers.
        match self.graphics {
            Graphics::Blocks => {
                let picture = blocks::text(picture, "\x1b[K\n");
                Ok(format!("{HOME}{picture}{CLEAR_BELOW}"))
            }
            Graphics::Kitty | Graphics::Sixel => Ok(format!("{HOME}{}", self.show(picture)?)),
        }
    }

    /// The text that clears the screen.
    pub(super) fn clear(&self) -> String {
        let delete = (self.graphics == Graphics::Kitty).then(kitty::delete);
        format!("{}{CLEAR}", delete.unwrap_or_default())
    }

    /// A text on the last line, cut at the end of the line.
    pub(super) fn last_line(&self, text: &str) -> String {
        let (columns, rows) = self.cells();
        let text = console::truncate_str(text, columns as usize, "…");
        format!("\x1b[{rows};1H{text}\x1b[K")
    }
}

impl Area {
    /// The largest size that fits into the area with the proportions of `size`.
    pub(super) fn fit(&self, size: Size) -> Size {
        let (width, height) = (f64::from(size.width), f64::from(size.height));
        let scale = (f64::from(self.width) / width).min(f64::from(self.height) / height);
        let scale = if self.enlarges { scale } else { scale.min(1.0) };
        let side = |length: f64, most: u32| ((length * scale).round() as u32).clamp(1, most);
        Size {
            width: side(width, self.width),
            height: side(height, self.height),
        }
    }
}

/// The name of a terminal with which users choose half blocks.
const PLAIN_TERM: &str = "xterm";

/// Returns whether a terminal with these attributes shows sixels. Its class comes before them.
fn has_sixels(attributes: &[u8]) -> bool {
    let mut attributes = attributes
        .strip_suffix(b"c")
        .unwrap_or_default()
        .split(|&byte| byte == b';');
    attributes.any(|attribute| attribute == SIXELS)
}

/// Returns whether a terminal supports kitty's graphics protocol, according to `TERM` and `TERM_PROGRAM`. Multiplexers
/// like tmux set names of their own.
fn speaks_kitty(term: &str, program: &str) -> bool {
    let between = ["screen", "tmux"].iter().any(|name| term.starts_with(name));
    let terms = ["xterm-kitty", "xterm-ghostty"];
    let programs = ["WezTerm", "ghostty"];
    !between && term != PLAIN_TERM && (terms.contains(&term) || programs.contains(&program))
}

/// The size of a character cell in pixels, if the terminal reports it.
#[cfg(unix)]
fn cell_pixels() -> Option<(u32, u32)> {
    let size = rustix::termios::tcgetwinsize(io::stdout()).ok()?;
    let side = |pixels: u16, cells: u16| {
        let pixels = u32::from(pixels).checked_div(cells.into())?;
        (pixels > 0).then_some(pixels)
    };
    Some((
        side(size.ws_xpixel, size.ws_col)?,
        side(size.ws_ypixel, size.ws_row)?,
    ))
}

/// On other systems terminals do not report it.
#[cfg(not(unix))]
fn cell_pixels() -> Option<(u32, u32)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminals_are_known_by_their_names() {
        for (term, program, expected) in [
            ("xterm-kitty", "", true),
            ("xterm-256color", "WezTerm", true),
            ("xterm-ghostty", "ghostty", true),
            ("xterm-256color", "Apple_Terminal", false),
            ("xterm", "WezTerm", false),
            ("tmux-256color", "tmux", false),
            ("screen.xterm-256color", "WezTerm", false),
            ("", "", false),
        ] {
            assert_eq!(speaks_kitty(term, program), expected, "{term} {program}");
        }
    }

    /// The answers of xterm -ti vt340, foot, VS Code with images, and tmux with and without them.
    #[test]
    fn terminals_say_whether_they_have_sixels() {
        for (answer, expected) in [
            (&b"\x1b[?63;1;2;4;6;9;15;16;22;28c"[..], true),
            (b"\x1b[?62;4;22;28c", true),
            (b"\x1b[?62;4;9;22c", true),
            (b"\x1b[?1;2;4c", true),
            (b"\x1b[?1;2c", false),
            (b"\x1b[?64;1;2;14;24c", false),
            (b"\x1b[?62;4", false),
            (b"", false),
        ] {
            assert_eq!(has_sixels(answer), expected, "{}", answer.escape_ascii());
        }
    }
}
