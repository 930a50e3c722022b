//! What the program said, from its JSON.

use serde_json::Value;
use std::collections::BTreeMap;

/// How sure it is of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Named,
    NamedSet,
    Suspected,
    Drift,
}

/// A parameter and its 95 % interval.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub value: f64,
    pub interval: Option<[f64; 2]>,
}

#[derive(Clone, Debug)]
pub struct Finding {
    pub effect: String,
    pub status: Status,
    /// Of a set, its leader among them.
    pub members: Vec<String>,
    pub parameters: BTreeMap<String, Estimate>,
}

#[derive(Clone, Debug)]
pub struct Answer {
    pub verdict: String,
    pub findings: Vec<Finding>,
    /// Effects that this log cannot show.
    pub not_detectable: Vec<String>,
    /// Effects that it can, and the size from which it would.
    pub detectable: BTreeMap<String, f64>,
    /// Effects that it shows and that are too small to matter.
    pub small: Vec<String>,
    /// Whether a base parameter is said to have drifted.
    pub drift: bool,
    pub captured: Option<f64>,
    /// Why there is no extended vehicle.
    pub not_extended: Option<String>,
}

impl Answer {
    /// An error says what is missing.
    pub fn read(text: &str) -> Result<Self, String> {
        let json: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let verdict = json["verdict"].as_str().ok_or("no verdict")?.to_string();
        let findings = list(&json["findings"]).iter().map(finding).collect::<Result<Vec<_>, _>>()?;
        let effect = |entry: &Value| entry["effect"].as_str().or(entry.as_str()).map(str::to_string);
        let drift = !list(&json["drift"]).is_empty() || findings.iter().any(|f| f.status == Status::Drift);
        Ok(Answer {
            verdict,
            findings,
            not_detectable: list(&json["not_detectable"]).iter().filter_map(effect).collect(),
            detectable: list(&json["detectable"]).iter().filter_map(would_show).collect(),
            small: list(&json["small"]).iter().filter_map(effect).collect(),
            drift,
            captured: json["captured"].as_f64(),
            not_extended: json["not_extended"].as_str().map(str::to_string),
        })
    }

    /// Findings with a name, in the program's order.
    pub fn named(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|finding| matches!(finding.status, Status::Named | Status::NamedSet))
    }

    pub fn unexplained(&self) -> bool {
        self.verdict == "unexplained"
    }
}

fn finding(json: &Value) -> Result<Finding, String> {
    let effect = json["effect"].as_str().ok_or("a finding without effect")?.to_string();
    let status = match json["status"].as_str() {
        Some("named") => Status::Named,
        Some("named_set") => Status::NamedSet,
        Some("suspected") => Status::Suspected,
        Some("drift") => Status::Drift,
        other => return Err(format!("{effect} has the status {other:?}")),
    };
    let mut members: Vec<String> =
        list(&json["members"]).iter().filter_map(Value::as_str).map(str::to_string).collect();
    if !members.contains(&effect) {
        members.push(effect.clone());
    }
    let mut parameters = BTreeMap::new();
    for (name, of) in json["parameters"].as_object().into_iter().flatten() {
        if let Some(value) = of["value"].as_f64() {
            let interval = of["low"].as_f64().zip(of["high"].as_f64()).map(|(low, high)| [low, high]);
            parameters.insert(name.clone(), Estimate { value, interval });
        }
    }
    Ok(Finding { effect, status, members, parameters })
}

fn would_show(json: &Value) -> Option<(String, f64)> {
    Some((json["effect"].as_str()?.to_string(), json["smallest"].as_f64()?))
}

fn list(json: &Value) -> &[Value] {
    json.as_array().map_or(&[], Vec::as_slice)
}
