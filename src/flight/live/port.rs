//! Ports: where bytes of a link come in and go out. What arrives comes by a channel, with its time.

#[cfg(feature = "ros2")]
mod dds;
mod serial;

use super::endpoint::Endpoint;
use crate::base::check::BadInput;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::mpsc::{SyncSender, TrySendError};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Bytes that arrived: a datagram, or a piece of a stream.
#[derive(Debug)]
pub struct Arrival {
    /// The link that they came by.
    pub line: usize,
    pub at: Instant,
    pub bytes: Vec<u8>,
}

/// Arrivals that wait to be read, at most: further ones are lost, so that a flood costs neither memory nor time.
pub const WAITING: usize = 1024;
/// Longest datagram.
const DATAGRAM: usize = 2048;
/// How long a stream may take to swallow what is sent, before it counts as broken.
const SWALLOW: Duration = Duration::from_millis(20);
/// How long it may take to answer a connection.
const CONNECT: Duration = Duration::from_secs(5);

/// Where bytes go.
pub trait Port {
    /// Sends a datagram, or a piece of a stream. An error means that nothing will arrive any more.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;
}

/// Opens `endpoint`, which the user named by `option`. What arrives there goes to `to`, as from `line`.
pub fn open(
    endpoint: &Endpoint,
    option: &str,
    line: usize,
    to: &SyncSender<Arrival>,
) -> Result<Box<dyn Port>, BadInput> {
    let to = Inbox { line, to: to.clone() };
    let refuse = |error: io::Error, expected: &str, advice: &str| BadInput::new(option, error, expected, advice);
    match endpoint {
        Endpoint::Listen(port) => listening(*port, to).map_err(|error| {
            refuse(error, "a port that is free", "choose another port, or end the program that has it")
        }),
        Endpoint::Udp(address) => speaking(*address, to)
            .map_err(|error| refuse(error, "an address that packets can be sent to", "look at the network")),
        Endpoint::Tcp(address) => connected(*address, to)
            .map_err(|error| refuse(error, "a program that answers there", "start the peer before the pilot")),
        #[cfg(feature = "ros2")]
        Endpoint::Topics { namespace, heard, told } => dds::open(namespace, heard, *told, to)
            .map_err(|error| refuse(error, "a domain of DDS", "look at ROS_DOMAIN_ID and at the network")),
        #[cfg(not(feature = "ros2"))]
        Endpoint::Topics { .. } => {
            Err(refuse(ErrorKind::Unsupported.into(), "a racer with ROS 2", "cargo build --release --features ros2"))
        }
        Endpoint::Serial(path, baud) => {
            serial::open(path, *baud).and_then(|file| stream(file.try_clone()?, file, to)).map_err(|error| {
                refuse(error, "a serial line", "look whether it is plugged in, and whether you may use it")
            })
        }
    }
}

struct Inbox {
    line: usize,
    to: SyncSender<Arrival>,
}

impl Inbox {
    /// Puts in what arrived now; what finds no place is lost. An error where nobody reads any more.
    fn put(&self, bytes: Vec<u8>) -> Result<(), Gone> {
        match self.to.try_send(Arrival { line: self.line, at: Instant::now(), bytes }) {
            Err(TrySendError::Disconnected(_)) => Err(Gone),
            _ => Ok(()),
        }
    }
}

/// Nobody reads the inbox any more.
struct Gone;

/// Hands on what `read` gives, until the other end or this program has gone. `stream` is whether nothing is the end.
fn listen(inbox: Inbox, stream: bool, mut read: impl FnMut(&mut [u8]) -> io::Result<usize> + Send + 'static) {
    std::thread::spawn(move || {
        let mut bytes = [0; DATAGRAM];
        loop {
            let length = match read(&mut bytes) {
                Ok(0) if stream => break,
                Ok(length) => length,
                // What was sent to a port where nobody listens comes back as an error of the next reading.
                Err(error) if matches!(error.kind(), ErrorKind::ConnectionRefused | ErrorKind::Interrupted) => continue,
                Err(_) => break,
            };
            if inbox.put(bytes[..length].into()).is_err() {
                break;
            }
        }
    });
}

/// A UDP socket, and whom it answers.
struct Datagrams {
    socket: UdpSocket,
    peer: Arc<Mutex<Option<SocketAddr>>>,
}

impl Port for Datagrams {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let peer = self.peer.lock().map_or(None, |peer| *peer);
        match peer.map(|peer| self.socket.send_to(bytes, peer)) {
            // Nobody listens yet, or no more: on this machine the system says so.
            Some(Err(error)) if error.kind() != ErrorKind::ConnectionRefused => Err(error),
            _ => Ok(()),
        }
    }
}

fn listening(port: u16, inbox: Inbox) -> io::Result<Box<dyn Port>> {
    let socket = UdpSocket::bind(("0.0.0.0", port))?;
    let peer = Arc::new(Mutex::new(None));
    let (receiver, last) = (socket.try_clone()?, peer.clone());
    listen(inbox, false, move |bytes| {
        let (length, from) = receiver.recv_from(bytes)?;
        if let Ok(mut last) = last.lock() {
            *last = Some(from);
        }
        Ok(length)
    });
    Ok(Box::new(Datagrams { socket, peer }))
}

fn speaking(address: SocketAddr, inbox: Inbox) -> io::Result<Box<dyn Port>> {
    let socket = UdpSocket::bind(if address.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" })?;
    let receiver = socket.try_clone()?;
    listen(inbox, false, move |bytes| receiver.recv(bytes));
    Ok(Box::new(Datagrams { socket, peer: Arc::new(Mutex::new(Some(address))) }))
}

fn connected(address: SocketAddr, inbox: Inbox) -> io::Result<Box<dyn Port>> {
    let socket = TcpStream::connect_timeout(&address, CONNECT)?;
    socket.set_nodelay(true)?;
    socket.set_write_timeout(Some(SWALLOW))?;
    stream(socket.try_clone()?, socket, inbox)
}

struct Flowing<W>(W);

impl<W: Write> Port for Flowing<W> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }
}

fn stream(
    mut reader: impl Read + Send + 'static,
    writer: impl Write + 'static,
    inbox: Inbox,
) -> io::Result<Box<dyn Port>> {
    listen(inbox, true, move |bytes| reader.read(bytes));
    Ok(Box::new(Flowing(writer)))
}
