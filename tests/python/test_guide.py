"""The first run, the page about Python, and the pages about results."""

import pathlib
import re
import tempfile

from guide import ROOT, Guide


class Pages(Guide):
    def test_the_first_run(self):
        self.expect_tutorial("first-run.md", "first.h5", "heavier.h5", "mine.h5", "rough-disc.png", "my-disc.h5", "rig.h5")

    def test_the_page_about_python(self):
        (self.folder / "data").symlink_to(ROOT / "data")
        text = (ROOT / "docs" / "python.md").read_text()
        # The study of the page, as a file of its own, for its runs are kept beside it.
        (self.folder / "study.toml").write_text(re.search(r"^```toml\n(.*?)^```$", text, re.MULTILINE | re.DOTALL).group(1))
        for _ in range(2):  # As in a notebook that is executed again.
            self.run_blocks("python.md")
        for name in ("contact-area.png", "maps.png"):
            self.assertGreater((self.folder / name).stat().st_size, 10000, name)

    def test_the_pages_about_results(self):
        for document, names in (
            ("figures.md", ("quick/topography.png", "quick/topography.pdf", "compared/heights.png")),
            ("report.md", ("quick.html", "report.html")),
            ("export.md", ("quick.csv", "quick-pin-0001.csv", "quick.npz", "quick-vtk/disc.pvd")),
        ):
            with self.subTest(document), tempfile.TemporaryDirectory() as folder:
                self.folder = pathlib.Path(folder)
                self.walk(document)
                for name in names:
                    self.assertTrue((self.folder / name).exists(), f"{document}: {name}")
