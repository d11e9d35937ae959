use super::*;

fn frames(text: &str) -> Vec<i32> {
    let list: FrameList = text.parse().unwrap();
    let frames: Vec<i32> = list.iter().collect();
    assert_eq!(list.count(), frames.len() as u64, "{text}");
    frames
}

fn refusal(text: &str) -> String {
    text.parse::<FrameList>().unwrap_err()
}

#[test]
fn lists_are_read() {
    assert_eq!(frames("7"), [7]);
    assert_eq!(frames("1-4"), [1, 2, 3, 4]);
    assert_eq!(frames("1-6x2"), [1, 3, 5]);
    assert_eq!(frames("1-7:3"), [1, 4, 7]);
    assert_eq!(frames("9-15:2"), [9, 11, 13, 15]);
    assert_eq!(frames("17, 19,30"), [17, 19, 30]);
    assert_eq!(frames("3-3x5"), [3]);
    assert_eq!(frames("007"), [7]);
}

#[test]
fn negative_frames_are_read() {
    assert_eq!(frames("-5"), [-5]);
    assert_eq!(frames("-2-1"), [-2, -1, 0, 1]);
    assert_eq!(frames("-10--8"), [-10, -9, -8]);
    assert_eq!(frames("-4-4x4"), [-4, 0, 4]);
}

#[test]
fn range_expressions_of_open_job_description_are_read() {
    // What its model 0.13 makes of each.
    assert_eq!(frames("1-3,7,9-15:2"), [1, 2, 3, 7, 9, 11, 13, 15]);
    assert_eq!(frames("1,2,4-8:2"), [1, 2, 4, 6, 8]);
    assert_eq!(frames("-5--1:2,0-2"), [-5, -3, -1, 0, 1, 2]);
    assert_eq!(frames("-5-5:5"), [-5, 0, 5]);
    assert_eq!(frames("1-10:20"), [1]);
    assert_eq!(frames("10-1:-3"), [10, 7, 4, 1]);
    assert_eq!(frames("-1--8:-3"), [-1, -4, -7]);
    assert_eq!(frames("5-5:-1"), [5]);
    assert_eq!(frames(" 1 - 5 : 2 ,\t7 "), [1, 3, 5, 7]);
}

#[test]
fn order_is_kept_and_a_frame_comes_once() {
    assert_eq!(frames("9-1x-2,1-5"), [9, 7, 5, 3, 1, 2, 4]);
    assert_eq!(frames("5,1-6x2,2-5,5,0"), [5, 1, 3, 2, 4, 0]);
    assert_eq!(frames("1-3,2-4,3-9x2,1-9x4").len(), 7);
}

#[test]
fn frames_are_listed_as_users_write_them() {
    assert_eq!(listed(&[5]), "5");
    assert_eq!(listed(&[4, -2, 9, 3, -1, 5, 4]), "-2--1,3-5,9");
    let frames = FrameList::from_str(&listed(&[-3, -2, 7, 8, 9])).unwrap();
    assert_eq!(frames.iter().collect::<Vec<_>>(), [-3, -2, 7, 8, 9]);
    let odd: Vec<i32> = (0..1000).map(|index| 2 * index + 1).collect();
    assert!(listed(&odd).ends_with(",37,39 and 980 more"));
}

#[test]
fn extremes_are_lazy() {
    let list = FrameList::from(i32::MIN..=i32::MAX);
    assert_eq!(list.count(), 1 << 32);
    let ends = "-2147483648-2147483647x4294967295";
    assert_eq!(frames(ends), [i32::MIN, i32::MAX]);
}

#[test]
fn long_lists_are_counted_or_refused_at_once() {
    let overlapping = |least: i32, most: i32| {
        let item = |step| format!("{least}-{most}x{step}");
        let items: Vec<String> = (2..300).map(item).collect();
        items.join(",")
    };
    let refused = refusal(&overlapping(-2_000_000_000, 2_000_000_000));
    let expected = "expected a list of at most 10000000 frames, found ";
    assert!(refused.starts_with(expected), "{refused}");

    let list: FrameList = overlapping(-900_000, 900_000).parse().unwrap();
    assert!((1_000_000..1_800_001).contains(&list.count()));
    assert_eq!(
        refusal("5,1-10000000"),
        format!("{expected}{}", MOST_FRAMES + 1)
    );
}

#[test]
fn refuses_with_what_was_expected() {
    assert!(refusal("").ends_with("found nothing"));
    assert!(refusal("1,,2").ends_with("found nothing"));
    assert!(refusal("1,").ends_with("found nothing"));
    for step in [
        "0",
        "-0",
        "4294967296",
        "-4294967296",
        "99999999999999999999",
    ] {
        let expected = "expected a step from 1 to 4294967295, or from -4294967295 to -1";
        assert_eq!(
            refusal(&format!("1-5x{step}")),
            format!("{expected}, found {step}")
        );
    }
    assert_eq!(
        refusal("1-5:-2"),
        "expected the larger frame first, because the step is negative, from 5 to 1, found `1-5`"
    );
    assert_eq!(
        refusal("1--3"),
        "expected the smaller frame first, from -3 to 1, found `1--3`"
    );
    assert_eq!(
        refusal("2147483648"),
        "expected frame numbers from -2147483648 to 2147483647, found 2147483648"
    );
    for text in [
        "a", "1-", "-", "--5", "1-5x", "1-5y2", "1x2", "1-5x2x2", "1 5", "- 5", "+3", "1.5",
        "1-5 2", "1-5:", "1-5::2",
    ] {
        assert!(
            refusal(text).contains(&format!("found `{text}`")),
            "{}",
            refusal(text)
        );
    }
}
