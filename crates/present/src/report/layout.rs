//! What all pages have in common: template, look and scripts, sections, and what is filled in.

use super::html;

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

/// A part of the page under a heading of its own; left out where its body is empty.
pub struct Section {
    id: String,
    heading: String,
    body: String,
}

impl Section {
    /// A section with its HTML; the heading is plain text.
    pub fn new(id: impl Into<String>, heading: impl Into<String>, body: impl Into<String>) -> Self {
        Self { id: id.into(), heading: heading.into(), body: body.into() }
    }

    /// Whether there is nothing to show.
    pub fn is_empty(&self) -> bool {
        self.body.is_empty()
    }

    /// A link to it.
    pub fn link(&self) -> String {
        format!("<a href=\"#{}\">{}</a>\n", self.id, html::escape(&self.heading))
    }

    /// The section itself.
    pub fn html(&self) -> String {
        let Self { id, heading, body } = self;
        let heading = html::escape(heading);
        format!(
            "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">\n<h2 id=\"{id}-heading\">{heading}</h2>\n\
             {body}</section>\n"
        )
    }
}

/// The template with every mark replaced by the part of its name; parts themselves are not searched for marks.
///
/// A mark without a part stays as it is.
pub fn fill(template: &str, parts: &[(&str, &str)]) -> String {
    let mut text = String::with_capacity(template.len() + parts.iter().map(|(_, part)| part.len()).sum::<usize>());
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        text.push_str(before);
        let found = after.split_once("}}").and_then(|(mark, behind)| {
            let part = parts.iter().find(|(name, _)| *name == mark.trim());
            part.map(|(_, part)| (*part, behind))
        });
        rest = match found {
            Some((part, behind)) => {
                text.push_str(part);
                behind
            }
            None => {
                text.push_str("{{");
                after
            }
        };
    }
    text.push_str(rest);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_filled_in_once() {
        let parts = [("title", "a {{body}} }}"), ("body", "text")];
        assert_eq!(fill("<{{title}}|{{ body }}>{{other}}{{", &parts), "<a {{body}} }}|text>{{other}}{{");
    }
}
