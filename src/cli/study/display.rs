//! How far a study is: a bar over runs and a line a run under way on a terminal; elsewhere a line when a run begins or
//! ends.

use crate::cli::progress::clock;
use crate::cli::tell;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// The display, on standard error.
pub struct Display {
    bars: Option<(MultiProgress, ProgressBar)>,
    total: usize,
    started: Instant,
}

impl Display {
    /// Of `total` runs.
    pub fn new(total: usize) -> Self {
        let bars = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{bar:24} {pos} of {len} runs  {wide_msg}");
            let all = MultiProgress::new();
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = all.add(ProgressBar::new(total as u64).with_style(style));
            bar.tick();
            (all, bar)
        });
        Self { bars, total, started: Instant::now() }
    }

    /// The line of a run that begins.
    pub fn begin(&self, name: &str) -> BarLine {
        match &self.bars {
            Some((all, _)) => {
                let style = ProgressStyle::with_template("  {prefix}  {wide_msg}");
                let bar = all.add(ProgressBar::new_spinner().with_prefix(name.to_string()));
                bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
                BarLine(Some(bar))
            }
            None => {
                tell(&format!("{name} begins"));
                BarLine(None)
            }
        }
    }

    /// A run has ended, the `done`th; `remark` says how.
    pub fn end(&self, line: BarLine, done: usize, remark: &str) {
        let elapsed = self.started.elapsed();
        let left = elapsed.as_secs_f64() / done.max(1) as f64 * (self.total - done) as f64;
        let left = format!("{} left", clock(left));
        if let Some(bar) = line.0 {
            bar.finish_and_clear();
        }
        match &self.bars {
            Some((all, bar)) => {
                let _ = all.println(remark);
                bar.set_position(done as u64);
                bar.set_message(format!("{}  {left}", clock(elapsed.as_secs_f64())));
            }
            None => tell(&format!("{done} of {}: {remark}; {left}", self.total)),
        }
    }

    /// Leaves the last state on the screen.
    pub fn finish(self) {
        if let Some((_, bar)) = self.bars {
            bar.abandon();
        }
    }
}

/// The line of a run under way.
pub struct BarLine(Option<ProgressBar>);

impl BarLine {
    /// Shows what the run says.
    pub fn show(&self, text: &str) {
        if let Some(bar) = &self.0 {
            bar.set_message(text.trim().to_string());
            bar.enable_steady_tick(Duration::from_millis(500));
        }
    }
}
