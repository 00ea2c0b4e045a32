//! Equal windows of physical time, over which runs are compared.

/// Windows that follow each other from the start of a run to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Windows {
    /// Width of each, s.
    pub width: f64,
    /// How many there are, at least 1.
    pub count: usize,
}

impl Windows {
    /// As many windows as a run of that duration (s) has room for, if none may be narrower than `least` (s); a run that is
    /// shorter than that is one window.
    pub fn new(duration: f64, least: f64) -> Self {
        let count = (duration / least + 1e-9).floor().max(1.0);
        Self { width: duration / count, count: count as usize }
    }

    /// Where each of them ends, s.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        let width = self.width;
        (1..=self.count).map(move |number| number as f64 * width)
    }
}

#[cfg(test)]
mod tests {
    use super::Windows;

    #[test]
    fn windows_fill_the_run_and_are_wide_enough() {
        for (duration, least, width, count) in
            [(3000.0, 60.0, 60.0, 50), (3000.0, 70.0, 3000.0 / 42.0, 42), (10.0, 6.0, 10.0, 1), (2.0, 5.0, 2.0, 1)]
        {
            assert_eq!(Windows::new(duration, least), Windows { width, count });
        }
        assert_eq!(Windows::new(10.0, 5.0).ends().collect::<Vec<_>>(), [5.0, 10.0]);
    }
}
