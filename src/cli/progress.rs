//! How far a training is: a bar on a terminal, now and then a line elsewhere.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Seconds between two lines where there is no terminal.
const LINE_S: f64 = 10.0;
/// The bar's resolution.
const TICKS: f64 = 1000.0;

/// What is shown.
pub struct TrainingStatus {
    /// Share of the budget used, 0..1.
    pub share: f64,
    pub seconds: f64,
    pub steps: u64,
    /// Median return and mean number of gates of the episodes that ended last; none before the first.
    pub episode_return: Option<f64>,
    pub gates: Option<f64>,
}

/// The display, on standard error.
pub struct TrainingBar {
    bar: Option<ProgressBar>,
    next_line_s: f64,
}

impl TrainingBar {
    pub fn new() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{bar:24} {percent:>3} %  {wide_msg}");
            ProgressBar::new(TICKS as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Self { bar, next_line_s: 0.0 }
    }

    /// Says something beside it.
    pub fn say(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => super::tell(text),
        }
    }

    pub fn show(&mut self, status: &TrainingStatus) {
        match &self.bar {
            Some(bar) => {
                bar.set_position((status.share * TICKS).min(TICKS) as u64);
                bar.set_message(text(status));
            }
            None if status.seconds >= self.next_line_s || status.share >= 1.0 => {
                super::tell(&format!("{:3.0} %  {}", 100.0 * status.share.min(1.0), text(status)));
                self.next_line_s = status.seconds + LINE_S;
            }
            None => {}
        }
    }
}

/// Leaves the last state on the screen.
impl Drop for TrainingBar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.abandon();
        }
    }
}

/// A bar in percent, for work that says how far it is.
pub fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:24} {percent:>3} %  {msg}");
    ProgressBar::new(100).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn text(status: &TrainingStatus) -> String {
    let &TrainingStatus { share, seconds, steps, episode_return, gates } = status;
    let number = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.1}"));
    let left = seconds * (1.0 - share).max(0.0) / share.max(1e-9);
    format!(
        "{:.1} M steps  {:.2} M steps/s  reward {}  gates/episode {}  {} left",
        steps as f64 / 1e6,
        steps as f64 / 1e6 / seconds.max(1e-9),
        number(episode_return),
        number(gates),
        clock(left)
    )
}

/// Minutes and seconds, or hours too.
pub fn clock(seconds: f64) -> String {
    let s = seconds.max(0.0).round() as u64;
    match s / 3600 {
        0 => format!("{}:{:02}", s / 60, s % 60),
        hours => format!("{hours}:{:02}:{:02}", s / 60 % 60, s % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks() {
        assert_eq!([0.0, 59.6, 245.0, 3725.0].map(clock), ["0:00", "1:00", "4:05", "1:02:05"]);
    }

    #[test]
    fn the_line_says_all_there_is() {
        let status =
            TrainingStatus { share: 0.25, seconds: 10.0, steps: 12_000_000, episode_return: Some(3.06), gates: None };
        assert_eq!(text(&status), "12.0 M steps  1.20 M steps/s  reward 3.1  gates/episode -  0:30 left");
    }
}
