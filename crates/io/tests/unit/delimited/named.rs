use super::*;

/// The cells of names and rows, parted by bars, a line each.
fn table(text: &str) -> Result<Vec<String>, Fault> {
    let shown = |line: &Line<'_>| line.cells.iter().map(|cell| &cell.text[..]).collect::<Vec<_>>().join("|");
    let Some(table) = Named::of(text)? else { return Ok(Vec::new()) };
    let mut lines = vec![shown(&table.head)];
    for row in table.rows() {
        lines.push(shown(&row?));
    }
    Ok(lines)
}

#[test]
fn every_dialect_gives_the_same_table() {
    for text in [
        "# rig 2\nload [N],worn\n7.5 N,-1.25e-3\n# no\n,dry\n\n# end\n",
        "sep=;\r\nload [N];worn\r\n7,5 N;-1,25e-3\r\n;dry\r\n",
        "load [N];worn;\n7.5 N;-1.25e-3;\n;dry;\n",
        "\"load [N]\"\t\"worn\"\r\"7,5 N\"\t\"-1,25e-3\"\r\tdry\r",
    ] {
        assert_eq!(table(text).unwrap(), ["load [N]|worn", "7.5 N|-1.25e-3", "|dry"], "{text}");
    }
    assert_eq!(table("a,b\n\"x, \"\"y\"\"\",\"1,5\"\n").unwrap()[1], "x, \"y\"|1,5");
    assert_eq!(table("sep=;\n# nothing\n").unwrap(), [""; 0]);
}

#[test]
fn two_marks_two_tables_and_open_quotation_marks_are_refused_with_their_places() {
    let fault = |text: &str| {
        let Fault { line, column, message } = table(text).unwrap_err();
        format!("{line}:{column}: {message}")
    };
    let two = fault("time [s];normal_force [N]\n0;10,5\n3; 1.200\n");
    assert!(
        two.starts_with("3:4: \"1.200\" and \"10,5\" in line 2, column 3: a decimal point and a decimal comma"),
        "{two}"
    );
    assert!(fault("a\tb\n1.5\t2\n1,5\t2\n").starts_with("3:1: \"1,5\" and \"1.5\" in line 2, column 1: "));
    for (text, place) in [("a,b\n1,2\n\n3,4\n", "4:1: "), ("a,b\n1,2\n\n# more\na,b\n3,4\n", "4:1: ")] {
        let found = fault(text);
        assert!(found.starts_with(place) && found.contains("another table begins here, below a blank line"), "{found}");
    }
    assert!(fault("a,b\n1,2\na,b\n3,4\n").starts_with("3:1: another table begins here, with a header"));
    assert!(fault("a,b\n1,\"2\n3\",4\n").starts_with("2:3: a quotation mark opens this cell"));
    assert!(fault("\"a,b\n1,2\n").starts_with("1:1: a quotation mark"));
}
