"""Drives: what a brake does is what the vehicle asks for, by its speed alone; tables of loggers and regulations."""

import csv
import itertools
import math
import re
import warnings
from pathlib import Path

import h5py
import numpy as np
import pandas
from checkout import ROOT, word
from package_scenes import InFolder

import plateau

CYCLES = ROOT / "data" / "cycles"
SCENE = ROOT / "data" / "scenes" / "drive.toml"
# The car of `plateau cycle`: mass, kg, and road load, N, N s/m and N s²/m² (0.0347 N/(km/h)²).
CAR = (1500.0, 130.0, 0.0, 0.0347 * 3.6**2)
# Half of 70 % of what it brakes is one front wheel's.
ONE_WHEEL = 0.35
# The pin is 161 of 2764 columns of a ring from 20 to 24 mm, the pads are 100 cm².
SHARE = math.pi * (24e-3**2 - 20e-3**2) * 161 / 2764 / 100e-4


def braking_energy(rows, vehicle):
    """Energy that the brakes of a vehicle (mass, kg, road load in SI units) take in rows of time, s, and speed, m/s: what it loses of its kinetic
    energy beyond the work of the road load.

    With a straight line between the speeds, ∫v dt, ∫v² dt and ∫v³ dt are D (v₀ + v₁)/2, D (v₀² + v₀v₁ + v₁²)/3 and D (v₀ + v₁)(v₀² + v₁²)/4.
    """
    (mass, steady, linear, square), energy = vehicle, 0.0
    for (start, before), (end, after) in itertools.pairwise(rows):
        road = steady * (before + after) / 2 + linear * (before**2 + before * after + after**2) / 3
        road += square * (before + after) * (before**2 + after**2) / 4
        energy += max(0.0, mass / 2 * (before**2 - after**2) - (end - start) * road)
    return energy


def trips():
    """A trace of the form of the WLTP-Brake cycle, second by second, made up: ten trips with pauses; time, s, and speed, m/s."""
    speeds = [0.0]
    for trip in range(10):
        top = (30.0 + 8.0 * trip) / 3.6
        speeds += [*np.linspace(0.0, top, 12)[1:], *[top] * 10, *np.linspace(top, 0.3 * top, 8)[1:], *np.linspace(0.3 * top, 0.0, 5)[1:], *[0.0] * 20]
    return [(float(time), float(speed)) for time, speed in enumerate(speeds)]


class Drive(InFolder):
    def test_the_shipped_cycle_is_what_the_command_writes(self):
        plateau.cycle(CYCLES / "wltc-class3b.csv", "w.toml")
        self.assertEqual(Path("w-cycle.csv").read_text(), (CYCLES / "wltc-front-brake.csv").read_text())

    def test_friction_work_is_the_braking_energy_of_the_car(self):
        plateau.run(SCENE, "drive.h5", set={"operation.duration": "200 s", "numerics.time_acceleration": 10})
        with open(CYCLES / "wltc-class3b.csv", newline="") as file:
            rows = [(float(row["time [s]"]), float(row["road_speed [km/h]"]) / 3.6) for row in csv.DictReader(file)][:201]
        expected = ONE_WHEEL * SHARE * braking_energy(rows, CAR)
        with h5py.File("drive.h5") as run:
            work = run["series/friction_work"][-1]
        self.assertLess(abs(work / expected - 1.0), 0.01)

    def test_a_regulations_trace_gives_a_brake_with_the_energy_of_its_vehicle(self):
        rows = trips()
        Path("annex.csv").write_text("Time [s],Speed [km/h]\n" + "".join(f"{time:g},{3.6 * speed:.9g}\n" for time, speed in rows))
        scene = plateau.cycle("annex.csv", "wltp.toml", mass="1600 kg", road_load=(100, 1, 0.03), share=0.6, wheel_radius="0.3 m")
        small = {"mesh.pin_width": "1 mm", "mesh.pin_length": "2 mm", "mesh.mean_radius": "20.5 mm", "output.maps": []}
        series = plateau.run(scene, "wltp.h5", set=small).plateau.series.iloc[-1]
        work = series["friction_work"] * series["brake_pm10_mass"] / series["pm10_mass"]
        expected = 0.3 * braking_energy(rows, (1600.0, 100.0, 3.6, 0.03 * 3.6**2))
        self.assertLess(abs(work / expected - 1.0), 0.01)
        road = sum((one[1] + other[1]) / 2 for one, other in itertools.pairwise(rows))
        self.assertLess(abs(series["road_distance"] / road - 1.0), 1e-6)
        # With the largest acceleration that leaves ten revolutions in every braking nothing is warned of.
        self.assertEqual(plateau.check(scene, set={"output.file": "other.h5"})["warnings"], [])


