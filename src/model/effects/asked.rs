//! Sizes of effects by the names that people read, turned into those of the equation.

use super::{Card, EffectParameter};

/// Halvings of the search for a parameter: more than a double has digits.
const HALVINGS: usize = 200;

impl Card {
    /// Names and units that people read, where the equation has others, with the values at its parameters `k` and the
    /// time constants `tau` of roll, pitch, yaw and thrust, s.
    fn read_as(&self, k: &[f64], tau: [f64; 4]) -> Vec<(&'static str, f64, &'static str)> {
        let own = |name: &str| self.parameters.iter().any(|p| p.name == name);
        let shown = self.shown.map_or(Vec::new(), |shown| shown(k, tau));
        shown.into_iter().filter(|(name, ..)| !own(name)).collect()
    }

    /// The same of a single parameter as ranges while it goes through `sizes`; none of what does not change with it.
    pub fn read_within(&self, sizes: [f64; 2], tau: [f64; 4]) -> Vec<(&'static str, [f64; 2], &'static str)> {
        if self.parameters.len() != 1 {
            return Vec::new();
        }
        let [first, last] = sizes.map(|size| self.read_as(&[size], tau));
        let both = first.into_iter().zip(last).filter(|((_, a, _), (_, b, _))| a != b);
        both.map(|((name, a, unit), (_, b, _))| (name, [a.min(b), a.max(b)], unit)).collect()
    }

    /// The parameter, and its size, at which people read `value` by the name `name`, in a vehicle of these time
    /// constants; none where no single parameter makes it.
    pub fn asked(&self, name: &str, value: f64, tau: [f64; 4]) -> Option<(&'static EffectParameter, f64)> {
        let [parameter] = self.parameters else { return None };
        let beyond = |size: f64| {
            let (_, at, _) = self.read_as(&[size], tau).into_iter().find(|(shown, ..)| *shown == name)?;
            Some(at - value)
        };
        let (mut low, mut high) = (parameter.low, parameter.high);
        let (first, last) = (beyond(low)?, beyond(high)?);
        if first == last || first * last > 0.0 || !value.is_finite() {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (beyond(middle)? > 0.0) == (last > first) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some((parameter, 0.5 * (low + high)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::cards;

    #[test]
    fn what_people_read_is_what_they_may_ask_for() {
        let tau = [0.02, 0.02, 0.05, 0.03];
        let mut found = 0;
        for card in cards().filter(|card| card.parameters.len() == 1) {
            for size in card.parameters[0].typical {
                for (name, value, _) in card.read_as(&[size], tau) {
                    let Some((parameter, asked)) = card.asked(name, value, tau) else {
                        // The vehicle's own number, whatever the size.
                        assert_eq!(card.read_as(&[0.0], tau)[0].1, value, "{}.{name}", card.id);
                        continue;
                    };
                    assert!((asked / size - 1.0).abs() < 1e-9, "{}.{name}: {asked} {}", card.id, parameter.name);
                    found += 1;
                }
                assert!(card.asked("nothing", 1.0, tau).is_none());
            }
        }
        assert!(found >= 10, "{found}");
    }
}
