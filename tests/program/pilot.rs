//! `racer pilot` over real links on this machine. Whether it keeps time depends on the machine: asked is only that the
//! flight begins, and ends for a reason.

use crate::support::racer;
use crate::support::tongue::{Speech, Tongue};
use crate::support::vehicle::Peer;
use assert_cmd::cargo::CommandCargoExt;
use racer::flight::live::Mission;
use racer::race::onboard::Surroundings;
use racer::race::snapshot::Snapshot;
use std::io::Read;
use std::net::{TcpListener, UdpSocket};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const POLICY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/policy-73e7003.safetensors");

fn mission() -> Mission {
    let snapshot = Snapshot::read(Path::new(POLICY)).unwrap();
    let range = snapshot.ranges();
    let (track, vehicle) = (snapshot.about.track, snapshot.about.vehicle);
    Mission { network: snapshot.network, track, vehicle, range, laps: None, lead: 0 }
}

fn start(args: &[&str]) -> Child {
    let args = [&["pilot", POLICY, "--laps", "1", "--seconds", "20"], args].concat();
    Command::cargo_bin("racer").unwrap().args(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// A port that nobody has at this moment.
fn free() -> u16 {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Flies a simulated vehicle in real time until the pilot has ended, and gives what that printed.
fn flown(mut child: Child, mut tongue: Tongue, send: &dyn Fn(&[u8]), hear: &dyn Fn() -> Option<Vec<u8>>) -> String {
    let mission = mission();
    let mut peer = Peer::new(&mission);
    let begun = Instant::now();
    let (mut flew, mut setpoint, mut answered) = (0, None, None);
    while child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it has not ended");
        // Released long enough after the first answer that the pilot is ready.
        let told = peer.told(answered.is_some_and(|at: Instant| at.elapsed() > Duration::from_secs(1)));
        tongue.encode(&told).iter().for_each(|piece| send(piece));
        while let Some(bytes) = hear() {
            answered = answered.or(Some(Instant::now()));
            setpoint = tongue.obeyed(&bytes).or(setpoint);
        }
        flew += u32::from(setpoint.is_some());
        peer.fly(setpoint);
        let due = Duration::from_secs_f64(peer.now_s);
        std::thread::sleep(due.saturating_sub(begun.elapsed()));
    }
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap() + &String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("\nready") && told.contains("\nflying\n") && told.contains("\nended: "), "{told}");
    assert!(flew > 0 && told.contains("deadlines"), "{told}");
    told
}

fn datagrams(socket: &UdpSocket) -> impl Fn() -> Option<Vec<u8>> {
    socket.set_nonblocking(true).unwrap();
    move || {
        let mut bytes = [0; 2048];
        socket.recv(&mut bytes).ok().map(|length| bytes[..length].to_vec())
    }
}

#[test]
fn over_racers_own_packets_and_over_mavlink() {
    let full = Surroundings::of(&mission().track, &mission().vehicle).full_rate;
    for (speech, prefix, switch) in [
        (Speech::Packets, "", &[][..]),
        (Speech::Odometry, "mavlink:", &["--switch", "offboard"]),
        (Speech::Parts, "mavlink:", &["--switch", "rc:8"]),
    ] {
        let port = free();
        let child = start(&[&["--in", &format!("{prefix}udp:{port}")], switch].concat());
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        // Until the pilot listens, nobody does.
        let send = |bytes: &[u8]| drop(socket.send_to(bytes, ("127.0.0.1", port)));
        flown(child, Tongue::new(speech, full), &send, &datagrams(&socket));
    }
}

#[test]
fn over_msp_to_a_flight_controller_that_listens_on_tcp() {
    let full = Surroundings::of(&mission().track, &mission().vehicle).full_rate;
    let (port, server) = (free(), TcpListener::bind("127.0.0.1:0").unwrap());
    let to = format!("msp:tcp:{}", server.local_addr().unwrap());
    let child = start(&["--in", &format!("udp:{port}"), "--out", &to]);
    let (stream, _) = server.accept().unwrap();
    stream.set_nonblocking(true).unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let send = |bytes: &[u8]| drop(socket.send_to(bytes, ("127.0.0.1", port)));
    // The last whole frame of sticks, of which several may have come at once.
    let hear = || {
        let mut bytes = vec![0; 1 << 16];
        let length = (&stream).read(&mut bytes).ok()?;
        let mark = [b'$', b'M', b'<', 32, 200];
        let at = (0..length.saturating_sub(37)).rev().find(|at| bytes[*at..].starts_with(&mark))?;
        Some(bytes[at..length].to_vec())
    };
    flown(child, Tongue::new(Speech::Sticks, full), &send, &hear);
}

#[test]
fn a_link_that_goes_away_ends_the_flight() {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let child =
        start(&["--in", &format!("udp:{}", free()), "--out", &format!("msp:tcp:{}", server.local_addr().unwrap())]);
    let (mut stream, _) = server.accept().unwrap();
    stream.read_exact(&mut [0; 38]).unwrap();
    drop((stream, server));
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && told.contains("ended: the link for setpoints broke"), "{told}");
}

