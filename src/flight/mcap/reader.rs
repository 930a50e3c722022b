//! What the records of a file add up to: schemas, channels, and a table for each topic that is wanted.

use super::Topic;
use super::column::{Budget, Columns};
use super::decoder::{Decoder, Schema};
use super::file::Stop;
use super::record::{self, McapRecord, MessageRecord};
use super::vehicle;
use crate::base::check::BadInput;
use crate::flight::table::Tables;
use crate::flight::{Readable, VehicleRecord};
use std::collections::{BTreeMap, HashMap};

/// Bytes that all that is read of a file may take: more than an hour of a canonical log.
const MEMORY: usize = 2 << 30;

pub struct TopicReader<'w> {
    wanted: &'w dyn Fn(&str) -> bool,
    budget: Budget,
    schemas: HashMap<u16, Schema>,
    channels: HashMap<u16, OpenChannel>,
    columns: BTreeMap<String, Columns>,
    vehicle: VehicleRecord,
}

struct OpenChannel {
    schema: u16,
    encoding: String,
    topic: Topic,
    wanted: bool,
    decoder: Option<Decoder>,
}

impl<'w> TopicReader<'w> {
    pub fn new(wanted: &'w dyn Fn(&str) -> bool) -> Self {
        Self {
            wanted,
            budget: Budget::new(MEMORY),
            schemas: HashMap::new(),
            channels: HashMap::new(),
            columns: BTreeMap::new(),
            vehicle: VehicleRecord::default(),
        }
    }

    pub fn record(&mut self, record: McapRecord) -> Result<(), Stop> {
        match record {
            McapRecord::Message(message) => self.message(&message),
            McapRecord::Schema(schema) => self.schema(&schema),
            McapRecord::Channel(channel) => self.channel(&channel),
            McapRecord::Metadata { name: vehicle::NAME, values } => {
                self.vehicle = vehicle::read(values).map_err(Stop::Useless)?;
                Ok(())
            }
            McapRecord::Metadata { .. } | McapRecord::Other => Ok(()),
        }
    }

    fn schema(&mut self, record: &record::SchemaRecord) -> Result<(), Stop> {
        let record::SchemaRecord { id, name, encoding, data } = *record;
        if let Some(known) = self.schemas.get(&id) {
            let same = (known.name.as_str(), known.encoding.as_str(), known.data.as_slice()) == (name, encoding, data);
            return if same { Ok(()) } else { Err(format!("there are two schemas with number {id}").into()) };
        }
        self.budget.spend(name.len() + encoding.len() + data.len())?;
        self.schemas.insert(id, Schema { name: name.into(), encoding: encoding.into(), data: data.into() });
        Ok(())
    }

    fn channel(&mut self, record: &record::ChannelRecord) -> Result<(), Stop> {
        let record::ChannelRecord { id, schema, topic, encoding } = *record;
        if let Some(known) = self.channels.get(&id) {
            let same = (known.schema, known.topic.name.as_str(), known.encoding.as_str()) == (schema, topic, encoding);
            return if same { Ok(()) } else { Err(format!("there are two channels with number {id}").into()) };
        }
        let of = self.schemas.get(&schema);
        if schema != 0 && of.is_none() {
            return Err(format!("the schema of {topic} is missing").into());
        }
        let (message, language) = of.map_or(("", "no schema"), |of| (&of.name, &of.encoding));
        self.budget.spend(3 * topic.len() + 2 * encoding.len() + message.len() + language.len())?;
        let (name, message, full) = (topic.to_string(), message.to_string(), format!("{encoding}, {language}"));
        let wanted = (self.wanted)(topic);
        if wanted {
            self.columns.entry(topic.into()).or_insert_with(|| Columns::new(self.budget.clone()));
        }
        let topic = Topic { name, message, encoding: full, count: 0 };
        self.channels.insert(id, OpenChannel { schema, encoding: encoding.into(), topic, wanted, decoder: None });
        Ok(())
    }

    fn message(&mut self, message: &MessageRecord) -> Result<(), Stop> {
        let Some(channel) = self.channels.get_mut(&message.channel) else {
            return Err(format!("channel {} is missing", message.channel).into());
        };
        if channel.wanted {
            let schema = self.schemas.get(&channel.schema);
            let columns = self.columns.get_mut(&channel.topic.name).expect("a wanted topic has columns");
            let read = channel.read(schema, message, columns);
            read.map_err(|why| if columns.rows() == 0 { channel.useless(&why) } else { channel.broken(&why) })?;
        }
        channel.topic.count += 1;
        Ok(())
    }

    /// The tables of wanted topics, and all topics by name.
    pub fn finish(self, readable: Readable) -> (Tables, Vec<Topic>) {
        let tables = self.columns.into_iter().map(|(topic, columns)| (topic, columns.into_table())).collect();
        let mut topics: Vec<_> = self.channels.into_values().map(|channel| channel.topic).collect();
        topics.sort_by(|a, b| a.name.cmp(&b.name));
        (Tables { tables, vehicle: self.vehicle, readable }, topics)
    }
}

impl OpenChannel {
    fn read(&mut self, schema: Option<&Schema>, message: &MessageRecord, columns: &mut Columns) -> Result<(), String> {
        let decoder = match &mut self.decoder {
            Some(decoder) => decoder,
            none => none.insert(Decoder::new(&self.encoding, schema, columns)?),
        };
        decoder.decode(message.data, columns)?;
        columns.end_row(message.log_time_ns as f64 / 1e9)
    }

    fn broken(&self, why: &str) -> Stop {
        Stop::Broken(format!("topic {}: {why}", self.topic.name))
    }

    fn useless(&self, why: &str) -> Stop {
        let Topic { name, message, encoding, .. } = &self.topic;
        Stop::Useless(BadInput::new(
            format!("topic {name}"),
            format!("{message} in {encoding}: {why}"),
            "cdr with ros2msg or ros2idl, json, or protobuf with descriptors",
            "record the topic again, or map another one",
        ))
    }
}
