//! The parameters that ArduPilot flies a rehearsal with: what racer needs, and what it begins with where the user has
//! none.

use super::gains::RateGains;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Over the user's: how it is flown and by what, and what a simulator has no sense of. `SYSID_MYGCS` and `ARMING_CHECK`
/// are older names; a name that a version does not have is nothing to it.
const SET: &str = "\
FRAME_CLASS 1
FRAME_TYPE 1
SERVO1_FUNCTION 33
SERVO2_FUNCTION 34
SERVO3_FUNCTION 35
SERVO4_FUNCTION 36
MOT_PWM_TYPE 0
MOT_PWM_MIN 1000
MOT_PWM_MAX 2000
INITIAL_MODE 1
FLTMODE_CH 0
ACRO_TRAINER 0
ACRO_RP_EXPO 0
ACRO_Y_EXPO 0
ACRO_RP_RATE_TC 0
ACRO_Y_RATE_TC 0
ACRO_THR_MID 0.5
PILOT_THR_FILT 0
RC_OPTIONS 0
MAV_GCS_SYSID 255
SYSID_MYGCS 255
RCMAP_ROLL 1
RCMAP_PITCH 2
RCMAP_THROTTLE 3
RCMAP_YAW 4
ARMING_SKIPCHK -1
ARMING_CHECK 0
DISARM_DELAY 0
FS_THR_ENABLE 0
FS_GCS_ENABLE 0
FS_EKF_ACTION 0
FS_CRASH_CHECK 0
FS_VIBE_ENABLE 0
FS_DR_ENABLE 0
FENCE_ENABLE 0
AHRS_EKF_TYPE 10
EK2_ENABLE 0
EK3_ENABLE 0
COMPASS_ENABLE 1
INS_GYR_CAL 1
SIM_IMU_COUNT 1
LOG_DISARMED 0
LOG_FILE_DSRMROT 1
";

/// Under the user's: a rate loop as fast as the gyro's samples here, with all authority over the throttle, that takes
/// steps of the setpoint, and motors that follow the throttle straight from a slow idle.
const BEGIN: &str = "\
SCHED_LOOP_RATE 1000
INS_GYRO_FILTER 200
ACRO_OPTIONS 3
ATC_ACCEL_R_MAX 0
ATC_ACCEL_P_MAX 0
ATC_ACCEL_Y_MAX 0
ATC_THR_MIX_MAN 4
MOT_SPIN_ARM 0.04
MOT_SPIN_MIN 0.05
MOT_SPIN_MAX 1
MOT_THST_EXPO 0
MOT_THST_HOVER 0.25
MOT_HOVER_LEARN 0
MOT_SPOOL_TIME 0.1
";

/// A line of a parameter file.
#[derive(Debug, PartialEq)]
struct ParameterLine<'a> {
    name: &'a str,
    line: &'a str,
}

fn parameters(text: &str) -> impl Iterator<Item = ParameterLine<'_>> {
    text.lines().filter_map(|line| {
        let name = line.split([',', ' ', '=', '\t']).find(|part| !part.is_empty())?.trim();
        let is_name = name.starts_with(|c: char| c.is_ascii_uppercase());
        (is_name && !name.contains('#')).then_some(ParameterLine { name, line: line.trim_end() })
    })
}

/// The parameter file for a firmware whose full sticks are to be the rates `full` (rad/s), as
/// [`full_rates`](super::full_rates) has them. `user` are the user's own parameters, whose lines count but for those
/// that racer has to set; without them it begins with `gains`. `log` asks for its own log.
pub fn file(full: [f64; 3], user: Option<&str>, gains: [RateGains; 3], log: bool) -> String {
    let mut set = String::from(SET);
    let [tilt, _, yaw] = full.map(|rate| rate.to_degrees().round());
    let _ = write!(set, "ACRO_RP_RATE {tilt}\nACRO_Y_RATE {yaw}\nLOG_BACKEND_TYPE {}\n", i32::from(log));
    for channel in 1..=16 {
        // Arms.
        let option = if channel == 6 { 153 } else { 0 };
        let trim = if channel == 3 { 1000 } else { 1500 };
        let _ = write!(set, "RC{channel}_MIN 1000\nRC{channel}_TRIM {trim}\nRC{channel}_MAX 2000\n");
        let _ = write!(set, "RC{channel}_DZ 0\nRC{channel}_REVERSED 0\nRC{channel}_OPTION {option}\n");
    }
    let begin = user.map_or_else(|| beginning(gains), str::to_string);
    let names: BTreeSet<&str> = parameters(&set).map(|parameter| parameter.name).collect();
    let own = parameters(&begin).filter(|parameter| !names.contains(parameter.name));
    let own: String = own.flat_map(|parameter| [parameter.line, "\n"]).collect();
    own + &set
}

fn beginning(gains: [RateGains; 3]) -> String {
    let mut out = String::from(BEGIN);
    for (axis, RateGains { p, i, d }) in ["RLL", "PIT", "YAW"].into_iter().zip(gains) {
        let _ = write!(out, "ATC_RAT_{axis}_P {p:.6}\nATC_RAT_{axis}_I {i:.6}\nATC_RAT_{axis}_D {d:.6}\n");
        let _ = write!(out, "ATC_RAT_{axis}_FLTT 0\nATC_RAT_{axis}_FLTE 0\nATC_RAT_{axis}_FLTD 120\n");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAINS: [RateGains; 3] = [RateGains { p: 0.125, i: 0.25, d: 0.0625 }; 3];

    #[test]
    fn a_users_parameters_count_but_for_what_racer_has_to_set() {
        let user = "# a comment\nATC_RAT_RLL_P,0.07\nFRAME_TYPE  12\nRC6_OPTION=31\n\nMOT_SPIN_MIN\t0.1\r\n";
        let text = file([15.0, 15.0, 2.0], Some(user), GAINS, true);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..2], ["ATC_RAT_RLL_P,0.07", "MOT_SPIN_MIN\t0.1"]);
        assert!(lines.contains(&"FRAME_TYPE 1") && lines.contains(&"RC6_OPTION 153"), "{text}");
        assert!(!text.contains("12\n") && !text.contains("INS_GYRO_FILTER"), "{text}");
        assert!(lines.contains(&"ACRO_RP_RATE 859") && lines.contains(&"ACRO_Y_RATE 115"), "{text}");
        assert!(lines.contains(&"LOG_BACKEND_TYPE 1"));
    }

    #[test]
    fn without_them_it_begins_with_the_vehicles_gains_and_names_nothing_twice() {
        let text = file([15.0, 15.0, 2.0], None, GAINS, false);
        assert!(text.contains("ATC_RAT_YAW_P 0.125000\n") && text.contains("LOG_BACKEND_TYPE 0\n"), "{text}");
        let names: Vec<&str> = parameters(&text).map(|parameter| parameter.name).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        assert!(names.iter().all(|name| name.len() <= 16), "the firmware knows no longer names");
    }
}
