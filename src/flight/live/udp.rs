//! A flight over UDP, in real time.

use super::Live;
use super::histogram::Histogram;
use super::packet::STATE_BYTES;
use super::phase::{Phase, Reason};
use crate::model::constants::CONTROL_S;
use std::io::{self, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// How long the end is told after a flight, s.
const FAREWELL_S: f64 = 1.0;
/// Pause after which the receiver looks whether it is still wanted, s.
const LOOK_S: f64 = 0.1;

/// How well real time was kept.
#[derive(Clone, Debug, Default)]
pub struct Timing {
    /// From when a period began to when the program woke, s.
    pub wake: Histogram,
    /// From waking to the answer's being sent, s.
    pub answer: Histogram,
    /// Periods whose answer was sent after the next one had begun.
    pub missed: u64,
}

/// Flies until it has ended or `most_s` are over. `key` says whether the user asks for an end; `told` hears of every
/// change.
pub fn fly(
    live: &mut Live,
    input: &UdpSocket,
    to: SocketAddr,
    most_s: f64,
    key: &dyn Fn() -> bool,
    told: &mut dyn FnMut(Phase, Option<Reason>),
) -> io::Result<Timing> {
    input.set_read_timeout(Some(Duration::from_secs_f64(LOOK_S)))?;
    let output = UdpSocket::bind(if to.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" })?;
    let (over, begun) = (AtomicBool::new(false), Instant::now());
    let (packets, arrived) = channel();
    std::thread::scope(|scope| {
        scope.spawn(|| listen(input, &packets, &over));
        let result = periods(live, &arrived, begun, most_s, key, told, &|bytes| output.send_to(bytes, to).map(drop));
        over.store(true, Ordering::Relaxed);
        result
    })
}

/// A packet and when it arrived. One byte more than a state has tells a longer one.
type Packet = (Instant, [u8; STATE_BYTES + 1], usize);

fn listen(input: &UdpSocket, packets: &Sender<Packet>, over: &AtomicBool) {
    let mut bytes = [0; STATE_BYTES + 1];
    while !over.load(Ordering::Relaxed) {
        if let Ok(length) = input.recv(&mut bytes)
            && packets.send((Instant::now(), bytes, length)).is_err()
        {
            break;
        }
    }
}

fn periods(
    live: &mut Live,
    arrived: &Receiver<Packet>,
    begun: Instant,
    most_s: f64,
    key: &dyn Fn() -> bool,
    told: &mut dyn FnMut(Phase, Option<Reason>),
    send: &dyn Fn(&[u8]) -> io::Result<()>,
) -> io::Result<Timing> {
    let mut timing = Timing::default();
    let mut last = None;
    let mut ended_s = None;
    let mut period = 0u64;
    loop {
        let planned_s = period as f64 * CONTROL_S;
        std::thread::sleep(Duration::from_secs_f64((planned_s - begun.elapsed().as_secs_f64()).max(0.0)));
        let woke_s = begun.elapsed().as_secs_f64();
        while let Ok((at, bytes, length)) = arrived.try_recv() {
            live.receive(&bytes[..length], at.duration_since(begun).as_secs_f64());
        }
        let answer = live.tick(woke_s, key() || woke_s > most_s);
        match send(&answer.bytes()) {
            // Nobody listens yet, or no more: on this machine the system says so.
            Err(error) if error.kind() != ErrorKind::ConnectionRefused => return Err(error),
            _ => {}
        }
        let sent_s = begun.elapsed().as_secs_f64();
        timing.wake.add(woke_s - planned_s);
        timing.answer.add(sent_s - woke_s);
        // Periods that are over are left out: an answer to the past helps nobody.
        let next = (sent_s / CONTROL_S) as u64 + 1;
        timing.missed += next - (period + 1).min(next);
        period = next.max(period + 1);
        let now = (answer.phase, answer.reason);
        if last != Some(now) {
            told(now.0, now.1);
            last = Some(now);
        }
        if answer.phase == Phase::Ended && sent_s - *ended_s.get_or_insert(sent_s) > FAREWELL_S {
            return Ok(timing);
        }
    }
}
