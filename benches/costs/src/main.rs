//! What parts of this engine cost, each measured by itself. Times are medians, in milliseconds.
//!
//! `cargo run --release -p bench_costs` in the folder `benches` measures all, `-- events` one part.

mod batches;
mod characters;
mod drawing;
mod events;
mod meshes;
mod world;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let all = [
        ("events", events::measure as fn()),
        ("characters", characters::measure),
        ("drawing", drawing::measure),
        ("meshes", meshes::measure),
        ("batches", batches::measure),
    ];
    match &words[..] {
        [] => all.iter().for_each(|(_, measure)| measure()),
        words => {
            for word in words {
                let names = all.map(|(name, _)| name);
                let part = all.iter().find(|(name, _)| name == word);
                part.unwrap_or_else(|| panic!("{word} is none of {names:?}")).1();
            }
        }
    }
}
