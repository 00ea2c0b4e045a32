//! Runs that repeat another one, in words.

/// What is to be known of so many runs that repeat another one.
pub fn sentence(repeats: usize, runs: usize) -> String {
    let (repeat, count) = if repeats == 1 { ("repeats", "counts") } else { ("repeat", "count") };
    format!(
        "{repeats} of {runs} runs {repeat} another one and {count} once with it: the same scene with the same seeds gives the \
         same result. Only [replicates] with several seeds tell the pure error."
    )
}
