"""What docs/study.md does with the results of a study works, whatever its factors are called."""

import contextlib
import io
import re

import numpy as np
import pandas
import xarray
from checkout import QUICK, ROOT, Folder, program
from matplotlib import pyplot

STUDY = """
version = 1
base = "{base}"
set = ["operation.duration = '0.4 s'", "output.sample_every = '0.1 s'", "plateaus.debris = 'contact'", "plateaus.captured_fraction = 0.06"]
design = "full-factorial"
replicates = {{ keys = ["disc.surface.synthetic.seed"], seeds = [1, 2] }}
[[factor]]
name = "{name}"
key = "operation.normal_force"
levels = ["5 N", "0.01 kN"]
[[factor]]
name = "rows"
key = "mesh.rows"
levels = [10, 20]
[[factor]]
name = "pool"
key = "plateaus.debris"
levels = ["contact", "track"]
[[response]]
name = "contact area"
dataset = "/series/contact_area_mean"
at = "end"
[[response]]
name = "filled"
dataset = "/series/filled_fraction"
at = "1000 s"
"""


class Studies(Folder):
    def setUp(self):
        super().setUp()
        self.results = self.folder / "first-study"

    def collect(self, name):
        study = self.results.with_suffix(".toml")
        study.write_text(STUDY.format(base=QUICK, name=name))
        for command in ("run", "collect"):
            program("sweep", command, study)

    def block(self):
        """The Python of the guide."""
        blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / "docs" / "study.md").read_text(), re.MULTILINE | re.DOTALL)
        self.assertEqual(len(blocks), 1)
        return blocks[0]

    def run_python(self, text):
        """What Python prints; in this process, for each of its own would import all packages anew."""
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(text, {})
        pyplot.close("all")
        return out.getvalue()

    def test_the_guide_works_for_any_name_of_a_factor(self):
        # Names that are methods of xarray, that are dimensions, that a series has, and that are no identifiers; how they
        # are called in results.h5.
        names = {"load": "load", "mean": "mean", "Time": "time_factor", "contact area": "contact_area_factor", "µ (1)": "µ__1"}
        for name, variable in names.items():
            self.collect(name)
            text = self.block().replace('"load [N]"', f'"{name} [N]"').replace('groupby("load")', f'groupby("{variable}")')
            out = self.run_python(text + "\nprint(areas.shape, *areas[areas.dims[0]].values)\n")
            self.assertIn("(2, 4) 5.0 10.0", out, name)

    def test_the_table_has_numbers_in_the_units_of_its_head(self):
        self.collect("load")
        table = pandas.read_csv(self.results / "results.csv")
        columns = ["run", "point", "replicate", "state", "load [N]", "rows", "pool", "contact area [m2]", "filled", "error"]
        self.assertEqual(list(table), columns)
        for column, kind in {"load [N]": "f", "rows": "i", "contact area [m2]": "f", "filled": "f", "run": "i"}.items():
            self.assertEqual(table[column].dtype.kind, kind, column)
        # SI units, whatever the study has, and the numbers of results.h5, to the bit.
        with xarray.open_dataset(self.results / "results.h5", engine="h5netcdf") as study:
            for column, name in {"load [N]": "load", "rows": "rows", "contact area [m2]": "contact_area_response"}.items():
                np.testing.assert_array_equal(table[column], study[name].values, column)
            self.assertEqual(list(table["pool"]), list(study["pool_factor"].values.astype(str)))
        self.assertEqual(sorted(set(table["load [N]"])), [5, 10])
        # The runs end before 1000 s.
        self.assertTrue(table["filled"].isna().all())
