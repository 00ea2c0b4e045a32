"""Figures of surfaces, of the fibre map and of the accuracy of runs show the data that they are given: numbers are found another way, by
hand or from formulas."""

import json
import math
import pathlib
import shutil
import statistics
from unittest import mock

import matplotlib.colors
import matplotlib.figure
import matplotlib.text
import numpy as np
from checkout import word
from package_scenes import InFolder

import plateau
from plateau.figures import surfaces as module
from plateau.figures.fibres import SEAM, fibre_map
from plateau.figures.surfaces import surfaces
from plateau.surface_data import power_spectrum

UM, MM = 1e-6, 1e-3
UNITS = {"pitch": "um", **dict.fromkeys(("Sq", "Sp", "Sv", "Sk", "Spk", "Svk", "Sal"), "um"), "Smr1": "%", "Smr2": "%", "Str": "1"}


def described(heights, pitch, name="made", **more):
    """What the program tells of a surface, as far as figures need it, in its units."""
    known = np.sort(heights[np.isfinite(heights)])[::-1] - np.nanmean(heights)
    places = (np.arange(known.size) + 0.5) / known.size
    told = {
        "title": name,
        "body": name.split()[0] if name.split()[0] in ("disc", "pin") else None,
        "pitch": [one / UM for one in pitch],
        "measured": known.size,
    }
    told |= {"points": heights.size, "rows": heights.shape[0], "columns": heights.shape[1]}
    told |= {"Sq": known.std() / UM, "Ssk": 0.0, "Sku": 1.5, "Sp": known[0] / UM, "Sv": -known[-1] / UM, "units": UNITS}
    told |= {"Sk": 1.0, "Spk": 0.5, "Svk": 0.25, "Smr1": 10.0, "Smr2": 80.0, "Sal": None, "Str": None, **more}
    return told | {"material_curve": np.interp(np.linspace(0, 1, 501), places, known).tolist()}


def folder_of(*those):
    """A folder of data, as the program writes it."""
    folder = pathlib.Path(f"data-{len(list(pathlib.Path().iterdir()))}")
    folder.mkdir()
    for number, (told, heights) in enumerate(those):
        np.save(folder / f"{number}.npy", heights)
        told["heights"] = f"{number}.npy"
    (folder / "surfaces.json").write_text(json.dumps([told for told, _ in those]))
    return folder


def panel(figure, label, number=0):
    """The axes with this label below."""
    return [axis for axis in figure.axes if axis.get_xlabel() == label][number]


def waves():
    """10 µm along x with 8 waves on 2 mm, 2 µm along y with 5 waves on 0.5 mm: points 10 µm and 5 µm apart."""
    x, y = np.meshgrid(10 * UM * np.arange(200), 5 * UM * np.arange(100))
    return 10 * UM * np.cos(math.tau * 4 / MM * x) + 2 * UM * np.cos(math.tau * 10 / MM * y) + 3 * UM


