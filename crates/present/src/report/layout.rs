//! What all pages have in common: template, look and scripts, and what is filled in.

use super::html;
use super::section::Section;
use super::template::fill;

const TEMPLATE: &str = include_str!("assets/page.html");
const STYLE: &str = include_str!("assets/style.css");
const SCRIPT: &str = include_str!("assets/common.js");

/// Bytes of a page without what is filled in.
pub const AROUND: usize = TEMPLATE.len() + STYLE.len() + SCRIPT.len();

/// A page before it is put together.
pub struct Layout<'a> {
    /// Its title, as plain text.
    pub title: &'a str,
    /// What stands below the title, as plain text.
    pub subtitle: &'a str,
    /// What deserves attention first, each a plain text.
    pub notices: &'a [String],
    /// What does without scripts and what does not.
    pub without_scripts: &'a str,
    /// The sections; empty ones are left out.
    pub sections: &'a [Section],
    /// Rules besides those of all pages.
    pub style: &'a str,
    /// The JSON document from which scripts draw.
    pub data: &'a str,
    /// Scripts besides those of all pages, each after those that it uses.
    pub script: &'a str,
}

impl Layout<'_> {
    /// The page.
    pub fn html(&self) -> String {
        let present = || self.sections.iter().filter(|section| !section.is_empty());
        let notice = |text: &String| format!("<p class=\"notice\">{}</p>\n", html::escape(text));
        fill(
            TEMPLATE,
            &[
                ("title", &html::escape(self.title)),
                ("subtitle", &html::escape(self.subtitle)),
                ("notices", &self.notices.iter().map(notice).collect::<String>()),
                ("without_scripts", &html::escape(self.without_scripts)),
                ("links", &present().map(Section::link).collect::<String>()),
                ("sections", &present().map(Section::html).collect::<String>()),
                ("style", &[self.style, STYLE].concat()),
                ("data", &html::json_in_script(self.data)),
                ("script", &[SCRIPT, self.script].concat()),
            ],
        )
    }
}
