//! Text as HTML.

use std::fmt::Write as _;

use plateau_io::text::is_plain;

/// A text that HTML shows as it is, also within the quotes of an attribute.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // Control characters are no HTML; lines may be wanted.
            letter if !is_plain(letter) && !"\n\t".contains(letter) => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// A text that begins with a capital letter.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A JSON document that may stand within a `script` element: what would end the element is written otherwise.
pub fn json_in_script(json: &str) -> String {
    // In JSON a `<` can only be within a string, where this means the same.
    json.replace('<', "\\u003c")
}

/// A table with heads above and to the left, in a box of its own that can be scrolled sideways.
///
/// `heads` are those of all columns, the first included; every row has as many cells.
pub fn table(caption: &str, heads: &[String], rows: &[Vec<String>]) -> String {
    table_of("scroll", caption, heads, rows)
}

/// The same for numbers: columns are as wide as they need to be, and numbers stand to the right.
pub fn number_table(caption: &str, heads: &[String], rows: &[Vec<String>]) -> String {
    table_of("scroll numbers", caption, heads, rows)
}

fn table_of(class: &str, caption: &str, heads: &[String], rows: &[Vec<String>]) -> String {
    let mut text = format!(
        "<div class=\"{class}\" tabindex=\"0\" role=\"region\" aria-label=\"{caption}\"><table>\n<thead><tr>",
        caption = escape(caption)
    );
    for head in heads {
        // Writing to a String cannot fail.
        let _ = write!(text, "<th scope=\"col\">{}</th>", escape(head));
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        let mut cells = row.iter().map(|cell| escape(cell));
        let head = cells.next().unwrap_or_default();
        let _ = write!(text, "<tr><th scope=\"row\">{head}</th>");
        for cell in cells {
            let _ = write!(text, "<td>{cell}</td>");
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody></table></div>\n");
    text
}

/// Names and what they mean, as a list.
pub fn terms(terms: &[(&str, String)]) -> String {
    let term = |(name, text): &(&str, String)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(text));
    format!("<dl>\n{}</dl>\n", terms.iter().map(term).collect::<String>())
}

/// A list of texts.
pub fn list(items: &[String]) -> String {
    let items: String = items.iter().map(|item| format!("<li>{}</li>\n", escape(item))).collect();
    format!("<ul>\n{items}</ul>\n")
}

#[cfg(test)]
mod tests {
    use super::{escape, json_in_script, table};

    #[test]
    fn text_stays_text() {
        assert_eq!(escape("</script><b a=\"1\">&'"), "&lt;/script&gt;&lt;b a=&quot;1&quot;&gt;&amp;&#39;");
        let json = serde_json::to_string("</script><!--").unwrap();
        let escaped = json_in_script(&json);
        assert!(!escaped.contains('<'));
        assert_eq!(serde_json::from_str::<String>(&escaped).unwrap(), "</script><!--");
    }

    #[test]
    fn cells_of_tables_are_escaped() {
        let html = table("a<b", &["<i>".into(), "run".into()], &[vec!["x".into(), "<u>".into()]]);
        assert!(html.contains("&lt;u&gt;") && html.contains("&lt;i&gt;") && html.contains("a&lt;b"), "{html}");
    }
}
