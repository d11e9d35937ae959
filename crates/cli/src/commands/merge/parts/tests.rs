use super::*;

fn parts(windows: &[[u32; 4]]) -> Vec<Part> {
    let part = |&[col, row, width, height]: &[u32; 4]| Part {
        path: PathBuf::from(format!("{col}-{row}.png")),
        window: Window {
            col,
            row,
            width,
            height,
        },
        reader: None,
    };
    windows.iter().map(part).collect()
}

const WHOLE: Size = Size {
    width: 10,
    height: 8,
};

#[test]
fn parts_that_cover_the_picture_once_are_accepted() {
    for windows in [
        &[[0, 0, 10, 8]][..],
        &[[5, 0, 5, 8], [0, 0, 5, 8]],
        // A pinwheel, around one in the middle.
        &[
            [0, 0, 7, 2],
            [7, 0, 3, 6],
            [3, 6, 7, 2],
            [0, 2, 3, 6],
            [3, 2, 4, 4],
        ],
    ] {
        assert!(check_cover(&parts(windows), WHOLE).is_ok(), "{windows:?}");
    }
}

#[test]
fn gaps_are_found_where_they_begin() {
    for (windows, expected) in [
        (&[[0, 0, 10, 7]][..], (0, 7)),
        (&[[1, 0, 9, 8]], (0, 0)),
        (&[[0, 0, 9, 8]], (9, 0)),
        (
            &[[0, 0, 7, 2], [7, 0, 3, 6], [3, 6, 7, 2], [0, 2, 3, 6]],
            (3, 2),
        ),
        (
            &[
                [0, 0, 7, 2],
                [7, 0, 3, 6],
                [4, 6, 6, 2],
                [0, 2, 3, 6],
                [3, 2, 4, 4],
            ],
            (3, 6),
        ),
    ] {
        assert_eq!(gap(&parts(windows), WHOLE), Some(expected), "{windows:?}");
    }
}

#[test]
fn overlaps_are_refused() {
    for windows in [
        [[0, 0, 10, 8], [0, 0, 10, 8]],
        [[0, 0, 6, 8], [5, 0, 5, 8]],
        [[0, 0, 10, 5], [0, 4, 10, 4]],
        [[0, 0, 10, 8], [3, 3, 1, 1]],
    ] {
        let refusal = check_cover(&parts(&windows), WHOLE).unwrap_err();
        assert!(refusal.to_string().contains(" overlaps "), "{windows:?}");
    }
}
