//! What pages share: the frame, numbers, units.

use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:960px;margin:2em auto;padding:0 1em;color:#111}
table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;text-align:right;border-bottom:1px solid #ccc}
td:first-child,th:first-child{text-align:left}.why{color:#555}svg{width:100%;height:auto}";

/// A page that needs nothing else.
pub fn page(title: &str, extra_style: &str, body: Markup) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head { meta charset="utf-8"; title { (title) } style { (PreEscaped(STYLE)) (PreEscaped(extra_style)) } }
            body { (body) }
        }
    };
    markup.into_string()
}

/// A number, or a dash.
pub fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("-".into(), |v| format!("{v:.digits$}"))
}

/// A number with as many digits as `to` has in its first `digits`.
pub fn digits(value: f64, to: f64, digits: i32) -> String {
    let places = if to.abs() > 0.0 && to.is_finite() { digits - 1 - to.abs().log10().floor() as i32 } else { 3 };
    let places = places.clamp(0, 9) as usize;
    format!("{value:.places$}").replace('-', "\u{2212}")
}

/// `low` to `high`, each with up to three digits.
pub fn range([low, high]: [f64; 2]) -> String {
    let short = |value: f64| {
        let text = digits(value, value, 3);
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
    };
    format!("{} to {}", short(low), short(high))
}

/// A unit as people write it: m/s2 with a raised 2.
pub fn unit(unit: &str) -> String {
    let mut before = ' ';
    let raised = |c: char| {
        let to = match c {
            '2' if before.is_alphabetic() => '²',
            '3' if before.is_alphabetic() => '³',
            _ => c,
        };
        before = c;
        to
    };
    if unit == "1" { String::new() } else { unit.chars().map(raised).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_units_are_for_people() {
        assert_eq!(digits(0.499_46, 0.005_9, 2), "0.4995");
        assert_eq!(digits(-1234.5, 1234.5, 3), "\u{2212}1234");
        assert_eq!(digits(0.0, 0.0, 3), "0.000");
        assert_eq!(range([1.0 / 600.0, 0.01]), "0.00167 to 0.01");
        assert_eq!([range([4.4e-5, 2.8e-4]), range([0.5, 150.0])], ["0.000044 to 0.00028", "0.5 to 150"]);
        assert_eq!([unit("m/s2"), unit("s2/rad"), unit("1/s"), unit("1")], ["m/s²", "s²/rad", "1/s", ""]);
    }
}
