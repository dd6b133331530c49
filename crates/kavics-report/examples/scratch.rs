//! scratch
#[path = "../../kavics-results/tests/block/mod.rs"]
mod block;
fn main() {
    let dir = std::path::PathBuf::from(std::env::args().nth(1).unwrap());
    let rows: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let long: usize = std::env::args().nth(3).unwrap().parse().unwrap();
    let _ = std::fs::remove_dir_all(&dir);
    let mut scene = block::scene(rows, long);
    if rows == 7 {
        scene.compare = Some("/tmp/out-table.csv".into());
    }
    block::write(&dir, &scene);
    let t = std::time::Instant::now();
    kavics_report::write(&dir, None).unwrap();
    eprintln!("{:?}", t.elapsed());
}
