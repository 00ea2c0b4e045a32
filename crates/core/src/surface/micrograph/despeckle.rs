//! Removal of specks.

use super::Picture;

/// Turns every region of `value` of fewer than `smallest` pixels into its opposite; gives their number. Pixels belong
/// together that share a side.
pub(super) fn despeckle(picture: &mut Picture<bool>, value: bool, smallest: usize) -> usize {
    let Picture { width, ref mut pixels, .. } = *picture;
    let mut seen = vec![false; pixels.len()];
    let mut region = Vec::new();
    let mut specks = 0;
    for start in 0..pixels.len() {
        if pixels[start] != value || seen[start] {
            continue;
        }
        seen[start] = true;
        region.clear();
        region.push(start);
        let mut next = 0;
        while let Some(&pixel) = region.get(next) {
            next += 1;
            for neighbour in neighbours(pixel, width, pixels.len()).into_iter().flatten() {
                if pixels[neighbour] == value && !seen[neighbour] {
                    seen[neighbour] = true;
                    region.push(neighbour);
                }
            }
        }
        if region.len() < smallest {
            specks += 1;
            region.iter().for_each(|pixel| pixels[*pixel] = !value);
        }
    }
    specks
}

/// Pixels that share a side with this one.
fn neighbours(pixel: usize, width: usize, count: usize) -> [Option<usize>; 4] {
    let x = pixel % width;
    [
        (x > 0).then(|| pixel - 1),
        (x + 1 < width).then_some(pixel + 1),
        pixel.checked_sub(width),
        (pixel + width < count).then_some(pixel + width),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(lines: &[&str]) -> Picture<bool> {
        let pixels = lines.iter().flat_map(|line| line.chars()).map(|pixel| pixel == '#').collect();
        Picture { width: lines[0].len(), height: lines.len(), pixels }
    }

    #[test]
    fn takes_away_what_is_small_and_leaves_the_rest() {
        // Regions of 1, 2 and 5 pixels that touch each other at corners only.
        let before = picture(&["#....##", ".##....", "...#...", "..###..", "...#..."]);
        for (smallest, specks, after) in [
            (1, 0, ["#....##", ".##....", "...#...", "..###..", "...#..."]),
            (2, 1, [".....##", ".##....", "...#...", "..###..", "...#..."]),
            (3, 3, [".......", ".......", "...#...", "..###..", "...#..."]),
            (6, 4, [".......", ".......", ".......", ".......", "......."]),
        ] {
            let mut found = before.clone();
            assert_eq!(despeckle(&mut found, true, smallest), specks);
            assert_eq!(found, picture(&after), "{smallest}");
        }
    }

    #[test]
    fn fills_holes() {
        let mut found = picture(&["#####", "#.#.#", "###.#", "#####"]);
        assert_eq!(despeckle(&mut found, false, 2), 1);
        assert_eq!(found, picture(&["#####", "###.#", "###.#", "#####"]));
    }
}
