"""The scripts in examples/ run as they stand, and what they print and draw is what the run file holds.

The numbers are found another way than the scripts find them: by netCDF4, and by sums written out here.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import netCDF4
import numpy as np
from checkout import QUICK, ROOT, changed, program
from PIL import Image


def numbers(line):
    return [float(text) for text in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?", line)]


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.means = {}
        for name, force in [("quick", "5 N"), ("strong", "20 N")]:
            changes = [f"operation.normal_force={force}", 'operation.duration="20 s"', 'output.maps_at=["0 s", "10 s"]']
            program("run", QUICK, "-o", f"{name}.h5", *changed(*changes), cwd=cls.folder)

    def example(self, name, *arguments):
        """Lines that an example prints."""
        command = [sys.executable, "-W", "error::DeprecationWarning", str(ROOT / "examples" / name), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout.splitlines()

    def line_of_mean(self, name):
        """The mean contact area of a run as an example says it, which has a test of its own."""
        if name not in self.means:
            _, self.means[name] = self.example("contact_area.py", f"{name}.h5", "-o", "other.png")
        return self.means[name]

    def close(self, found, expected):
        # Six digits are printed.
        np.testing.assert_allclose(found, expected, rtol=1e-5, atol=0)

    def check_picture(self, name):
        """The picture decodes and is not blank: many places differ from the background."""
        with Image.open(self.folder / name) as picture:
            pixels = np.asarray(picture.convert("RGB"), dtype=int)
        different = (abs(pixels - pixels[0, 0]).sum(axis=2) > 30).mean()
        self.assertGreater(different, 0.005, name)
        self.assertGreater(min(pixels.shape[:2]), 200, name)

    def test_notebooks_show_what_their_cells_say(self):
        notebooks = sorted((ROOT / "examples").glob("*.ipynb"))
        self.assertGreater(len(notebooks), 2)
        for notebook in notebooks:
            with self.subTest(notebook.name):
                self.check_notebook(notebook)

    def check_notebook(self, notebook):
        cells = [cell for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]
        folder = self.folder / notebook.stem
        folder.mkdir()
        (folder / "data").symlink_to(ROOT / "data")
        # The part of a cell that a notebook alone knows is left out; between cells there is a line that nothing prints.
        source = "\nprint('--- next cell')\n".join(re.sub(r"^%.*$", "", "".join(cell["source"]), flags=re.MULTILINE) for cell in cells)
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", source], capture_output=True, text=True, timeout=300, cwd=folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        for cell, said in zip(cells, done.stdout.split("--- next cell\n"), strict=True):
            shown = "".join("".join(output["text"]) for output in cell["outputs"] if output["output_type"] == "stream")
            number = r"-?\d+\.?\d*(?:e[-+]?\d+)?"
            self.assertEqual(*(re.sub(rf" *{number}", " #", text) for text in (said, shown)))
            found, expected = np.array(numbers(said)), np.array(numbers(shown))
            # Digits that are printed may round the other way on another machine.
            self.assertTrue((abs(found - expected) <= 0.06 * abs(expected) + 0.0021 * (abs(expected) > 1e-3)).all(), said)
        self.assertTrue(any("image/png" in output.get("data", {}) for cell in cells for output in cell["outputs"]))

    def test_numpy_step(self):
        """The plain model of the program is the other implementation."""
        for scene in (ROOT / "data/scenes/quick.toml", ROOT / "tests/vectors/local/scene.toml"):
            [line] = self.example("numpy_step.py", str(scene), "--steps", "300")
            steps, displacements, heights, _ = numbers(line)
            self.assertEqual(steps, 300)
            self.assertLess(max(displacements, heights), 1e-15)

    def test_every_example_is_tested(self):
        found = {path.stem for path in (ROOT / "examples").glob("*.py")}
        tested = {name.removeprefix("test_") for name in dir(self) if name.startswith("test_")}
        self.assertLessEqual(found, tested)
        guide = (ROOT / "docs/python.md").read_text()
        for name in found:
            self.assertIn(f"examples/{name}.py", guide)

    def test_contact_area(self):
        line, mean = self.example("contact_area.py", "quick.h5", "-o", "contact_area.png")
        with netCDF4.Dataset(self.folder / "quick.h5") as run:
            series, time = run["series"], run["time"][:]
            expected = [time[-1], series["contact_area"][-1] * 1e6, series["contact_area_mean"][-1] * 1e6]
            integral = series["contact_area_integral"][:]
        found = numbers(line.replace("mm2", "mm"))
        self.close(found, expected)
        start, end, value, _ = numbers(mean.replace("mm2", "mm"))
        first = np.argmin(abs(time - start))
        self.close(value, (integral[-1] - integral[first]) / (time[-1] - time[first]) * 1e6)
        self.close(end, time[-1])
        self.check_picture("contact_area.png")

    def test_disc_map(self):
        with netCDF4.Dataset(self.folder / "quick.h5") as run:
            height, pressure, times = run["disc/height"][:], run["pin/pressure"][:], run["map_time"][:]
            radius, status = np.asarray(run["radius"][:]), np.asarray(run["pin/status"][2])
        self.assertEqual(len(times), 3)

        def mean(values):
            return (values * radius).sum() / (radius.sum() * len(values))

        [line] = self.example("disc_map.py", "quick.h5", "-o", "disc_map.png")
        self.assertTrue(line.startswith("disc/height at "), line)
        self.close(numbers(line), [times[2], height[2].min(), height[2].max(), mean(height[2])])
        self.assertEqual(line.count(" m"), 4)  # a unit behind each height, and " mean"
        self.check_picture("disc_map.png")
        [line] = self.example("disc_map.py", "quick.h5", "--map", "pin/pressure", "--time", "11", "-o", "pressure.png")
        self.close(numbers(line), [times[1], pressure[1].min(), pressure[1].max(), mean(pressure[1])])
        self.check_picture("pressure.png")
        [line] = self.example("disc_map.py", "quick.h5", "--map", "pin/status", "--polar", "-o", "status.png")
        self.close(numbers(line)[0], times[2])
        self.assertRegex(line, r": none [\d.]+%, primary [\d.]+%, secondary [\d.]+% of the area$")
        # In the order of their numbers.
        parts = [100 * mean((status == value).astype(float)) for value in range(3)]
        np.testing.assert_allclose(numbers(line)[1:], parts, atol=0.006)
        self.check_picture("status.png")

    def test_compare_runs(self):
        lines = self.example("compare_runs.py", "quick.h5", "strong.h5", "--series", "filled_fraction", "-o", "compare.png")
        self.assertEqual(len(lines), 3)
        names, units = zip(*re.findall(r"(\S+) \[(\S+)\]", lines[0]), strict=True)
        for name, line in zip(["quick", "strong"], lines[1:], strict=True):
            with netCDF4.Dataset(self.folder / f"{name}.h5") as run:
                time, series = run["time"][:], {name: run["series"][name][:] for name in names[3:]}
                integral = run["series"]["contact_area_integral"][:]
            self.assertEqual(line.split()[0], name)
            found = [float(word) for word in line.split()[1:]]
            # The mean and the error are those of the other example, and the mean is not that of the last revolution.
            line_of_mean = self.line_of_mean(name)
            start, end, *mean = numbers(line_of_mean.replace("mm2", "mm"))
            self.close(found[:3], [end, *(1e-6 * value for value in mean)])
            first = np.argmin(abs(time - start))
            self.close(found[1], (integral[-1] - integral[first]) / (time[-1] - time[first]))
            pressure = series.pop("mean_pressure")[first + 1 :].mean()
            # Samples lie whole steps apart, so that their distances differ a little.
            np.testing.assert_allclose(found[3], pressure, rtol=2e-3)
            self.close(found[4:], [values[-1] for values in series.values()])
        self.assertEqual(names, ("time", "contact_area", "standard_error", "mean_pressure", "filled_fraction", "disc_secondary", "emitted"))
        self.assertEqual(units, ("s", "m2", "m2", "Pa", "1", "1", "m3"))
        self.check_picture("compare.png")

    def test_lines_of_runs_that_pulse_can_be_told_apart(self):
        """With the pulses the lines cover each other, as bands of two colours."""
        for name, force in [("long-5", "5 N"), ("long-10", "10 N")]:
            changes = [f"operation.normal_force={force}", "operation.duration=1500 s", "numerics.time_acceleration=100", "output.sample_every=1 s"]
            program("run", QUICK, "-o", f"{name}.h5", *changed(*changes), cwd=self.folder)
        self.example("compare_runs.py", "long-5.h5", "long-10.h5", "-o", "long.png")
        with Image.open(self.folder / "long.png") as picture:
            pixels = np.asarray(picture.convert("RGB"), dtype=int)
        for colour in ((31, 119, 180), (255, 127, 14)):
            part = (abs(pixels - colour).sum(axis=2) < 30).mean()
            self.assertGreater(part, 0.001)
            self.assertLess(part, 0.02)

    def test_coverage(self):
        lines = self.example("coverage.py", "quick.h5")
        with netCDF4.Dataset(self.folder / "quick.h5") as run:
            radius, times = np.asarray(run["radius"][:]), run["map_time"][:]
            disc, pin = np.asarray(run["disc/status"][:]), np.asarray(run["pin/status"][:])
            film = np.asarray(run["disc/height"][:] - run["disc/substrate"][:])
            last = [run["series"][name][-1] for name in ("disc_secondary", "pin_primary", "pin_secondary")]
        self.assertEqual(len(lines), 1 + len(times))
        for index, line in enumerate(lines[1:]):
            found = [float(word) for word in line.split()]
            mean = [
                np.average(status == value, axis=1, weights=radius).mean() for status, value in ((disc[index], 2), (pin[index], 1), (pin[index], 2))
            ]
            mean.append(np.average(film[index], axis=1, weights=radius).mean() * 1e6)
            np.testing.assert_allclose(found[1:5], mean, rtol=0, atol=1e-6)
            self.close(found[0], times[index])
        # The program counts the cells of the last map itself.
        np.testing.assert_allclose(found[1:4], last, rtol=0, atol=1e-6)
        self.assertGreater(found[1], 0)
        self.assertGreater(found[5], 0)

    def test_loads(self):
        scene = self.folder / "loads.toml"
        scene.write_text(f'extends = "{ROOT / "data/scenes/quick.toml"}"\n[operation]\nduration = "20 s"\n')
        for _ in range(2):  # The second time nothing is run again.
            lines = self.example("loads.py", "loads.toml", "--loads", "5", "20")
            self.assertEqual(len(lines), 3)
            for name, load, line in zip(["quick", "strong"], [5, 20], lines[1:], strict=True):
                line_of_mean = self.line_of_mean(name)
                self.close([float(word) for word in line.split()], [load, *numbers(line_of_mean.replace("mm2", "mm"))[2:]])

    def test_to_pandas(self):
        lines = self.example("to_pandas.py", "quick.h5", "--parts", "2")
        with netCDF4.Dataset(self.folder / "quick.h5") as run:
            time = run["time"][:]
            names = ["contact_area_mean", "mean_pressure", "filled_fraction"]
            series = {name: run["series"][name][:] for name in names}
            # Beside the series there is their time.
            self.assertEqual(lines[0], f"{len(time)} samples of {len(run['series'].variables) - 1} series")
        units = {"time": "s", "contact_area_mean": "m2", "mean_pressure": "Pa", "filled_fraction": "1"}
        self.assertEqual(dict(re.findall(r"(\S+) \[(\S+)\]", lines[1])), units)
        first = time <= time[-1] / 2
        for line, part in zip(lines[2:], [first, ~first], strict=True):
            found = [float(word) for word in line.split("]")[1].split()]
            self.close(found, [series[name][part].mean() for name in names])
        self.assertEqual(len(lines), 4)
