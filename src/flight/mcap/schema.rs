//! How a CDR message is laid out, whichever language its schema is written in.

use crate::flight::number::Number;
use std::collections::HashMap;

/// Structs within structs that a message may have.
const DEPTH: usize = 32;

#[derive(Clone, Debug, PartialEq)]
pub enum Type {
    Number(Number),
    /// Seconds and nanoseconds.
    Time,
    Text,
    /// A position in [`CdrSchema::structs`].
    Struct(usize),
    /// So many of them, or a sequence that says itself how many.
    List {
        of: Box<Type>,
        count: Option<usize>,
    },
    /// A type called so, before linking.
    Named(String),
}

pub type Fields = Vec<(String, Type)>;

/// What a name stands for. Parts of a name are separated by `::`.
pub enum Definition {
    Struct(Fields),
    Alias(Type),
}

/// The types of a message, with every name resolved, without cycles and not too deep.
#[derive(Debug)]
pub struct CdrSchema {
    pub structs: Vec<Fields>,
    pub root: Type,
}

impl CdrSchema {
    /// Follows the names from `root` on.
    pub fn link(mut definitions: HashMap<String, Definition>, root: &str) -> Result<Self, String> {
        for name in ["Time", "Duration", "msg::Time", "msg::Duration"] {
            let part = |name: &str, number| (name.to_string(), Type::Number(number));
            let time = vec![part("sec", Number::I32), part("nanosec", Number::U32)];
            definitions.entry(format!("builtin_interfaces::{name}")).or_insert(Definition::Struct(time));
        }
        let mut linker = Linker { definitions, linked: HashMap::new(), structs: Vec::new() };
        let (root, _) = linker.name(root, "", 0)?;
        Ok(Self { structs: linker.structs, root })
    }
}

struct Linker {
    definitions: HashMap<String, Definition>,
    /// Types and how many levels they nest.
    linked: HashMap<String, (Type, usize)>,
    structs: Vec<Fields>,
}

impl Linker {
    fn name(&mut self, name: &str, scope: &str, depth: usize) -> Result<(Type, usize), String> {
        let full = self.resolve(name, scope).ok_or_else(|| format!("its schema does not define the type {name}"))?;
        if let Some(linked) = self.linked.get(&full) {
            return Ok(linked.clone());
        }
        let linked = match &self.definitions[&full] {
            Definition::Alias(of) => self.link(&of.clone(), &full, depth)?,
            Definition::Struct(fields) => self.fields(fields.clone(), &full, depth)?,
        };
        self.linked.insert(full, linked.clone());
        Ok(linked)
    }

    /// The definition meant by `name` within `scope`: the innermost.
    fn resolve(&self, name: &str, mut scope: &str) -> Option<String> {
        let name = name.trim_start_matches("::");
        loop {
            let full = if scope.is_empty() { name.to_string() } else { format!("{scope}::{name}") };
            if self.definitions.contains_key(&full) {
                return Some(full);
            }
            if scope.is_empty() {
                return None;
            }
            scope = scope.rsplit_once("::").map_or("", |(outer, _)| outer);
        }
    }

    fn fields(&mut self, mut fields: Fields, scope: &str, depth: usize) -> Result<(Type, usize), String> {
        let mut levels = 0;
        for (_, of) in &mut fields {
            let (linked, below) = self.link(of, scope, depth)?;
            *of = linked;
            levels = levels.max(below);
        }
        if let [(sec, Type::Number(Number::I32)), (nanosec, Type::Number(Number::U32))] = fields.as_slice()
            && (sec, nanosec) == (&"sec".to_string(), &"nanosec".to_string())
        {
            return Ok((Type::Time, 0));
        }
        if fields.is_empty() {
            // An empty struct still takes a byte.
            fields.push(("structure_needs_at_least_one_member".into(), Type::Number(Number::U8)));
        }
        self.structs.push(fields);
        Ok((Type::Struct(self.structs.len() - 1), levels))
    }

    fn link(&mut self, of: &Type, scope: &str, depth: usize) -> Result<(Type, usize), String> {
        let too_deep = || format!("its schema nests types more than {DEPTH} deep, or within themselves");
        if depth > DEPTH {
            return Err(too_deep());
        }
        let (linked, below) = match of {
            Type::Named(name) => self.name(name, scope, depth + 1)?,
            Type::List { count: Some(0), .. } => return Err("its schema has an array of size 0".into()),
            Type::List { of, count } => {
                let (of, below) = self.link(of, scope, depth + 1)?;
                (Type::List { of: Box::new(of), count: *count }, below)
            }
            plain => return Ok((plain.clone(), 0)),
        };
        if below >= DEPTH { Err(too_deep()) } else { Ok((linked, below + 1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> Type {
        Type::Named(name.into())
    }

    #[test]
    fn cycles_and_towers_are_refused() {
        let cycle = HashMap::from([("a".into(), Definition::Struct(vec![("a".into(), named("a"))]))]);
        assert!(CdrSchema::link(cycle, "a").is_err());
        // Each is shallow on its own, seen from the one before.
        let mut tower = HashMap::from([("t0".into(), Definition::Alias(Type::Text))]);
        for i in 1..100 {
            tower.insert(format!("t{i}"), Definition::Struct(vec![("x".into(), named(&format!("t{}", i - 1)))]));
        }
        let fields = (0..100).map(|i| (format!("f{i}"), named(&format!("t{i}")))).collect();
        tower.insert("all".into(), Definition::Struct(fields));
        assert!(CdrSchema::link(tower, "all").is_err());
    }

    #[test]
    fn names_are_looked_up_from_the_inside_out() {
        let definitions = HashMap::from([
            ("p::Root".into(), Definition::Struct(vec![("a".into(), named("Leaf")), ("b".into(), named("q::Leaf"))])),
            ("p::Leaf".into(), Definition::Alias(Type::Number(Number::F32))),
            ("q::Leaf".into(), Definition::Alias(Type::Number(Number::F64))),
        ]);
        let schema = CdrSchema::link(definitions, "p::Root").unwrap();
        assert_eq!(schema.structs[0][0].1, Type::Number(Number::F32));
        assert_eq!(schema.structs[0][1].1, Type::Number(Number::F64));
    }
}
