//! A vehicle under a flight controller, motor by motor: a rate loop, a mixer that moves the collective with what the
//! rates ask for, a throttle boost, and a compensation of the voltage. Its log has what each motor was sent, and if
//! wanted how fast each rotor turned. Nothing of it is a first-order lag of the collective command.

use super::CONTROL_S;
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};
use racer::flight::pilot::{Pilot, PilotLimits, Seen};
use racer::flight::{Log, VehicleRecord, motors};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

/// Steps of 0.25 ms; the controller runs in every fourth.
const STEP_S: f64 = 0.25e-3;
const EVERY: usize = 4;
const GRAVITY: f64 = 9.80665;
/// Front right, rear right, front left, rear left: roll to the left lifts the right... each row roll, pitch, yaw.
const MIXER: [[f64; 3]; 4] = [[-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0]];

/// A quadrotor and its controller.
#[derive(Clone, Debug)]
pub struct Controlled {
    pub mass: f64,
    /// N s2/rad2 of one rotor, and its speed at full output and full pack, rad/s.
    pub thrust_per_square: f64,
    pub full_speed: f64,
    /// Lag of a rotor, s.
    pub rotor_lag: f64,
    /// Angular acceleration per newton of difference, rad/s2/N: roll, pitch, yaw.
    pub authority: [f64; 3],
    /// Quadratic drag along each axis over mass, 1/m.
    pub drag: [f64; 3],
    pub full_v: f64,
    pub rate_v_s: f64,
    /// Rates of a full stick, rad/s.
    pub full_rate: [f64; 3],
    /// Output of a motor that is sent nothing.
    pub idle: f64,
    /// Share of the throttle's change that is added for a moment.
    pub boost: f64,
    /// Whether outputs grow as the voltage falls.
    pub compensates: bool,
    /// Whether outputs are the root of what is asked for, so that thrust is in proportion to it.
    pub linearises: bool,
}

impl Controlled {
    pub fn racer() -> Self {
        Controlled {
            mass: 0.68,
            thrust_per_square: 1.35e-6,
            full_speed: 2600.0,
            rotor_lag: 0.032,
            authority: [55.0, 45.0, 9.0],
            drag: [0.03, 0.035, 0.06],
            full_v: 16.6,
            rate_v_s: -1.6 / 300.0,
            full_rate: [700.0_f64, 700.0, 400.0].map(f64::to_radians),
            idle: 0.055,
            boost: 0.5,
            compensates: true,
            linearises: false,
        }
    }

    /// Output of a motor of which 0 to 1 is asked.
    fn sent(&self, asked: f64) -> f64 {
        let asked = asked.clamp(0.0, 1.0);
        self.idle + (1.0 - self.idle) * if self.linearises { asked.sqrt() } else { asked }
    }

    /// Speed that a rotor goes to, rad/s.
    pub fn speed(&self, motor: f64, volts: f64) -> f64 {
        self.full_speed * volts / self.full_v * (1.2 * motor - 0.2 * motor * motor)
    }

    /// Thrust of all rotors at this output of each in the end, N.
    pub fn thrust(&self, motor: f64, volts: f64) -> f64 {
        4.0 * self.thrust_per_square * self.speed(motor, volts).powi(2)
    }

    /// Output of each motor in the end for a collective command of 0 to 1, without rates.
    pub fn output(&self, command: f64, volts: f64) -> f64 {
        let lifted = if self.compensates { command * self.full_v / volts } else { command };
        self.sent(lifted)
    }

    /// The collective command that carries it, 0 to 1.
    fn hover(&self) -> f64 {
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let lifts = self.thrust(self.output(middle, self.full_v), self.full_v) > self.mass * GRAVITY;
            if lifts { high = middle } else { low = middle }
        }
        low
    }
}

/// What the controller remembers.
#[derive(Default)]
struct Controller {
    gyro: Vector3<f64>,
    slope: Vector3<f64>,
    integral: Vector3<f64>,
    slow: f64,
}

impl Controller {
    /// Motor outputs for rates `wanted` (rad/s) and a collective of 0 to 1.
    fn outputs(&mut self, v: &Controlled, wanted: Vector3<f64>, lift: f64, gyro: Vector3<f64>, volts: f64) -> [f64; 4] {
        let dt = STEP_S * EVERY as f64;
        let before = self.gyro;
        self.gyro += (gyro - self.gyro) * 0.5;
        self.slope += ((self.gyro - before) / dt - self.slope) * 0.3;
        let error = wanted - self.gyro;
        self.integral = (self.integral + error * dt).map(|x| x.clamp(-0.3, 0.3));
        let gains = Vector3::new(0.05, 0.055, 0.12);
        let ask = (error + self.integral * 4.0 - self.slope * 0.006).component_mul(&gains);
        let mix = MIXER.map(|row| Vector3::from(row).dot(&ask));
        let (least, most) = mix.iter().fold((0.0f64, 0.0f64), |(a, b), &x| (a.min(x), b.max(x)));
        let range = (most - least).max(1.0);
        let mix = mix.map(|x| x / range);
        self.slow += (lift - self.slow) * dt / (dt + 0.03);
        let boosted = lift + v.boost * (lift - self.slow);
        let lifted = if v.compensates { boosted * v.full_v / volts } else { boosted };
        // Rates come first: the collective moves until every motor has room for them.
        let collective = lifted.min(1.0 - most / range).max(-least / range);
        mix.map(|x| v.sent(collective + x))
    }
}

/// Where everything is.
struct Craft {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    rates: Vector3<f64>,
    rotors: Vector4<f64>,
    resting: bool,
}

