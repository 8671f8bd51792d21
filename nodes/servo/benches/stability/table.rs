//! The tables of docs/stability.md and docs/stability.csv.

use crate::Row;
use crate::cell::NO_ENERGY;
use crate::found::Found;
use crate::press::PRESS;
use crate::rig::{DEVICE, GRIPS};
use haptics::{Gains, LawKind};
use servo::MotionKind;
use std::fmt::Write;

/// Name of a law, as the parameter has it.
pub fn name(law: LawKind) -> &'static str {
    match law {
        LawKind::Paper => "paper",
        LawKind::Pstar => "pstar",
        LawKind::Blended => "blended",
        LawKind::Proxy => "proxy",
    }
}

fn of(rows: &[Row], motion: MotionKind) -> impl Iterator<Item = &Row> {
    rows.iter().filter(move |r| r.cell.motion == motion)
}

/// Whether the law's rotation has a stiffness to be looked for.
fn has_stiffness(row: &Row) -> bool {
    row.without.largest.is_finite()
}

/// One line of progress.
pub fn line(row: &Row) -> String {
    let c = &row.cell;
    let part = |f: &Found| format!("{} (predicted {})", number(f.largest), number(f.predicted));
    format!(
        "{:?} {} {} {} ms: without {}, with {}",
        c.motion,
        name(c.law),
        c.grip.name,
        c.period * 1e3,
        part(&row.without),
        part(&row.with)
    )
}

/// Least and greatest ratio of all that is compared.
pub fn summary(rows: &[Row]) -> String {
    let mut text = String::new();
    for (motion, word) in [(MotionKind::Translation, "translation"), (MotionKind::Rotation, "rotation (proxy)")] {
        let rows: Vec<&Row> =
            of(rows, motion).filter(|r| motion == MotionKind::Translation || r.cell.law == LawKind::Proxy).collect();
        let span = |f: &dyn Fn(&Row) -> f64| {
            let values = rows.iter().map(|r| f(r));
            (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max))
        };
        let gain = span(&|r| r.with.largest / r.without.largest);
        let (without, with) =
            (span(&|r| r.without.predicted / r.without.largest), span(&|r| r.with.predicted / r.with.largest));
        let _ = writeln!(
            text,
            "- {word}: with passivity control {:.1} to {:.1} times as stiff; prediction over simulation {:.2} to {:.2} \
             without, {:.2} to {:.2} with it",
            gain.0, gain.1, without.0, without.1, with.0, with.1
        );
    }
    let rows: Vec<&Row> = of(rows, MotionKind::Translation).collect();
    let least = |f: &dyn Fn(&Row) -> f64| rows.iter().map(|r| f(r)).fold(f64::MAX, f64::min);
    let _ = writeln!(
        text,
        "- no energy into the hand beyond {:.0e} J, pressing and tapping, with passivity control: up to at least {:.2} times \
         what the check at start allows, which is at least {:.1} times the stiffness that is stable without it",
        NO_ENERGY,
        least(&|r| r.with.passive / r.with.passive_predicted),
        least(&|r| r.with.passive_predicted / r.without.largest)
    );
    text
}

