//! Tables and columns by name, and what to say where there are none.

use super::quantity::{Flag, Scalar, Time, Vector, column, optional};
use super::units::Unit;
use super::{Mapping, Part, StatesPart, join};
use crate::base::check::BadInput;
use crate::base::document::nearest;
use crate::flight::table::{LOG_TIME, Table, Tables};

/// Time of a message that carries its own.
const STAMP: &str = "header.stamp";

/// The rows of a part, one for each of its table.
pub type Rows<const N: usize> = Result<Vec<[f64; N]>, Missing>;

/// What a part is read from.
pub struct Sources<'a> {
    pub mapping: &'a Mapping,
    pub tables: &'a Tables,
    pub name: &'a str,
}

/// A part of the mapping and its table.
pub struct Open<'a> {
    pub sources: &'a Sources<'a>,
    /// Key of the part in the mapping.
    key: &'a str,
    source: &'a str,
    pub table: &'a Table,
    pub stamps: Vec<f64>,
}

/// What a file lacks.
pub enum Missing {
    Source(BadInput),
    Other(BadInput),
}

impl From<BadInput> for Missing {
    fn from(error: BadInput) -> Self {
        Missing::Other(error)
    }
}

/// When a flag was said to be what.
pub type Told = Vec<(f64, f64)>;

impl<'a> Sources<'a> {
    /// What a flag of the part `key` says, row by row, in the order of the file.
    pub fn flag(&self, key: &str, part: &'a StatesPart, flag: &'a Flag) -> Result<Told, Missing> {
        let source = flag.source.as_deref().unwrap_or(&part.source);
        let table = self.table(key, source)?;
        if optional(&flag.field) && !table.columns.contains_key(column(&flag.field)) {
            return Ok(Told::new());
        }
        let values = self.column(key, source, table, column(&flag.field))?;
        let stamps = self.stamps(key, source, table, part.time.as_ref())?;
        Ok(stamps.into_iter().zip(values.iter().map(|&x| flag.value(x))).collect())
    }

    pub fn open<'b, P: Part>(&'b self, key: &'b str, part: &'b P) -> Result<Open<'b>, Missing> {
        let origin = part.origin();
        let table = self.table(key, origin.source)?;
        let stamps = self.stamps(key, origin.source, table, origin.time)?;
        Ok(Open { sources: self, key, source: origin.source, table, stamps })
    }

    fn table(&self, key: &str, source: &str) -> Result<&'a Table, Missing> {
        self.tables.tables.get(source).ok_or_else(|| {
            let known: Vec<&str> = self.tables.tables.keys().map(String::as_str).collect();
            Missing::Source(BadInput::new(
                self.name,
                format!("no `{source}`"),
                &format!("the source of `{key}` in the mapping"),
                advice(source, &known),
            ))
        })
    }

    fn column(&self, key: &str, source: &str, table: &'a Table, name: &str) -> Result<&'a [f64], BadInput> {
        table.columns.get(name).map(Vec::as_slice).ok_or_else(|| {
            let known: Vec<&str> = table.columns.keys().map(String::as_str).collect();
            let of = if source.is_empty() { String::new() } else { format!(" in `{source}`") };
            BadInput::new(
                self.name,
                format!("no column `{name}`{of}"),
                &format!("the columns that `{key}` in the mapping names"),
                advice(name, &known),
            )
        })
    }

    /// When each row was measured, s.
    fn stamps(&self, key: &str, source: &str, table: &'a Table, time: Option<&Time>) -> Result<Vec<f64>, BadInput> {
        match time.or(self.mapping.time.as_ref()) {
            Some(Time { field, unit }) => {
                let column = self.column(&format!("{key}.time"), source, table, field)?;
                Ok(column.iter().map(|time| time * unit.factor()).collect())
            }
            None => {
                let name = if table.columns.contains_key(STAMP) { STAMP } else { LOG_TIME };
                match table.columns.get(name) {
                    Some(column) => Ok(column.clone()),
                    None => self.column(&format!("{key}.time"), source, table, "time").map(<[f64]>::to_vec),
                }
            }
        }
    }
}

/// The nearest name, and those that there are.
pub fn advice(name: &str, known: &[&str]) -> String {
    /// More would only hide the rest of the message.
    const MOST: usize = 60;
    if known.is_empty() || known == [""] {
        return "is it the right file?".into();
    }
    let shown = known.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    let more = if known.len() > MOST { format!(", and {} more", known.len() - MOST) } else { String::new() };
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? There are {shown}{more}"),
        None => format!("there are {shown}{more}"),
    }
}

impl Open<'_> {
    /// Rows of a quantity in SI; NaN where the mapping has none.
    pub fn vector<U: Unit, const N: usize>(&self, name: &str, quantity: &Option<Vector<U>>, sphere: bool) -> Rows<N> {
        let Some(quantity) = quantity else { return Ok(vec![[f64::NAN; N]; self.table.rows()]) };
        let key = format!("{}.{name}", self.key);
        let Some(source) = quantity.source.as_deref().filter(|&source| source != self.source) else {
            return self.own(&key, self.source, self.table, quantity);
        };
        let table = self.sources.table(&key, source)?;
        let rows = self.own(&key, source, table, quantity)?;
        let stamps = self.sources.stamps(&key, source, table, None)?;
        let at = |found: join::Between| join::blend(rows[found.before], rows[found.after], found.share, sphere);
        let found = join::between(&stamps, &self.stamps);
        Ok(found.into_iter().map(|found| found.map_or([f64::NAN; N], at)).collect())
    }

    fn own<U: Unit, const N: usize>(&self, key: &str, source: &str, table: &Table, quantity: &Vector<U>) -> Rows<N> {
        let mut rows = vec![[f64::NAN; N]; table.rows()];
        for (k, field) in quantity.fields.iter().enumerate().take(N) {
            if optional(field) && !table.columns.contains_key(column(field)) {
                continue;
            }
            let column = self.sources.column(&format!("{key}.fields"), source, table, column(field))?;
            for (row, &x) in rows.iter_mut().zip(column) {
                row[k] = quantity.value(k, x);
            }
        }
        Ok(rows)
    }

    pub fn scalar<U: Unit>(&self, name: &str, quantity: &Option<Scalar<U>>) -> Result<Vec<f64>, Missing> {
        let Some(quantity) = quantity else { return Ok(vec![f64::NAN; self.table.rows()]) };
        let key = format!("{}.{name}", self.key);
        let mut columns = Vec::new();
        for field in quantity.fields() {
            if optional(field) && !self.table.columns.contains_key(column(field)) {
                return Ok(vec![f64::NAN; self.table.rows()]);
            }
            columns.push(self.sources.column(&key, self.source, self.table, column(field))?);
        }
        Ok((0..self.table.rows()).map(|i| quantity.value(columns.iter().map(|column| column[i]))).collect())
    }
}
