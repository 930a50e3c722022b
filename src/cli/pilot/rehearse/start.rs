//! Setting up a rehearsal: the firmware that was chosen, and the vehicle on its pad.

use super::super::super::tell;
use super::{Args, ClockKind, Flight, Kind};
use crate::base::check::{BadInput, Check};
use crate::flight::instruments::Instruments;
use crate::flight::rehearse::airframe::Airframe;
use crate::flight::rehearse::ardupilot::process::ARDUPILOT;
use crate::flight::rehearse::ardupilot::wire::ArduPilotWire;
use crate::flight::rehearse::betaflight::process::BETAFLIGHT;
use crate::flight::rehearse::betaflight::wire::{BetaflightWire, Ports};
use crate::flight::rehearse::clock::SharedClock;
use crate::flight::rehearse::firmware::Firmware;
use crate::flight::rehearse::plant::Plant;
use crate::flight::rehearse::wire::FirmwareWire;
use crate::flight::rehearse::{Rehearsal, STEP_S, ardupilot, betaflight};
use std::path::Path;

impl<'a> Flight<'a> {
    /// The firmware, and the vehicle on its pad.
    pub(super) fn begin(&self, position: [f64; 3], heading: f64) -> anyhow::Result<(Rehearsal<'a>, Firmware)> {
        let Args { settings, seed, .. } = self.args;
        let airframe = self.airframe()?;
        let own = settings.as_ref().map(|path| {
            std::fs::read_to_string(path)
                .map_err(|error| BadInput::new(path.display(), error, "settings of the firmware", ""))
        });
        let own = own.transpose()?;
        let (wire, firmware) = match self.args.rehearse.unwrap_or(Kind::Betaflight) {
            Kind::Betaflight => self.betaflight(own.as_deref())?,
            Kind::ArduPilot => self.ardupilot(own.as_deref(), &airframe)?,
        };
        for line in &firmware.refused {
            tell(&format!("the firmware refuses a setting: {line}"));
        }
        let attitude = [(0.5 * heading).cos(), 0.0, 0.0, (0.5 * heading).sin()];
        let plant = Plant::new(self.vehicle, airframe, STEP_S, position, attitude);
        let instruments = Instruments::new(self.sensors, *seed);
        Ok((Rehearsal::new(plant, wire, instruments, self.vehicle.mass_kg, self.full_rate), firmware))
    }

    fn betaflight(&self, own: Option<&str>) -> anyhow::Result<(Box<dyn FirmwareWire>, Firmware)> {
        let clock = match self.args.clock {
            ClockKind::Lockstep => SharedClock::lockstep()?,
            ClockKind::Wall => SharedClock::wall(),
        };
        let path = BETAFLIGHT.find(self.program())?;
        let wire = BetaflightWire::new(Ports::BETAFLIGHT, clock)?;
        let settings = betaflight::settings(self.full_rate);
        let firmware = betaflight::process::start(&path, own.unwrap_or_default(), &settings, &wire.clock)?;
        Ok((Box::new(wire), firmware))
    }

    fn ardupilot(&self, own: Option<&str>, airframe: &Airframe) -> anyhow::Result<(Box<dyn FirmwareWire>, Firmware)> {
        if self.args.clock == ClockKind::Wall {
            let found = "ArduPilot, whose simulator build goes by racer's time";
            return Err(BadInput::new("--clock wall", found, "--clock lockstep", "leave the option out").into());
        }
        let path = ARDUPILOT.find(self.program())?;
        let mut wire = ArduPilotWire::new()?;
        let gains = ardupilot::gains::of(self.vehicle, airframe);
        let full = ardupilot::full_rates(self.full_rate);
        let parameters = ardupilot::parameters::file(full, own, gains, self.args.blackbox.is_some());
        let firmware = ardupilot::process::start(&path, &parameters, &mut wire)?;
        Ok((Box::new(wire), firmware))
    }

    fn program(&self) -> &Path {
        self.args.firmware.as_deref().unwrap_or(Path::new(""))
    }

    /// Derived from the vehicle, but for what was given.
    fn airframe(&self) -> Result<Airframe, BadInput> {
        let mut airframe = Airframe::of(self.vehicle);
        if let Some(inertia) = &self.args.inertia {
            airframe.inertia_kg_m2 = inertia.as_slice().try_into().map_err(|_| {
                BadInput::new("--inertia", format!("{} numbers", inertia.len()), "three, as 0.002,0.002,0.004", "")
            })?;
        }
        airframe.arm_m = self.args.arm_length.unwrap_or(airframe.arm_m);
        airframe.torque_m = self.args.torque.unwrap_or(airframe.torque_m);
        airframe.check().map_err(|invalid| BadInput::at("--inertia, --arm-length, --torque", invalid))?;
        Ok(airframe)
    }
}
