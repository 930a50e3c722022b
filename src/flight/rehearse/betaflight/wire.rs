//! The way to Betaflight: three UDP ports that cannot be changed, and a common clock.

use super::super::clock::SharedClock;
use super::super::sticks::Sticks;
use super::super::wire::FirmwareWire;
use super::{MOTORS_BYTES, MOTORS_PORT, STATE_PORT, STICKS_PORT};
use crate::base::error::{Error, Result};
use crate::flight::instruments::Actual;
use std::net::UdpSocket;

/// Where a firmware listens and sends, on this machine.
#[derive(Clone, Copy, Debug)]
pub struct Ports {
    pub state: u16,
    pub sticks: u16,
    pub motors: u16,
}

impl Ports {
    /// Betaflight's, which cannot be changed.
    pub const BETAFLIGHT: Ports = Ports { state: STATE_PORT, sticks: STICKS_PORT, motors: MOTORS_PORT };
}

/// Sockets to a firmware, and a common clock.
#[derive(Debug)]
pub struct BetaflightWire {
    out: UdpSocket,
    motors: UdpSocket,
    ports: Ports,
    pub clock: SharedClock,
}

impl BetaflightWire {
    /// Takes the ports. Fails where another simulator has them.
    pub fn new(ports: Ports, clock: SharedClock) -> Result<Self> {
        let bind = |port: u16| {
            UdpSocket::bind(("127.0.0.1", port)).map_err(|error| {
                Error::Failed(format!("UDP port {port}: {error}; end the other simulator or firmware that has it"))
            })
        };
        // Firmwares share their ports without a word, and then each gets some of the packets.
        if ports.state == STATE_PORT {
            [ports.state, ports.sticks].into_iter().try_for_each(|port| bind(port).map(drop))?;
        }
        let (out, motors) = (bind(0)?, bind(ports.motors)?);
        motors.set_nonblocking(true).map_err(|error| Error::Failed(error.to_string()))?;
        Ok(Self { out, motors, ports, clock })
    }

    fn send(&self, bytes: &[u8], port: u16) {
        // A firmware that is gone shows in its silence.
        let _ = self.out.send_to(bytes, ("127.0.0.1", port));
    }

    /// The newest motors that have arrived.
    fn newest(&self) -> Option<[f64; 4]> {
        let mut bytes = [0; MOTORS_BYTES + 1];
        std::iter::from_fn(|| self.motors.recv(&mut bytes).ok().map(|n| super::motors(&bytes[..n]))).last()?
    }
}

impl FirmwareWire for BetaflightWire {
    fn full_rates(&self, wanted: [f64; 3]) -> [f64; 3] {
        super::full_rates(wanted)
    }

    fn patience(&self) -> [usize; 2] {
        // It calibrates its gyro for some of the first three seconds.
        [300, 100]
    }

    fn begin(&mut self) -> Result<()> {
        self.clock.begin()
    }

    fn hold(&mut self, sticks: &Sticks) -> Result<()> {
        self.send(&super::sticks(sticks), self.ports.sticks);
        self.clock.after_sticks()
    }

    fn step(&mut self, now: &Actual, imu: &[f64; 6]) -> Result<Option<[f64; 4]>> {
        self.send(&super::state(now, imu), self.ports.state);
        self.clock.after_step()?;
        Ok(self.newest())
    }

    fn late(&self) -> Option<[u64; 2]> {
        self.clock.late()
    }
}
