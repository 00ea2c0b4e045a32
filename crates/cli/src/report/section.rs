//! The sections of the page.

/// A part of the page under a heading of its own; left out where its body is empty.
pub struct Section {
    id: &'static str,
    heading: &'static str,
    body: String,
}

impl Section {
    /// A section with its HTML.
    pub fn new(id: &'static str, heading: &'static str, body: impl Into<String>) -> Self {
        Self { id, heading, body: body.into() }
    }

    /// Whether there is nothing to show.
    pub fn is_empty(&self) -> bool {
        self.body.is_empty()
    }

    /// A link to it.
    pub fn link(&self) -> String {
        format!("<a href=\"#{}\">{}</a>\n", self.id, self.heading)
    }

    /// The section itself.
    pub fn html(&self) -> String {
        let Self { id, heading, body } = self;
        format!(
            "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">\n<h2 id=\"{id}-heading\">{heading}</h2>\n\
             {body}</section>\n"
        )
    }
}
