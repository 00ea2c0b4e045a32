//! A text with marks such as `{{name}}` for what is filled in.

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
    use super::fill;

    #[test]
    fn parts_are_filled_in_once() {
        let parts = [("title", "a {{body}} }}"), ("body", "text")];
        assert_eq!(fill("<{{title}}|{{ body }}>{{other}}{{", &parts), "<a {{body}} }}|text>{{other}}{{");
    }
}