class Tables(InFolder):
    def cycle(self, text, name="log.csv", **options):
        Path(name).write_text(text, encoding="utf-8")
        return pandas.read_csv(plateau.cycle(name, "made.toml", force=True, **options).cycle)

    def test_a_logger_has_headers_clock_and_commas_of_its_own(self):
        text = "Zeit;Tempo (km/h);Verzögerung [m/s2];Gang\n12:00:05;36,0;-1\n12:00:06,5;36,0;2,5;\n12:00:07;0;2,5;\n".replace(";-1\n", ";-1;3\n")
        names = {"time": "Zeit", "road_speed": "Tempo", "deceleration": "Verzögerung"}
        found = self.cycle(text, columns=names, mass=1000, road_load=(200, 0, 0), share=0.5, wheel_radius=0.3)
        self.assertEqual(found["time [s]"].tolist(), [0.0, 1.5, 2.0])
        # (1000 kg 2.5 m/s² - 200 N) 0.5 0.3 m / 2; what speeds the car up brakes nothing.
        self.assertEqual(found["brake_torque [N m]"].tolist(), [0.0, 172.5, 172.5])

    def test_rows_of_any_spacing_have_the_energy_of_the_vehicle(self):
        rows = [(0.0, 50.0), (10.0, 50.0), (15.0, 0.0), (16.0, 0.0), (40.0, 0.0), (40.0, 30.0), (41.0, 10.0)]
        text = "time [s],road_speed [km/h]\n" + "".join(f"{time},{speed}\n" for time, speed in rows)
        found = self.cycle(text)
        time, torque = found["time [s]"].to_numpy(), found["brake_torque [N m]"].to_numpy()
        wheel = found["road_speed [km/h]"].to_numpy() / 3.6 / 0.31
        # ∫T ω dt of straight lines between the rows.
        parts = 2 * torque[:-1] * wheel[:-1] + 2 * torque[1:] * wheel[1:] + torque[:-1] * wheel[1:] + torque[1:] * wheel[:-1]
        written = float(np.sum(np.diff(time) * parts) / 6)
        # The road load is that of the mean speed of a row, not the mean over it: less than a hundredth apart here.
        of_car = sum(braking_energy([(a, b / 3.6), (c, d / 3.6)], CAR) for (a, b), (c, d) in itertools.pairwise(rows) if c > a)
        self.assertLess(abs(written / (ONE_WHEEL * of_car) - 1.0), 0.01)

    def test_what_was_read_is_told_and_what_can_hardly_be_meant(self):
        rows = "".join(f"{time},{50 if time < 30 else 0},{0.2 if time < 25 else 10}\n" for time in range(40) if not 5 < time < 20)
        Path("log.csv").write_text(f"time [s],road_speed [km/h],brake_pressure [MPa]\n{rows}")
        with self.assertWarns(plateau.PlateauWarning) as caught:
            made = plateau.cycle("log.csv", "made.toml", piston_area="25 cm^2", force=True)
        said = " ".join(made.warnings)
        self.assertIn("between the rows at 5 and 20 s there are 15 s, else about 1 s", said)
        self.assertIn("100 bar", made.told)
        self.assertIn("the brake is on in most of the rows", said)
        self.assertIn("log.csv: between", str(caught.warning))
        # The same of the speed alone, whose brakings are put between the rows.
        Path("speed.csv").write_text("time [s],road_speed [km/h]\n" + "".join(f"{time},50\n" for time in (0, 1, 2, 3, 4, 5, 30, 31)) + "35,0\n")
        with self.assertWarns(plateau.PlateauWarning):
            made = plateau.cycle("speed.csv", "made.toml", force=True)
        self.assertIn("between the rows at 5 and 30 s there are 25 s", " ".join(made.warnings))
        self.assertIn("9 rows, 35 s", made.told)
        # Less than half a bar presses no pad.
        quiet = self.cycle("time [s],road_speed [km/h],brake_pressure [bar]\n0,50,0.4\n9,50,0.4\n10,40,5\n", piston_area="25 cm^2")
        self.assertEqual(quiet["brake_pressure [bar]"].tolist(), [0.0, 0.0, 5.0])

    def test_a_noisy_speed_is_told_from_brakings(self):
        between = np.random.default_rng(1)
        time, speed = np.arange(400.0), np.zeros(400)
        for start in range(0, 400, 80):
            speed[start : start + 75] = 50.0 * np.clip(np.minimum(np.arange(75) / 15, (74 - np.arange(75)) / 8), 0.0, 1.0)
        noise = np.where(speed > 0.0, between.uniform(-0.6, 0.6, 400), 0.0)

        def said(speed):
            rows = "".join(f"{one:g},{max(of, 0.0):.3f}\n" for one, of in zip(time, speed, strict=True))
            Path("log.csv").write_text(f"time [s],road_speed [km/h]\n{rows}")
            with warnings.catch_warnings(action="ignore"):
                made = plateau.cycle("log.csv", "made.toml", force=True)
            return int(re.search(r"(\d+) brakings", made.told)[1]), " ".join(made.warnings)

        self.assertEqual(said(speed), (5, ""))
        brakings, warned = said(speed + noise)
        counts = re.search(r"(\d+) of (\d+) brakings last 2 s or less, (\d+) of them below 5 % of the largest brake_torque", warned)
        short, of_all, weak = map(int, counts.groups())
        self.assertEqual((short, of_all), (brakings - 5, brakings))
        self.assertGreaterEqual(weak, 5)
        self.assertIn("smooth the road_speed before, such as by a moving mean", warned)
        # What is advised helps.
        self.assertEqual(said(pandas.Series(speed + noise).rolling(5, center=True, min_periods=1).mean()), (5, ""))
        # A mean would not take away the noise of a load, which is never negative.
        loads = "".join(f"{one:g},50,{200 if one % 80 < 8 else 3 * (one % 3 == 0):g}\n" for one in time)
        with self.assertWarnsRegex(plateau.PlateauWarning, "if that is noise, set it to 0 in brake_torque"):
            self.cycle(f"time [s],road_speed [km/h],brake_torque [N m]\n{loads}")

    def test_sizes_that_can_hardly_be_meant_and_those_of_no_use_are_told(self):
        speeds = "time [s],road_speed [km/h]\n0,50\n10,50\n15,0\n"
        pressures = "time [s],road_speed [km/h],brake_pressure [bar]\n0,50,0\n10,50,10\n15,0,10\n"
        for text, options, expected in [
            (speeds, {"pad_area": "104 cm^2"}, []),
            (speeds, {"disc_mass": "0.65 kg"}, ["disc_mass = 0.65 kg is not from 2 kg to 60 kg: check its unit"]),
            (speeds, {"piston_area": "25 cm^2"}, ["no use is made of piston_area: the table has no brake_pressure"]),
            (pressures, {"piston_area": "25 cm^2"}, []),
            (
                pressures,
                {"piston_area": "25 cm^2", "mass": "1600 kg", "share": 0.6},
                ["no use is made of mass and share: the table has the brake_pressure"],
            ),
        ]:
            Path("log.csv").write_text(text)
            with self.subTest(options), warnings.catch_warnings(action="ignore"):
                self.assertEqual(plateau.cycle("log.csv", "made.toml", force=True, **options).warnings, expected)
        # In gram so light a car brakes nothing: it is told why.
        Path("log.csv").write_text(speeds)
        with self.assertRaises(plateau.InputError), self.assertWarnsRegex(plateau.PlateauWarning, "mass = 1600 g is not from 200 kg to 44000 kg"):
            plateau.cycle("log.csv", "made.toml", force=True, mass="1600 g")

    def test_the_command_tells_what_it_wrote_and_what_is_not_of_the_car(self):
        Path("glatt.csv").write_text("time [s],road_speed [km/h]\n0,0\n5,0\n10,50\n20,50\n25,0\n30,0\n")
        done, printed, _ = zip(*(word("cycle", "glatt.csv", "-o", name) for name in ("glatt.toml", "t/d.toml")), strict=True)
        self.assertEqual(done, (0, 0))
        for said in (
            "wrote glatt.toml and glatt-cycle.csv\n",
            "wrote t/d.toml and t/d-cycle.csv\n",
            "while the vehicle stands, 100 N m hold it",
            "not of your car: materials and friction (a cermet-coated disc), the disc's size but for its mass, its cooling",
        ):
            self.assertIn(said, "".join(printed))
        held = pandas.read_csv("glatt-cycle.csv")
        self.assertEqual(held["brake_torque [N m]"].iloc[[0, -1]].tolist(), [100.0, 100.0])
        scene = Path("glatt.toml").read_text()
        self.assertRegex(scene, r"(?m)^disc_primary = .* # <- 0: .* grey iron does, with a specific_wear_rate of its own$")
        self.assertEqual(Path(plateau.Scene("glatt.toml")["operation.cycle.file"]), Path("glatt-cycle.csv").resolve())

    def test_pressure_and_torque_are_taken_as_they_are(self):
        rows = "0,36,0\n2,36,10\n4,0,20\n"
        found = self.cycle(f"time [s],road_speed [km/h],brake_pressure [bar]\n{rows}", piston_area="25 cm^2")
        self.assertEqual(found["brake_pressure [bar]"].tolist(), [0.0, 10.0, 20.0])
        self.assertEqual(plateau.Scene("made.toml")["brake.piston_area"], "25 cm^2")
        self.assertEqual(self.cycle(f"time [s],road_speed [km/h],brake_torque [kN m]\n{rows}")["brake_torque [N m]"].tolist(), [0.0, 1e4, 2e4])

    def test_a_workbook_is_read(self):
        table = pandas.DataFrame({"time [s]": [0.0, 5.0], "road_speed [m/s]": [10.0, 0.0], "brake_torque [N m]": [0.0, 300.0]})
        table.to_excel("log.xlsx", index=False)
        made = pandas.read_csv(plateau.cycle("log.xlsx", "book.toml").cycle)
        self.assertEqual(made["road_speed [km/h]"].tolist(), [36.0, 0.0])
        self.assertEqual(made["brake_torque [N m]"].tolist(), [0.0, 300.0])

    def test_what_is_wrong_is_said_with_what_to_do(self):
        for text, options, said in [
            ("time [s],v [km/h]\n0,1\n1,0\n", {}, 'no column "road_speed"; there are "time [s]", "v [km/h]": name it by --column road_speed=HEADER'),
            ("time [s],road_speed\n0,1\n1,0\n", {}, 'file or as --column road_speed="road_speed [km/h]"'),
            ("Zeit,road_speed [km/h]\n0,1\n1,0\n", {"columns": {"time": "Zeit"}}, "h:mm:ss, or a number and for its unit one in brackets"),
            ("time [s],road_speed [km/h],brake_pressure\n0,1,2\n1,0,2\n", {}, '"brake_pressure" has no unit: give one in brackets'),
            ("time [s],road_speed [km/h],brake_pressure\n0,1,2\n1,0,2\n", {}, '--column brake_pressure="brake_pressure [bar]"'),
            ("time [s],road_speed [km/h],brake_torque\n0,1,2\n1,0,2\n", {}, '--column brake_torque="brake_torque [N m]"'),
            ("time [s],road_speed [km/h]\n0,1\n1,x\n", {}, 'log.csv:3: "road_speed [km/h]" is "x", expected a number'),
            ("time [s],road_speed [km/h]\n0,1\n1,-3\n", {}, '"road_speed [km/h]" is -3, expected 0 or more'),
            ("time [s],road_speed [kg]\n0,1\n1,3\n", {}, '"kg" measures something else than m s-1'),
            ("time [s],road_speed [km/h]\n5,1\n1,0\n", {}, "log.csv:3: its time is before that of the row above"),
            ("time [s],road_speed [km/h],brake_torque [N m],brake_pressure [bar]\n0,1,2,3\n1,0,2,3\n", {}, "expected one of them"),
            ("time [s],road_speed [km/h],brake_pressure [bar]\n0,1,2\n1,0,2\n", {}, "give the area of those of one pad"),
            ("time [s],road_speed [km/h]\n0,50\n1,50\n", {}, "nowhere between two rows is there load and speed"),
            ("time [s],road_speed [km/h]\n0,50\n9,0\n", {"share": 70.0}, "share: 70, expected more than 0 and at most 1, such as 0.7"),
            ("time [s],road_speed [km/h]\n0,50\n9,0\n", {"road_load": (1, 2)}, "road_load: expected three numbers"),
            ("time [s],road_speed [km/h]\n0,50\n9,0\n", {"mass": "1600"}, 'mass: "1600", expected text with a unit, such as "1500 kg"'),
            ("time [s],road_speed [km/h]\n0,50\n9,0\n", {"mass": "1,6 Mg"}, 'mass: "1,6 Mg": decimal marks are points, expected text with a unit'),
            ("time [s],road_speed [km/h]\n0,50\n9,0\n", {"effective_radius": "400 mm"}, "expected less than the wheel_radius of 310 mm"),
            ("", {}, "no points, expected a line"),
            ("time [s],road_speed [km/h]\n0,1\n", {}, "expected two rows or more, with times that go on"),
            ("time [s],v [m/s],v [km/h]\n0,1,3.6\n1,0,0\n", {"columns": {"road_speed": "v"}}, "are both road_speed: give the whole header"),
            ("time [s],v [m/s]\n0,1\n1,0\n", {"columns": {"road_speed": "v [km/h]"}}, 'column "v [m/s]" is in m/s, not in km/h'),
            ("time [s],road_speed [km/h]\n0,nan\n1,0\n", {}, 'is "nan", expected a number'),
            ("time [s],road_speed [km/h]\n0,50\n9,0\n", {"wheel_radius": "0 m"}, "wheel_radius: expected more than 0"),
        ]:
            Path("made.toml").unlink(missing_ok=True)
            with self.subTest(said), self.assertRaises(plateau.InputError) as caught:
                self.cycle(text, **options)
            self.assertIn(said, str(caught.exception))
            self.assertFalse(Path("made.toml").exists())
