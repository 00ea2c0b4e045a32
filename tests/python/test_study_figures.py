"""What the figures and texts of studies show: units, signs, and nothing where nothing was computed."""

import itertools
import math
import unittest
from types import SimpleNamespace

import numpy as np
import pandas

from plateau.output_folder import plain
from plateau.study.data import Factor
from plateau.study.figure_axes import set_axis
from plateau.study.fit_answer import Fit
from plateau.study.scene_comparison import Comparison
from plateau.style import in_style, new, number
from plateau.units import Unit, shown_unit, with_digits, with_hyphen, with_minus

RECESS = Factor("recess", "key", "m", (2e-6, 20e-6), True, True, False, "um", 1e-6, 0.0)


class Shown(unittest.TestCase):
    def test_units_have_one_spelling(self):
        for typed in ("um", "µm", "μm"):
            self.assertEqual(shown_unit(typed), "µm")
        for typed in ("mm^2", "mm2", "mm²"):
            self.assertEqual(shown_unit(typed), "mm²")
        others = {"degC": "°C", "1/Pa": "1/Pa", "m s^-1": "m s⁻¹", "mm3/(N m)": "mm³/(N m)", "%RH": "%RH", "Ra2": "Ra2", "": ""}
        for typed, expected in others.items():
            self.assertEqual(shown_unit(typed), expected)
        self.assertEqual((RECESS.shown(6e-6), RECESS.text(6e-6)), ("6 µm", "6 um"))

    def test_people_read_a_minus_and_programs_a_hyphen(self):
        self.assertEqual(with_minus("-5 °C, 1.5e-14, (-1 to -.5)"), "−5 °C, 1.5e−14, (−1 to −.5)")
        self.assertEqual(with_minus("run-2, --model, 2026-01-02"), "run-2, --model, 2026-01-02")
        self.assertEqual([with_digits(-1.234, 0.1), with_digits(-3e-9)], ["−1.23", "−3e−09"])
        self.assertEqual(Unit("mm", 1e3).text(-2e-3, 1e-4), "−2.00 ± 0.10 mm")
        self.assertEqual(with_hyphen("−5 − x"), "-5 − x")
        self.assertEqual(plain({"said": ["−5 N"]}), {"said": ["-5 N"]})


class Figures(unittest.TestCase):
    @in_style
    def test_logarithmic_axes_have_few_numbers(self):
        figure, axes = new(88.0, 60.0, "")
        axes[0, 0].plot([2, 20], [2e-14, 1e-13])
        set_axis(axes[0, 0], RECESS)
        figure.canvas.draw()
        ticks = [at for at in axes[0, 0].get_xticks() if 2.0 <= at <= 20.0]
        self.assertEqual((axes[0, 0].get_xlabel(), axes[0, 0].get_xscale(), ticks), ("recess, µm", "log", [2.0, 5.0, 10.0, 20.0]))
        self.assertEqual([number(value) for value in (2.0, -0.05, 2e-14, 1e-13)], ["2", "−0.05", r"$2\times10^{-14}$", "$10^{-13}$"])

    def test_runs_of_a_fit_are_told_at_measured_times_alone(self):
        series = pandas.DataFrame({"response": "area", "unit": "m2", "time": [1.0, 2.0, 9.0], "measured": [1e-6, 2e-6, 3e-6]})
        series = series.assign(uncertainty=1e-7, forecast=[1.1e-6, 1.9e-6, 3.2e-6], forecast_deviation=2e-7)
        profiles = pandas.DataFrame({"key": "recess", "value": [2e-6, 6e-6, 20e-6], "rise": [5.0, 0.0, 5.0], "threshold": 3.84})
        keys = pandas.DataFrame({"key": ["recess"], "low": [3e-6], "high": [9e-6]})
        study = SimpleNamespace(factors=[RECESS])
        found = Fit.figures(SimpleNamespace(study=study, confidence=0.95, profiles=profiles, keys=keys, series=series))
        axis = found["series-area"].axes[0]
        (measured, *_), (runs, _, (bars,)) = axis.containers
        np.testing.assert_allclose(measured.get_xydata(), [[1, 1], [2, 2], [9, 3]])
        np.testing.assert_allclose(runs.get_xydata(), [[1, 1.1], [2, 1.9], [9, 3.2]])
        self.assertEqual((runs.get_linestyle(), len(axis.collections), axis.get_ylabel()), ("None", 2, "area, mm²"))
        np.testing.assert_allclose(bars.get_segments()[2], [[9, 3.0], [9, 3.4]])
        np.testing.assert_allclose(found["profiles"].axes[0].lines[0].get_xdata(), [2, 6, 20])

    def test_a_comparison_says_what_the_series_is_and_the_time_in_its_unit(self):
        rows = itertools.product(("old", "new"), (0.0, 72000.0))
        curves = pandas.DataFrame(rows, columns=["scene", "time"]).assign(series="worn_pin", unit="m3", mean=2e-9, deviation=1e-9, window=0.0)
        curves = curves.assign(difference=[math.nan, math.nan, 0.0, -1e-9], low=math.nan, high=math.nan)
        pulsing = curves.assign(series="pin_secondary", unit="1", mean=0.25, window=7200.0)
        titles = {"old": "Cast iron", "new": "Steel"}
        found = Comparison.figures(SimpleNamespace(titles=titles, curves=pandas.concat([curves, pulsing]), confidence=0.95))
        figure, shares = found["worn_pin"], found["pin_secondary"]
        self.assertEqual([text.get_text() for text in figure.legends[0].texts], ["Cast iron", "Steel"])
        said = [" ".join(one.get_supxlabel().split()) for one in (figure, shares)]
        self.assertEqual(["weighted means over 2 h" in text for text in said], [False, True])
        self.assertIn("difference from Cast iron", said[0])
        self.assertEqual([axis.get_ylabel() for axis in shares.axes], ["mean, %", "difference, points"])
        np.testing.assert_allclose(shares.axes[0].lines[0].get_ydata(), 25.0)
        top, below = figure.axes
        self.assertEqual(" ".join(top.get_title(loc="left").split()), "volume worn off plateaus of the simulated pin")
        self.assertEqual((top.get_ylabel(), below.get_ylabel(), below.get_xlabel()), ("mean, mm³", "difference, mm³", "time, h"))
        np.testing.assert_allclose(below.lines[1].get_xydata(), [[0, 0], [20, -1]])