class Surfaces(InFolder):
    def test_the_map_has_its_axes_and_heights(self):
        heights = np.zeros((100, 200))
        # Right above, 4 µm over the mean.
        heights[90:, 180:] = 4 * UM
        heights[:5, :10] = np.nan
        figure = surfaces(folder_of((described(heights, (10 * UM, 5 * UM)), heights)))["surfaces"]
        axis = panel(figure, "x, mm")
        image = axis.images[0]
        self.assertEqual((image.get_extent(), image.origin, axis.get_ylabel()), ([0, 2, 0, 0.5], "lower", "y, mm"))
        self.assertEqual((axis.get_xlim(), axis.get_ylim()), ((0, 2), (0, 0.5)))
        drawn = np.asarray(image.get_array().filled(np.nan))
        np.testing.assert_allclose(drawn, (heights - np.nanmean(heights)) / UM)
        bar = next(one for one in figure.axes if one.get_xlabel() == "height, µm" and one is not axis)
        self.assertEqual(bar.get_title(loc="left"), "made\ngrey: no height, 0.25 %")

    def test_the_distribution_and_the_material_ratio_are_in_per_cent(self):
        heights = np.random.default_rng(1).normal(size=(150, 200)) * UM
        heights[3, 4] = 90 * UM
        figure = surfaces(folder_of((described(heights, (UM, UM)), heights)))["surfaces"]
        axis = panel(figure, "points per class, %")
        parts, edges, _ = axis.patches[0].get_data()
        self.assertEqual(axis.get_title(loc="left").splitlines()[-1], "beyond axis: 0.0033 %")
        self.assertAlmostEqual(parts.sum() + 100 / heights.size, 100)
        # A normal distribution with the deviation 1 µm.
        erf = np.array([math.erf(edge / math.sqrt(2)) for edge in edges])
        np.testing.assert_allclose(parts, 50 * np.diff(erf), atol=0.4)
        self.assertEqual(axis.get_ylabel(), "height, µm")
        axis = panel(figure, "material ratio, %")
        ratio, height = axis.lines[-1].get_data()
        at = np.array([10.0, 50.0, 84.13])
        np.testing.assert_allclose(np.interp(at, ratio, height), [1.2816, 0.0, -1.0], atol=0.03)
        # Least squares through the flattest 40 % of a normal distribution, which are about its median; triangles stand on the ends of the core.
        middle = np.linspace(0.3, 0.7, 401)
        half = -0.5 * np.polyfit(middle, [statistics.NormalDist().inv_cdf(1 - part) for part in middle], 1)[0]
        np.testing.assert_allclose(axis.lines[0].get_data(), [[0, 100], [half, -half]], atol=0.02)
        upper, lower = axis.lines[0].get_ydata()
        peaks, dales = (patch.get_xy()[:3] for patch in axis.patches)
        np.testing.assert_allclose(peaks, [[0, upper], [0, upper + 0.5], [10, upper]])
        np.testing.assert_allclose(dales, [[100, lower], [100, lower - 0.25], [80, lower]])
        self.assertEqual(axis.get_title(loc="left"), "Sk 1 µm\nSpk 500 nm   Svk 250 nm\nSmr1 10 %   Smr2 80 %")

    def test_a_cosine_has_its_power_at_its_frequency_and_its_correlation_at_its_wavelength(self):
        heights = waves()
        figure = surfaces(folder_of((described(heights, (10 * UM, 5 * UM), Sal=48.0, Str=0.5), heights)))["surfaces"]
        axis = panel(figure, "spatial frequency, mm⁻¹")
        self.assertEqual((axis.get_ylabel(), axis.get_xscale(), axis.get_yscale()), ("PSD, µm² mm", "log", "log"))
        for line, label, frequency, amplitude in zip(axis.lines, ("along x", "along y"), (4, 10), (10, 2), strict=True):
            per_mm, density = line.get_data()
            self.assertEqual(line.get_label(), label)
            self.assertAlmostEqual(per_mm[np.argmax(density)], frequency)
            # The other cosine is constant along these profiles.
            self.assertAlmostEqual(density.sum() * (per_mm[1] - per_mm[0]), amplitude**2 / 2)
        # Of the power 1/2 and 1, the second where heights go up and down from point to point.
        x = np.arange(64)
        _, density = power_spectrum((np.cos(math.tau / 8 * x) + (-1.0) ** x)[None], 0.5, 1)
        np.testing.assert_allclose([density[:-3].sum() / 32, density[-3:].sum() / 32], [0.5, 1], rtol=1e-3)
        axis = panel(figure, "lag, mm")
        lag, values = axis.lines[0].get_data()
        z = heights / UM - 3
        for at in (1, 20, 100):
            self.assertAlmostEqual(lag[at], 0.01 * at)
            self.assertAlmostEqual(values[at], (z[:, :-at] * z[:, at:]).mean() / 52)
            self.assertAlmostEqual(axis.lines[1].get_ydata()[at // 2], (z[: -(at // 2) or None] * z[at // 2 :]).mean() / 52)
        # (50 cos(2π 4 lag) + 2) / 52 falls to 0.2, to a pitch.
        first = np.flatnonzero(values <= 0.2)[0]
        self.assertAlmostEqual(lag[first], math.acos((0.2 * 52 - 2) / 50) / math.tau / 4, delta=0.0101)
        np.testing.assert_allclose(axis.lines[2].get_data()[0], [0, 0.048, 0.048])
        self.assertEqual(axis.get_title(loc="left"), "Sal 48 µm   Str 0.5")

    def test_missing_points_change_little(self):
        heights = waves()
        heights[np.random.default_rng(2).random(heights.shape) < 0.05] = np.nan
        figure = surfaces(folder_of((described(heights, (10 * UM, 5 * UM)), heights)))["surfaces"]
        per_mm, density = panel(figure, "spatial frequency, mm⁻¹").lines[0].get_data()
        self.assertAlmostEqual(density.sum() * (per_mm[1] - per_mm[0]), 50, delta=1)
        _lag, values = panel(figure, "lag, mm").lines[0].get_data()
        known = np.isfinite(heights)
        z = np.where(known, heights - np.nanmean(heights), 0)
        pairs = (known[:, :-30] & known[:, 30:]).sum()
        self.assertAlmostEqual(values[30], (z[:, :-30] * z[:, 30:]).sum() / pairs / np.nanvar(heights))

    def test_a_patch_and_what_is_made_of_it_have_the_same_scales(self):
        rng = np.random.default_rng(3)
        made = [("disc", 1), ("disc patch", 3), ("other.sdf", 9), ("pin", 0.1)]
        those = [(described(z := size * UM * rng.normal(size=(30, 40)), (UM, UM), name), z) for name, size in made]
        figures = surfaces(folder_of(*those))
        self.assertEqual(list(figures), ["surfaces", "surfaces-2"])
        first = figures["surfaces"]
        limits = [panel(first, "points per class, %", number).get_ylim() for number in range(3)]
        self.assertEqual(limits[0], limits[1])
        self.assertGreater(limits[2][1], 2 * limits[1][1])
        spans = [panel(first, "x, µm", number).images[0].get_clim() for number in range(3)]
        self.assertEqual(spans[0], spans[1])
        self.assertNotEqual(spans[1], spans[2])
        self.assertEqual(panel(figures["surfaces-2"], "points per class, %").get_ylabel(), "height, nm")
        for figure in figures.values():
            self.assertAlmostEqual(figure.get_figwidth() * 25.4, 180)
            self.assertLessEqual(figure.get_figheight() * 25.4, 240)

    def test_a_ring_is_in_windows_and_a_large_map_is_thinned(self):
        heights = np.arange(24000.0) * UM * np.ones((8, 1))
        figure = surfaces(folder_of((described(heights, (5 * UM, 400 * UM), "disc"), heights)))["surfaces"]
        windows = [axis for axis in figure.axes if axis.images]
        ends = [axis.images[0].get_extent() for axis in windows]
        np.testing.assert_allclose(ends, [[30 * n, 30 * n + 30, 0, 3.2] for n in range(4)])
        for number, axis in enumerate(windows):
            drawn = axis.images[0].get_array()
            self.assertEqual(drawn.shape, (8, 1000))
            # In mm: every sixth point, from the middle of six on, above the mean.
            np.testing.assert_allclose(1000 * drawn[0], 6000 * number + 3 + 6 * np.arange(1000) - 11999.5)

    def test_the_relief_has_the_heights(self):
        heights = np.zeros((40, 50))
        heights[28:32, 8:12] = 5 * UM
        folder = folder_of((described(heights, (10 * UM, 20 * UM)), heights))
        with mock.patch("mpl_toolkits.mplot3d.axes3d.Axes3D.plot_surface", autospec=True) as draw:
            axis = surfaces(folder, "relief")["surfaces"].axes[0]
        x, y, z = draw.call_args.args[1:]
        self.assertEqual((axis.get_xlabel(), axis.get_ylabel(), axis.get_zlabel()), ("x, µm", "y, µm", "height, µm"))
        np.testing.assert_allclose([x[0, [0, -1]], y[[0, -1], 0]], [[5, 495], [10, 790]])
        np.testing.assert_allclose(z, heights / UM - 0.04, atol=1e-9)
        with self.assertRaisesRegex(plateau.InputError, "expected"):
            surfaces(folder, "round")
        np.save(folder / "0.npy", heights.T)
        with self.assertRaisesRegex(plateau.InputError, "expected 40 rows and 50 columns"):
            surfaces(folder)

    def test_surfaces_are_drawn_by_a_call_of_the_program(self):
        made = folder_of((described(waves(), (10 * UM, 5 * UM)), waves()))

        def program(*arguments, figure_data, **options):
            self.assertEqual((arguments, options), (("surface", "./-a.sdf"), {"prepare": "b.toml", "level": "quadratic"}))
            shutil.copytree(made, figure_data, dirs_exist_ok=True)

        with mock.patch.object(module, "command", program):
            figures = plateau.plot_surfaces("-a.sdf", prepare="b.toml", level="quadratic")
        self.assertEqual(list(figures), ["surfaces"])


class FibreMaps(InFolder):
    def test_the_picture_stands_upright(self):
        # Fibre in the first column and the lowest line of pixels; there is no pin in the corner right above.
        fibre = np.zeros((12, 20), bool)
        fibre[:, :2], fibre[-2:] = True, True
        base = np.where(fibre, 1, 0).astype("u1")
        base[:3, -4:] = 3
        for name, values in (("grey", np.where(fibre, 200, 40).astype("u1")), ("fibre", fibre), ("base", base)):
            np.save(f"{name}.npy", values)
        # A ring of 22 mm with 12 rows of 0.2 mm, and a pin of 28 of its columns.
        ring = {"mean_radius": 22 * MM, "row_height": 0.2 * MM, "pin_columns": 28, "leading_edge": [[-2 * MM, -1.2 * MM], [-2 * MM, 1.2 * MM]]}
        told = {"extent": [4 * MM, 2.4 * MM], "picture": [4 * MM, 2.4 * MM], "micrograph": "grey.npy", "fibre": "fibre.npy", "base": "base.npy"}
        told |= {"is_tiled": False, "seams": {"angles": [], "radii": []}, **ring}
        heights = np.tile(np.arange(960.0) * UM, (12, 1))
        disc = described(heights, (0.144 * MM, 0.2 * MM), "disc", is_patch=False)
        folder = folder_of((disc, heights))
        shutil.copytree(folder, ".", dirs_exist_ok=True)
        pathlib.Path("fibre_map.json").write_text(json.dumps(told))
        left, right, whole, near, *_ = (figure := fibre_map(".")["fibre-map"]).axes
        figure.draw_without_rendering()
        for axis, below, above in ((left, 200, 40), (right, 1, 3)):
            image = axis.images[0]
            self.assertEqual((axis.get_xlabel(), image.get_extent(), image.origin), ("x, mm", [-2, 2, -1.2, 1.2], "upper"))
            self.assertEqual((axis.get_xlim(), axis.get_ylim()), ((-2, 2), (-1.2, 1.2)))
            # Left below and right above.
            shown = image.get_array()
            self.assertEqual((shown[-1, 0], shown[0, -1]), (below, above))
        self.assertEqual(left.get_ylabel(), "y, mm")
        colours = [right.images[0].to_rgba(np.array([[0, 1, 3]]))[0, place, :3].tolist() for place in range(3)]
        self.assertEqual([matplotlib.colors.to_hex(one) for one in colours], ["#3c3c46", "#e69f00", "#ffffff"])
        # Pixels are 0.2 mm wide: the outline is 0.4 mm from the left and from below.
        outline = np.concatenate([path.vertices for path in left.collections[0].get_paths()])
        self.assertAlmostEqual(outline[outline[:, 1] > 0, 0].max(), -1.6)
        self.assertAlmostEqual(outline[outline[:, 0] > 0, 1].max(), -0.8)
        # On the ring the pin is where its columns are, over the first 28 of the disc; none of it hides the disc where there is no pin.
        for axis in (whole, near):
            self.assertEqual(axis.images[0].get_extent(), [-2, 2, -1.2, 1.2])
            self.assertEqual(axis.images[0].get_array()[0, -1] is np.ma.masked, True)
            self.assertEqual(axis.lines[-1].get_xdata().tolist(), [-2, -2])
        mesh = near.collections[0]
        x, y = mesh.get_coordinates()[0, np.argmin(mesh.get_array()[0])]
        angle = -14 * math.tau / 960
        # The innermost corner of the lowest column, which is the first.
        self.assertAlmostEqual(x, 20.8 * math.sin(angle), places=6)
        self.assertAlmostEqual(y, 20.8 * math.cos(angle) - 22, places=6)

    def test_seams_of_tiles_are_marked(self):
        base = np.ones((10, 20), "u1")
        np.save("base.npy", base)
        np.save("grey.npy", base)
        np.save("fibre.npy", base.astype(bool))
        heights = np.zeros((4, 100))
        heights[0] = 1 * UM
        shutil.copytree(folder_of((described(heights, (1.2 * MM, 1 * MM), "disc", is_patch=False), heights)), ".", dirs_exist_ok=True)
        told = {"extent": [10 * MM, 4 * MM], "picture": [3 * MM, 5 * MM], "micrograph": "grey.npy", "fibre": "fibre.npy", "base": "base.npy"}
        told |= {
            "is_tiled": True,
            "seams": {"angles": [0.0, 1.0], "radii": [19 * MM]},
            "mean_radius": 20 * MM,
            "row_height": 1 * MM,
            "pin_columns": 8,
        }
        told |= {"leading_edge": [[-5 * MM, -2 * MM], [-5 * MM, 2 * MM]]}
        pathlib.Path("fibre_map.json").write_text(json.dumps(told))
        _, right, whole, *_ = fibre_map(".")["fibre-map"].axes
        # The picture lies in the middle: 3 mm from 1.5 mm on; it is higher than the pin.
        seams = sorted(line.get_xdata()[0] for line in right.lines if line.get_color() == SEAM["color"])
        np.testing.assert_allclose(seams, [-4.5, -1.5, 1.5, 4.5])
        angles = [
            math.atan2(line.get_xdata()[0], line.get_ydata()[0] + 20)
            for line in whole.lines
            if line.get_color() == SEAM["color"] and len(line.get_xdata()) == 2
        ]
        np.testing.assert_allclose(angles, [-4 * math.tau / 100, 1 - 4 * math.tau / 100])
        # Without a picture there is the pin alone.
        pathlib.Path("fibre_map.json").write_text(json.dumps({**told, "micrograph": None, "fibre": None, "picture": None, "is_tiled": False}))
        self.assertEqual(len([axis for axis in fibre_map(".")["fibre-map"].axes if axis.images]), 3)


class Accuracy(InFolder):
    def document(self):
        """Runs as the program tells of them, errors as fractions, times in s."""

        def run(ladder, value, time, error, on_front=0.0):
            told = {"ladder": ladder, "value": value, "wall_time": time, "error": error, "on_front": on_front}
            return told | {"state": "failed" if error is None else "finished"}

        runs = [run("time_acceleration", 2.0, 4.0, 1e-4, 1.0), run("time_acceleration", 20.0, 0.5, 2e-3, 1.0)]
        runs += [run("tolerance", 0.01, 1.0, 3e-3), run("time_acceleration", 50.0, None, None)]
        # This one is far below all others.
        runs += [run("perturbation", 1e-9, 8.0, 1e-12), run("perturbation", 1e-6, 8.0, 5e-5)]
        reference = {"wall_time": 9.0, "error": 2e-5, "time_acceleration": 1.0}
        return {"reference": reference, "runs": runs, "quantities": ["contact_area", "worn"]}

    def test_points_are_the_runs(self):
        pathlib.Path("accuracy.json").write_text(json.dumps(self.document()))
        axis = plateau.plot_accuracy(".")
        self.assertEqual((axis.get_xlabel(), axis.get_ylabel()), ("run time, s", "largest error, %"))
        self.assertEqual((axis.get_xscale(), axis.get_yscale()), ("log", "log"))
        drawn = {line.get_label(): np.array(line.get_data(), float).T for line in axis.lines}
        expected = {
            "no other run is quicker and more exact": [[0.5, 0.2], [4, 0.01]],
            "time acceleration": [[4, 0.01], [0.5, 0.2]],
            "tolerance of the time acceleration": [[1, 0.3]],
            "heights times 1 + the number": [[8, 0.005]],
            "time of the reference, time acceleration 1": [[9, 0], [9, 1]],
            "own error of the reference": [[0, 0.002], [1, 0.002]],
        }
        self.assertEqual(list(drawn), list(expected))
        for label, points in expected.items():
            np.testing.assert_allclose(drawn[label], points, err_msg=label)
        # The lines of the reference go through the whole axes.
        low, high = axis.get_ylim()
        self.assertTrue(low < 0.002 and high > 0.3 and axis.get_xlim()[1] > 9)

    def test_names_stand_beside_their_points_and_not_on_others(self):
        document = self.document()
        # A crowd.
        more = [{**document["runs"][2], "value": 0.001 * n, "wall_time": 1 + 0.06 * n, "error": 3e-3} for n in range(1, 6)]
        document["runs"] += more
        pathlib.Path("crowd.json").write_text(json.dumps(document))
        axis = plateau.plot_accuracy("crowd.json")
        axis.figure.draw_without_rendering()
        texts = [text for text in axis.texts if text.get_text()]
        self.assertTrue({"2", "20", "0.01", "1e-06"} <= {text.get_text() for text in texts})
        boxes = [matplotlib.text.Text.get_window_extent(text) for text in texts]
        runs = [[run["wall_time"], 100 * run["error"]] for run in document["runs"] if run["wall_time"]]
        points = axis.transData.transform(runs)
        for number, box in enumerate(boxes):
            self.assertFalse(any(box.overlaps(other) for other in boxes[:number]), texts[number])
            self.assertFalse(any(box.contains(*point) for point in points), texts[number])
            self.assertTrue(axis.bbox.contains(*box.min) and axis.bbox.contains(*box.max))

    def test_axes_of_others_are_taken(self):
        figure = matplotlib.figure.Figure()
        pathlib.Path("own.json").write_text(json.dumps(self.document()))
        axis = figure.add_subplot()
        self.assertIs(plateau.plot_accuracy("own.json", ax=axis), axis)
        pathlib.Path("one.json").write_text(json.dumps({**self.document(), "quantities": ["contact_area"]}))
        self.assertEqual(plateau.plot_accuracy("one.json").get_ylabel(), "error, contact area, %")
        with self.assertRaisesRegex(plateau.InputError, "accuracy.json of plateau accuracy"):
            pathlib.Path("wrong.json").write_text("[]")
            plateau.plot_accuracy("wrong.json")

    def test_the_program_has_files_written(self):
        pathlib.Path("of-word.json").write_text(json.dumps(self.document()))
        call = ["figure", "accuracy", "of-word.json", "--format", "svg", "--format", "png"]
        first, second, forced = word(*call), word(*call), word(*call, "--force")
        self.assertEqual((first[:2], forced[:2]), ((0, "accuracy.svg\naccuracy.png\n"),) * 2)
        self.assertEqual(second[:2], (2, ""))
        self.assertIn("accuracy.svg exists; give --force", second[2])
        # Letters stay letters.
        self.assertIn(">run time, s<", pathlib.Path("accuracy.svg").read_text())
