//! What caches and memory give to plain loops over heights.
//!
//! Reading and updating are loops that the compiler turns into vector code, for the widest vectors that the processor
//! has; copying is the system's. A step of the model reads and writes most of its fields in place, as the update does.

use std::hint::black_box;
use std::sync::Barrier;
use std::time::{Duration, Instant};

use multiversion::multiversion;

use crate::document::{Bandwidth, Spread};
use crate::machine::Machine;

/// Values that are added up side by side, enough to hide the time that an addition takes.
const LANES: usize = 64;

/// How long and how often each loop runs.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Measurements of each loop.
    pub repeats: usize,
    /// Time of one, about.
    pub block: Duration,
}

/// Where data can be, as name and bytes of each of `threads` threads: half of every cache, and far more than the last
/// cache holds.
pub fn places(machine: &Machine, threads: usize) -> Vec<(String, usize)> {
    let share = |cache: &crate::machine::Cache| cache.bytes as usize / 2 / threads.min(cache.shared_by);
    let mut places: Vec<_> = machine.caches.iter().map(|cache| (format!("L{}", cache.level), share(cache))).collect();
    let last = machine.caches.last().map_or(32 << 20, |cache| cache.bytes as usize);
    let most = machine.memory_bytes.map_or(usize::MAX, |bytes| bytes as usize / 4 / threads);
    places.push(("memory".into(), (8 * last).min(most)));
    places
}

/// Measures all loops over `bytes` bytes in each of `threads` threads at once.
pub fn bandwidth(place: String, bytes: usize, threads: usize, effort: Effort) -> Bandwidth {
    let values = (bytes / size_of::<f64>()).next_multiple_of(2 * LANES);
    let moved = (values * size_of::<f64>()) as f64;
    // Reading goes over the bytes once; copying reads one half and writes the other; updating reads and writes all.
    let read = sweep(values, threads, effort, |heights| {
        black_box(sum(heights));
    });
    let copy = sweep(values, threads, effort, |heights| {
        let (to, from) = heights.split_at_mut(heights.len() / 2);
        to.copy_from_slice(from);
    });
    let update = sweep(values, threads, effort, update_in_place);
    let rate = |times: Vec<f64>, factor: f64| {
        let rates: Vec<f64> = times.iter().map(|seconds| threads as f64 * factor * moved / seconds / 1e9).collect();
        Spread::of(&rates)
    };
    Bandwidth {
        place,
        working_set_bytes: values * size_of::<f64>(),
        threads,
        read: rate(read, 1.0),
        copy: rate(copy, 1.0),
        update: rate(update, 2.0),
    }
}

/// Seconds that one pass of `work` over the data takes, of the slowest thread, in every repeat.
fn sweep(values: usize, threads: usize, effort: Effort, work: impl Fn(&mut [f64]) + Sync) -> Vec<f64> {
    let barrier = Barrier::new(threads);
    let one_thread = || {
        let mut heights = vec![1.0; values];
        let start = Instant::now();
        work(black_box(&mut heights));
        work(black_box(&mut heights));
        let pass = start.elapsed().as_secs_f64() / 2.0;
        let passes = (effort.block.as_secs_f64() / pass.max(1e-9)).clamp(1.0, 1e9) as u32;
        let timed = |_| {
            barrier.wait();
            let start = Instant::now();
            for _ in 0..passes {
                work(black_box(&mut heights));
            }
            start.elapsed().as_secs_f64() / f64::from(passes)
        };
        (0..effort.repeats).map(timed).collect::<Vec<f64>>()
    };
    let slowest = |slowest: Vec<f64>, times: Vec<f64>| slowest.iter().zip(times).map(|(a, b)| a.max(b)).collect();
    std::thread::scope(|scope| {
        let running: Vec<_> = (1..threads).map(|_| scope.spawn(one_thread)).collect();
        let own = one_thread();
        let others =
            running.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        others.fold(own, slowest)
    })
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn sum(heights: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for heights in heights.chunks_exact(LANES) {
        for (sum, height) in sums.iter_mut().zip(heights) {
            *sum += height;
        }
    }
    sums.iter().sum()
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn update_in_place(heights: &mut [f64]) {
    // 1 is where it ends, so that no value grows or vanishes however often this is done.
    let (keep, add) = (0.75, 0.25);
    for height in heights {
        *height = *height * keep + add;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loops_do_their_work() {
        let mut heights: Vec<f64> = (0..2 * LANES).map(|index| index as f64).collect();
        // Closed form: 0 + 1 + .. + (n − 1) = n (n − 1)/2.
        assert_eq!(sum(&heights), (LANES * (2 * LANES - 1)) as f64);
        update_in_place(&mut heights);
        assert_eq!((heights[0], heights[4]), (0.25, 3.25));
    }

    #[test]
    fn every_loop_has_a_rate_for_any_number_of_threads() {
        let effort = Effort { repeats: 2, block: Duration::from_micros(50) };
        for threads in [1, 3] {
            let measured = bandwidth("L1".into(), 10_000, threads, effort);
            // 10 000 bytes are 1250 values, rounded up to whole pairs of lanes.
            assert_eq!((measured.working_set_bytes, measured.threads), (1280 * 8, threads));
            for rate in [measured.read, measured.copy, measured.update] {
                assert!(rate.minimum > 0.0 && rate.maximum.is_finite(), "{measured:?}");
            }
        }
    }
}
