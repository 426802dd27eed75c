use gelbench::finite_element::*;
use gelbench::material::Card;
use gelbench::mesh::*;
use gelbench::problem::*;
use gelbench::solve::*;
use std::time::Instant;
fn cpu() -> f64 {
    let t = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = t.rsplit(')').next().unwrap().split_whitespace().collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
}
fn main() {
    let law = Card::load("pva-10", std::path::Path::new(".")).unwrap().law;
    let p = ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law: law.clone(),
        stretches: vec![0.3],
    };
    let set = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 60,
    };
    for (c, e, g) in [
        ([280, 160], Element::Q2, 1.0),
        ([400, 240], Element::Q2, 1.0),
        ([720, 240], Element::Q1, 1.0),
        ([1200, 400], Element::Q1, 1.0),
    ] {
        let fine = FiniteElements::graded(&p, c, e, g);
        let coarse = FiniteElements::graded(&p, c.map(|n| n / 2), e, g);
        let r0 = coarse
            .model(&p)
            .solve(&p.stretches, set, &|_| ())
            .map_err(|_| ())
            .unwrap();
        for s in [LinearSolver::Direct, LinearSolver::Multigrid] {
            let m = fine.model(&p).solved_by(s).near(&coarse.mesh, &r0);
            let (t, k) = (Instant::now(), cpu());
            let r = m.solve(&p.stretches, set, &|_| ()).map_err(|_| ()).unwrap();
            let (a, b) = (t.elapsed().as_secs_f64(), cpu() - k);
            let (t, k) = (Instant::now(), cpu());
            let z = m.influences(&r, "right", 0);
            println!(
                "{c:?} {e:?} {g} {s:?} {} unknowns: solve {a:.2} s cpu {b:.2} ({:?} its), influences {:.2} s cpu {:.2} {}",
                2 * fine.mesh.nodes.len(),
                r.iter()
                    .map(|r| r.convergence.iterations())
                    .collect::<Vec<_>>(),
                t.elapsed().as_secs_f64(),
                cpu() - k,
                z.iter().all(|z| z.is_ok())
            );
        }
    }
    let _ = Mesh::plate;
}
