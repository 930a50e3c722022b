//! The MAVLink side of the way to ArduPilot: sticks there, and back what it says of itself.

use super::super::sticks::Sticks;
use crate::base::error::{Error, Result};
use crate::flight::live::mavlink::frame::{Frames, Scanned, frame};
use crate::flight::live::mavlink::message::{Payload, RC_CHANNELS_OVERRIDE, STATUSTEXT, rc_channels_override};
use std::net::{SocketAddr, UdpSocket};

/// Who may override a receiver: a ground station, by its system.
const GROUND_STATION: [u8; 2] = [255, 190];
/// The firmware's own system and component.
const VEHICLE: [u8; 2] = [1, 1];
/// What it says once it has booted.
const BOOTED: &str = "ArduPilot Ready";

/// A socket to the firmware's first serial port, which speaks first.
#[derive(Debug)]
pub struct StickLink {
    socket: UdpSocket,
    /// Of its end, once it spoke.
    at: Option<SocketAddr>,
    /// Of the next frame.
    sequence: u8,
    heard: Frames,
    /// The last that it said.
    pub said: Option<String>,
    /// Whether it said that it has booted.
    pub booted: bool,
}

impl StickLink {
    /// Takes a port that is free. Fails where there is none.
    pub fn new() -> Result<Self> {
        let failed = |error: std::io::Error| Error::Failed(format!("no UDP port for the firmware: {error}"));
        let socket = UdpSocket::bind(("127.0.0.1", 0)).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        Ok(Self { socket, at: None, sequence: 0, heard: Frames::default(), said: None, booted: false })
    }

    /// Where it listens.
    pub fn port(&self) -> u16 {
        self.socket.local_addr().map_or(0, |address| address.port())
    }

    /// Sends sticks to a firmware that spoke. Before, it has no receiver, and flies nothing.
    pub fn send(&mut self, sticks: &Sticks) {
        let Some(address) = self.at else { return };
        let payload = rc_channels_override(VEHICLE, super::channels(sticks));
        let bytes = frame(self.sequence, GROUND_STATION, RC_CHANNELS_OVERRIDE, &payload);
        self.sequence = self.sequence.wrapping_add(1);
        // A firmware that is gone shows in its silence.
        let _ = self.socket.send_to(&bytes, address);
    }

    /// Takes what has arrived.
    pub fn listen(&mut self) {
        let mut bytes = [0; 2048];
        while let Ok((length, from)) = self.socket.recv_from(&mut bytes) {
            self.at = Some(from);
            for found in self.heard.hear(&bytes[..length]) {
                let Scanned::Known(frame) = found else { continue };
                if frame.id == STATUSTEXT {
                    let text: Vec<u8> = (1..51).map(|at| Payload(&frame.payload).u8(at)).collect();
                    let text = String::from_utf8_lossy(&text).trim_end_matches('\0').to_string();
                    self.booted |= text == BOOTED;
                    self.said = Some(text);
                }
            }
        }
    }
}
