//! What is shown of a flight: the page in a real browser, the MCAP file read by others.
//!
//! `RACER_BROWSER` names the browser (default: `chromium`, `chromium-browser` or `google-chrome`), `RACER_PYTHON` the
//! interpreter. Where one is missing, its test says so and passes, unless `RACER_REQUIRE_BROWSER` or
//! `RACER_REQUIRE_PYTHON` is set.

use crate::support::{python, skipped};
use racer::base::lane::Level;
use racer::base::rng::{Philox, RngStream};
use racer::flight::Log;
use racer::learn::nn::Network;
use racer::model::track::Track;
use racer::present::replay::{Replay, mcap::mcap, race, recorded};
use racer::present::report;
use racer::present::report::commands::Commands;
use racer::present::report::replay::page;
use racer::race::config::Setup;
use racer::race::env::Race;
use racer::race::env::observe::OBSERVATIONS;
use racer::race::env::reset::StartPlace;
use racer::race::eval::fly::fly;
use racer::race::eval::spread::spread;
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// A log of a vehicle that is led through every gate of a track, along its reset spline, at 8 m/s.
fn log(track: &Track) -> Log {
    let spline = track.reset_spline();
    let mut log = Log { name: "led <b>along</b>".into(), start_ns: 1_700_000_000_000_000_000, ..Log::default() };
    log.vehicle.max_rate_rad_s = Some([10.0, 10.0, 2.0]);
    let steps = (1.05 * spline.length() / 0.08) as usize;
    for i in 0..steps {
        let (time_s, s) = (0.01 * i as f64, 0.08 * i as f64);
        let [x, y, z]: [f64; 3] = spline.position(s).into();
        let t = spline.tangent(s) * 8.0;
        log.odometry.push(time_s, [x, y, z, 1.0, 0.0, 0.0, 0.0, t.x, t.y, t.z]);
        log.setpoint.push(time_s, [5.0, -10.0, 0.0, 0.75]);
    }
    log
}

fn untrained(vehicles: usize) -> Replay {
    let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).unwrap();
    let network = Network::initialised(OBSERVATIONS, -0.5, &mut Philox::new(3).sequence(RngStream::Weights, 0, 0));
    race(Level::best(), &Race::new(&config.env, &track, &vehicle, 3), &track, &network, vehicles, 3.0, false)
}

#[test]
fn a_log_passes_the_gates_it_was_led_through() {
    let track = Track::load("square").unwrap();
    let replay = recorded(&log(&track), Some(&track)).unwrap();
    let flown = &replay.vehicles[0];
    let gates: Vec<_> = flown.passes.iter().map(|(_, gate)| *gate).collect();
    assert_eq!(gates[..4], [0, 1, 2, 3], "{:?}", flown.passes);
    let frame = &flown.frames[10];
    assert!((frame.speed() - 8.0).abs() < 1e-9 && frame.command == [0.5, -1.0, 0.0, 0.5], "{frame:?}");
    let empty = recorded(&Log::default(), None).unwrap_err().to_string();
    assert!(empty.contains("0 samples of position and attitude"), "{empty}");
}

#[test]
fn the_first_vehicle_is_nominal_and_the_others_are_not() {
    let replay = untrained(3);
    assert_eq!(replay.vehicles.len(), 3);
    let [nominal, first, second] = [0, 1, 2].map(|i| &replay.vehicles[i].frames);
    let length = nominal.len().min(first.len()).min(second.len());
    assert!(length > 10 && nominal[0].observation.is_some());
    assert_eq!(nominal[0].position, first[0].position);
    assert!(nominal[0].voltage > first[0].voltage && first[length - 1].position != second[length - 1].position);
}

#[test]
fn figures_of_flights_are_drawn() {
    let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).unwrap();
    let network = Network::initialised(OBSERVATIONS, -0.5, &mut Philox::new(3).sequence(RngStream::Weights, 0, 0));
    let race = Race::new(&config.env, &track, &vehicle, 3);
    let spread = spread(Level::best(), &race, &track, &network, 20, 100);
    assert_eq!((spread.nominal.len() > 10, spread.randomised.len()), (true, 20));
    let figure = report::spread::svg(&track, &spread, "fixed starts").unwrap();
    assert!(figure.contains("20 randomised vehicles") && figure.contains("fixed starts"));
    let trace = fly(Level::best(), &race.scored(&track), &network, StartPlace::Pad, 1, 100).trace;
    let [left, right] = ["weak", "strong"].map(|title| Commands { title, trace: &trace });
    let figure = report::commands::svg(&[left, right]).unwrap();
    assert!(["weak", "strong", "roll rate", "thrust", "time, s"].iter().all(|text| figure.contains(text)));
}