/// A serial line that is the other end of a pseudo-terminal, as Python makes them.
#[cfg(unix)]
#[test]
fn over_msp_on_a_serial_line() {
    use crate::support::skipped;
    use std::io::Write;
    let script = "import os, sys, tty\n\
                  ours, theirs = os.openpty()\n\
                  tty.setraw(ours)\n\
                  print(os.ttyname(theirs), flush=True)\n\
                  data = b''\n\
                  while len(data) < 76: data += os.read(ours, 76 - len(data))\n\
                  print(data[:5].hex(), flush=True)\n\
                  sys.stdin.read()\n";
    let python = std::env::var_os("RACER_PYTHON").unwrap_or("python3".into());
    let started = Command::new(python).args(["-c", script]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let Ok(mut line) = started else { return skipped("python3", "RACER_REQUIRE_PYTHON") };
    let mut said = std::io::BufRead::lines(std::io::BufReader::new(line.stdout.take().unwrap()));
    let name = said.next().unwrap().unwrap();
    let mut child = start(&["--in", &format!("udp:{}", free()), "--out", &format!("msp:{name}:115200")]);
    assert_eq!(said.next().unwrap().unwrap(), "244d3c20c8");
    child.kill().unwrap();
    child.wait().unwrap();
    line.stdin.take().unwrap().write_all(b"over").unwrap();
    line.wait().unwrap();
}

#[test]
fn bad_links_and_switches_are_refused_with_what_would_be_right() {
    let folder = tempfile::tempdir().unwrap();
    let taken = UdpSocket::bind("0.0.0.0:0").unwrap();
    let taken = format!("udp:{}", taken.local_addr().unwrap().port());
    let nobody =
        format!("msp:tcp:127.0.0.1:{}", TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port());
    for (args, parts) in [
        (&["--in", "9101"][..], &["--in", "9101", "udp:PORT"][..]),
        (&["--in", "udp:127.0.0.1:9101"], &["--in", "udp:PORT"]),
        (&["--in", "msp:/dev/ttyACM0"], &["--in", "motion capture"]),
        (&["--in", "mavlink:14540", "--switch", "offboard"], &["14540", "tcp:HOST:PORT"]),
        (&["--in", "mavlink:udp:14540"], &["--switch", "offboard", "rc:CHANNEL"]),
        (&["--in", "mavlink:udp:14540", "--switch", "rc:19"], &["--switch", "rc:19", "1 to 18"]),
        (&["--in", "udp:9101", "--switch", "rc:8"], &["--switch", "bit 0"]),
        (&["--in", "udp:9101", "--out", "udp:9102"], &["--out", "udp:HOST:PORT"]),
        (&["--in", "udp:9101", "--out", "udp:no.such.host.invalid:1"], &["--out", "no.such.host.invalid"]),
        (&["--in", "udp:9101", "--out", "msp:/dev/none", "--switch", "offboard"], &["--switch", "rc:CHANNEL"]),
        (&["--in", "udp:9101", "--out", "msp:/dev/none:fast"], &["--out", "/dev/none:fast"]),
        (&["--in", "udp:9101", "--out", "msp:/dev/none"], &["--out msp:/dev/none", "plugged in"]),
        (&["--in", "udp:9101", "--out", &nobody], &["--out msp:tcp:127", "start the peer"]),
        (&["--in", "ros2:mavros/"], &["--in", "ros2:mavros/", "ros2"]),
        (&["--in", "udp:9101", "--arm", "5"], &["--arm 5", "msp:"]),
        (&["--in", "udp:9101", "--out", "msp:/dev/none", "--arm", "4"], &["--arm", "5..=16"]),
        (&["--in", &taken], &["--in", "another port"]),
    ] {
        let ran = racer(folder.path(), &[&["pilot", POLICY], args].concat());
        assert_eq!(ran.code, 2, "{args:?}: {}", ran.err);
        for part in parts {
            assert!(ran.err.contains(part), "{args:?}: `{part}` is not in:\n{}", ran.err);
        }
    }
}

/// Against a DDS that others wrote. It stays on its pad: the policy ends the flight by itself.
#[cfg(feature = "ros2")]
#[test]
fn over_ros2_to_cyclone_dds() {
    let folder = tempfile::tempdir().unwrap();
    let estimate = Peer::new(&mission()).told(false).estimate;
    let (position, attitude, voltage) = (estimate.position, estimate.attitude, estimate.voltage);
    let pad = serde_json::json!({"position": position, "attitude": attitude, "voltage": voltage});
    let path = folder.path().join("pad.json");
    std::fs::write(&path, pad.to_string()).unwrap();
    let child = start(&["--in", "ros2:/mavros", "--switch", "offboard"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/ros2_peer.py");
    let Some(output) = crate::support::python("cyclonedds", &[&script, &path]) else { return stop(child) };
    let output: serde_json::Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(output["setpoints"][0], serde_json::json!([128, 0.0, 0.0, 0.0, 0.0]));
    assert!(output["counts"][0].as_u64() > Some(10) && output["counts"][1].as_u64() > Some(0), "{output}");
    let ended = child.wait_with_output().unwrap();
    let told = String::from_utf8(ended.stderr).unwrap();
    assert!(told.contains("\nready") && told.contains("\nflying\n") && told.contains("\nended: "), "{told}");
}

#[cfg(feature = "ros2")]
fn stop(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}
