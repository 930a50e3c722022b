use racer::config::Config;
use racer::env::Race;
use racer::env::reset::Place;
use racer::eval::{fly, score};
use racer::lane::Level;
use racer::ppo::train::*;
use racer::track::Track;
use racer::vehicle::Vehicle;
struct Obs {
    last: f64,
}
impl Observer<racer::env::tally::Tally> for Obs {
    fn iteration(&mut self, it: &Iteration<racer::env::tally::Tally>) -> Flow {
        if it.seconds - self.last > 10.0 || it.index == 1 {
            self.last = it.seconds;
            let t = it.tally;
            let e = t.episodes().max(1.0);
            let terms: Vec<String> = t.terms.iter().map(|x| format!("{:.3}", x / t.steps)).collect();
            eprintln!(
                "{:5} {:6.1}s {:7.2}M {:5.2}M/s std {:.2} kl {:.4} clip {:.2} ev {:.2} gn {:.2} | gates/ep {:.2} len {:.0} laps {} causes {:?} tr {} | {}",
                it.index,
                it.seconds,
                it.steps as f64 / 1e6,
                it.steps as f64 / it.seconds / 1e6,
                it.std,
                it.losses.approx_kl,
                it.losses.clip_fraction,
                it.explained_variance,
                it.losses.gradient_norm,
                t.episode_gates / e,
                t.episode_steps / e,
                t.laps,
                t.causes,
                t.truncated,
                terms.join(" ")
            );
        }
        Flow::Continue
    }
}
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let threads: usize = args[0].parse().unwrap();
    let settings: Vec<_> =
        args[1..].iter().map(|a| racer::config::Setting::parse(a).unwrap_or_else(|e| panic!("{e}"))).collect();
    let config = Config::load("a2rl", &settings).unwrap_or_else(|e| panic!("{e}"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let track = Track::load(&config.track).unwrap();
        let vehicle = Vehicle::load(&config.vehicle).unwrap();
        let race = Race::new(&config.env, &track, &vehicle, config.seed);
        let level = Level::best();
        let tr = train(level, &race, &config.ppo, &config.budget, config.seed, &mut Obs { last: 0.0 });
        let scored = race.scored(&track);
        println!("trained {} steps {:.1}s {:.3}M/s", tr.steps, tr.seconds, tr.steps as f64 / tr.seconds / 1e6);
        for s in &tr.snapshots {
            let f = score::score(&track, &fly::fly(level, &scored, &s.network, Place::Pad, config.eval.agents, 1000));
            let r =
                score::score(&track, &fly::fly(level, &scored, &s.network, Place::Spline, config.eval.agents, 1000));
            println!(
                "{:6.1}M {:5.0}s fixed {:.3} lap {:?} gates {:.1} top {:.1} sat {:.3} dA {:.4} | random {:.3} {:?}",
                s.steps as f64 / 1e6,
                s.seconds,
                f.lap_completion,
                f.lap_time_s.map(|l| (l.median * 100.0).round() / 100.0),
                f.gates_passed.mean,
                f.top_speed_m_s,
                f.saturated_share,
                f.mean_action_change_sq,
                r.lap_completion,
                if std::ptr::eq(s, tr.snapshots.last().unwrap()) {
                    format!("{:?} {:?}", f.failures_by_gate, r.failures_by_gate)
                } else {
                    String::new()
                }
            );
        }
    });
}
