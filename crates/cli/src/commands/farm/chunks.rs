//! Lists of frames, divided into chunks and written as short texts. `--frames` and range expressions of Open Job
//! Description read them alike.

/// The frames as a list that is read in the same order: `1-20`, `1-9:2`, `17,19,30`.
///
/// If frames are in increasing order, the ranges of the list do not overlap.
pub(super) fn expression(frames: &[i32]) -> String {
    /// Shorter ranges are written frame by frame.
    const SHORTEST: usize = 3;
    let mut items = Vec::new();
    let mut rest = frames;
    while !rest.is_empty() {
        let run = evenly_spaced(rest);
        let run = if run < SHORTEST { 1 } else { run };
        let (frames, others) = rest.split_at(run);
        rest = others;
        items.push(match frames {
            [frame] => frame.to_string(),
            [first, second, .., last] => match i64::from(*second) - i64::from(*first) {
                1 => format!("{first}-{last}"),
                step => format!("{first}-{last}:{step}"),
            },
            _ => continue,
        });
    }
    items.join(",")
}

/// The number of frames at the start that have the same spacing as the first two.
fn evenly_spaced(frames: &[i32]) -> usize {
    let step = |pair: &[i32]| i64::from(pair[1]) - i64::from(pair[0]);
    let mut steps = frames.windows(2).map(step);
    match steps.next() {
        Some(first) => 2 + steps.take_while(|&step| step == first).count(),
        None => frames.len(),
    }
}

#[cfg(test)]
mod tests;
