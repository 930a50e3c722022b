//! `racer check`: what counts as flight.

use crate::support::racer;
use racer::flight::spans::{contain, length};
use racer::flight::{self, Log};
use racer::insight::quality::{Quality, check};

/// The vehicle hardly has to work where it sinks so fast that drag carries it.
fn dived() -> Log {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| {
        let ran = racer(folder.path(), &args.split(' ').collect::<Vec<_>>());
        assert_eq!(ran.code, 0, "{}", ran.err);
    };
    run("extend seed_class axial_inflow.k=0.5 --out true.toml");
    run("fly --pilot --vehicle true.toml --manoeuvres climb,descent,roll-steps,pitch-steps,circle --seconds 60 \
         --seed 4 --out dived.mcap");
    flight::open(&folder.path().join("dived.mcap"), None).unwrap()
}

/// Spans on the ground.
fn ground(quality: &Quality) -> Vec<[f64; 2]> {
    quality.findings.iter().filter(|finding| finding.kind == "ground").filter_map(|finding| finding.span_s).collect()
}

#[test]
fn what_falls_fast_does_not_stand_on_the_ground() {
    let log = dived();
    let with = check(&log);
    let (spans, end) = (ground(&with), *log.imu.time_s.last().unwrap());
    assert!(spans.len() == 2 && spans[0][0] < 0.1 && spans[1][1] > end, "{spans:?}");
    assert!(contain(&with.usable, 48.0), "{:?}", with.usable);

    // Nobody knows without the odometry, or where it stops.
    let mut without = log.clone();
    without.odometry = Default::default();
    let without = check(&without);
    assert!(ground(&without).len() == 3 && length(&without.usable) < length(&with.usable) - 3.0);

    // An estimate that drifts on the ground is no flight.
    let mut drifting = log.clone();
    let odometry = &mut drifting.odometry;
    for (_, row) in odometry.time_s.iter().zip(&mut odometry.rows).filter(|(t, _)| **t < 2.0) {
        row[7..].copy_from_slice(&[0.2, -0.2, 0.1]);
    }
    assert_eq!(ground(&check(&drifting)), spans);
}
