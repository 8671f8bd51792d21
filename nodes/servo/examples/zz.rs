//! Debug.
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::{DQuat, DVec3, Pose};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let scene = scene::Scene::load(std::path::Path::new(&a[1])).unwrap();
    let law = match a[3].as_str() {
        "paper" => LawKind::Paper,
        "pstar" => LawKind::Pstar,
        "blended" => LawKind::Blended,
        _ => LawKind::Proxy,
    };
    let from: usize = a[4].parse().unwrap();
    let to: usize = a[5].parse().unwrap();
    let mut r = Renderer::new(scene.world.clone());
    let mut t = cspace::BodyTracker::new(scene.world.clone(), 5e-3);
    for (i, l) in std::fs::read_to_string(&a[2]).unwrap().lines().skip(1).enumerate() {
        let f: Vec<f64> = l.split(',').map(|x| x.parse().unwrap()).collect();
        let p = Pose::new(DVec3::new(f[1], f[2], f[3]), DQuat::from_xyzw(f[4], f[5], f[6], f[7]));
        if i == from {
            println!("==");
        }
        let o = r.render(&p, &Gains { law, ..Gains::default() }, 1e-3);
        if i + 50 >= from {
            for c in t.step(&p) {
                if i >= from && i <= to {
                    println!(
                        "  pair {} {} near {:?} n {} {:e}",
                        c.part, c.piece, c.tracked.near.contact, c.tracked.near.normal_w, c.tracked.near.distance
                    );
                }
            }
        }
        if i >= from && i <= to {
            println!(
                "{i} F {} T {} depth {:e} {:?} scp {}",
                o.wrench.force,
                o.wrench.torque,
                o.depth,
                o.formation.kind,
                o.proxy.translation - p.translation
            );
            for c in o.formation.points() {
                println!(
                    "   {} {} {:?} {} n {} {:e}",
                    c.part_a, c.piece_b, c.contact, c.point_w, c.normal_w, c.distance
                );
            }
        }
        if i > to {
            break;
        }
    }
}
