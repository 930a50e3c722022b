//! Keys of the configuration that came after the first runs were kept, and what was so before them.
//!
//! Whoever adds a key adds it here as well, with the value that changes nothing: an older run or policy then opens, and
//! means what it meant.

use toml::{Table, Value};

/// A key, and the value that stands for a racer without it, as TOML.
struct Later {
    key: &'static str,
    before: &'static str,
}

const LATER: [Later; 11] = [
    // Penalties were whole from the first step on.
    Later { key: "ppo.penalty_begin", before: "1.0" },
    Later { key: "ppo.penalty_full", before: "0.0" },
    // The entropy was that of the Gaussian before its tanh, with the same weight to the end.
    Later { key: "ppo.entropy_squashed", before: "false" },
    Later { key: "ppo.entropy_end", before: "1.0" },
    // Products were singles'.
    Later { key: "ppo.precision", before: "'f32'" },
    // The step size depended on the share of the budget alone.
    Later { key: "ppo.refine_after", before: "0.0" },
    // Nothing but `action_magnitude` held commands back.
    Later { key: "ppo.saturation", before: "0.0" },
    // The weights of a policy were those of its iteration.
    Later { key: "ppo.average", before: "0.0" },
    // An episode started anywhere, however the one before it had ended.
    Later { key: "env.reset.retry_share", before: "0.0" },
    // Apertures were the same from the first step on.
    Later { key: "env.gate_radius_begin", before: "1.0" },
    Later { key: "env.gate_radius_full", before: "0.0" },
];

/// Whether `key` came later.
pub fn is_later(key: &str) -> bool {
    LATER.iter().any(|later| later.key == key)
}

/// Gives every later key that `table` lacks its old meaning. `table` is a whole configuration, or `part` of one, such
/// as `env`; tables that are not there stay away.
pub fn complete(table: &mut Table, part: Option<&str>) {
    for Later { key, before } in LATER {
        let key = match part {
            None => Some(key),
            Some(part) => key.strip_prefix(part).and_then(|rest| rest.strip_prefix('.')),
        };
        if let Some(key) = key {
            set_if_absent(table, key, before);
        }
    }
}

fn set_if_absent(table: &mut Table, key: &str, before: &str) {
    match key.split_once('.') {
        Some((outer, rest)) => {
            if let Some(Value::Table(inner)) = table.get_mut(outer) {
                set_if_absent(inner, rest, before);
            }
        }
        None => {
            table.entry(key).or_insert_with(|| before.parse().expect("a TOML value"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::race::config::Config;

    #[test]
    fn every_later_key_exists_and_its_old_value_is_allowed() {
        let mut whole: Table = Config::load("a2rl", &[]).unwrap().to_toml().parse().unwrap();
        let keys = whole.clone();
        for Later { key, .. } in LATER {
            let (tables, name) = key.rsplit_once('.').unwrap();
            let within = tables.split('.').fold(&keys, |table, part| table[part].as_table().unwrap());
            assert!(within.contains_key(name), "{key}");
            let without = tables.split('.').fold(&mut whole, |table, part| table[part].as_table_mut().unwrap());
            without.remove(name);
        }
        let mut part = whole["ppo"].as_table().unwrap().clone();
        complete(&mut part, Some("ppo"));
        complete(&mut whole, None);
        assert_eq!(whole["ppo"].as_table().unwrap(), &part);
        let old: Config = whole.try_into().unwrap();
        crate::base::check::Check::check(&old).unwrap();
        assert_eq!([0.0, 0.2].map(|share| old.ppo.penalty(share)), [1.0; 2]);
    }
}
