use std::io::Write;

use super::*;
use crate::tests::temporary as destination;

#[test]
fn files_appear_when_they_are_complete() {
    let destination = destination("complete");
    let mut file = TemporaryFile::beside(&destination).unwrap();
    let path = file.path.clone();
    file.file().write_all(b"marbles").unwrap();
    assert!(path.exists() && !destination.exists());
    file.persist().unwrap();
    assert!(!path.exists());
    assert_eq!(fs::read(&destination).unwrap(), b"marbles");
    fs::remove_file(destination).unwrap();
}

#[test]
fn unfinished_files_are_removed() {
    let destination = destination("unfinished");
    let file = TemporaryFile::beside(&destination).unwrap();
    let path = file.path.clone();
    assert!(path.exists());
    drop(file);
    assert!(!path.exists() && !destination.exists());
}

#[test]
fn names_are_cut_between_characters() {
    let long = "ö".repeat(LONGEST_NAME / 2);
    // 239 bytes are left, and 238 are filled.
    assert_eq!(stem(&Path::new("folder").join(&long)), long[..238]);
    assert_eq!(stem(Path::new("folder/a.png")), "a.png");
    for (name, expected) in [
        ("a.0001.png.tmp", Some("a.0001.png")),
        ("a.0001.png.12.tmp", Some("a.0001.png")),
        ("a.0001.png", None),
    ] {
        assert_eq!(stem_of_temporary(OsStr::new(name)), expected);
    }
}

#[test]
fn files_that_are_being_written_are_stepped_over() {
    let destination = destination("others.png");
    let first = TemporaryFile::claim(&destination).unwrap().unwrap();
    assert!(TemporaryFile::claim(&destination).unwrap().is_none());
    let second = TemporaryFile::beside(&destination).unwrap();
    assert_ne!(first.path, second.path);
    LeftOver::default().remove(&destination);
    assert!(first.path.exists() && second.path.exists());
    drop(first);
    assert!(TemporaryFile::claim(&destination).unwrap().is_some());
}

#[test]
fn files_of_the_dead_are_removed() {
    let destination = destination("dead.png");
    let names = ["", ".1", ".7"].map(|number| {
        let mut name = stem(&destination);
        name.push(format!("{number}.tmp"));
        destination.with_file_name(name)
    });
    let other = destination.with_extension("exr.tmp");
    let all = names.iter().chain([&other]);
    all.for_each(|path| fs::write(path, "half a picture").unwrap());
    // The first is taken over, the others wait for somebody who looks.
    let file = TemporaryFile::claim(&destination).unwrap().unwrap();
    assert_eq!(file.path, names[0]);
    assert_eq!(file.file.metadata().unwrap().len(), 0);
    LeftOver::default().remove(&destination);
    assert!(names[0].exists() && other.exists());
    assert!(!names[1].exists() && !names[2].exists());
    fs::remove_file(other).unwrap();
}

#[test]
fn many_claims_at_once_leave_one_owner_at_a_time() {
    use std::sync::atomic::{AtomicU32, Ordering};

    let destination = destination("contested.png");
    let (owners, claims) = (AtomicU32::new(0), AtomicU32::new(0));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..200 {
                    // Not through the list of open files, whose lock other processes do not share.
                    let path = destination.with_extension("claim");
                    if let Some(file) = create(&path).unwrap() {
                        assert_eq!(owners.fetch_add(1, Ordering::SeqCst), 0);
                        assert!(is_at(&file, &path).unwrap());
                        claims.fetch_add(1, Ordering::SeqCst);
                        owners.fetch_sub(1, Ordering::SeqCst);
                        // Half of them die without cleaning up.
                        if claims.load(Ordering::SeqCst).is_multiple_of(2) {
                            fs::remove_file(&path).unwrap();
                        }
                    }
                }
            });
        }
    });
    assert!(claims.into_inner() > 0);
    let _ = fs::remove_file(destination.with_extension("claim"));
}
