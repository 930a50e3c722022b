//! All that can be hidden, as the numbers that the equations of motion and the sensors use. Nothing is hidden by
//! default.

use super::Hidden;
use nalgebra::Vector3;

/// A controller of rates and the motors under it.
#[derive(Clone, Copy, Debug)]
pub struct Motors {
    /// Gain of the rate error, 1/s, and of the rate's own change, s.
    pub stiffness: f64,
    pub damping: f64,
    /// Time constant of a motor, s.
    pub lag: f64,
    /// Angular acceleration at full difference between opposite motors, rad/s2.
    pub authority: f64,
}

/// A cell with one resistor-capacitor pair.
#[derive(Clone, Copy, Debug)]
pub struct Circuit {
    /// Volts lost at full load, at once and in the end.
    pub at_once: f64,
    pub later: f64,
    pub tau: f64,
}

/// A mass or a frame that swings, moved by the vehicle's own acceleration.
#[derive(Clone, Copy, Debug)]
pub struct Swing {
    /// Hz, and damping ratio.
    pub frequency: f64,
    pub damping: f64,
    /// Share of the mass that swings along, or m/s2 that full throttle pushes to the side.
    pub share: f64,
    pub push: f64,
}

/// See the module. Names, units and signs are the catalogue's.
#[derive(Clone, Debug, Default)]
pub struct Terms {
    pub rate_delay: f64,
    /// Of yaw alone, on top.
    pub yaw_delay: f64,
    pub thrust_delay: f64,
    pub dropout: f64,
    /// Mean of the exponential part of the delay, s.
    pub jitter: f64,
    /// Half the width of a backlash of the yaw and thrust commands.
    pub yaw_play: f64,
    pub throttle_play: f64,

    /// Natural frequency and damping that replace the lag.
    pub second_order: Option<[f64; 2]>,
    /// The same of yaw alone.
    pub yaw_second_order: Option<[f64; 2]>,
    pub slew: Option<f64>,
    pub yaw_slew: Option<f64>,
    pub expo: f64,
    pub response_voltage: f64,
    pub cross: [f64; 2],
    pub gyroscopic: f64,
    pub yaw_loss: f64,
    pub weak_motor: Vector3<f64>,
    pub motors: Option<Motors>,

    /// Time constants of thrust, up and down.
    pub thrust_lag: Option<[f64; 2]>,
    pub compensation: f64,
    pub throttle_offset: f64,
    pub axial_inflow: f64,
    pub translational_lift: f64,
    pub propwash: f64,
    pub ground_effect: f64,
    pub mixer_room: f64,
    pub mixer_loss: f64,
    pub rate_thrust: f64,
    pub fade: f64,
    /// Loss of thrust by heat, and its time constant, s.
    pub heat: Option<[f64; 2]>,
    pub mass: f64,
    /// Slope of thrust over the flow through the disk.
    pub momentum: f64,

    pub sag: f64,
    pub relaxation: Option<[f64; 2]>,
    pub ocv_curve: f64,
    pub circuit: Option<Circuit>,

    pub axis_drag: f64,
    pub rotor_drag: f64,
    pub blade_drag: f64,
    pub drag_asymmetry: f64,
    pub body_lift: f64,
    pub vertical_drag: f64,
    pub wind: [f64; 2],
    /// Strength and time constant of a force, m/s2, and of moving air, m/s.
    pub gusts: Option<[f64; 2]>,
    pub turbulence: Option<[f64; 2]>,
    pub magnus: f64,
    /// Speed and centre of a fan's air.
    pub fan: Option<[f64; 3]>,
    pub swing: Option<Swing>,
    /// Size and moment of what changes in flight.
    pub thrust_step: Option<[f64; 2]>,
    pub drag_step: Option<[f64; 2]>,

    pub gyro_offset: f64,
    pub skew: f64,
    pub lever: Vector3<f64>,
    /// Rotation vector that measured vectors are turned by.
    pub misalignment: Vector3<f64>,
    /// The same of the accelerometer alone.
    pub accel_misalignment: Vector3<f64>,
    pub accel_bias: Vector3<f64>,
    pub accel_scale: f64,
    pub gyro_bias: Vector3<f64>,
    pub gyro_scale: f64,
    pub velocity_lag: f64,
    /// Lag of an observer of second order, s.
    pub estimator: f64,
    pub rectification: f64,
}

impl Terms {
    pub fn of(hidden: &[Hidden]) -> Self {
        let mut terms = Terms::default();
        for one in hidden {
            terms.add(one);
        }
        terms
    }

