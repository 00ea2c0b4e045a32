"""The recipes."""

import h5py
import numpy as np

from guide import QUICK, Guide


class Recipes(Guide):
    def test_every_recipe(self):
        self.walk("recipes.md")
        names = {path.name for path in self.folder.iterdir()}
        self.assertLessEqual({"measured.png", "fibres.png", "fibres.h5", "disc-13.h5", "load-2.5.h5", "job.h5", "stopped.h5", "man"}, names)

        def last(file, series):
            with h5py.File(self.folder / file) as run:
                return run["series"][series][-1]

        # Expected: model.md. Without formation no cell becomes a secondary plateau; without resin none is worn.
        self.assertEqual(last("wear-only.h5", "disc_secondary"), 0.0)
        self.assertEqual((last("plain.h5", "worn_resin"), last("plain.h5", "pin_none")), (0.0, 0.0))
        self.assertGreater(last("worn-disc.h5", "worn_disc"), 0.0)
        with h5py.File(self.folder / "stopped.h5") as run:
            self.assertEqual(run.attrs["state"], "interrupted")

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
