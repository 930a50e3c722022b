//! What the model says that sensors of the flights should have read, by the simulator's own equations, and what is left
//! of what they did read. Numbers of the model and channels of the measurement are laid out here.

pub mod actuator_response;
pub mod bends;
pub mod channels;
pub mod contrast;
pub mod forms;
pub mod horizon;
pub mod imu_seen;
pub mod kinematics;
pub mod measured;
pub mod model;
pub mod motors;
pub mod numbers;
pub mod predict;
pub mod problem;
pub mod record;
pub mod signals;
