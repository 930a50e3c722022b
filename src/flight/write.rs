//! Logs written in the canonical form: MCAP with ROS 2 messages in CDR and the definitions that any ROS tool reads them
//! by.

pub(super) mod cdr;
pub(super) mod message;
mod topic;

use super::mcap::vehicle;
use super::{Log, Stream, VehicleRecord};
use crate::base::error::{Error, Result};
use ::mcap::records::{MessageHeader, Metadata};
use ::mcap::{Compression, McapError, WriteOptions, Writer};
use cdr::Cdr;
use std::collections::BTreeMap;
use std::io::Cursor;
use topic::CanonicalTopic;

type McapWriter = Writer<Cursor<Vec<u8>>>;

/// The bytes of a canonical MCAP file.
///
/// Messages are in time order over all streams, but each stream keeps its own order. Battery voltage and current and
/// the setpoint's thrust become `f32`. An error if a time is not finite, or before 1970 or after 2038.
pub fn mcap(log: &Log) -> Result<Vec<u8>> {
    let mut file = WriteOptions::new()
        .profile("ros2")
        .library(concat!("racer/", env!("CARGO_PKG_VERSION")))
        .compression(Some(Compression::Zstd))
        .compression_threads(0)
        .create(Cursor::new(Vec::new()))
        .map_err(failed)?;
    // First, so that a file that breaks off still has it.
    if log.vehicle != VehicleRecord::default() {
        file.write_metadata(&metadata(&log.vehicle)).map_err(failed)?;
    }
    let [armed, in_air] = [0, 1].map(|k| said(&log.states, k));
    let mut queues = [
        queue(&mut file, log, topic::SETPOINT, message::BODY, &log.setpoint, message::attitude_target)?,
        queue(&mut file, log, topic::IMU, message::BODY, &log.imu, message::imu)?,
        queue(&mut file, log, topic::ODOMETRY, message::WORLD, &log.odometry, message::odometry)?,
        queue(&mut file, log, topic::BATTERY, message::BODY, &log.battery, message::battery_state)?,
        queue(&mut file, log, topic::ROTORS, message::BODY, &log.rotors, message::joint_state(log.rotors.count()))?,
        queue(&mut file, log, topic::MOTORS, message::BODY, &log.motors, message::actuators(log.motors.count()))?,
        queue(&mut file, log, topic::STATE, message::BODY, &armed, message::state)?,
        queue(&mut file, log, topic::EXTENDED_STATE, message::BODY, &in_air, message::extended_state)?,
    ];
    while let Some(queue) = queues.iter_mut().filter(|queue| queue.first().is_some()).min_by_key(|queue| queue.first())
    {
        queue.write(&mut file)?;
    }
    file.finish().map_err(failed)?;
    Ok(file.into_inner().into_inner())
}

/// The error of the library that writes MCAP.
fn failed(error: McapError) -> Error {
    Error::encode("the log")(error)
}

fn metadata(record: &VehicleRecord) -> Metadata {
    let mut metadata = BTreeMap::from([(vehicle::THRUST_MAP.to_string(), vehicle::THRUST.to_string())]);
    metadata.extend(record.mass_kg.map(|mass| (vehicle::MASS.to_string(), mass.to_string())));
    metadata.extend(record.max_rate_rad_s.map(|rate| (vehicle::MAX_RATE.to_string(), format!("{rate:?}"))));
    metadata.extend(record.kind.map(|kind| (vehicle::KIND.to_string(), kind.name().to_string())));
    metadata.extend(record.rotors.map(|rotors| (vehicle::ROTORS.to_string(), rotors.to_string())));
    Metadata { name: vehicle::NAME.into(), metadata }
}

/// One of the states, where it is known.
fn said(states: &Stream<2>, k: usize) -> Stream<1> {
    let mut said = Stream::default();
    for (&time_s, row) in states.time_s.iter().zip(&states.rows).filter(|(_, row)| row[k].is_finite()) {
        said.push(time_s, [row[k]]);
    }
    said
}

/// Serializes the message of a row.
type Serialize<'l> = Box<dyn Fn(&mut Cdr, usize) + 'l>;

/// The messages of one stream that are not written yet.
struct Queue<'l> {
    channel: u16,
    times_ns: Vec<u64>,
    written: usize,
    message: Serialize<'l>,
    frame: &'static str,
}

/// Empty streams get no channel.
fn queue<'l, const N: usize>(
    file: &mut McapWriter,
    log: &Log,
    topic: CanonicalTopic,
    frame: &'static str,
    stream: &'l Stream<N>,
    message: impl Fn(&mut Cdr, [f64; N]) + 'l,
) -> Result<Queue<'l>> {
    let times_ns = stream.time_s.iter().map(|&time_s| stamp_ns(log.start_ns, time_s));
    let times_ns = times_ns.collect::<Option<Vec<_>>>();
    let times_ns = times_ns.ok_or_else(|| {
        let why = format!("{} has times that ROS cannot represent", topic.name);
        Error::Encode { what: "the log", why }
    })?;
    let channel = if stream.is_empty() {
        0
    } else {
        let schema = file.add_schema(topic.message, "ros2msg", topic.schema().as_bytes()).map_err(failed)?;
        file.add_channel(schema, topic.name, "cdr", &BTreeMap::new()).map_err(failed)?
    };
    Ok(Queue { channel, times_ns, written: 0, message: Box::new(move |cdr, i| message(cdr, stream.rows[i])), frame })
}

/// None unless the seconds fit into `builtin_interfaces/Time`.
fn stamp_ns(start_ns: u64, time_s: f64) -> Option<u64> {
    let ns = i128::from(start_ns).checked_add((time_s * 1e9).round() as i128)?;
    let ns = u64::try_from(ns).ok().filter(|_| time_s.is_finite())?;
    i32::try_from(ns / 1_000_000_000).ok().map(|_| ns)
}

impl Queue<'_> {
    /// Time of the next message, ns.
    fn first(&self) -> Option<u64> {
        self.times_ns.get(self.written).copied()
    }

    fn write(&mut self, file: &mut McapWriter) -> Result<()> {
        let time_ns = self.times_ns[self.written];
        let mut cdr = Cdr::new(time_ns, self.frame);
        (self.message)(&mut cdr, self.written);
        let sequence = self.written as u32;
        let header = MessageHeader { channel_id: self.channel, sequence, log_time: time_ns, publish_time: time_ns };
        file.write_to_known_channel(&header, cdr.bytes()).map_err(failed)?;
        self.written += 1;
        Ok(())
    }
}
