"""The Python of the user guide works as it stands, in a folder with the run file that it reads."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("PLATEAU_PROGRAM", str(ROOT / "plateau"))
QUICK = str(ROOT / "data" / "scenes" / "quick.toml")


class Recipes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def plateau(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)

    def run_blocks(self, document):
        """Runs the Python of a document, block by block, as with the package installed."""
        text = (ROOT / "docs" / document).read_text()
        blocks = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 2)
        environment = {**os.environ, "MPLBACKEND": "agg", "PYTHONPATH": str(ROOT / "python"), "PLATEAU_PROGRAM": PROGRAM}
        for block in blocks:
            command = [sys.executable, "-c", block]
            done = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=600)
            self.assertEqual((done.returncode, done.stderr), (0, ""), block)

    def test_the_page_about_python(self):
        (self.folder / "data").symlink_to(ROOT / "data")
        text = (ROOT / "docs" / "python.md").read_text()
        # The study of the page, as a file of its own, for its runs are kept beside it.
        (self.folder / "study.toml").write_text(re.search(r"^```toml\n(.*?)^```$", text, re.MULTILINE | re.DOTALL).group(1))
        for _ in range(2):  # As in a notebook that is executed again.
            self.run_blocks("python.md")
        for name in ("contact-area.png", "maps.png"):
            self.assertGreater((self.folder / name).stat().st_size, 10000, name)

    def test_the_tutorial_about_a_study_leads_to_its_answer(self):
        """Its commands work in a folder that looks like the repository, and say every line that it shows."""
        text = (ROOT / "docs/tutorial-study.md").read_text()
        for name, target in (("data", ROOT / "data"), ("plateau", pathlib.Path(PROGRAM).resolve())):
            (self.folder / name).symlink_to(target)
        environment = {**os.environ, "PATH": f"{ROOT / 'python/bin'}:{os.environ['PATH']}"}
        place, said = self.folder, ""
        for block in re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
            command = ["sh", "-e", "-c", f"{block}\npwd > '{self.folder / '.left'}'"]
            done = subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, f"{block}\n{done.stderr}")
            said, place = said + done.stdout + done.stderr, pathlib.Path((self.folder / ".left").read_text().strip())
        lines = said.splitlines()
        for shown in re.findall(r"^```console\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
            for line in shown.splitlines():
                begin, is_beginning = line.removesuffix(" …"), line.endswith(" …")
                self.assertTrue(any(found.startswith(begin) if is_beginning else found == line for found in lines), line)
        for name in ("first-study/effects/effects.html", "first-study/results.csv", "first-study/optimum/profiler.svg", "wear-rate/fit/keys.csv"):
            self.assertTrue((self.folder / "own" / name).is_file(), name)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), [".left", "data", "own", "plateau"])

    def test_every_block_runs(self):
        self.plateau("run", QUICK)
        self.run_blocks("recipes.md")
        self.assertGreater((self.folder / "contact-area.png").stat().st_size, 1000)

        # The scene in a run file gives the same run again; the stripes are every fourth column.
        self.plateau("run", "again.toml", "-o", "again.h5")
        stripes = ["--set", f"pin.base.file={self.folder / 'stripes.h5'}", "--set", "pin.base.dataset=/base"]
        self.plateau("run", QUICK, "-o", "stripes-run.h5", *stripes)
        with h5py.File(self.folder / "quick.h5") as one, h5py.File(self.folder / "again.h5") as other:
            for name in ("series/contact_area", "disc/height", "pin/height"):
                np.testing.assert_array_equal(one[name][:], other[name][:])
        with h5py.File(self.folder / "stripes-run.h5") as run:
            base = run["pin/base"][:]
        self.assertTrue((base[::4] == 1).all())
        self.assertEqual(base.sum(), 10 * 20)
