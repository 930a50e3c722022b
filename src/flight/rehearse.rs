//! A flight on the ground: a real flight controller's firmware, as its own simulator build, closes the rate loop of a
//! simulated vehicle.
//!
//! sticks -> firmware ([`betaflight`] or [`ardupilot`], a process: [`firmware`]) -> motors -> [`plant`] -> sensors ->
//! firmware, in steps of a millisecond. What differs between firmwares is behind a [`wire`]. `docs/flying.md` says how
//! to build them.

pub mod airframe;
pub mod ardupilot;
pub mod betaflight;
pub mod clock;
pub mod firmware;
pub mod flown;
pub mod plant;
pub mod sticks;
pub mod wire;

use crate::base::error::{Error, Result};
use crate::flight::instruments::{Actual, Instruments};
use crate::flight::{Log, VehicleKind, VehicleRecord, motors};
use crate::model::constants::CONTROL_S;
use plant::Plant;
use sticks::Sticks;
use wire::FirmwareWire;

/// Step of plant, gyro and firmware, s.
pub const STEP_S: f64 = 0.001;

/// A vehicle whose motors the firmware commands, and the log of its flight.
#[derive(Debug)]
pub struct Rehearsal<'a> {
    pub plant: Plant,
    pub log: Log,
    wire: Box<dyn FirmwareWire>,
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
        wire: Box<dyn FirmwareWire>,
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

    /// Body rates of full sticks, rad/s, of a firmware that was set up for at least `wanted`.
    pub fn full_rates(&self, wanted: [f64; 3]) -> [f64; 3] {
        self.wire.full_rates(wanted)
    }

    /// Steps that began late, and all, by the wall; none in lockstep.
    pub fn late(&self) -> Option<[u64; 2]> {
        self.wire.late()
    }

    /// Waits for the firmware to boot and to calibrate its gyro, arms, and begins the log.
    pub fn arm(&mut self) -> Result<()> {
        self.wire.begin()?;
        let [resting, armed] = self.wire.patience();
        for _ in 0..resting {
            self.hold(&Sticks::default())?;
            if self.wire.ready() {
                break;
            }
        }
        for _ in 0..armed {
            self.hold(&Sticks { armed: true, ..Sticks::default() })?;
        }
        if self.motors.iter().all(|share| *share <= 0.0) {
            let why = self.wire.said().map_or(String::new(), |said| format!("; it said last: {said}"));
            return Err(Error::Failed(format!("the firmware does not arm: no motor turns{why}; look at its settings")));
        }
        self.steps = 0;
        self.log = Log { name: self.log.name.clone(), vehicle: self.log.vehicle, ..Log::default() };
        self.log.states.push(0.0, [1.0, 0.0]);
        Ok(())
    }

    /// A control period with the sticks held there.
    pub fn hold(&mut self, sticks: &Sticks) -> Result<()> {
        self.wire.hold(sticks)?;
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
        let sent = self.wire.step(&actual, &imu)?;
        self.plant.step(self.motors);
        self.motors = sent.unwrap_or(self.motors);
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
