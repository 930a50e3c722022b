//! Topics of ROS 2, over DDS. `ROS_DOMAIN_ID` says which domain, as it does for ROS.

use super::{Inbox, Port};
use crate::flight::live::ros2::RosTopic;
use bytes::Bytes;
use rustdds::no_key::{DataReader, DataWriter, Decode, DefaultDecoder, DeserializerAdapter, SerializerAdapter};
use rustdds::policy::{History, Reliability};
use rustdds::{DomainParticipant, QosPolicies, QosPolicyBuilder, RepresentationIdentifier, TopicKind};
use std::convert::Infallible;
use std::io;
use std::time::Duration;

/// Between two looks for messages: a tenth of a period.
const LOOK: Duration = Duration::from_millis(1);

/// Serialized messages as they are: the byte order, then what follows the header.
struct Raw;

impl DeserializerAdapter<Vec<u8>> for Raw {
    type Error = Infallible;
    type Decoded = Vec<u8>;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE]
    }

    fn transform_decoded(decoded: Vec<u8>) -> Vec<u8> {
        decoded
    }
}

#[derive(Clone)]
struct Copying;

impl<'de> Decode<'de, Vec<u8>> for Copying {
    type Error = Infallible;

    fn decode_bytes(self, bytes: &'de [u8], encoding: RepresentationIdentifier) -> Result<Vec<u8>, Infallible> {
        let little = u8::from(encoding == RepresentationIdentifier::CDR_LE);
        Ok([&[0, little, 0, 0], bytes].concat())
    }
}

impl DefaultDecoder<Vec<u8>> for Raw {
    type Decoder = Copying;
    const DECODER: Copying = Copying;
}

impl SerializerAdapter<Vec<u8>> for Raw {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(message: &Vec<u8>) -> Result<Bytes, Infallible> {
        // The library writes the header itself.
        Ok(Bytes::copy_from_slice(message.get(4..).unwrap_or_default()))
    }
}

fn quality(reliability: Reliability) -> QosPolicies {
    QosPolicyBuilder::new().reliability(reliability).history(History::KeepLast { depth: 8 }).build()
}

struct Topics {
    writer: DataWriter<Vec<u8>, Raw>,
    /// What the writer writes through; both end together.
    _participant: DomainParticipant,
}

impl Port for Topics {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        // A message that nobody takes in time is replaced by the next.
        let _ = self.writer.write(bytes.to_vec(), None);
        Ok(())
    }
}

/// Listens to `heard` below `namespace`, and writes to `told`.
pub fn open(namespace: &str, heard: &[RosTopic], told: RosTopic, inbox: Inbox) -> io::Result<Box<dyn Port>> {
    let domain = std::env::var("ROS_DOMAIN_ID").ok().and_then(|id| id.parse().ok()).unwrap_or(0);
    let participant = DomainParticipant::new(domain).map_err(io::Error::other)?;
    // A reader that asks for little hears every writer, and a writer that offers much is heard by every reader.
    let asked = quality(Reliability::BestEffort);
    let offered = quality(Reliability::Reliable { max_blocking_time: rustdds::Duration::ZERO });
    let topic = |topic: RosTopic| {
        let [name, kind] = topic.names();
        let name = format!("rt{namespace}/{name}");
        participant.create_topic(name, kind.into(), &asked, TopicKind::NoKey).map_err(io::Error::other)
    };
    let subscriber = participant.create_subscriber(&asked).map_err(io::Error::other)?;
    let mut readers = Vec::new();
    for kind in heard {
        let reader: DataReader<Vec<u8>, Raw> =
            subscriber.create_datareader_no_key(&topic(*kind)?, Some(asked.clone())).map_err(io::Error::other)?;
        readers.push((*kind as u8, reader));
    }
    let publisher = participant.create_publisher(&offered).map_err(io::Error::other)?;
    let writer = publisher.create_datawriter_no_key(&topic(told)?, Some(offered)).map_err(io::Error::other)?;
    std::thread::spawn(move || {
        loop {
            for (place, reader) in &mut readers {
                while let Ok(Some(sample)) = reader.take_next_sample() {
                    if inbox.put([&[*place], sample.value().as_slice()].concat()).is_err() {
                        return;
                    }
                }
            }
            std::thread::sleep(LOOK);
        }
    });
    Ok(Box::new(Topics { writer, _participant: participant }))
}