    fn add(&mut self, h: &Hidden) {
        let get = |name: &'static str| h.get(name);
        let then = || Some([get("size"), get("then")]);
        let vector = |names: [&'static str; 3]| Vector3::from(names.map(get));
        match h.id.as_str() {
            "rate_delay" => self.rate_delay = get("delay"),
            "yaw_delay" => self.yaw_delay = get("extra"),
            "thrust_delay" => self.thrust_delay = get("delay"),
            "rate_second_order" => self.second_order = Some([get("wn"), get("zeta")]),
            "yaw_second_order" => self.yaw_second_order = Some([get("wn"), get("zeta")]),
            "rate_slew_limit" => self.slew = Some(get("limit")),
            "yaw_slew_limit" => self.yaw_slew = Some(get("limit")),
            "rate_expo" => self.expo = get("e"),
            "response_voltage" => self.response_voltage = get("k"),
            "stream_offset" => self.gyro_offset = get("offset"),
            "clock_skew" => self.skew = get("skew"),
            "command_dropout" => self.dropout = get("probability"),
            "rate_cross_coupling" => self.cross = [get("kxy"), get("kyx")],
            "gyroscopic_coupling" => self.gyroscopic = get("k"),
            "yaw_authority_loss" => self.yaw_loss = get("k"),
            "weak_motor" => self.weak_motor = vector(["sx", "sy", "sz"]) * get("b"),
            "thrust_asymmetric_lag" => self.thrust_lag = Some([get("tau_up"), get("tau_down")]),
            "voltage_sag" => self.sag = get("v_full"),
            "voltage_relaxation" => self.relaxation = Some([get("v_full"), get("tau")]),
            "ocv_curve" => self.ocv_curve = get("k"),
            "voltage_compensation" => self.compensation = get("share"),
            "throttle_offset" => self.throttle_offset = get("u0"),
            "axial_inflow" => self.axial_inflow = get("k"),
            "translational_lift" => self.translational_lift = get("k"),
            "propwash" => self.propwash = get("k"),
            "ground_effect" => self.ground_effect = get("k"),
            "mixer_room" => self.mixer_room = get("k"),
            "mixer_thrust_loss" => self.mixer_loss = get("k"),
            "rate_thrust_coupling" => self.rate_thrust = get("k"),
            "thrust_fade" => self.fade = get("k"),
            "mass_or_density" => self.mass = get("share"),
            "axis_drag" => self.axis_drag = get("share"),
            "rotor_drag" => self.rotor_drag = get("k"),
            "drag_asymmetry" => self.drag_asymmetry = get("k"),
            "body_lift" => self.body_lift = get("k"),
            "vertical_drag" => self.vertical_drag = get("k"),
            "steady_wind" => self.wind = [get("wx"), get("wy")],
            "gusts" => self.gusts = Some([get("sigma"), get("tau")]),
            "imu_lever_arm" => self.lever = vector(["rx", "ry", "rz"]),
            "imu_misalignment" => self.misalignment = vector(["rx", "ry", "rz"]),
            "accel_misalignment" => self.accel_misalignment = vector(["rx", "ry", "rz"]),
            "accel_bias" => self.accel_bias = vector(["x", "y", "z"]),
            "accel_scale" => self.accel_scale = get("scale"),
            "gyro_bias" => self.gyro_bias = vector(["x", "y", "z"]),
            "gyro_scale" => self.gyro_scale = get("scale"),
            "velocity_lag" => self.velocity_lag = get("tau"),
            "vibration_rectification" => self.rectification = get("k"),

            "motor_loop" | "motor_saturation" => {
                let [stiffness, damping] = [get("stiffness"), get("damping")];
                self.motors = Some(Motors { stiffness, damping, lag: get("lag"), authority: get("authority") });
            }
            "momentum_inflow" => self.momentum = get("slope"),
            "blade_drag" => self.blade_drag = get("k"),
            "cell_circuit" => {
                self.circuit = Some(Circuit { at_once: get("at_once"), later: get("later"), tau: get("tau") });
            }
            "jittery_link" => [self.rate_delay, self.jitter] = [get("delay"), get("jitter")],
            "turbulence" => self.turbulence = Some([get("sigma"), get("tau")]),
            "hot_motors" => self.heat = Some([get("loss"), get("tau")]),
            "estimator" => self.estimator = get("lag"),

            "throttle_play" => self.throttle_play = get("size"),
            "yaw_play" => self.yaw_play = get("size"),
            "slung_mass" | "resonance" => {
                let hangs = h.id == "slung_mass";
                let [share, push] = if hangs { [h.size, 0.0] } else { [0.0, h.size] };
                self.swing = Some(Swing { frequency: get("frequency"), damping: get("damping"), share, push });
            }
            "thrust_step" => self.thrust_step = then(),
            "drag_step" => self.drag_step = then(),
            "fan" => self.fan = Some([get("size"), get("x"), get("y")]),
            "magnus" => self.magnus = get("size") * get("sign"),
            unknown => panic!("nothing hides `{unknown}`"),
        }
    }
}
