//! What plans were worth, printed and as lines of CSV.

use crate::plan::{Planned, said, says};
use crate::rows::Row;
use crate::share::Share;
use racer::base::stats::quantile;

/// Prints the shares.
pub fn print(all: &[Planned]) {
    let tied: Vec<&Planned> = all.iter().filter(|p| p.tied()).collect();
    println!("\n{} flights, {} of them with tied causes and the truth among them", all.len(), tied.len());
    let share = |name: &str, yes: &dyn Fn(&Planned) -> bool| {
        println!("  {name:<52}{}", Share::count(tied.iter().map(|p| yes(p))).text());
    };
    share("no plan, or the program failed", &|p| p.answer().is_none());
    share("told apart: the right cause named, and alone", &Planned::apart);
    share("the right cause named", &Planned::right);
    share("a wrong name", &Planned::wrong);
    let lengths: Vec<f64> = tied.iter().filter_map(|p| Some(p.after.as_ref()?.as_ref().ok()?.plan_s)).collect();
    if !lengths.is_empty() {
        println!("planned flight: median {:.0} s, longest {:.0} s", quantile(&lengths, 0.5), quantile(&lengths, 1.0));
    }
}

impl Row for Planned {
    const COLUMNS: &'static [&'static str] =
        &["hidden", "size", "flown", "before", "tied", "plan", "plan_s", "after", "apart"];

    fn fields(&self) -> Vec<String> {
        let (plan, plan_s, after) = match &self.after {
            Some(Ok(after)) => (after.plan.clone(), format!("{:.0}", after.plan_s), says(&after.answer)),
            Some(Err(error)) => (format!("FAILED {error}"), String::new(), String::new()),
            None => Default::default(),
        };
        let flag = |yes: bool| usize::from(yes).to_string();
        vec![
            self.hidden.id.clone(),
            format!("{:.5}", self.hidden.size),
            self.flown.join(" "),
            said(&self.before),
            flag(self.tied()),
            plan,
            plan_s,
            after,
            if self.tied() { flag(self.apart()) } else { String::new() },
        ]
    }

    fn line(&self) -> String {
        let hidden = format!("{} {:.4}", self.hidden.id, self.hidden.size);
        let first = said(&self.before);
        let Some(after) = &self.after else { return format!("{hidden}  ->  {first}  {:.1} s", self.seconds) };
        let (plan, last) = match after {
            Ok(after) => (format!("{} ({:.0} s)", after.plan, after.plan_s), says(&after.answer)),
            Err(error) => (format!("FAILED: {error}"), String::new()),
        };
        let verdict = if self.apart() { "apart" } else { "NOT APART" };
        format!("{hidden}  ->  {first}  ->  {plan}  ->  {last}  {verdict}  {:.1} s", self.seconds)
    }
}
