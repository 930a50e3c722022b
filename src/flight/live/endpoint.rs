//! Where a link ends: the part of a name behind its protocol.

use super::ros2::RosTopic;
use std::net::{SocketAddr, ToSocketAddrs};
use std::path::PathBuf;

/// Where bytes go, and come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// A UDP port of this machine; answers go to whoever spoke last.
    Listen(u16),
    Udp(SocketAddr),
    Tcp(SocketAddr),
    /// A serial line, and its speed where it has one.
    Serial(PathBuf, Option<u32>),
    /// Topics of ROS 2 below a namespace: those that are listened to, and the one that is written.
    Topics {
        namespace: String,
        heard: Vec<RosTopic>,
        told: RosTopic,
    },
}

impl Endpoint {
    /// `udp:PORT`, `udp:HOST:PORT`, `tcp:HOST:PORT` or `/dev/NAME[:BAUD]`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let address = |place: &str| {
            let mut found = place.to_socket_addrs().map_err(|error| format!("{text}: {error}"))?;
            found.next().ok_or_else(|| format!("{text}, which names no address"))
        };
        if let Some(place) = text.strip_prefix("udp:") {
            return match place.parse::<u16>() {
                Ok(0) => Err(text.into()),
                Ok(port) => Ok(Self::Listen(port)),
                Err(_) => address(place).map(Self::Udp),
            };
        }
        if let Some(place) = text.strip_prefix("tcp:") {
            return address(place).map(Self::Tcp);
        }
        if !text.starts_with('/') {
            return Err(text.into());
        }
        match text.rsplit_once(':') {
            None => Ok(Self::Serial(text.into(), None)),
            Some((path, baud)) => {
                let baud = baud.parse().map_err(|_| format!("{text}, whose speed is no number"))?;
                Ok(Self::Serial(path.into(), Some(baud)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_taken_apart() {
        let local = |port| SocketAddr::from(([127, 0, 0, 1], port));
        assert_eq!(Endpoint::parse("udp:14540"), Ok(Endpoint::Listen(14540)));
        assert_eq!(Endpoint::parse("udp:127.0.0.1:9"), Ok(Endpoint::Udp(local(9))));
        assert_eq!(Endpoint::parse("tcp:127.0.0.1:5761"), Ok(Endpoint::Tcp(local(5761))));
        assert_eq!(Endpoint::parse("/dev/ttyACM0"), Ok(Endpoint::Serial("/dev/ttyACM0".into(), None)));
        assert_eq!(Endpoint::parse("/dev/ttyUSB0:921600"), Ok(Endpoint::Serial("/dev/ttyUSB0".into(), Some(921_600))));
        for wrong in ["", "udp:", "udp:0", "udp:70000", "udp:a", "tcp:5761", "/dev/ttyUSB0:fast", "ttyUSB0", "http:x"] {
            assert!(Endpoint::parse(wrong).is_err(), "{wrong}");
        }
    }
}