/// docs/stability.md.
pub fn markdown(rows: &[Row]) -> String {
    let g = Gains::default();
    let d = DEVICE;
    let mut text = format!(
        "# How stiff may it be\n\n\
         Made by `cargo bench -p servo --bench stability` (some minutes): the same numbers on every machine, \
         and in docs/stability.csv.\n\n\
         ![Largest stable stiffness over the time of a tick](pictures/stability.png)\n\n\
         A hand holds a cube of 20 mm at a device and presses it on a floor with {PRESS} N, is knocked, and ought to come to \
         rest; or taps on the floor four times a second at 0.2 m/s. The servo's own tick (law, coupling, passivity, limiter) \
         closes the loop; mass, damping and grip are integrated in 50 steps a tick, the wrench being held over the tick and \
         coming late by the delay. Device: {} kg, {} N.s/m, {:.0e} kg.m^2, {:.0e} N.m.s/rad, encoder steps {:.0e} m and \
         {:.0e} rad, delay {} ms. Coupling damping {} N.s/m and {} N.m.s/rad, passivity.max_damping 20 N.s/m.\n\n",
        d.mass,
        d.damping,
        d.inertia,
        d.rotation_damping,
        d.resolution,
        d.angular_resolution,
        d.delay * 1e3,
        g.damping,
        g.rotation_damping
    );
    text += "| grip | mass | damping | stiffness | inertia | rotational damping | rotational stiffness |\n\
             |---|---|---|---|---|---|---|\n";
    for g in GRIPS {
        let _ = writeln!(
            text,
            "| {} | {} kg | {} N.s/m | {} N/m | {:.0e} kg.m^2 | {:.1e} N.m.s/rad | {} N.m/rad |",
            g.name, g.mass, g.damping, g.stiffness, g.inertia, g.rotation_damping, g.rotation_stiffness
        );
    }
    text += "\n**Stable**: over the last 0.2 s of 3 s the part moves no more than 4 encoder steps from peak to peak (a quantised \
             spring, damped by its quantised rate, has a limit cycle of that size), or no more than 0.8 of what it did after the knock \
             and of what it did in between, without leaving the floor, and under the full force (the energy account is not exhausted then). The \
             stiffness is raised in steps of 30 % until a run is not stable, then found within 2 %.\n\n\
             **Predicted**: what the check at start works out from mass, damping, delay and rate alone (`stability.*`, no \
             grip stiffness): the stiffness at which a root of the discrete loop meets the unit circle, with the virtual \
             damping behind its filter and, in the right half, the damping 1.2 K (T/2 + delay), up to its limit, that the passivity controller adds. No-energy: where \
             that damping reaches its limit, or 0.6 of the largest stable stiffness.\n\n";
    let _ = writeln!(text, "{}", summary(rows));
    text += "## Translation into the floor, N/m\n\n\
             Energy: the most by which the hand ever had got more than it gave, at stiffnesses that come to rest. No-energy: up to \
             this stiffness that never exceeded 1e-6 J, pressing and tapping.\n\n\
             | law | grip | tick, ms | stable without | predicted | energy, J | stable with control | predicted | energy, J | \
             no-energy | predicted | times as stiff |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for r in of(rows, MotionKind::Translation) {
        let _ = writeln!(
            text,
            "| {} | {:.0} | {:.0} | {:.0e} | {:.0} | {:.0} | {:.0e} | {:.0} | {:.0} | {:.1} |",
            head(r),
            r.without.largest,
            r.without.predicted,
            r.without.energy,
            r.with.largest,
            r.with.predicted,
            r.with.energy,
            r.with.passive,
            r.with.passive_predicted,
            r.with.largest / r.without.largest
        );
    }
    let _ = write!(
        text,
        "\n## Rocking on the floor, N.m/rad\n\n\
         All six freedoms, the hand twisting with half of what would turn the cube over. For `proxy` the rotational stiffness of \
         the coupling; for `blended` 2 F L^2 / blend_depth with F = {PRESS} N and L = 20 mm, of which the prediction is a lower \
         bound: a flat face gives no torque until it has tilted by a quarter of blend_depth, and no more than F L / 2. The search ends at 200.\n\n\
         | law | grip | tick, ms | stable without | predicted | stable with control | predicted | times as stiff |\n\
         |---|---|---|---|---|---|---|---|\n"
    );
    for r in of(rows, MotionKind::Rotation).filter(|r| has_stiffness(r)) {
        let most = if r.with.largest >= 200.0 { ">= " } else { "" };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {most}{} | {} | {:.1} |",
            head(r),
            number(r.without.largest),
            number(r.without.predicted),
            number(r.with.largest),
            number(r.with.predicted),
            r.with.largest / r.without.largest
        );
    }
    text += "\n`paper` and `pstar` turn a face that lies flat infinitely stiffly: there is no stable stiffness to look for. The torque \
             that is left in the hand, from peak to peak, beside the two other laws at 1 N.m/rad:\n\n\
             | law | grip | tick, ms | torque without, N.m | rests | torque with control, N.m | rests |\n\
             |---|---|---|---|---|---|---|\n";
    let rests = |f: &Found| if f.rests { "yes" } else { "no" };
    for r in of(rows, MotionKind::Rotation) {
        let _ = writeln!(
            text,
            "| {} | {:.0e} | {} | {:.0e} | {} |",
            head(r),
            r.without.torque,
            rests(&r.without),
            r.with.torque,
            rests(&r.with)
        );
    }
    text
}

fn head(row: &Row) -> String {
    let c = &row.cell;
    format!("{} | {} | {}", name(c.law), c.grip.name, c.period * 1e3)
}

fn number(x: f64) -> String {
    if x.is_nan() {
        "-".into()
    } else if x >= 100.0 {
        format!("{x:.0}")
    } else {
        format!("{x:.1}")
    }
}

/// docs/stability.csv.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "motion,law,grip,period_s,passivity,largest_stable,predicted,largest_no_energy,predicted_no_energy,energy_j,torque_at_rest_nm,rests\n",
    );
    for r in rows {
        for (passivity, f) in [(false, &r.without), (true, &r.with)] {
            let c = &r.cell;
            let _ = writeln!(
                text,
                "{:?},{},{},{},{passivity},{},{},{},{},{:e},{:e},{}",
                c.motion,
                name(c.law),
                c.grip.name,
                c.period,
                f.largest,
                f.predicted,
                f.passive,
                f.passive_predicted,
                f.energy,
                f.torque,
                f.rests
            );
        }
    }
    text
}
