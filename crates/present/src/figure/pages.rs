//! A figure that is higher than a page of a journal: with lower boxes, or on several pages.

use std::ops::Range;

use super::chart::TWO_COLUMNS;
use super::page::Page;

/// Height of a page, at most, pixels: 240 mm beside a width of 180 mm.
const HIGHEST: f64 = TWO_COLUMNS * 4.0 / 3.0;

/// Whether each of the pages fits into a journal.
pub fn are_low(pages: &[Page]) -> bool {
    pages.iter().all(is_low)
}

fn is_low(page: &Page) -> bool {
    page.size[1] <= HIGHEST
}

/// Pages with so many parts of a figure in their order, as many on each as fit, at least one. `page` puts some of them on one page.
pub fn in_pages(parts: usize, page: impl Fn(Range<usize>) -> Page) -> Vec<Page> {
    let mut pages = Vec::new();
    let mut first = 0;
    while first < parts {
        let mut end = first + 1;
        let mut most = page(first..end);
        while end < parts {
            let more = page(first..end + 1);
            if !is_low(&more) {
                break;
            }
            (end, most) = (end + 1, more);
        }
        pages.push(most);
        first = end;
    }
    pages
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_parts_as_fit_are_on_a_page() {
        // By hand: at most 2880 pixels, the second part alone has more.
        let heights = |parts: &[f64]| -> Vec<f64> {
            let page = |some: Range<usize>| Page { size: [TWO_COLUMNS, parts[some].iter().sum()], ..Page::default() };
            in_pages(parts.len(), page).iter().map(|page| page.size[1]).collect()
        };
        assert_eq!(heights(&[1000.0, 3000.0, 1000.0, 1880.0, 1.0]), [1000.0, 3000.0, 2880.0, 1.0]);
        assert_eq!(heights(&[]), [0.0; 0]);
    }
}
