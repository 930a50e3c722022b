//! A flight on the ground: a real flight controller's firmware, as its own simulator build, closes the rate loop of a
//! simulated vehicle.
//!
//! sticks -> firmware ([`betaflight`], [`firmware`]) -> motors -> [`plant`] -> sensors -> firmware, in steps of a
//! millisecond by a common [`clock`]. `docs/flying.md` says how to build the firmware.

pub mod airframe;
pub mod betaflight;
pub mod clock;
pub mod firmware;
pub mod flown;
pub mod plant;

use crate::base::error::{Error, Result};
use crate::flight::instruments::{Actual, Instruments};
use crate::flight::{Log, VehicleKind, VehicleRecord, motors};
use crate::model::constants::CONTROL_S;
use betaflight::{MOTORS_BYTES, MOTORS_PORT, STATE_PORT, STICKS_PORT, Sticks};
use clock::SharedClock;
use plant::Plant;
use std::net::UdpSocket;

/// Step of plant, gyro and firmware, s.
pub const STEP_S: f64 = 0.001;

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
pub struct FirmwareWire {
    out: UdpSocket,
    motors: UdpSocket,
    ports: Ports,
    pub clock: SharedClock,
}

impl FirmwareWire {
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
        std::iter::from_fn(|| self.motors.recv(&mut bytes).ok().map(|n| betaflight::motors(&bytes[..n]))).last()?
    }
}

/// A vehicle whose motors the firmware commands, and the log of its flight.
#[derive(Debug)]
pub struct Rehearsal<'a> {
    pub plant: Plant,
    pub log: Log,
    wire: FirmwareWire,
    instruments: Instruments<'a>,
    /// What each motor is sent, 0..1.
    motors: [f64; 4],
    /// Since the log began.
    steps: u64,
}

impl<'a> Rehearsal<'a> {
    /// At rest; the log is of a vehicle of that mass (kg) whose full command asks for those rates (rad/s).
    pub fn new(
        plant: Plant,
        wire: FirmwareWire,
        instruments: Instruments<'a>,
        mass_kg: f64,
        full_rate: [f64; 3],
    ) -> Self {
        let vehicle = VehicleRecord {
            mass_kg: Some(mass_kg),
            max_rate_rad_s: Some(full_rate),
            kind: Some(VehicleKind::Multirotor),
            rotors: Some(4),
        };
        let log = Log { name: "rehearsal".into(), vehicle, ..Log::default() };
        Self { plant, log, wire, instruments, motors: [0.0; 4], steps: 0 }
    }

    /// Since the log began, s.
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * STEP_S
    }

    /// Steps that began late, and all, by the wall; none in lockstep.
    pub fn late(&self) -> Option<[u64; 2]> {
        self.wire.clock.late()
    }

    /// Waits for the firmware to boot and to calibrate its gyro, arms, and begins the log.
    pub fn arm(&mut self) -> Result<()> {
        self.wire.clock.begin()?;
        for _ in 0..300 {
            self.hold(&Sticks::default())?;
        }
        for _ in 0..100 {
            self.hold(&Sticks { armed: true, ..Sticks::default() })?;
        }
        if self.motors.iter().all(|share| *share <= 0.0) {
            let advice = "its settings may ask for more; look at `status` of its command line";
            return Err(Error::Failed(format!("the firmware does not arm: no motor turns; {advice}")));
        }
        self.steps = 0;
        self.log = Log { name: self.log.name.clone(), vehicle: self.log.vehicle, ..Log::default() };
        self.log.states.push(0.0, [1.0, 0.0]);
        Ok(())
    }

    /// A control period with the sticks held there.
    pub fn hold(&mut self, sticks: &Sticks) -> Result<()> {
        self.wire.send(&sticks.bytes(), self.wire.ports.sticks);
        self.wire.clock.after_sticks()?;
        for _ in 0..(CONTROL_S / STEP_S).round() as usize {
            self.step()?;
        }
        Ok(())
    }

    /// The firmware sees the vehicle as it is now; what it sends the motors then acts from the next step on.
    fn step(&mut self) -> Result<()> {
        let (time_s, rested) = (self.time_s(), self.plant.resting);
        let actual = self.plant.actual();
        let before = self.log.imu.len();
        let imu = self.instruments.read(time_s, &actual, &mut self.log);
        if self.log.imu.len() > before {
            self.log.motors.push(time_s, motors::row(&self.motors));
        }
        self.wire.send(&betaflight::state(&actual, &imu), self.wire.ports.state);
        self.wire.clock.after_step()?;
        self.plant.step(self.motors);
        self.motors = self.wire.newest().unwrap_or(self.motors);
        self.steps += 1;
        if rested != self.plant.resting {
            self.log.states.push(self.time_s(), [1.0, if rested { 1.0 } else { 0.0 }]);
        }
        Ok(())
    }

    /// What there is to see of the vehicle.
    pub fn actual(&self) -> Actual {
        self.plant.actual()
    }
}
