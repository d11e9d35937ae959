//! Lists of frames in parts, as short texts that `--frames` and range expressions of Open Job
//! Description read alike.

/// The frames as a list that is read back in the same order: `1-20`, `1-9:2`, `17,19,30`.
///
/// Frames that are in increasing order make a list that no two of its ranges overlap in.
pub(super) fn expression(frames: &[i32]) -> String {
    /// Fewer frames are shorter one by one.
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

/// The number of frames from the first on that are as far apart as the first two.
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
