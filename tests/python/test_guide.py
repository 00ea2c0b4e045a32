"""The commands of the user guide lead where its pages say, and its Python works."""

import h5py
import numpy as np
from checkout import QUICK
from guide import Guide


class Pages(Guide):
    def last(self, file, series):
        with h5py.File(self.own / file) as run:
            return run["series"][series][-1]

    def test_the_readme(self):
        self.expect_page("../README.md", "cermet.h5", "cermet.html", "rig.toml")
        self.run_blocks("../README.md")
        self.assertGreater((self.own / "disc.png").stat().st_size, 10000)

    def test_the_first_run(self):
        self.expect_page("first-run.md", "first.h5", "heavier.h5", "mine.h5", "rough-disc.png", "my-disc.h5", "rig.h5")

    def test_a_surface_leads_to_its_ring(self):
        self.expect_page("surface.md", "disc.png", "ring.png", "measured.h5", "finer.h5", "extended-3.h5")

    def test_a_study_leads_to_its_answer(self):
        names = ("first-study/effects/effects.html", "first-study/results.csv", "first-study/optimum/profiler.svg", "wear-rate/fit/keys.csv")
        self.expect_page("study.md", *names, warns=True)

    def test_a_drive_leads_to_its_answer(self):
        self.expect_page("drive.md", "city-events.csv", "drives/emission.png", "drives/temperature.png")

    def test_a_cluster_loses_nothing_that_is_killed(self):
        self.expect_page("cluster.md", "loads.sbatch", "loads/results.h5")
        table = (self.own / "loads/results.csv").read_text()
        self.assertEqual(sum(",finished," in line for line in table.splitlines()[1:]), 24)

    def test_python(self):
        self.make_own()
        for _ in range(2):  # As in a notebook that is executed again.
            self.run_blocks("python.md")
        for name in ("contact-area.png", "maps.png"):
            self.assertGreater((self.own / name).stat().st_size, 10000, name)

    def test_figures_pages_and_tables(self):
        self.expect_page("figures.md", "quick/topography.pdf", "quick.html", "quick.csv", "quick-pin-0001.csv")

    def test_questions(self):
        self.expect_page("questions.md", "disc-11.h5", "worn.sdf", "longer.h5")
        # Expected: model.md. Without formation no cell becomes a secondary plateau; without resin none is worn.
        self.assertEqual(self.last("wear-only.h5", "disc_secondary"), 0.0)
        self.assertEqual((self.last("plain.h5", "worn_resin"), self.last("plain.h5", "pin_none")), (0.0, 0.0))
        self.assertGreater(self.last("worn-disc.h5", "worn_disc"), 0.0)
        with h5py.File(self.own / "stopped.h5") as run:
            self.assertEqual(run.attrs["state"], "interrupted")

    def test_what_pages_read_and_write_in_python(self):
        self.make_own()
        self.plateau("run", QUICK)
        for document in ("run-file.md", "scenes.md", "questions.md"):
            self.run_blocks(document)

        # The scene in a run file gives the same run again; the stripes are every fourth column.
        self.plateau("run", "again.toml", "-o", "again.h5")
        stripes = ["--set", f"pin.base.file={self.own / 'stripes.h5'}", "--set", "pin.base.dataset=/base"]
        self.plateau("run", QUICK, "-o", "stripes-run.h5", *stripes)
        with h5py.File(self.own / "quick.h5") as one, h5py.File(self.own / "again.h5") as other:
            for name in ("series/contact_area", "disc/height", "pin/height"):
                np.testing.assert_array_equal(one[name][:], other[name][:])
        with h5py.File(self.own / "stripes-run.h5") as run:
            base = run["pin/base"][:]
        self.assertTrue((base[::4] == 1).all())
        self.assertEqual(base.sum(), 10 * 20)
