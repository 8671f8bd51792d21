//! How stiff may it be? A hand at a device, the servo's own tick, and a floor: the largest stable stiffness and the energy
//! put into the hand, for every law, grip and time of a tick, with and without passivity control.
//!
//! `cargo bench -p servo --bench stability` (or `cargo xtask bench stability`) writes docs/stability.md,
//! docs/stability.csv and docs/pictures/stability.png. Deterministic: the same tables on every machine.

#[path = "../../tests/stability/cell.rs"]
mod cell;
mod found;
#[path = "../../tests/stability/hand.rs"]
mod hand;
mod plot;
#[path = "../../tests/stability/press.rs"]
mod press;
#[path = "../../tests/stability/rig.rs"]
mod rig;
#[path = "../../tests/stability/search.rs"]
mod search;
mod table;

use cell::Cell;
use found::Found;
use haptics::LawKind;
use rig::GRIPS;
use servo::MotionKind;
use std::error::Error;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Times of a tick, s.
const PERIODS: [f64; 4] = [0.25e-3, 0.5e-3, 1e-3, 2e-3];
/// The laws, in the order of the tables.
const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

/// A cell and what was found without and with the controller.
#[derive(Clone, Copy, Debug)]
struct Row {
    cell: Cell,
    without: Found,
    with: Found,
}

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo bench` hands over its own flag, and `cargo xtask bench TEXT` a filter.
    if std::env::args().skip(1).any(|a| !a.starts_with('-') && !"stability".contains(&a)) {
        return Ok(());
    }
    let rows = rows();
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    std::fs::write(docs.join("stability.md"), table::markdown(&rows))?;
    std::fs::write(docs.join("stability.csv"), table::csv(&rows))?;
    plot::draw(&rows, &docs.join("pictures/stability.png"))?;
    println!("{}", table::summary(&rows));
    Ok(())
}

/// All rows, worked out on all cores, in the order of the tables.
fn rows() -> Vec<Row> {
    let mut cells = Vec::new();
    for motion in [MotionKind::Translation, MotionKind::Rotation] {
        for law in LAWS {
            for grip in GRIPS {
                cells.extend(PERIODS.map(|period| Cell { law, grip, period, motion }));
            }
        }
    }
    let world = rig::cube_over_floor();
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            let (sender, cells, next, world) = (sender.clone(), &cells, &next, &world);
            scope.spawn(move || {
                while let Some(cell) = cells.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let found = |passivity| Found::in_cell(cell, world, passivity);
                    let row = Row { cell: *cell, without: found(false), with: found(true) };
                    eprintln!("{}", table::line(&row));
                    let _ = sender.send(row);
                }
            });
        }
    });
    drop(sender);
    let mut rows: Vec<Row> = receiver.into_iter().collect();
    let place = |row: &Row| {
        let c = &row.cell;
        (c.motion == MotionKind::Rotation, LAWS.iter().position(|l| *l == c.law), c.grip.name, c.period)
    };
    rows.sort_by(|a, b| place(a).partial_cmp(&place(b)).expect("periods are numbers"));
    rows
}
