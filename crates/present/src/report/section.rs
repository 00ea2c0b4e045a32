//! The sections of a page.

use super::html;

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
