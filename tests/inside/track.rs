//! The tracks and vehicles that are shipped are sound, and those that cannot be raced are refused.

use racer::base::document::Document;
use racer::model::track::{Gate, GateKind, Track, spline::Spline};
use racer::model::vehicle::Vehicle;

const A2RL: &str = include_str!("../../tracks/a2rl_s2.toml");
const SEED: &str = include_str!("../../configs/vehicles/seed_class.toml");

fn refuses_track(from: &str, to: &str, parts: &[&str]) {
    assert!(A2RL.contains(from), "{from}");
    let message =
        Document::parse("t.toml", A2RL.replacen(from, to, 1)).unwrap().decode::<Track>().unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
}

fn refuses_vehicle(from: &str, to: &str, parts: &[&str]) {
    assert!(SEED.contains(from), "{from}");
    let message =
        Document::parse("v.toml", SEED.replacen(from, to, 1)).unwrap().decode::<Vehicle>().unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
}

/// 1-based line of `text`'s first occurrence.
fn line_of(text: &str) -> usize {
    A2RL[..A2RL.find(text).unwrap()].lines().count() + 1
}

fn lap_length(track: &Track) -> f64 {
    Spline::through(&track.centres()).length()
}

#[test]
fn shipped_tracks_are_sound_and_as_long_as_they_say() {
    for (name, gates, length) in [
        ("a2rl_s2", 14, 96.6),
        ("a2rl_s1", 11, 170.0),
        ("uzh_split_s.toml", 7, 75.0),
        ("figure_eight", 8, 17.6),
        ("square", 4, 17.5),
    ] {
        let track = Track::load(name).unwrap();
        assert_eq!(track.gates.len(), gates, "{name}");
        let found = lap_length(&track);
        assert!((found / length - 1.0).abs() < 0.05, "{name}: {found} m");
    }
}

/// Each gate is crossed in its own direction by the way from the gate before to the gate after; a wrong sign of heading
/// or a mirrored frame would show here. Virtual gates are ours to place and stand wherever the route needs them.
#[test]
fn gates_face_along_the_track() {
    for name in ["a2rl_s2", "a2rl_s1", "uzh_split_s", "figure_eight", "square"] {
        let track = Track::load(name).unwrap();
        let spline = Spline::through(&track.centres());
        for (index, gate) in track.gates.iter().enumerate() {
            let along = spline.tangent(spline.length_at(index)).dot(&gate.rotation().column(0));
            assert!(gate.kind == GateKind::Virtual || along > 0.3, "{name} gate {index}: {along}");
        }
    }
}

#[test]
fn season_two_is_as_published() {
    let track = Track::load("a2rl_s2").unwrap();
    assert_eq!(track.gates.iter().filter(|gate| gate.kind == GateKind::Virtual).count(), 2);
    assert_eq!(
        track.sections.iter().map(|section| section.name.as_str()).collect::<Vec<_>>(),
        ["chicane", "split-S", "ladder"]
    );
    let split: Vec<&Gate> = track.sections[1].gates.iter().map(|&gate| &track.gates[gate]).collect();
    assert_eq!((split[0].position_m, split[1].position_m), ([17.5, 30.0, 4.05], [17.5, 30.0, 1.35]));
    assert_eq!(Track::load("a2rl_s2").unwrap().start.position_m, [18.6, 2.0, 0.1]);
}

#[test]
fn gates_that_cannot_be_passed() {
    let place = "position_m = [12.5, 2.0, 1.35]";
    let line = format!("t.toml:{}", line_of(place));
    refuses_track(place, "position_m = [99.0, 2.0, 1.35]", &[&line, "gates[0].position_m", "99.0", "cannot be passed"]);
    refuses_track(place, "position_m = [12.5, 2.0, 0.5]", &[&line, "gates[0].position_m", "cannot be passed", "0.75"]);
    refuses_track(place, "position_m = [12.5, nan, 1.35]", &[&line, "finite"]);
    refuses_track(place, "position_m = [6.5, 6.0, 1.35]", &["gates[0].position_m", "apart from the next"]);
    refuses_track("radius_m = 0.75", "radius_m = 0.0", &["gates[0].radius_m", "cannot be passed"]);
    refuses_track("radius_m = 1.5", "radius_m = -1", &["gates[5].radius_m"]);
}

#[test]
fn tracks_that_are_wrong_elsewhere() {
    refuses_track("gates = [7, 8]", "gates = [7, 14]", &["sections[1].gates[1]", "14", "0 to 13"]);
    refuses_track("kind = \"virtual\"", "kind = \"imaginary\"", &["gates[5].kind", "imaginary", "virtual"]);
    refuses_track("heading_deg = 135.0", "heading = 135.0", &["gates[1].heading", "did you mean `heading_deg`?"]);
    refuses_track("max_m = [25.5, 35.0, 7.0]", "max_m = [25.5, 35.0, -7.0]", &["volume.max_m"]);
    refuses_track("[18.6, 2.0, 0.1]", "[18.6, 2.0, -0.1]", &["start.position_m", "widen the volume"]);
    refuses_track("[18.6, 2.0, 0.1]", "[18.6, 2.0]", &["start.position_m"]);
    let message = Track::load("a2rl-s2").unwrap_err().to_string();
    assert!(message.contains("did you mean `a2rl_s2`?"), "{message}");
}

#[test]
fn shipped_vehicles_are_as_strong_as_they_say() {
    let ratio = |name| Vehicle::load(name).unwrap().thrust_to_weight();
    assert!((ratio("seed_class") - 39.9 / 9.80665).abs() < 0.02);
    assert!((ratio("a2rl_class") - 6.0).abs() < 0.2);
}

#[test]
fn vehicles_that_cannot_fly() {
    refuses_vehicle("mass_kg = 1.0 ", "mass_kg = 5.0 ", &["v.toml", "thrust_n", "more than the weight"]);
    refuses_vehicle("-16.103, -19.048", "-16.103, -60.048", &["thrust_n", "grows with the command"]);
    refuses_vehicle("roll = 0.0067", "roll = 0", &["time_constant_s.roll", "above 0"]);
    refuses_vehicle("rate_v_s = -", "rate_v_s = ", &["battery.rate_v_s", "zero or less"]);
    refuses_vehicle("empty_v = 22.0", "empty_v = 25.0", &["battery.full_v", "25"]);
    refuses_vehicle("yaw = 0.0124\n", "", &["time_constant_s.yaw", "nothing", "add the key"]);
}
