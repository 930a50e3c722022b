//! Whether a track can be raced on.

use super::{Gate, GateKind, Pose, Section, Track, Volume};
use crate::base::check::{Check, Invalid};

/// Consecutive gates closer than this in every way are the same gate twice, m.
const SAME_M: f64 = 1e-3;

impl Check for Track {
    fn check(&self) -> Result<(), Invalid> {
        Invalid::unless(!self.name.is_empty(), "name", "nothing", "a name", "")?;
        self.volume.check().map_err(|invalid| invalid.within("volume"))?;
        self.start.check().map_err(|invalid| invalid.within("start"))?;
        let inside = self.volume.contains(&self.start.position());
        let found = format!("{:?}", self.start.position_m);
        Invalid::unless(inside, "start.position_m", found, "a place in the volume", "move it, or widen the volume")?;
        Invalid::unless(self.gates.len() >= 2, "gates", self.gates.len(), "at least 2 gates", "add [[gates]]")?;
        for (index, gate) in self.gates.iter().enumerate() {
            let next = &self.gates[(index + 1) % self.gates.len()];
            let passable = gate.check().and_then(|()| passable(gate, next, &self.volume));
            passable.map_err(|invalid| invalid.within(&format!("gates[{index}]")))?;
        }
        for (index, section) in self.sections.iter().enumerate() {
            let checked = check_section(section, self.gates.len());
            checked.map_err(|invalid| invalid.within(&format!("sections[{index}]")))?;
        }
        Ok(())
    }
}

impl Check for Pose {
    fn check(&self) -> Result<(), Invalid> {
        finite("position_m", &self.position_m)?;
        finite("heading_deg", &[self.heading_deg])
    }
}

impl Check for Volume {
    fn check(&self) -> Result<(), Invalid> {
        finite("min_m", &self.min_m)?;
        finite("max_m", &self.max_m)?;
        let ordered = (0..3).all(|axis| self.min_m[axis] < self.max_m[axis]);
        let found = format!("{:?}", self.max_m);
        Invalid::unless(ordered, "max_m", found, &format!("more than min_m = {:?}", self.min_m), "")
    }
}

impl Check for Gate {
    fn check(&self) -> Result<(), Invalid> {
        finite("position_m", &self.position_m)?;
        finite("heading_deg", &[self.heading_deg])?;
        let pitch = self.pitch_deg;
        Invalid::unless((-90.0..=90.0).contains(&pitch), "pitch_deg", pitch, "-90 to 90 degrees", "")?;
        let advice = "a gate of no width cannot be passed";
        Invalid::unless_positive("radius_m", self.radius_m, advice)?;
        match self.outer_m {
            Some(outer) => Invalid::unless_positive("outer_m", outer, ""),
            None => Ok(()),
        }
    }
}

/// Whether a vehicle that must stay in the volume can fly through the gate, and then through the next one.
fn passable(gate: &Gate, next: &Gate, volume: &Volume) -> Result<(), Invalid> {
    let found = format!("{:?}", gate.position_m);
    let advice = "it cannot be passed there; move it, or widen the volume";
    Invalid::unless(volume.contains(&gate.position()), "position_m", &found, "a place in the volume", advice)?;
    // A virtual gate may reach into the floor: only its upper part is used, and nothing stands there.
    if gate.kind == GateKind::Physical {
        let (centre, reach) = (gate.position(), gate.reach());
        let fits = volume.contains(&(centre - reach)) && volume.contains(&(centre + reach));
        let expected = format!("an aperture of radius {} m that lies in the volume", gate.radius_m);
        let advice = "it cannot be passed where it leaves the volume; move it, narrow it, or widen the volume";
        Invalid::unless(fits, "position_m", &found, &expected, advice)?;
    }
    let apart = (gate.position() - next.position()).norm() > SAME_M;
    Invalid::unless(apart, "position_m", &found, "a place apart from the next gate's", "remove one of the two")
}

fn check_section(section: &Section, gates: usize) -> Result<(), Invalid> {
    Invalid::unless(!section.name.is_empty(), "name", "nothing", "a name", "")?;
    Invalid::unless(!section.gates.is_empty(), "gates", "none", "at least one gate", "")?;
    match section.gates.iter().position(|&gate| gate >= gates) {
        Some(bad) => {
            let expected = format!("a gate, 0 to {}", gates - 1);
            Err(Invalid::new(&format!("gates[{bad}]"), section.gates[bad], &expected, "gates are counted from 0"))
        }
        None => Ok(()),
    }
}

fn finite(key: &str, values: &[f64]) -> Result<(), Invalid> {
    Invalid::unless(values.iter().all(|value| value.is_finite()), key, format!("{values:?}"), "finite numbers", "")
}
