//! Truth and answer side by side.

use crate::answer::{Answer, Finding, Status};
use crate::case::Group;
use crate::extended::Extended;
use crate::truth::effects::Hidden;

/// A log that the program answered, or failed on.
#[derive(Clone, Debug)]
pub struct Judged {
    pub group: Group,
    pub hidden: Vec<Hidden>,
    /// Names that the same log gets without what was put in; they are neither right nor wrong.
    pub before: Vec<String>,
    pub answer: Result<Answer, String>,
    /// How long the program took, s.
    pub seconds: f64,
    /// The vehicle that it wrote, if any.
    pub extended: Option<Result<Extended, String>>,
}

/// A parameter of a rightly named effect.
#[derive(Clone, Debug)]
pub struct Scored {
    /// Effect and parameter.
    pub name: String,
    /// Error over the size of the truth.
    pub error: f64,
    /// Whether the interval holds the truth, where there is one.
    pub inside: Option<bool>,
}

impl Judged {
    /// What is to be named first: any of two, else the last, which is the dominant one.
    pub fn wanted(&self) -> &[Hidden] {
        match self.group {
            Group::Clutter => &self.hidden[self.hidden.len() - 1..],
            _ => &self.hidden,
        }
    }

    fn ok(&self) -> Option<&Answer> {
        self.answer.as_ref().ok()
    }

    /// Names that count: not those of the untouched log, and drift only where that is what is wanted, as for a wrong
    /// mass.
    fn fresh<'a>(&'a self, answer: &'a Answer) -> impl Iterator<Item = &'a Finding> {
        answer.findings.iter().filter(|finding| match finding.status {
            Status::Named | Status::NamedSet => !self.before.contains(&finding.effect),
            Status::Drift => self.hidden.iter().any(|truth| truth.is(&finding.effect)),
            Status::Suspected => false,
        })
    }

    /// The first name it gave.
    pub fn first(&self) -> Option<&Finding> {
        self.fresh(self.ok()?).next()
    }

    pub fn first_is_right(&self) -> bool {
        self.first().is_some_and(|first| self.wanted().iter().any(|truth| truth.is(&first.effect)))
    }

    /// First is a set with the truth in it, led by another.
    pub fn first_set_holds(&self) -> bool {
        let holds = |first: &Finding| self.wanted().iter().any(|truth| first.members.iter().any(|m| truth.is(m)));
        !self.first_is_right() && self.first().is_some_and(|first| first.status == Status::NamedSet && holds(first))
    }

    pub fn first_is_wrong(&self) -> bool {
        self.first().is_some() && !self.first_is_right() && !self.first_set_holds()
    }

    pub fn missed(&self) -> bool {
        self.ok().is_some() && self.first().is_none()
    }

    pub fn unexplained(&self) -> bool {
        self.ok().is_some_and(Answer::unexplained)
    }

    /// Whether any right name of what is wanted can be told from this log, as the program sees it.
    pub fn nameable(&self) -> bool {
        let Some(answer) = self.ok() else { return true };
        let hopeless = |id: &str| answer.not_detectable.iter().any(|effect| effect == id);
        if self.group == Group::Outside {
            return true;
        }
        self.wanted().iter().any(|truth| truth.right.iter().any(|id| !hopeless(id)))
    }

    /// Whether the only cause, in the catalogue's form, is as large as the report says would have shown.
    pub fn promised(&self) -> bool {
        let (Some(answer), [truth]) = (self.ok(), &self.hidden[..]) else { return false };
        answer.detectable.get(&truth.id).is_some_and(|smallest| truth.size.abs() >= *smallest)
    }

    /// Whether the only cause is named, alone or in a set, or listed as too small to matter.
    pub fn shown(&self) -> bool {
        let small = |truth: &Hidden| self.ok().is_some_and(|answer| answer.small.iter().any(|id| truth.is(id)));
        self.found()[1] == 1 || self.hidden.first().is_some_and(small)
    }

    /// Confident names for what is not there.
    pub fn confident_wrong(&self) -> usize {
        let Some(answer) = self.ok() else { return 0 };
        let true_of = |finding: &&Finding| self.hidden.iter().any(|truth| truth.is(&finding.effect));
        self.fresh(answer).filter(|f| f.status == Status::Named && !true_of(f)).count()
    }

    /// Confident names, alone or of a set, with nothing behind them.
    pub fn spurious(&self) -> Vec<&str> {
        let Some(answer) = self.ok() else { return Vec::new() };
        let behind = |f: &&Finding| self.hidden.iter().any(|truth| f.members.iter().any(|member| truth.is(member)));
        self.fresh(answer).filter(|f| !behind(f)).map(|f| f.effect.as_str()).collect()
    }

    /// Whether each of what is hidden has a name of its own, and how many have one or are in a set.
    pub fn found(&self) -> [usize; 2] {
        let Some(answer) = self.ok() else { return [0, 0] };
        let named = |truth: &&Hidden| self.fresh(answer).any(|f| truth.is(&f.effect));
        let held = |truth: &&Hidden| self.fresh(answer).any(|f| f.members.iter().any(|member| truth.is(member)));
        [self.hidden.iter().filter(named).count(), self.hidden.iter().filter(held).count()]
    }

    /// Parameters of rightly named effects of the catalogue's form.
    pub fn parameters(&self) -> Vec<Scored> {
        let Some(answer) = self.ok() else { return Vec::new() };
        let mut scored = Vec::new();
        for truth in self.wanted() {
            let Some(finding) = self.fresh(answer).find(|f| truth.is(&f.effect)) else { continue };
            for value in truth.values() {
                if let Some(estimate) = finding.parameters.get(value.name) {
                    let error = (estimate.value - value.value) / value.against;
                    let inside = estimate.interval.map(|[low, high]| (low..=high).contains(&value.value));
                    scored.push(Scored { name: format!("{} {}", truth.id, value.name), error, inside });
                }
            }
        }
        scored
    }

    pub fn say(finding: &Finding) -> String {
        let status = match finding.status {
            Status::Named => "",
            Status::NamedSet => " (set)",
            Status::Suspected => "?",
            Status::Drift => " (drift)",
        };
        format!("{}{status}", finding.effect)
    }

    pub fn judgement(&self) -> &'static str {
        match (self.group, self.first()) {
            _ if self.answer.is_err() => "",
            (Group::None | Group::Drift, None) => "right",
            (Group::None | Group::Drift, Some(_)) => "FALSE NAME",
            (Group::Small, _) if !self.spurious().is_empty() => "WRONG NAME",
            (Group::Small, _) => "right",
            (Group::Outside, _) if self.unexplained() => "flagged",
            (Group::Outside, Some(_)) => "WRONG NAME",
            (Group::Outside, None) => "not flagged",
            _ if self.first_is_right() => "right",
            _ if self.first_set_holds() => "in the set",
            (_, Some(_)) => "WRONG FIRST",
            _ if self.nameable() => "MISSED",
            _ => "missed, not detectable",
        }
    }
}

pub fn told(truth: &Hidden) -> String {
    let parameters = truth.parameters();
    if parameters.is_empty() {
        return format!("{} {:.3}", truth.id, truth.size);
    }
    let list: Vec<_> = parameters.iter().map(|(name, value, unit)| format!("{name} {value:.4} {unit}")).collect();
    format!("{} ({})", truth.id, list.join(", "))
}
