//! Random vehicles, flown in the independent simulator and identified from what its sensors logged.

mod truth;

use racer::flight::quality::check;
use racer::identify::{Options, identify};
use racer::vehicle::Vehicle;

#[test]
fn probe() {
    let seeds: u64 = std::env::var("N").map_or(2, |n| n.parse().unwrap());
    for seed in 1..=seeds {
        let vehicle = truth::Vehicle::random(seed);
        let clock = std::time::Instant::now();
        let flown = truth::fly(&vehicle, seed, 300.0, std::env::var("NOISE").map_or(1.0, |n| n.parse().unwrap()));
        let flew = clock.elapsed().as_secs_f64();
        let top =
            |f: &dyn Fn(&truth::motion::Body) -> f64| flown.bodies.iter().map(f).fold(f64::NEG_INFINITY, f64::max);
        println!(
            "seed {seed}: T/W {:.2} xy {:.0} z {:.0}..{:.0} speed {:.1} vz {:.1}..{:.1}",
            vehicle.push(1.0, vehicle.full_v) / 9.81,
            top(&|b| b.position.xy().norm()),
            -flown.bodies[500..].iter().map(|b| -b.position.z).fold(f64::NEG_INFINITY, f64::max),
            top(&|b| b.position.z),
            top(&|b| b.velocity.norm()),
            -top(&|b| -b.velocity.z),
            top(&|b| b.velocity.z)
        );
        let quality = check(&flown.log);
        for f in &quality.findings {
            println!("  {:?}", f);
        }
        let options = Options {
            base: Vehicle::load("seed_class").unwrap(),
            mass_kg: None,
            max_rate_rad_s: None,
            rate_cutoff_hz: 100.0,
            force_cutoff_hz: std::env::var("FC").map_or(30.0, |n| n.parse().unwrap()),
        };
        let clock = std::time::Instant::now();
        let found =
            identify(vec![quality], &options, &mut |s, _| println!("   {:.2} {s}", clock.elapsed().as_secs_f64()));
        println!("  flew in {flew:.1} s, identified in {:.1} s", clock.elapsed().as_secs_f64());
        let show = |name: &str, e: &racer::identify::estimate::Estimate, true_value: f64| {
            let (v, Some([l, h])) = (e.value.unwrap_or(f64::NAN), e.interval()) else {
                println!("  {name}: {e:?}");
                return;
            };
            println!(
                "  {name:<12} true {true_value:9.5} found {v:9.5} off {:6.2} % half {:6.2} % {}",
                100.0 * (v / true_value - 1.0),
                50.0 * (h - l) / true_value.abs(),
                if l <= true_value && true_value <= h { "" } else { "OUT" }
            );
        };
        for k in 0..4 {
            show(&format!("tau {k}"), &found.response[k].tau_s, vehicle.tau[k]);
            println!("      r2 {:?} rmse {:?}", found.response[k].r2, found.response[k].rmse);
        }
        for k in 0..3 {
            show(&format!("rate {k}"), &found.max_rate_rad_s[k], vehicle.max_rate[k]);
            show(&format!("drag {k}"), &found.drag.k_1_m[k], vehicle.drag_over_mass()[k]);
        }
        for k in 0..6 {
            show(&format!("c{k}"), &found.thrust_n[k], vehicle.thrust[k]);
        }
        show("volts", &found.battery.initial_v, vehicle.full_v);
        show("discharge", &found.battery.rate_v_s, vehicle.discharge);
        println!("  flown {:?} remarks {:?}", found.flown, found.remarks);
        let c: Vec<f64> = found.thrust_n.iter().map(|e| e.value.unwrap_or(0.0)).collect();
        let mut worst: f64 = 0.0;
        let [from, to] = found.flown.unwrap_or([-1.0, 1.0]);
        for i in 0..=20 {
            for v in [vehicle.full_v, vehicle.full_v + 300.0 * vehicle.discharge] {
                let u = from + (to - from) * f64::from(i) / 20.0;
                let t = c[0] + c[1] * u + c[2] * u * u + c[3] * u * u * u + c[4] * v + c[5] * u * v;
                worst = worst.max((t / vehicle.mass - vehicle.push(u, v)).abs());
            }
        }
        println!("  curve off by {:.2} % of full", 100.0 * worst / vehicle.push(1.0, vehicle.full_v));
    }
}
