use super::*;
#[test]
#[ignore]
fn timing() {
    for name in std::env::var("TABLES").unwrap().split(',') {
        let request = Request::default();
        for _ in 0..3 {
            let start = std::time::Instant::now();
            let rows = read(Path::new(name), &request).map_err(|e| format!("{e:?}"));
            let t = start.elapsed();
            println!("{name} {:?} {:?}", rows.map(|r| r.len()), t);
        }
    }
}
