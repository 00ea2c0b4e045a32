"""Pages of the guide are prepared for the site as they should be, all of them are in it, and a site with broken links is found out."""

import re
import sys
import unittest

from checkout import ROOT, Folder

sys.path.insert(0, str(ROOT / "site"))
import check
import preprocess


class Pages(unittest.TestCase):
    def test_formulas(self):
        def span(tex):
            return f'<span class="formula" data-tex="{tex}"></span>'

        for text, expected in {
            r"with $\mu_s$ and $a < b$.": "with " + span("\\mu_s") + " and " + span("a &lt; b") + ".",
            "| $|x|$ |": "| " + span("&#124;x&#124;") + " |",
            "`$PATH` and $x$ and ``a `$y$` b``": "`$PATH` and " + span("x") + " and ``a `$y$` b``",
            "5 $ and 6 $": "5 $ and 6 $",
        }.items():
            self.assertEqual(preprocess.page(text, ""), expected)
        block = '<div class="formula" data-tex="a \\\\ b"></div>\n'
        self.assertEqual(preprocess.page("x\n\n```math\na \\\\\nb\n```\ny", ""), f"x\n\n{block}y")
        self.assertEqual(preprocess.page("$$a$$\n", ""), '<div class="formula" data-tex="a"></div>\n')
        code = "```sh\necho $HOME $x$\n```\n"
        self.assertEqual(preprocess.page(code, ""), code)

    def test_links_out_of_the_guide(self):
        text = "see [`step.rs`](../crates/step.rs), [runs](python.md#open-a-run), [words](README.md#words) and `[a](../b)`"
        kept = "[runs](python.md#open-a-run), [words](index.md#words) and `[a](../b)`"
        self.assertEqual(preprocess.page(text, ""), f"see `step.rs`, {kept}")
        self.assertEqual(preprocess.page(text, "https://h/p"), f"see [`step.rs`](https://h/p/crates/step.rs), {kept}")
        below = "[a](../../data/a), [runs](../python.md#open-a-run), [words](../README.md#words), [first](../../README.md) and [b](other.md)"
        kept = "[runs](../python.md#open-a-run), [words](../index.md#words)"
        expected = f"[a](https://h/p/data/a), {kept}, [first](https://h/p/README.md) and [b](other.md)"
        self.assertEqual(preprocess.page(below, "https://h/p", "evidence/page.md"), expected)

    def test_every_page_is_in_the_summary_and_no_formula_is_left(self):
        pages = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")} - {"SUMMARY.md"}
        summary = (ROOT / "docs" / "SUMMARY.md").read_text()
        self.assertEqual(sorted(re.findall(r"\]\((.*?)\)", summary)), sorted(pages))
        for name in pages:
            text = preprocess.page((ROOT / "docs" / name).read_text(), "", name)
            text = re.sub(r'data-tex="[^"]*"', "", text)
            text = re.sub(r"(?ms)^```.*?^```$|`[^`]*`", "", text)
            self.assertNotIn("$", text, name)


class Sites(Folder):
    def test_broken_links_are_found(self):
        site = self.folder.resolve()
        (site / "one.html").write_text('<h1 id="a">A</h1><a href="two.html#b"></a><a href="https://x/"></a><p class="formula" data-tex="x">')
        (site / "two.html").write_text('<h1 id="b">B</h1><a href="#b"></a><img src="p.png">')
        (site / "p.png").write_bytes(b"")
        self.assertEqual(check.problems(site), [])
        (site / "p.png").unlink()
        (site / "two.html").write_text((site / "two.html").read_text() + '<a href="one.html#none"></a>$\\mu$')
        self.assertEqual(
            check.problems(site),
            ["two.html: p.png leads nowhere", "two.html: one.html#none: there is no such place", "two.html: a formula was left as it is: $\\mu$"],
        )
