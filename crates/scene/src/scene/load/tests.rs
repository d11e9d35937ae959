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

#[cfg(unix)]
#[test]
fn files_without_an_end_are_read_up_to_a_limit() {
    let error = read_at_most(Path::new("/dev/zero"), 1000).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::FileTooLarge);
}
