//! Progress bars, on terminals that support them.

use std::fmt::Write;

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use super::console::Console;
use crate::base::numbers;

/// A line that is cut at the edge of the terminal.
const LINE: &str = "{wide_msg}";

/// Two columns at the end of the line, and the way back. Terminals print `^C` there; otherwise it would begin another
/// line, and the bar would not be erased.
const ROOM: &str = "  \x1b[2D";

/// Shades of the bar, from full to empty.
const SHADES: &str = "█▉▊▋▌▍▎▏ ";

/// A bar; `None` if messages do not go to a terminal, or go to one that cannot return to the start of a line.
pub(crate) fn bar(console: &Console) -> Option<ProgressBar> {
    let bar = console.is_interactive().then(|| ProgressBar::new(0))?;
    (!bar.is_hidden()).then_some(bar)
}

/// Shows a line in place of the bar.
pub(crate) fn show_line(bar: &ProgressBar, line: String) {
    if let Ok(style) = ProgressStyle::with_template(LINE) {
        bar.set_style(style);
    }
    bar.set_message(line);
    bar.tick();
}

/// A bar that counts pixels, after an optional message.
pub(crate) fn style(has_message: bool) -> ProgressStyle {
    let message = if has_message { "{msg} " } else { "" };
    let template = format!("{message}{{wide_bar}} {{percent:>3}}% of {{total}}{{left}}{ROOM}");
    ProgressStyle::with_template(&template)
        // Without its template the bar is plainer, no reason to stop.
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars(SHADES)
        .with_key("total", |state: &ProgressState, text: &mut dyn Write| {
            // Writing into a string cannot fail.
            let _ = text.write_str(&numbers::pixels(state.len().unwrap_or(0)));
        })
        .with_key("left", |state: &ProgressState, text: &mut dyn Write| {
            if state.pos() > 0 {
                let _ = write!(text, ", {} left", numbers::wait(state.eta()));
            }
        })
}
