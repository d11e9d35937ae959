use super::*;

#[test]
fn files_are_read_up_to_a_limit() {
    let name = format!("marbles-{}-limit", std::process::id());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, "12345").unwrap();
    let read = |most| read_at_most(&path, most).map_err(|error| error.kind());
    assert_eq!(read(5), Ok(b"12345".to_vec()));
    assert_eq!(read(4), Err(ErrorKind::FileTooLarge));

    // A file of nothing but a size.
    let file = OpenFile::create(&path).unwrap();
    file.set_len(LARGEST_FILE + 1).unwrap();
    let message = Scene::load(&path).unwrap_err().to_string();
    std::fs::remove_file(&path).unwrap();
    assert!(message.ends_with(": expected a scene file of at most 1 GiB, found a larger one"));
}

#[test]
fn what_is_no_text_is_read_up_to_there() {
    let path = std::env::temp_dir().join(format!("marbles-{}-zero", std::process::id()));
    for (bytes, place) in [
        (
            &b"(image\0 more"[..],
            "1:7: expected text, found the byte 0x00",
        ),
        (
            b"(\n\xff\0",
            "2:1: expected text in UTF-8, found the byte 0xff",
        ),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let message = Scene::load(&path).unwrap_err().to_string();
        assert!(message.contains(place), "{message}");
    }
    std::fs::remove_file(&path).unwrap();
}

#[cfg(unix)]
#[test]
fn files_without_an_end_are_read_up_to_their_first_zero() {
    assert_eq!(
        read_at_most(Path::new("/dev/zero"), LARGEST_FILE).unwrap(),
        [0]
    );
}
