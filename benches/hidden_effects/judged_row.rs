//! Truth, answer and judgement of a log, as a line and as one of CSV.

use crate::extended;
use crate::judge::{Judged, told};
use crate::rows::Row;

impl Row for Judged {
    const COLUMNS: &'static [&'static str] = &[
        "group",
        "hidden",
        "said",
        "verdict",
        "first_right",
        "found",
        "of",
        "nameable",
        "spurious",
        "unexplained",
        "seconds",
        "extended",
        "trains",
        "best",
        "best_ratio",
        "worst",
        "worst_ratio",
        "surely_worse",
        "surely_ratio",
    ];

    fn fields(&self) -> Vec<String> {
        let hidden: Vec<String> = self.hidden.iter().map(|h| format!("{}={:.4}", h.id, h.size)).collect();
        let (said, verdict) = match &self.answer {
            Ok(answer) => {
                (answer.findings.iter().map(Judged::say).collect::<Vec<_>>().join(" "), answer.verdict.clone())
            }
            Err(error) => (String::new(), format!("FAILED {error}")),
        };
        let mut fields = vec![
            self.group.name().to_string(),
            hidden.join(" "),
            said,
            verdict,
            usize::from(self.first_is_right()).to_string(),
            self.found()[1].to_string(),
            self.hidden.len().to_string(),
            usize::from(self.nameable()).to_string(),
            self.spurious().join(" "),
            usize::from(self.unexplained()).to_string(),
            format!("{:.1}", self.seconds),
        ];
        fields.extend(extended::fields(self));
        fields
    }

    fn line(&self) -> String {
        let truth = match self.wanted() {
            [] => self.group.name().to_string(),
            some => some.iter().map(told).collect::<Vec<_>>().join(" + "),
        };
        let (said, verdict) = match &self.answer {
            Ok(answer) => {
                let said: Vec<_> = answer.findings.iter().map(Judged::say).collect();
                (if said.is_empty() { "nothing".into() } else { said.join(", ") }, answer.verdict.clone())
            }
            Err(error) => (format!("FAILED: {error}"), String::new()),
        };
        let judgement = self.judgement();
        format!("{:<10}{truth}  ->  {said}  [{verdict}]  {judgement}  {:.1} s", self.group.name(), self.seconds)
    }
}
