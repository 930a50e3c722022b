//! The way to ArduPilot: servo outputs and states on one socket, in lockstep, and MAVLink on another.

use super::super::STEP_S;
use super::super::sticks::Sticks;
use super::super::wire::FirmwareWire;
use super::SERVO_BYTES;
use super::link::StickLink;
use crate::base::error::{Error, Result};
use crate::flight::instruments::Actual;
use std::io::ErrorKind;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

/// Longest wait for an answer, s.
const ANSWER_S: f64 = 10.0;
/// How long it may take before it is looked whether it still runs, s.
const PROBE_S: f64 = 0.5;
/// Steps of a control period. The firmware looks at its serial ports when more than 10 ms have gone by; a microsecond
/// more in each period lets it look once in every, right after sticks were sent.
const PERIOD: u64 = 10;

/// Sockets to a firmware. Racer's ports are whichever are free.
#[derive(Debug)]
pub struct ArduPilotWire {
    physics: UdpSocket,
    link: StickLink,
    longest: Duration,
    /// Number of the last servo packet; none before the first.
    frame: Option<u32>,
    /// States that were sent.
    steps: u64,
    /// The step at which it said that it has booted.
    booted: Option<u64>,
}

/// Steps from there until it can be armed.
const SETTLE: u64 = 3000;

impl ArduPilotWire {
    /// Takes two ports. Fails where there are none.
    pub fn new() -> Result<Self> {
        Self::within(ANSWER_S)
    }

    /// The same with another longest wait, s.
    pub fn within(longest_s: f64) -> Result<Self> {
        let failed = |error: std::io::Error| Error::Failed(format!("no UDP port for the firmware: {error}"));
        let physics = UdpSocket::bind(("127.0.0.1", 0)).map_err(failed)?;
        let link = StickLink::new()?;
        let longest = Duration::from_secs_f64(longest_s);
        Ok(Self { physics, link, longest, frame: None, steps: 0, booted: None })
    }

    /// Where it listens for servo outputs, and for MAVLink.
    pub fn ports(&self) -> [u16; 2] {
        [self.physics.local_addr().map_or(0, |address| address.port()), self.link.port()]
    }

    /// Waits at most so long for the first servo packet: whether it is there.
    pub fn spoke_within(&mut self, wait: Duration) -> Result<bool> {
        let mut bytes = [0; SERVO_BYTES];
        let end = Instant::now() + wait;
        while self.frame.is_none() && Instant::now() < end {
            self.wait_for(end - Instant::now())?;
            let Ok((length, from)) = self.physics.recv_from(&mut bytes) else { continue };
            let Some((frame, _)) = super::motors(&bytes[..length]) else { continue };
            // From now on its end shows in errors, too.
            self.physics.connect(from).map_err(|error| Error::Failed(format!("the firmware's port: {error}")))?;
            self.frame = Some(frame);
        }
        Ok(self.frame.is_some())
    }

    fn wait_for(&self, wait: Duration) -> Result<()> {
        let wait = Some(wait.max(Duration::from_millis(1)));
        self.physics.set_read_timeout(wait).map_err(|error| Error::Failed(error.to_string()))
    }

    /// The servo packet that answers a state. One that comes a second time was sent because the state was late.
    fn outputs(&mut self) -> Result<[f64; 4]> {
        let mut bytes = [0; SERVO_BYTES];
        let end = Instant::now() + self.longest;
        self.wait_for(self.longest.min(Duration::from_secs_f64(PROBE_S)))?;
        while Instant::now() < end {
            let length = match self.physics.recv(&mut bytes) {
                Ok(length) => length,
                Err(error) if error.kind() == ErrorKind::ConnectionRefused => {
                    return Err(Error::Failed(format!("the firmware is gone: {error}")));
                }
                Err(_) => {
                    // It takes no notice of nothing; where it is gone, the system answers.
                    let _ = self.physics.send(&[]);
                    continue;
                }
            };
            match (super::motors(&bytes[..length]), self.frame) {
                (Some((frame, _)), Some(last)) if frame == last => {}
                (Some((frame, motors)), _) => {
                    self.frame = Some(frame);
                    return Ok(motors);
                }
                (None, _) => {}
            }
        }
        let waited = self.longest.as_secs_f64();
        Err(Error::Failed(format!("the firmware does not answer a state: no servo outputs within {waited} s")))
    }
}

impl FirmwareWire for ArduPilotWire {
    fn full_rates(&self, wanted: [f64; 3]) -> [f64; 3] {
        super::full_rates(wanted)
    }

    fn patience(&self) -> [usize; 2] {
        // It looks for its gyro's offset for up to 30 s, and lets motors turn two after it was armed.
        [4500, 300]
    }

    fn ready(&self) -> bool {
        self.booted.is_some_and(|at| self.steps > at + SETTLE)
    }

    fn begin(&mut self) -> Result<()> {
        let waited = self.longest.as_secs_f64();
        match self.spoke_within(self.longest)? {
            true => Ok(()),
            false => Err(Error::Failed(format!("the firmware does not speak: no servo outputs within {waited} s"))),
        }
    }

    fn hold(&mut self, sticks: &Sticks) -> Result<()> {
        self.link.listen();
        if self.link.booted && self.booted.is_none() {
            self.booted = Some(self.steps);
        }
        self.link.send(sticks);
        Ok(())
    }

    fn step(&mut self, now: &Actual, imu: &[f64; 6]) -> Result<Option<[f64; 4]>> {
        self.steps += 1;
        // It cuts differences to whole microseconds: a nanosecond more in each step keeps them whole.
        let whole = self.steps as f64 * (STEP_S + 1e-9);
        let time_s = whole + ((self.steps - 1) / PERIOD) as f64 * 1e-6;
        // A firmware that is gone shows in its silence.
        let _ = self.physics.send(super::state(time_s, now, imu).as_bytes());
        self.outputs().map(Some)
    }

    fn said(&self) -> Option<String> {
        self.link.said.clone()
    }
}
