//! How fast a run is, and whether it still goes on.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::Look;

/// Wall time over which the speed is taken.
const WINDOW: Duration = Duration::from_secs(30);
/// Wall time between two looks that tells a speed, at least.
const SHORTEST: Duration = Duration::from_secs(2);
/// Wall time without a sample after which a run may have been killed, at least.
const PATIENCE: Duration = Duration::from_secs(60);
/// As many usual intervals between samples must pass without one.
const INTERVALS: u32 = 10;

/// How fast a run is, and how long nothing new has come, from one look to the next.
#[derive(Debug)]
pub struct Pace {
    /// Wall times of looks and the simulated times that they found, s.
    seen: VecDeque<(Instant, f64)>,
    samples: usize,
    news: Instant,
    /// Samples have come while it was watched.
    alive: bool,
}

impl Pace {
    /// Before the first look.
    pub fn new(now: Instant) -> Self {
        Self { seen: VecDeque::new(), samples: 0, news: now, alive: false }
    }

    /// Takes note of a look.
    pub fn note(&mut self, look: &Look, now: Instant) {
        if self.seen.back().is_some_and(|(_, time)| look.time() < *time) {
            // Another run has taken the place of the file.
            *self = Self::new(now);
        }
        if look.times.len() != self.samples {
            self.alive |= self.samples > 0;
            self.samples = look.times.len();
            self.news = now;
        }
        self.seen.push_back((now, look.time()));
        while self.seen.len() > 2 && self.seen.front().is_some_and(|(then, _)| now - *then > WINDOW) {
            self.seen.pop_front();
        }
    }

    /// Simulated seconds per second of wall time: lately, or since the run began; none before the first sample.
    pub fn speed(&self, look: &Look) -> Option<f64> {
        let lately = || {
            let ((start, from), (end, to)) = (*self.seen.front()?, *self.seen.back()?);
            (self.alive && end - start >= SHORTEST).then(|| (to - from) / (end - start).as_secs_f64())
        };
        let over_all = || Some(look.time() / look.elapsed?.as_secs_f64());
        lately().or_else(over_all).filter(|speed| *speed > 0.0 && speed.is_finite())
    }

    /// How long there has been no new sample while it was watched.
    pub fn idle(&self, now: Instant) -> Duration {
        now - self.news
    }

    /// How long there has been no new sample, where that is so long that the run may have been killed.
    pub fn silence(&self, look: &Look, now: Instant) -> Option<Duration> {
        // Clocks of two machines differ: the age of a file that is seen to grow says nothing.
        let silence = if self.alive { self.idle(now) } else { self.idle(now).max(look.age) };
        let samples = u32::try_from(look.times.len()).unwrap_or(u32::MAX).max(1);
        let usual = look.elapsed.unwrap_or_default() / samples;
        (silence >= PATIENCE.max(usual.saturating_mul(INTERVALS))).then_some(silence)
    }
}

#[cfg(test)]
mod tests {
    use plateau_io::run_file::State;

    use super::*;

    fn look(samples: usize, elapsed: u64, age: u64) -> Look {
        Look {
            title: "a run".into(),
            state: State::Running,
            error: None,
            times: (1..=samples).map(|sample| sample as f64).collect(),
            duration: Some(100.0),
            contact_area: vec![1e-6; samples],
            contact_area_mean: vec![1e-6; samples],
            filled_fraction: None,
            elapsed: Some(Duration::from_secs(elapsed)),
            age: Duration::from_secs(age),
        }
    }

    #[test]
    fn speed_is_that_since_the_start_and_later_that_of_the_last_half_minute() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        pace.note(&look(20, 10, 0), start);
        assert_eq!(pace.speed(&look(20, 10, 0)), Some(2.0));
        pace.note(&look(80, 20, 0), start + Duration::from_secs(10));
        assert_eq!(pace.speed(&look(80, 20, 0)), Some(6.0));
        assert_eq!(Pace::new(start).speed(&look(0, 10, 0)), None);
    }

    #[test]
    fn a_run_without_news_may_have_been_killed() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        // Written an hour ago, as far as the clocks agree.
        let old = look(20, 10, 3600);
        pace.note(&old, start);
        assert_eq!(pace.silence(&old, start), Some(Duration::from_secs(3600)));
        // It grows after all.
        let grown = look(21, 3610, 3600);
        pace.note(&grown, start + Duration::from_secs(5));
        assert_eq!(pace.silence(&grown, start + Duration::from_secs(6)), None);
        // One sample in 10 min until now: a minute without one says nothing.
        let slow = look(6, 3600, 0);
        let mut pace = Pace::new(start);
        pace.note(&slow, start);
        assert_eq!(pace.silence(&slow, start + Duration::from_secs(300)), None);
        assert_eq!(pace.silence(&slow, start + Duration::from_secs(6000)), Some(Duration::from_secs(6000)));
    }
}
