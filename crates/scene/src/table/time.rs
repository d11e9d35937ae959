//! Times as texts write them: ISO 8601, in seconds since the start of 1970 in UTC.

/// Seconds of a day.
const DAY: f64 = 86_400.0;
/// The days from the start of the year 1 to that of 1970, and from there to the end of 9999.
const BEFORE_1970: i64 = 719_162;
const UNTIL_10000: i64 = 2_932_896;

/// The time that is all of this text: a date, `2020-02-26`, or one with the time of day, `2020-02-26T20:00:29.166Z`, with a
/// space for the letter T, without seconds, with an offset from UTC, or none.
pub(crate) fn parse(text: &[u8]) -> Option<f64> {
    let text = str::from_utf8(text).ok()?;
    let (date, rest) = text.split_at_checked(10)?;
    let [year, month, day] = parts(date, '-', [4, 2, 2])?;
    let is_date =
        year > 0 && (1..=12).contains(&month) && (1..=days_of(year, month)).contains(&day);
    let days = is_date.then(|| days_before(year, month) + day - 1)? as f64;
    if rest.is_empty() {
        return Some(days * DAY);
    }
    let time = rest.strip_prefix(['T', 't', ' '])?;
    let end = time.find(['Z', 'z', '+', '-']).unwrap_or(time.len());
    let (time, offset) = time.split_at(end);
    let (minutes, seconds) = match time.split_at_checked(5)? {
        (minutes, "") => (minutes, 0.0),
        (minutes, seconds) => (minutes, seconds_of(seconds.strip_prefix(':')?)?),
    };
    let [hour, minute] = parts(minutes, ':', [2, 2])?;
    let of_day =
        (hour < 24 && minute < 60).then_some((60 * hour + minute) as f64 * 60.0 + seconds)?;
    Some(days * DAY + of_day - offset_of(offset)?)
}

/// The numbers of so many digits between separators.
fn parts<const N: usize>(text: &str, separator: char, digits: [usize; N]) -> Option<[i64; N]> {
    let mut numbers = [0; N];
    let mut parts = text.split(separator);
    for (number, digits) in numbers.iter_mut().zip(digits) {
        let part = parts.next().filter(|part| part.len() == digits)?;
        let are_digits = part.bytes().all(|byte| byte.is_ascii_digit());
        *number = are_digits.then(|| part.parse().ok())??;
    }
    parts.next().is_none().then_some(numbers)
}

fn seconds_of(text: &str) -> Option<f64> {
    let whole = text.find('.').unwrap_or(text.len());
    let is_plain = text
        .bytes()
        .all(|byte| byte.is_ascii_digit() || byte == b'.');
    // A second may be inserted at the end of a minute.
    let seconds = (whole == 2 && is_plain).then(|| text.parse::<f64>().ok())??;
    (seconds < 61.0).then_some(seconds)
}

/// The seconds by which local time is ahead of UTC.
fn offset_of(text: &str) -> Option<f64> {
    let (sign, rest) = match text {
        "" | "Z" | "z" => return Some(0.0),
        _ if text.starts_with('+') => (1.0, &text[1..]),
        _ => (-1.0, text.strip_prefix('-')?),
    };
    let [hours, minutes] = match rest.len() {
        2 => [parts(rest, ':', [2])?[0], 0],
        4 => {
            let (hours, minutes) = rest.split_at_checked(2)?;
            [parts(hours, ':', [2])?[0], parts(minutes, ':', [2])?[0]]
        }
        _ => parts(rest, ':', [2, 2])?,
    };
    Some(sign * (60 * hours + minutes) as f64 * 60.0)
}

/// The days from the start of 1970 to that of a month, by the Gregorian calendar.
fn days_before(year: i64, month: i64) -> i64 {
    let before = year - 1;
    let leap_days = before / 4 - before / 100 + before / 400;
    let of_months: i64 = (1..month).map(|month| days_of(year, month)).sum();
    365 * before + leap_days + of_months - BEFORE_1970
}

fn days_of(year: i64, month: i64) -> i64 {
    match month {
        2 if year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// The date of a time in seconds since the start of 1970, and the time of day unless it is midnight, as people write
/// them. Times outside of the years 1 to 9999 are shown as the first or the last of these days.
pub fn written_time(seconds: f64) -> String {
    let days = libm::floor(seconds / DAY);
    let of_day = libm::floor(seconds - days * DAY) as i64;
    let days = (days as i64).clamp(-BEFORE_1970, UNTIL_10000);
    let mut year = 1970 + days / 366;
    while days_before(year + 1, 1) <= days {
        year += 1;
    }
    while days_before(year, 1) > days {
        year -= 1;
    }
    let mut months = (1..=12).rev();
    let month = months.find(|month| days_before(year, *month) <= days);
    let month = month.unwrap_or(1);
    let day = days - days_before(year, month) + 1;
    let date = format!("{year:04}-{month:02}-{day:02}");
    match of_day {
        0 => date,
        _ => format!(
            "{date} {:02}:{:02}:{:02}",
            of_day / 3600,
            of_day / 60 % 60,
            of_day % 60
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_and_written() {
        for (text, seconds, shown) in [
            ("1970-01-01", 0.0, "1970-01-01"),
            ("1970-01-02T00:00:01Z", 86_401.0, "1970-01-02 00:00:01"),
            (
                "2020-02-26T20:00:29.166Z",
                1_582_747_229.166,
                "2020-02-26 20:00:29",
            ),
            ("2000-03-01 12:30", 951_913_800.0, "2000-03-01 12:30:00"),
            (
                "2020-02-29T00:30:00+01:00",
                1_582_932_600.0,
                "2020-02-28 23:30:00",
            ),
            ("1969-12-31T23:59:59-0000", -1.0, "1969-12-31 23:59:59"),
            ("0001-01-01", -719_162.0 * DAY, "0001-01-01"),
            ("9999-12-31", 2_932_896.0 * DAY, "9999-12-31"),
        ] {
            assert_eq!(parse(text.as_bytes()), Some(seconds), "{text}");
            assert_eq!(written_time(seconds), shown, "{text}");
        }
        for text in [
            "",
            "2020",
            "2020-2-2",
            "2021-02-29",
            "2020-13-01",
            "0000-01-01",
            "2020-01-01T25:00",
            "2020-01-01T10:00:61",
            "2020-01-01x",
            "2020-01-01T10",
            "20200101",
            "2020-01-01T10:00+1",
            "\u{e4}\u{e4}\u{e4}\u{e4}\u{e4}-01",
        ] {
            assert_eq!(parse(text.as_bytes()), None, "{text}");
        }
        assert_eq!(
            written_time(f64::INFINITY).len(),
            "9999-12-31 00:00:00".len() - 9
        );
    }
}
