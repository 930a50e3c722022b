//! A training on disk, between two iterations: what it takes to go on bit for bit.
//!
//! A line with the format, a checksum and the length of the rest; then safetensors: the networks, the optimiser's
//! moments, the order of the rows, and the environments as the bits of their numbers. Whatever counts and clocks there
//! are stands in its metadata, with a note of whoever keeps the file.

use crate::base::check::Invalid;
use crate::base::error::Error;
use crate::base::lane::{LANES, Portable};
use crate::learn::nn::Network;
use crate::learn::nn::adam::Adam;
use crate::learn::ppo::state::TrainingState;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::env::{Block, Race};
use safetensors::tensor::{Dtype, SafeTensors, TensorView, serialize};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// 16 environments of a race between rollouts.
pub type SavedBlock = Block<Portable<f32>>;
/// The state of a training of a race.
pub type RaceState = TrainingState<SavedBlock>;

/// A format is this and a version. The version changes where an older racer would misread the file.
const FORMAT: &str = "racer-checkpoint-2";
/// The metadata's only key.
const METADATA: &str = "racer";

/// What is counted rather than computed.
#[derive(Serialize, Deserialize)]
struct Counts {
    iterations: usize,
    steps: u64,
    seconds: f64,
    snapshots: usize,
    setbacks: u32,
    optimiser_steps: u64,
    note: String,
}

/// The file's content; `note` is kept with it.
pub fn to_bytes(state: &RaceState, note: &str) -> Result<Vec<u8>, Error> {
    let counts = Counts {
        iterations: state.iterations,
        steps: state.steps,
        seconds: state.seconds,
        snapshots: state.snapshots,
        setbacks: state.setbacks,
        optimiser_steps: state.adam.steps,
        note: note.into(),
    };
    let numbers = |x: &[f32]| x.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let words = |x: &[u32]| x.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let mut environments = Vec::new();
    state.environments.iter().for_each(|block| write_block(block, &mut environments));
    let all = [
        ("network", Dtype::F32, numbers(&state.network.parameters)),
        ("average", Dtype::F32, numbers(&state.average.parameters)),
        ("adam.first", Dtype::F32, numbers(&state.adam.first)),
        ("adam.second", Dtype::F32, numbers(&state.adam.second)),
        ("order", Dtype::U32, words(&state.order)),
        ("environments", Dtype::U32, words(&environments)),
    ];
    let encode = Error::encode("the checkpoint");
    let metadata = serde_json::to_string(&counts).map_err(Error::encode("the checkpoint"))?;
    let views: Result<Vec<_>, _> = all
        .iter()
        .map(|(name, kind, bytes)| Ok((*name, TensorView::new(*kind, vec![bytes.len() / 4], bytes)?)))
        .collect();
    let content = views.and_then(|views| serialize(views, Some(HashMap::from([(METADATA.into(), metadata)]))));
    let content = content.map_err(encode)?;
    let mut file = format!("{FORMAT} {:08x} {}\n", crc32c::crc32c(&content), content.len()).into_bytes();
    file.extend(content);
    Ok(file)
}

/// Reads the state of a training of `race`, and the note.
pub fn from_bytes(bytes: &[u8], race: &Race) -> Result<(RaceState, String), Invalid> {
    let refuse = |found: &str| Invalid::new("", found, "a whole checkpoint of this racer", "");
    let end = bytes.iter().take(64).position(|&b| b == b'\n').ok_or_else(|| refuse("no line with its format"))?;
    let (line, content) = (String::from_utf8_lossy(&bytes[..end]), &bytes[end + 1..]);
    let words: Vec<&str> = line.split(' ').collect();
    let [format, checksum, length] = words[..] else { return Err(refuse("no line with its format")) };
    if format != FORMAT {
        return Err(refuse(&format!("format `{format}`")));
    }
    if length.parse() != Ok(content.len()) || u32::from_str_radix(checksum, 16) != Ok(crc32c::crc32c(content)) {
        return Err(refuse("a damaged file: length or checksum is another one"));
    }
    read_content(content, race).map_err(|why| refuse(&why))
}

fn read_content(content: &[u8], race: &Race) -> Result<(RaceState, String), String> {
    let (_, header) = SafeTensors::read_metadata(content).map_err(|error| error.to_string())?;
    let text = header.metadata().as_ref().and_then(|map| map.get(METADATA)).ok_or("no metadata")?;
    let counts: Counts = serde_json::from_str(text).map_err(|error| error.to_string())?;
    let file = SafeTensors::deserialize(content).map_err(|error| error.to_string())?;
    let words = |name: &str| -> Result<Vec<u32>, String> {
        let view = file.tensor(name).map_err(|error| error.to_string())?;
        let (chunks, _) = view.data().as_chunks::<4>();
        Ok(chunks.iter().map(|&b| u32::from_le_bytes(b)).collect())
    };
    let mut network = Network::<f32>::zeros(OBSERVATIONS);
    let mut average = network.clone();
    let mut adam = Adam::new(network.parameters.len());
    for (name, to) in [
        ("network", &mut network.parameters),
        ("average", &mut average.parameters),
        ("adam.first", &mut adam.first),
        ("adam.second", &mut adam.second),
    ] {
        let from = words(name)?;
        if from.len() != to.len() {
            return Err(format!("{name} of {} numbers", from.len()));
        }
        to.iter_mut().zip(from).for_each(|(to, bits)| *to = f32::from_bits(bits));
    }
    adam.steps = counts.optimiser_steps;
    let mut bits = words("environments")?.into_iter();
    let mut environments = Vec::new();
    while bits.len() > 0 {
        let first = (environments.len() * LANES) as u32;
        environments.push(read_block(race, first, &mut bits).ok_or("environments of another race")?);
    }
    let Counts { iterations, steps, seconds, snapshots, setbacks, note, .. } = counts;
    let order = words("order")?;
    Ok((
        TrainingState { iterations, steps, seconds, snapshots, setbacks, network, average, adam, order, environments },
        note,
    ))
}

/// Adds the bits of all numbers of `block`.
fn write_block(block: &SavedBlock, words: &mut Vec<u32>) {
    block.map(|x| words.extend(x.0.map(f32::to_bits)));
    words.extend(block.target.iter().chain(&block.passed).chain([&block.step]));
}

/// The inverse of [`write_block`] for environments `first..first + 16`; `None` unless there are as many numbers.
fn read_block(race: &Race, first: u32, words: &mut impl Iterator<Item = u32>) -> Option<SavedBlock> {
    let mut short = false;
    let mut next = || {
        words.next().unwrap_or_else(|| {
            short = true;
            0
        })
    };
    let mut block =
        race.empty_block::<Portable<f32>>(first).map(|_| Portable(std::array::from_fn(|_| f32::from_bits(next()))));
    block.target = std::array::from_fn(|_| next());
    block.passed = std::array::from_fn(|_| next());
    block.step = next();
    let fits = block.target.iter().all(|&gate| (gate as usize) < race.gates.len());
    (fits && !short).then_some(block)
}
