//! From what the user named to the protocols and endpoints of a flight.

use super::duty::Duty;
use super::endpoint::Endpoint;
use super::mavlink::Mavlink;
use super::msp::Msp;
use super::packets::Packets;
use super::protocol::Protocol;
use super::ros2::{Ros2, RosTopic};
use super::switch::Switch;
use crate::base::check::BadInput;

/// What the user asked for.
#[derive(Clone, Copy, Debug)]
pub struct Wishes<'a> {
    /// Where states come from, and where setpoints go; none: back to where states come from.
    pub source: &'a str,
    pub sink: Option<&'a str>,
    pub switch: Option<&'a str>,
    /// The channel that arms over MSP, from 1.
    pub arm: Option<usize>,
}

/// A protocol, and where it is spoken.
pub struct Leg {
    pub protocol: Box<dyn Protocol>,
    pub endpoint: Endpoint,
    /// The option that named it, with its value.
    pub option: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Language {
    Packets,
    Mavlink,
    Msp,
    Ros2,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Name {
    option: String,
    language: Language,
    endpoint: Endpoint,
}

const PLACES: &str = "udp:PORT, udp:HOST:PORT, tcp:HOST:PORT or /dev/NAME[:BAUD]";

/// What was asked for, understood.
#[derive(Clone, Debug)]
pub struct Route {
    source: Name,
    sink: Option<Name>,
    switch: Option<Switch>,
    arm: Option<usize>,
}

impl Route {
    /// Understands `wishes`; opens nothing.
    pub fn of(wishes: &Wishes) -> Result<Self, BadInput> {
        let source = source(wishes.source)?;
        let sink = wishes.sink.filter(|sink| *sink != wishes.source).map(sink).transpose()?;
        let last = sink.as_ref().unwrap_or(&source).language;
        let switch = wishes.switch.map(Switch::parse).transpose()?;
        check_switch(switch, source.language, last)?;
        if let Some(arm) = wishes.arm.filter(|_| last != Language::Msp) {
            let place = format!("--arm {arm}");
            return Err(BadInput::new(place, "no msp: in --out", "an --out of msp:", "leave it out: the pilot arms"));
        }
        Ok(Self { source, sink, switch, arm: wishes.arm })
    }

    /// The legs, of which the first brings states. Full sticks ask for rates of `full_rate`, rad/s.
    pub fn legs(&self, full_rate: [f64; 3]) -> Vec<Leg> {
        let leg = |name: &Name, duty: Duty| {
            // racer's own packets leave a switch that is named to the other link.
            let switch = self.switch.filter(|_| duty.source || self.source.language == Language::Packets);
            let mut endpoint = name.endpoint.clone();
            if let Endpoint::Topics { heard, .. } = &mut endpoint {
                *heard = RosTopic::heard(switch, duty);
            }
            let protocol: Box<dyn Protocol> = match name.language {
                Language::Ros2 => Box::new(Ros2::new(switch, duty)),
                Language::Packets => Box::new(Packets::new(switch.is_none(), duty.sink)),
                Language::Mavlink => Box::new(Mavlink::new(switch, duty)),
                Language::Msp => Box::new(Msp::new(switch, full_rate, self.arm)),
            };
            Leg { protocol, endpoint, option: name.option.clone() }
        };
        let mut legs = vec![leg(&self.source, Duty { source: true, sink: self.sink.is_none() })];
        legs.extend(self.sink.iter().map(|sink| leg(sink, Duty { source: false, sink: true })));
        legs
    }
}

/// What `text` names, after `option`, where `expected` is the kind of name that is asked for.
fn parse(option: &str, text: &str, expected: &str) -> Result<Name, BadInput> {
    if let Some(namespace) = text.strip_prefix("ros2:") {
        return topics(option, text, namespace);
    }
    let languages = [("mavlink:", Language::Mavlink), ("msp:", Language::Msp), ("", Language::Packets)];
    let found = languages.iter().find_map(|(prefix, language)| Some((*language, text.strip_prefix(prefix)?)));
    let (language, place) = found.unwrap_or((Language::Packets, text));
    let endpoint = Endpoint::parse(place)
        .map_err(|found| BadInput::new(option, found, expected, "docs/flying.md has an example of each"))?;
    Ok(Name { option: format!("{option} {text}"), language, endpoint })
}

fn topics(option: &str, text: &str, namespace: &str) -> Result<Name, BadInput> {
    let built = cfg!(feature = "ros2");
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '/';
    let named = namespace.len() > 1 && namespace.starts_with('/') && !namespace.ends_with('/');
    let (expected, advice) = match (built, named && namespace.chars().all(plain)) {
        (true, true) => {
            let endpoint = Endpoint::Topics { namespace: namespace.into(), heard: Vec::new(), told: RosTopic::Target };
            return Ok(Name { option: format!("{option} {text}"), language: Language::Ros2, endpoint });
        }
        (false, _) => ("another link: this racer was built without ROS 2", "cargo build --release --features ros2"),
        (true, false) => ("ros2:/NAMESPACE, such as ros2:/mavros", "docs/flying.md lists the topics below it"),
    };
    Err(BadInput::new(option, text, expected, advice))
}

fn source(text: &str) -> Result<Name, BadInput> {
    let expected = format!("udp:PORT, or mavlink: and then {PLACES}, or ros2:/NAMESPACE");
    let name = parse("--in", text, &expected)?;
    match (name.language, &name.endpoint) {
        (Language::Mavlink | Language::Ros2, _) | (Language::Packets, Endpoint::Listen(_)) => Ok(name),
        (Language::Msp, _) => Err(BadInput::new(
            "--in",
            text,
            &expected,
            "over MSP a flight controller does not tell where it is: name what does, such as motion capture",
        )),
        _ => Err(BadInput::new("--in", text, &expected, "racer's own packets arrive at a port of UDP")),
    }
}

fn sink(text: &str) -> Result<Name, BadInput> {
    let expected = format!("udp:HOST:PORT, or mavlink: or msp: and then {PLACES}, or ros2:/NAMESPACE");
    let name = parse("--out", text, &expected)?;
    match (name.language, &name.endpoint) {
        (Language::Packets, Endpoint::Udp(_)) | (Language::Mavlink | Language::Msp | Language::Ros2, _) => Ok(name),
        _ => Err(BadInput::new("--out", text, &expected, "racer's own packets go to a host and a port of UDP")),
    }
}

/// Whether the links that there are have the switch.
fn check_switch(switch: Option<Switch>, source: Language, sink: Language) -> Result<(), BadInput> {
    let bearer = if source == Language::Packets { sink } else { source };
    let (found, expected) = match (bearer, switch) {
        (Language::Packets, None)
        | (Language::Mavlink | Language::Ros2, Some(_))
        | (Language::Msp, Some(Switch::Channel(_))) => {
            return Ok(());
        }
        (Language::Msp, None) => return Ok(()),
        (Language::Packets, Some(_)) => {
            ("a name", "none: over racer's own packets bit 0 of the last word is the switch")
        }
        (Language::Mavlink | Language::Ros2, None) => {
            ("none", "--switch offboard, --switch rc:CHANNEL or --switch button:NUMBER")
        }
        (Language::Msp, Some(_)) => ("another", "--switch rc:CHANNEL: over MSP there are only channels"),
    };
    Err(BadInput::new(
        "--switch",
        found,
        expected,
        "name what the pilot holds, and lets go of to have the vehicle back",
    ))
}
