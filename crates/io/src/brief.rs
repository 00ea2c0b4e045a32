//! Lists in messages - of problems, of names - of which as much is told as anybody reads: twenty, or what has room in 4000 letters.

use std::fmt::Display;

use crate::text::beginning;

/// Problems that are looked for in one text; nobody reads more, and in a file of another kind each word may be one.
pub const MOST_PROBLEMS: usize = 100;

/// Members of a list that are told, at most.
const MOST: usize = 20;
/// Letters of a list, at most, but for the separators and the number of those that are left out.
const ROOM: usize = 4000;

/// Some texts with a separator between them, such as a comma: the first of them, and how many more there are.
pub fn list<T: Display>(texts: impl IntoIterator<Item = T>, separator: &str) -> String {
    let (told, more) = told(texts, separator);
    if more == 0 { told } else { format!("{told}{separator}and {more} more") }
}

/// What is wrong with a file, a problem a line: the first of them, and how many more were found.
pub fn problems<T: Display>(problems: impl IntoIterator<Item = T>) -> String {
    let mut found = 0;
    let (told, more) = told(problems.into_iter().inspect(|_| found += 1), "\n");
    match more {
        0 => told,
        // Then no others were looked for.
        more if found >= MOST_PROBLEMS => format!("{told}\nand {more} more, at least"),
        more => format!("{told}\nand {more} more"),
    }
}

/// The first of some texts, one of them at least, and how many more there are.
fn told<T: Display>(texts: impl IntoIterator<Item = T>, separator: &str) -> (String, usize) {
    let mut texts = texts.into_iter();
    let (mut told, mut letters, mut count) = (String::new(), 0, 0);
    for text in texts.by_ref() {
        let text = text.to_string();
        let text = beginning(&text, ROOM);
        letters += text.chars().count();
        if count == MOST || count > 0 && letters > ROOM {
            // This one, and those that follow.
            return (told, 1 + texts.count());
        }
        if count > 0 {
            told.push_str(separator);
        }
        told.push_str(&text);
        count += 1;
    }
    (told, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_are_told_as_have_room() {
        assert_eq!(list([""; 0], ", "), "");
        assert_eq!(list(["a", "b"], ", "), "a, b");
        assert_eq!(list(1..=20, " "), "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20");
        assert_eq!(list(1..=23, ","), "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,and 3 more");
        let long = "ä".repeat(1500);
        assert_eq!(list([&long, &long, &long], "; "), format!("{long}; {long}; and 1 more"));
        assert_eq!(list(["x".repeat(10_000_000)], ", "), format!("{}…", "x".repeat(4000)));
    }

    #[test]
    fn problems_that_were_not_looked_for_are_not_counted() {
        assert_eq!(problems(["one", "two"]), "one\ntwo");
        assert!(problems(0..99).ends_with("\n19\nand 79 more"));
        assert!(problems(0..100).ends_with("\n19\nand 80 more, at least"));
    }
}
