//! The states of a flight, out of flags that may come from different tables.

use super::quantity::Flag;
use super::source::{Missing, Sources, Told};
use super::{Part, StatesPart};
use crate::base::check::BadInput;
use crate::flight::Stream;

impl Sources<'_> {
    /// Armed and in the air, at every time at which either was said.
    pub fn states(&self) -> Result<Stream<2>, BadInput> {
        let armed = self.alternatives("states.armed", |part| part.armed.as_ref())?;
        let in_air = self.alternatives("states.in_air", |part| part.in_air.as_ref())?;
        let mut said: Vec<(f64, usize, f64)> = Vec::new();
        for (k, told) in [armed, in_air].into_iter().enumerate() {
            said.extend(told.into_iter().filter(|(time, _)| time.is_finite()).map(|(time, value)| (time, k, value)));
        }
        said.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut stream = Stream::default();
        let mut now = [f64::NAN; 2];
        for same in said.chunk_by(|a, b| a.0 == b.0) {
            same.iter().for_each(|&(_, k, value)| now[k] = value);
            if now.iter().any(|value| value.is_finite()) {
                stream.push(same[0].0, now);
            }
        }
        Ok(stream)
    }

    /// What the first alternative says that the file has.
    fn alternatives(&self, key: &str, flag: fn(&StatesPart) -> Option<&Flag>) -> Result<Told, BadInput> {
        let mut next = self.mapping.states.as_ref();
        let optional = next.is_some_and(|part| part.optional);
        let mut missing = None;
        while let Some(part) = next {
            match flag(part).map(|flag| self.flag(key, part, flag)) {
                Some(Ok(told)) => return Ok(told),
                Some(Err(error)) => missing = missing.or(Some(error)),
                None => {}
            }
            next = part.otherwise();
        }
        match missing {
            Some(Missing::Source(error)) if !optional => Err(error),
            Some(Missing::Other(error)) => Err(error),
            _ => Ok(Told::new()),
        }
    }
}