/// The page's document after it has run in a browser, `script` after all of its own.
fn browsed(page: &str, script: &str) -> Option<String> {
    let names = ["chromium", "chromium-browser", "google-chrome"].map(String::from);
    let asked = std::env::var("RACER_BROWSER").map(|name| vec![name]);
    let works = |name: &&String| Command::new(name).arg("--version").output().is_ok_and(|o| o.status.success());
    let candidates = asked.unwrap_or(names.into());
    let Some(browser) = candidates.iter().find(works) else {
        skipped("chromium", "RACER_REQUIRE_BROWSER");
        return None;
    };
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("page.html");
    // Errors of the page become part of it. Pictures come with the virtual time: the browser's own come when the
    // machine has a screen and the leisure for it.
    let caught = "<script>window.onerror = m => { document.documentElement.dataset.failed = m; };
        window.requestAnimationFrame = draw => setTimeout(() => draw(performance.now()), 16);</script>";
    let page = page.replacen("<body>", &format!("<body>{caught}"), 1);
    let page = page.replace("</body>", &format!("<script>{script}</script></body>"));
    std::fs::write(&path, page).unwrap();
    let profile = format!("--user-data-dir={}", folder.path().join("profile").display());
    let output = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1280,800", &profile])
        .args(["--virtual-time-budget=30000", "--dump-dom"])
        .arg(format!("file://{}", path.display()))
        .output()
        .unwrap();
    let document = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(!document.contains("data-failed"), "{document}");
    Some(document)
}

/// What follows `before` in the document, up to the next `<` or `"`.
fn after<'a>(document: &'a str, before: &str) -> &'a str {
    let start = document.find(before).unwrap_or_else(|| panic!("no {before} in {document}")) + before.len();
    let rest = &document[start..];
    &rest[..rest.find(['<', '"']).unwrap_or(rest.len())]
}

#[test]
fn the_page_plays_in_a_browser() {
    let track = Track::load("square").unwrap();
    let text = page(&recorded(&log(&track), Some(&track)).unwrap());
    assert!(!text.contains("http"), "the page is to need nothing from elsewhere");
    assert!(text.contains("<title>led &lt;b>along"));
    // Seconds forward, the camera above, how many colours the picture then has, and playing from the beginning. The
    // page draws when the browser lets it: each step waits for the one before.
    let script = "
        const press = (key, shiftKey) => window.dispatchEvent(new KeyboardEvent('keydown', { key, shiftKey }));
        const note = document.body.dataset;
        const when = (done, then) => { if (done()) then(); else setTimeout(() => when(done, then), 20); };
        press('ArrowRight', true); press('ArrowRight'); press('3');
        when(() => note.drawn === '1.100', () => {
            const pixels = pen.getImageData(0, 0, view.width, view.height).data, seen = new Set();
            for (let i = 0; i < pixels.length; i += 4) seen.add(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]);
            [note.colours, note.at, note.mode] = [seen.size > 100 ? 'many' : 'few', note.drawn, camera.mode];
            press('Home'); press(' ');
            when(() => time > 0.1 && time < 1 && playing, () => { note.played = 'on'; });
        });";
    let Some(document) = browsed(&text, script) else { return };
    assert_eq!(after(&document, "data-at=\""), "1.100");
    assert_eq!(after(&document, "data-mode=\""), "top");
    assert_eq!(after(&document, "data-colours=\""), "many");
    assert_eq!(after(&document, "data-played=\""), "on");
    assert_eq!(after(&document, "<td>speed</td><td>"), "8.0 m/s");
    assert_eq!(after(&document, "<h1 id=\"title\">"), "led &lt;b&gt;along&lt;/b&gt;");
}

#[test]
fn a_flight_of_which_little_is_known_is_shown_too() {
    let track = Track::load("square").unwrap();
    let mut log = log(&track);
    log.setpoint = Default::default();
    let Some(document) = browsed(&page(&recorded(&log, None).unwrap()), "") else { return };
    assert_eq!(after(&document, "<td>battery</td><td>"), "\u{2013}");
    assert_eq!(after(&document, "<td>next gate</td><td>"), "\u{2013}");
}

#[test]
fn others_read_the_mcap_file() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("replay.mcap");
    std::fs::write(&path, mcap(&untrained(2)).unwrap()).unwrap();
    let Some(output) = python("mcap, jsonschema", &[Path::new("tests/python/replay.py"), &path]) else { return };
    let found: Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(found["invalid"], serde_json::json!([]));
    for (topic, schema) in [
        ("/tf", "foxglove.FrameTransforms"),
        ("/track", "foxglove.SceneUpdate"),
        ("/path", "foxglove.SceneUpdate"),
        ("/vehicles", "foxglove.SceneUpdate"),
        ("/poses", "foxglove.PosesInFrame"),
        ("/commands", "racer.Commands"),
        ("/state", "racer.State"),
        ("/observation", "racer.Observation"),
    ] {
        assert_eq!(found["topics"][topic], schema, "{topic}");
    }
    assert_eq!(found["gates"], 14);
}
