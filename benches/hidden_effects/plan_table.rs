//! What plans were worth, printed and as CSV.

use crate::plan::{Planned, said, says};
use crate::share::Share;
use racer::base::stats::quantile;
use std::path::Path;

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

/// Writes every flight as a line.
///
/// # Panics
///
/// Where the file cannot be written.
pub fn write(path: &Path, all: &[Planned]) {
    let mut out = csv::Writer::from_path(path).expect("the CSV");
    out.write_record(["log", "hidden", "size", "flown", "before", "tied", "plan", "plan_s", "after", "apart"])
        .expect("a line");
    for (number, p) in all.iter().enumerate() {
        let (plan, plan_s, after) = match &p.after {
            Some(Ok(after)) => (after.plan.clone(), format!("{:.0}", after.plan_s), says(&after.answer)),
            Some(Err(error)) => (format!("FAILED {error}"), String::new(), String::new()),
            None => Default::default(),
        };
        let flag = |yes: bool| usize::from(yes).to_string();
        let row = [
            number.to_string(),
            p.hidden.id.clone(),
            format!("{:.5}", p.hidden.size),
            p.flown.join(" "),
            said(&p.before),
            flag(p.tied()),
            plan,
            plan_s,
            after,
            if p.tied() { flag(p.apart()) } else { String::new() },
        ];
        out.write_record(row).expect("a line");
    }
    out.flush().expect("the CSV");
}
