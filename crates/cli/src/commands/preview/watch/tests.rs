use super::*;
use crate::tests::temporary;

fn folder(name: &str) -> PathBuf {
    let folder = temporary(&format!("watch-{name}"));
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn paths(files: &Files) -> Vec<&Path> {
    files.stamps.keys().map(PathBuf::as_path).collect()
}

#[test]
fn files_change_however_they_are_saved() {
    let folder = folder("saved");
    let scene = folder.join("a.ron");
    let files = Files::of(&scene);
    assert_eq!(files.look()[&scene], None);
    fs::write(&scene, "one").unwrap();
    assert_ne!(files.look(), files.stamps);

    let files = Files::of(&scene);
    assert_eq!(files.look(), files.stamps);
    fs::write(&scene, "longer").unwrap();
    assert_ne!(files.look(), files.stamps);

    let files = Files::of(&scene);
    let other = folder.join("a.ron.new");
    fs::write(&other, "renamed").unwrap();
    fs::rename(&other, &scene).unwrap();
    assert_ne!(files.look(), files.stamps);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_tables_of_the_last_scene_are_watched() {
    let folder = folder("tables");
    let [one, two] = ["one.csv", "two.csv"].map(|name| folder.join(name));
    fs::write(&one, "1").unwrap();
    let later = SystemTime::now() + Duration::from_secs(60);
    let mut files = Files::of(Path::new("a.ron"));
    files.name(vec![one.clone(), one.clone(), two.clone()], later);
    assert_eq!(paths(&files), [one.as_path(), &two, Path::new("a.ron")]);
    assert_eq!(files.look(), files.stamps);
    fs::write(&two, "2").unwrap();
    assert_ne!(files.look(), files.stamps);
    files.name(vec![one.clone()], later);
    assert_eq!(paths(&files), [one.as_path(), Path::new("a.ron")]);
    assert_eq!(files.look(), files.stamps);
    // What may have changed while it was read is read again.
    files.name(vec![one, two], SystemTime::UNIX_EPOCH);
    assert_ne!(files.look(), files.stamps);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn messages_keep_to_the_screen() {
    let text = "\x1b[1mfirst\x1b[0m\nsecond, which is long\n\nlast";
    assert_eq!(message(text, (80, 9)), format!("{text}\n"));
    assert_eq!(
        message(text, (80, 4)),
        "\x1b[1mfirst\x1b[0m\nsecond, which is long\n\n"
    );
    // Twenty-one letters are three lines of ten.
    assert_eq!(message(text, (10, 4)), "\x1b[1mfirst\x1b[0m\n");
    assert_eq!(
        message(text, (10, 5)),
        message("\x1b[1mfirst\x1b[0m\nsecond, which is long", (80, 9))
    );
    assert_eq!(message(text, (80, 1)), "");
}
