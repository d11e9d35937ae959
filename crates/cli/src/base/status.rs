//! Exit codes of the process.

/// Everything was done, and every pixel met the tolerance.
pub(crate) const SUCCESS: u8 = 0;
/// Something could not be done, or two pictures differ.
pub(crate) const FAILURE: u8 = 1;
/// The command line, the scene file or a picture to read is wrong.
pub(crate) const REFUSED: u8 = 2;
/// Everything is written, and some pixel is over the tolerance.
pub(crate) const OVER_TOLERANCE: u8 = 3;
/// The user interrupted the work: 128 plus the number of the signal, as in shells.
pub(crate) const INTERRUPTED: u8 = 130;

/// The combined exit code of two steps: the more serious one.
pub(crate) fn worse(one: u8, other: u8) -> u8 {
    let rank = |code: u8| match code {
        SUCCESS => 0,
        OVER_TOLERANCE => 1,
        FAILURE => 2,
        REFUSED => 3,
        _ => 4,
    };
    if rank(one) < rank(other) { other } else { one }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_written_is_worse_than_what_is_not_known() {
        let codes = [SUCCESS, OVER_TOLERANCE, FAILURE, REFUSED, INTERRUPTED];
        for pair in codes.windows(2) {
            assert_eq!(worse(pair[0], pair[1]), pair[1]);
            assert_eq!(worse(pair[1], pair[0]), pair[1]);
        }
    }
}
