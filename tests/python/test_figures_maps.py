"""Maps of runs as they are drawn, against the numbers of the run files, read with h5py."""

import re

import h5py
import numpy as np
import xarray
from matplotlib.backends.backend_agg import FigureCanvasAgg
from package_scenes import ROUND, SHORT, InFolder

import plateau
from plateau import figures
from plateau.figures import maps


def panels(figure):
    return [axes for axes in figure.axes if not hasattr(axes, "_colorbar")]


def titles(figure):
    found = (axes.get_title(loc="left").replace("\N{NO-BREAK SPACE}", " ").replace("\n", " ") for axes in figure.axes)
    return [title for title in found if title]


def drawn(axes):
    """Values of a map, NaN where there is none."""
    [artist] = [*axes.images, *axes.collections]
    return np.ma.filled(np.ma.asarray(artist.get_array(), float), np.nan), artist


def colour(artist, value):
    from matplotlib.colors import to_hex

    return to_hex(artist.cmap(artist.norm(value)))


def fractions(status, radius):
    """Parts of the area, cell by cell: those of larger radius are larger."""
    area = np.broadcast_to(radius, status.shape)
    return [area[status == value].sum() / area[status < 3].sum() for value in range(3)]


class Maps(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.runs = [plateau.run("quick.toml", "flat.h5", set=SHORT), plateau.run("quick.toml", "round.h5", set={**ROUND, "title": "Round"})]
        cls.files = [cls.enterClassContext(h5py.File(name)) for name in ("flat.h5", "round.h5")]
        for run in cls.runs:
            cls.addClassCleanup(run.close)

    def figure(self, name, runs=None, at=(), **options):
        made = figures.drawn(runs or self.runs[:1], [name], at, **options)
        for figure in made.values():
            FigureCanvasAgg(figure).draw()
        return made

    def test_heights_have_sign_zero_unit_and_a_common_scale(self):
        [figure] = self.figure("topography").values()
        heights, z = self.files[0]["disc/height"][:] * 1e6, self.files[0]["pin/height"][:] * 1e6
        *ring, first, last = panels(figure)
        for moment in (0, 1):
            windows = ring[: len(ring) // 2] if moment == 0 else ring[len(ring) // 2 :]
            np.testing.assert_allclose(np.hstack([drawn(axes)[0] for axes in windows]), heights[(0, -1)[moment]].T)
            pin = drawn((first, last)[moment])[0]
            np.testing.assert_allclose(pin, (z[(0, -1)[moment]].mean() - z[(0, -1)[moment]]).T, atol=1e-9)
        # Half a per cent of both maps together lies beyond each end.
        norm = drawn(ring[0])[1].norm
        shown = heights[[0, -1]].ravel()
        self.assertAlmostEqual((shown < norm.vmin).mean(), 0.005, delta=0.001)
        self.assertLess((shown > norm.vmax).mean(), 0.006)
        self.assertTrue(all(drawn(axes)[1].norm is norm for axes in ring))
        labels = [axes.get_ylabel().replace("\n", " ") for axes in figure.axes[-2:]]
        self.assertEqual(labels, ["height, µm", "height toward the disc, µm"])
        self.assertIn(f"z = {z[-1].mean():.4g} µm", titles(figure)[-1])

    def test_places_are_arc_lengths_and_radii_in_proportion(self):
        [figure] = self.figure("topography").values()
        ring = panels(figure)[:-2]
        radius, angle = self.files[0]["radius"][:] * 1e3, self.files[0]["disc_angle"][:]
        windows = ring[: len(ring) // 2]
        ends = [axes.get_xlim() for axes in windows]
        self.assertAlmostEqual(ends[0][0], 0.0)
        self.assertAlmostEqual(ends[-1][1], 2 * np.pi * radius.mean(), delta=1e-6)
        for (_, end), (begin, _), one, other in zip(ends, ends[1:], windows, windows[1:], strict=False):
            self.assertAlmostEqual(end, begin)
            self.assertGreater(one.get_position().y0, other.get_position().y1)
        first = (angle[1] - angle[0]) * radius.mean() * (len(angle) // len(windows))
        self.assertAlmostEqual(drawn(windows[0])[1].get_extent()[1], first, delta=1e-6)
        spacing = (radius[1] - radius[0]) / 2
        np.testing.assert_allclose(windows[0].get_ylim(), [radius[0] - spacing, radius[-1] + spacing])
        self.assertIn("the disc moves →", windows[-1].get_xlabel())
        for width, polar in ((180.0, False), (88.0, False), (88.0, True)):
            for made in self.figure("topography", width=width, polar=polar).values():
                self.assertLessEqual(made.get_figheight() * 25.4, 240.001)
                self.assertAlmostEqual(made.get_figwidth() * 25.4, width)
                for axes in panels(made):
                    box = axes.get_window_extent()
                    true = box.height / box.width / np.ptp(axes.get_ylim()) * np.ptp(axes.get_xlim())
                    told = re.search(r"stretched (\S+)×", axes.get_xlabel())
                    if axes.get_xlabel():
                        self.assertAlmostEqual(true, float(told[1]) if told else 1.0, delta=0.02)

    def test_the_ring_from_above(self):
        [figure] = self.figure("topography", polar=True).values()
        mesh = panels(figure)[1].collections[0]
        # Column 0 begins on the right, and the columns follow counter-clockwise, outward row by row.
        corners = mesh.get_coordinates()
        radius, angle = self.files[0]["radius"][:] * 1e3, self.files[0]["disc_angle"][:]
        expected = radius[3] * np.array([np.cos(angle[7]), np.sin(angle[7])])
        np.testing.assert_allclose((corners[3, 7] + corners[4, 8]) / 2, expected, rtol=1e-3)
        np.testing.assert_allclose(drawn(panels(figure)[1])[0][3, 7], self.files[0]["disc/height"][-1, 7, 3] * 1e6)
        self.assertEqual(panels(figure)[0].get_ylabel(), "y, mm")

    def test_a_round_pin_is_a_circle(self):
        *_, last = panels(list(self.figure("topography", self.runs[1:]).values())[-1])
        values, mesh = drawn(last)
        corners = mesh.get_coordinates()
        middles = (corners[1:, 1:] + corners[:-1, :-1]) / 2
        away = np.hypot(middles[..., 0], middles[..., 1] - self.files[1]["radius"][:].mean() * 1e3)
        # Its diameter is 1 mm, cells are 0.05 mm wide.
        np.testing.assert_array_equal(np.isnan(values), self.files[1]["pin/status"][-1].T == 3)
        self.assertLess(away[np.isfinite(values)].max(), 0.5 + 0.04)
        self.assertGreater(away[np.isnan(values)].min(), 0.5 - 0.04)
        self.assertEqual((last.get_aspect(), colour(mesh, np.nan)), (1, "#ffffff"))

    def test_statuses_have_parts_of_the_area_and_thin_films_are_paler(self):
        for number, name in ((0, "flat.h5"), (1, "round.h5")):
            *_, figure = self.figure("status", [self.runs[number]]).values()
            file = self.files[number]
            status, radius = file["pin/status"][-1], file["radius"][:]
            thickness = file["pin/substrate"][-1] - file["pin/height"][-1]
            films = (status == 2) & (thickness < 1e-7)
            self.assertTrue(films.any() and (films < (status == 2)).any(), name)
            values, artist = drawn(panels(figure)[-1])
            np.testing.assert_array_equal(values, np.where(films, 3.0, np.where(status == 3, np.nan, status)).T)
            none, primary, secondary = fractions(status, radius)
            thick = fractions(np.where(films, 0, status), radius)[2]
            told = [float(text) for text in re.findall(r"([\d.]+) %", titles(figure)[-1])]
            np.testing.assert_allclose(told[-4:], np.array([none, primary, secondary, thick]) * 100, rtol=6e-3)
            self.assertEqual([colour(artist, value) for value in range(3)], ["#e4e4e4", "#005a9c", "#e69f00"])
            self.assertEqual(len(figure.legends[0].get_texts()), 4)

    def test_build_up_is_height_above_the_substrate(self):
        [figure] = self.figure("build-up").values()
        file, radius = self.files[0], self.files[0]["radius"][:]
        thickness = file["disc/height"][-1] - file["disc/substrate"][-1]
        values = np.hstack([drawn(axes)[0] for axes in panels(figure)[:-1]])
        np.testing.assert_allclose(values, np.where(thickness < 1e-15, 0, thickness).T * 1e6, atol=1e-12)
        np.testing.assert_allclose(drawn(panels(figure)[-1])[0].T, (file["pin/substrate"][-1] - file["pin/height"][-1]) * 1e6)
        artist = drawn(panels(figure)[0])[1]
        self.assertEqual(colour(artist, 0.0), "#e4e4e4")
        self.assertNotEqual(colour(artist, 1e-3), "#e4e4e4")
        self.assertAlmostEqual((thickness[thickness > 1e-15] * 1e6 > artist.norm.vmax).mean(), 0.005, delta=0.005)
        area = np.broadcast_to(radius, thickness.shape) / radius.sum() / thickness.shape[0]
        told = [float(text) for text in re.findall(r"([\d.e-]+) [%µ]", titles(figure)[0])]
        np.testing.assert_allclose(told, [100 * area[thickness > 1e-15].sum(), 1e6 * (area * thickness).sum()], rtol=6e-3)

    def test_colours_of_pressure_are_those_that_carry_the_load(self):
        [figure] = self.figure("pressure", self.runs).values()
        norms = {id(drawn(axes)[1].norm) for axes in panels(figure)}
        self.assertEqual(len(norms), 1)
        # Each map counts as much as the others; cell by cell, from the highest pressure on.
        carried, radius = [], {id(file): file["radius"][:] for file in self.files}
        for file in self.files:
            for pressure in file["pin/pressure"][1:]:
                load = np.nan_to_num(pressure) * radius[id(file)]
                carried += [(one / 1e6, part) for one, part in zip(pressure[load > 0], load[load > 0] / load.sum(), strict=True)]
        total, ends = 0.0, len(self.files[0]["map_time"]) + len(self.files[1]["map_time"]) - 2
        for one, part in sorted(carried, reverse=True):
            total += part / ends
            if total > 0.005:
                break
        values, artist = drawn(panels(figure)[0])
        self.assertAlmostEqual(artist.norm.vmax / one, 1.0, delta=0.01)
        self.assertLess(artist.norm.vmin, 1e-6)
        self.assertEqual(colour(artist, 0.0), "#e4e4e4")
        np.testing.assert_allclose(values.T, self.files[0]["pin/pressure"][1] / 1e6)
        self.assertIn(f"at most {self.files[0]['pin/pressure'][1].max() / 1e6:.3g} MPa", titles(figure)[0])
        self.assertEqual(figure.axes[-1].get_ylabel(), "pressure, MPa\ngrey: no contact")

    def test_pressures_that_differ_very_much_have_a_logarithmic_scale(self):
        def scale(values):
            cells = xarray.DataArray(np.array(values) * 1.0, {"radius": [0.02, 0.021], "pin_angle": [0.0, 0.1]}, ["radius", "pin_angle"])
            picture = maps.picture_of(cells, False)
            maps.colour(maps.MAPS["pin/pressure"], [picture], "viridis")
            return picture.colours["norm"]

        # A cell that carries a thousandth of the load does not make the scale logarithmic, nor is the least pressure its begin.
        self.assertEqual((type(scale([[0.01, 10], [10, 10]])).__name__, scale([[0.01, 10], [10, 10]]).vmax), ("Normalize", 10))
        far = scale([[1, 1], [0, 1000]]), scale([[9, 9], [9, 1000]])
        self.assertEqual([type(one).__name__ for one in far], ["Normalize", "LogNorm"])
        self.assertEqual((far[1].vmin, far[1].vmax), (9, 1000))

    def test_what_is_apart_is_not_grey_among_greys(self):
        [figure] = self.figure("pressure", cmap="greys").values()
        artist = drawn(panels(figure)[0])[1]
        self.assertEqual([colour(artist, value) for value in (0.0, 1e9)], ["#bfdcf2", "#ffffff"])
        self.assertEqual(figure.axes[-1].get_ylabel(), "pressure, MPa\nblue: no contact")

    def test_temperatures_are_in_degrees_and_only_of_runs_that_have_them(self):
        with self.assertRaisesRegex(plateau.InputError, r"needs runs of scenes with output\.contact_temperature = true"):
            self.figure("contact-temperature")
        run = self.runs[0].copy()
        pressure = run["pin/pressure"]
        values = 300 + np.arange(pressure.size).reshape(pressure.shape) / 100
        run["pin/temperature"] = pressure.copy(data=values).assign_attrs(units="K")
        with self.assertWarnsRegex(plateau.PlateauWarning, "round.h5 has no map contact_temperature: left out of contact-temperature"):
            [figure] = self.figure("contact-temperature", [run, self.runs[1]]).values()
        last = drawn(panels(figure)[-1])[0]
        np.testing.assert_allclose(last, run["pin/temperature"].values[-1].T - 273.15)
        self.assertIn(f"at most {last.max():.3g} °C", titles(figure)[-1])
        self.assertEqual(figure.axes[-1].get_ylabel(), "temperature, °C")

    def test_moments_are_those_with_contact_or_those_that_are_asked_for(self):
        times = [f"Pin, {time:.4g} s" for time in self.files[0]["map_time"][:]]
        self.assertEqual([title.split(";")[0] for title in titles(next(iter(self.figure("pressure").values())))], times[1:])
        [one] = self.figure("topography", at=[9.0]).values()
        self.assertEqual([title.split(";")[0] for title in titles(one)], [times[1].replace("Pin", "Disc"), times[1]])
        lifted = self.runs[0].copy()
        lifted["pin/pressure"] = lifted["pin/pressure"] * 0
        with self.assertRaisesRegex(plateau.InputError, "flat.h5 has no map pressure with a contact after the start"):
            self.figure("pressure", [lifted])

    def test_eight_runs_stand_in_columns_on_pages_with_one_scale(self):
        made = self.figure("topography", [self.runs[0], *[self.runs[1]] * 7])
        self.assertEqual(list(made)[:2], ["topography", "topography-2"])
        norms, widths, lefts = set(), set(), set()
        for figure in made.values():
            self.assertLessEqual(figure.get_figheight() * 25.4, 240.001)
            for axes in panels(figure):
                box = axes.get_position()
                norms.add(id(drawn(axes)[1].norm))
                widths.add(round(box.width, 3))
                lefts.add(round(box.x0, 3))
        self.assertEqual((len(norms), len(widths), len(lefts)), (2, 1, 3))
        # Each run has two maps of the disc and two of the pin.
        self.assertEqual(sum(len(titles(figure)) for figure in made.values()), 8 * 4)

    def test_nothing_overlaps_and_nothing_is_cut_off(self):
        for name, widths in {"topography": (88.0, 180.0), "status": (88.0,), "build-up": (120.0,), "pressure": (88.0, 180.0)}.items():
            for width in widths:
                for figure in self.figure(name, self.runs, width=width).values():
                    renderer, boxes = figure._get_renderer(), []
                    for axes in figure.axes:
                        texts = [axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label]
                        boxes += [text.get_window_extent(renderer) for text in texts if text.get_text()]
                        boxes += [axes.get_window_extent(renderer)]
                    boxes += [legend.get_window_extent(renderer) for legend in figure.legends]
                    for number, box in enumerate(boxes):
                        inside = box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1
                        self.assertTrue(inside, f"{name} {width} {box}")
                        for other in boxes[number + 1 :]:
                            apart = box.x1 <= other.x0 or other.x1 <= box.x0 or box.y1 <= other.y0 or other.y1 <= box.y0
                            self.assertTrue(apart, f"{name} {width} {box} {other}")