impl Craft {
    fn thrusts(&self, v: &Controlled) -> Vector4<f64> {
        self.rotors.map(|w| v.thrust_per_square * w * w)
    }

    /// Specific force in the body, m/s2.
    fn force(&self, v: &Controlled) -> Vector3<f64> {
        if self.resting {
            return Vector3::new(0.0, 0.0, GRAVITY);
        }
        let air = self.attitude.inverse() * self.velocity;
        let damping = Vector3::from(v.drag).component_mul(&air).norm();
        Vector3::new(0.0, 0.0, self.thrusts(v).sum() / v.mass) - air * damping
    }

    fn step(&mut self, v: &Controlled, motors: &[f64; 4], volts: f64) {
        for (w, &m) in self.rotors.iter_mut().zip(motors) {
            *w += (v.speed(m, volts) - *w) * (1.0 - (-STEP_S / v.rotor_lag).exp());
        }
        let thrusts = self.thrusts(v);
        if self.resting && thrusts.sum() < v.mass * GRAVITY {
            return;
        }
        self.resting = false;
        let turning = Vector3::from_fn(|k, _| v.authority[k] * (0..4).map(|m| MIXER[m][k] * thrusts[m]).sum::<f64>());
        self.rates += (turning - self.rates * 0.5) * STEP_S;
        self.attitude *= UnitQuaternion::from_scaled_axis(self.rates * STEP_S);
        let pushed = self.attitude * self.force(v) - Vector3::new(0.0, 0.0, GRAVITY);
        self.position += self.velocity * STEP_S + pushed * (0.5 * STEP_S * STEP_S);
        self.velocity += pushed * STEP_S;
        if self.position.z < 0.0 {
            let (_, _, yaw) = self.attitude.euler_angles();
            self.attitude =
                UnitQuaternion::from_quaternion(Quaternion::new((0.5 * yaw).cos(), 0.0, 0.0, (0.5 * yaw).sin()));
            (self.position.z, self.velocity, self.rates, self.resting) =
                (0.0, Vector3::zeros(), Vector3::zeros(), true);
        }
    }
}

/// The excitation pilot flies `vehicle` for `seconds`; its log has rotor speeds where `speeds` says so.
pub fn fly(vehicle: &Controlled, seed: u64, seconds: f64, speeds: bool) -> Log {
    let mut rng = StdRng::seed_from_u64(seed ^ 0xc047);
    let mut log = Log { name: format!("controlled {seed}"), start_ns: 1_700_000_000_000_000_000, ..Log::default() };
    let (mass_kg, max_rate_rad_s) = (Some(vehicle.mass), Some(vehicle.full_rate));
    log.vehicle = VehicleRecord { mass_kg, max_rate_rad_s, ..VehicleRecord::default() };
    let hover_command = 2.0 * vehicle.hover() - 1.0;
    let limits = PilotLimits { max_rate_rad_s: vehicle.full_rate, hover_command, seconds, empty_v: 0.0 };
    let mut pilot = Pilot::new(seed, limits);
    let mut controller = Controller::default();
    let mut craft = Craft {
        position: Vector3::zeros(),
        velocity: Vector3::zeros(),
        attitude: UnitQuaternion::identity(),
        rates: Vector3::zeros(),
        rotors: Vector4::zeros(),
        resting: true,
    };
    let mut outputs = [vehicle.idle; 4];
    let per_control = (CONTROL_S / STEP_S).round() as usize;
    for control in 0..(seconds / CONTROL_S).round() as usize {
        let time = control as f64 * CONTROL_S;
        let voltage = vehicle.full_v + vehicle.rate_v_s * time;
        let q = craft.attitude.quaternion();
        let [position, velocity, rates] = [craft.position, craft.velocity, craft.rates].map(Into::into);
        let attitude = [q.w, q.i, q.j, q.k];
        let command = pilot.command(&Seen { time_s: time, position, velocity, attitude, rates, voltage });
        let wanted = Vector3::from_fn(|k, _| command[k] * vehicle.full_rate[k]);
        let lift = 0.5 + 0.5 * command[3];
        log.setpoint.push(time, [wanted.x, wanted.y, wanted.z, lift]);
        for k in 0..per_control {
            let now = time + k as f64 * STEP_S;
            if k % EVERY == 0 {
                if craft.resting {
                    controller = Controller::default();
                }
                let volts = vehicle.full_v + vehicle.rate_v_s * now;
                outputs = controller.outputs(vehicle, wanted, lift, craft.rates, volts);
                log.motors.push(now, motors::row(&outputs));
                let mut noisy = |x: Vector3<f64>, sd: f64| x.map(|x| x + sd * rng.sample::<f64, _>(StandardNormal));
                let (gyro, force) = (noisy(craft.rates, 0.03), noisy(craft.force(vehicle), 0.4));
                log.imu.push(now, [gyro.x, gyro.y, gyro.z, force.x, force.y, force.z]);
                if speeds {
                    log.rotors.push(now, motors::row(craft.rotors.as_slice()));
                }
            }
            craft.step(vehicle, &outputs, voltage);
        }
        let mut noise = |sd: f64| sd * rng.sample::<f64, _>(StandardNormal);
        if control % 5 == 0 {
            log.battery.push(time, [voltage + noise(0.02), f64::NAN]);
        }
        let v = craft.attitude.inverse() * craft.velocity;
        let q = craft.attitude * UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| noise(0.003)));
        let p = craft.position.map(|x| x + noise(0.02));
        let v = v.map(|x| x + noise(0.03));
        // The state after this control step.
        log.odometry.push(time + CONTROL_S, [p.x, p.y, p.z, q.w, q.i, q.j, q.k, v.x, v.y, v.z]);
    }
    log
}
