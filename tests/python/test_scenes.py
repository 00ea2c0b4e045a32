"""Scenes as data, and runs in this process: what the program makes of the same scenes is what is expected."""

import json
import pathlib
import pickle
import signal
import subprocess
import sys
import time
import tomllib

import h5py
import numpy as np
from checkout import QUICK, called, changed, program
from package_scenes import SHORT, InFolder

import plateau

# What tells when, where and how long.
OF_THE_MAKING = {"start_time", "end_time", "wall_time", "workers", "decomposition", "execution_sha256"}


def contents(path):
    """All numbers and texts of a run file, but those of its making."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item[:].tobytes()

    with h5py.File(path) as file:
        file.visititems(visit)
        for name, value in file.attrs.items():
            found[f"@{name}"] = repr(value)
    return found


class Quantity:
    """A number with a unit as pint has it."""

    class Unit:
        def __init__(self, symbol):
            self.symbol = symbol

        def __format__(self, form):
            assert form == "~C"
            return self.symbol

    def __init__(self, magnitude, symbol):
        self.magnitude, self.units = magnitude, self.Unit(symbol)


class Scenes(InFolder):
    def test_all_ways_to_give_a_scene_are_one_scene(self):
        expected = json.loads(program("check", "quick.toml", *changed('operation.normal_force="6 N"'), "--json"))["scene"]
        file = plateau.Scene("quick.toml", normal_force="6 N")
        self.assertEqual(str(file), expected)
        tables = file.tables
        self.assertEqual(tables, tomllib.loads(expected))
        for one in (
            plateau.Scene(pathlib.Path("quick.toml")).replace({"operation.normal_force": "6 N"}),
            plateau.Scene("quick.toml", operation={"normal_force": "6 N"}),
            plateau.Scene("quick.toml", normal_force="1 N").replace(normal_force=Quantity(np.float64(0.006), "kN")),
            plateau.Scene(tables),
            plateau.Scene(**tables),
            plateau.Scene(expected),
            plateau.Scene(file),
            pickle.loads(pickle.dumps(file)),
        ):
            self.assertEqual(one, file)
            self.assertEqual(hash(one), hash(file))
        self.assertNotEqual(file.replace(normal_force="7 N"), file)
        self.assertEqual(plateau.Scene('extends = "quick.toml"\nversion = 1\n', normal_force="6 N")["mesh"], file["mesh"])
        self.assertEqual(file.replace(mean_radius="20.5 mm", pin_width="1 mm", cell_size="50 um", shape="disc")["mesh.shape"], "disc")
        # Alternatives replace each other, also where all was given as data.
        for one in (file, plateau.Scene(tables)):
            self.assertEqual(one.replace(steps=7).replace(duration="2 s")["duration"], "2 s")
            self.assertNotIn("duration", one.replace(steps=7)["operation"])
        speed = plateau.Scene("quick.toml", sliding_speed=Quantity(2.5, "m/s"))
        self.assertEqual(speed["sliding_speed"], "2.5 m/s")
        rate = speed.replace({"materials.pin_primary.specific_wear_rate": Quantity(5e-5, "mm**3/N/m")})
        self.assertEqual(rate["materials.pin_primary.specific_wear_rate"], "5e-14 1/Pa")

    def test_a_path_may_have_an_equals_sign(self):
        pathlib.Path("a=b.toml").write_text(pathlib.Path("quick.toml").read_text())
        self.assertEqual(plateau.Scene("a=b.toml")["mesh.rows"], 20)

    def test_errors_name_the_key_and_its_place(self):
        pathlib.Path("bad.toml").write_text('extends = "quick.toml"\n[mesh]\nrows = "x"\n')
        wrong = [
            (lambda: plateau.Scene("bad.toml"), plateau.InputError, r'^bad.toml:3:8: mesh.rows: "x" is a string'),
            (lambda: plateau.Scene("[mesh]\nrows = 1.5\n"), plateau.InputError, r"^scene:2:8: mesh.rows: 1.5 is a decimal number"),
            (lambda: plateau.Scene("quick.toml", normal_force=6), plateau.InputError, "^operation.normal_force = 6: .* 6 has no unit"),
            (lambda: plateau.Scene("quick.toml", mesh={"rowz": 3}), plateau.InputError, 'mesh.rowz: unknown key, did you mean "rows"'),
            (lambda: plateau.Scene("quick.toml", normal_forc="6 N"), plateau.UnknownNameError, "did you mean normal_force"),
            (lambda: plateau.Scene("quick.toml", seed=3), plateau.InputError, "several such keys, give one of .*pin.base.synthetic.seed"),
            (lambda: plateau.Scene({"mesh.rows": 3}), plateau.InputError, r"(?s)^scene: required keys are missing:.*\[operation\]"),
            (lambda: plateau.Scene("none.toml"), plateau.MissingFileError, "^none.toml: cannot read the scene"),
            (lambda: plateau.Scene("quick.toml").replace(3), plateau.InputTypeError, "expected a dictionary"),
            (lambda: plateau.Scene("quick.toml")["disc.surface.file"], plateau.UnknownNameError, "has no value in this scene"),
            (lambda: plateau.Scene("quick.toml", rows=object()), plateau.InputTypeError, "is not a value of a scene"),
        ]
        for make, kind, message in wrong:
            with self.assertRaisesRegex(kind, message) as caught:
                make()
            self.assertIs(type(caught.exception), kind)

    def test_warnings_are_in_the_name_of_the_caller(self):
        calls = [
            lambda: plateau.Scene("quick.toml", normal_force="5 kN"),
            lambda: plateau.Scene("quick.toml").replace(normal_force="5 kN"),
            lambda: plateau.Simulation({**plateau.Scene("quick.toml").tables, "operation": {**OPERATION, "normal_force": "5 kN"}}),
        ]
        for call in calls:
            with self.assertWarnsRegex(plateau.PlateauWarning, "^operation.normal_force = .*nominal pressure of 669.6 MPa") as warned:
                call()
            self.assertEqual(warned.filename, __file__)


OPERATION = tomllib.loads(QUICK.read_text())["operation"]


class Runs(InFolder):
    def test_the_run_file_is_that_of_the_program(self):
        changes = changed(*(f"{key}={value!r}" for key, value in SHORT.items()))
        program("run", "quick.toml", "-o", "program.h5", *changes)
        plateau.run("quick.toml", "here.h5", set=SHORT, workers=2)
        one, other = contents("program.h5"), contents("here.h5")
        self.assertEqual(set(one), set(other))
        different = {name for name in one if one[name] != other[name]}
        # The number of workers is a key of the scene.
        self.assertEqual(different, {f"@{name}" for name in OF_THE_MAKING} | {"@scene", "@attributes_sha256"})
        # Each goes on with runs of the other: the revision is the same.
        done = called("run", "quick.toml", "-o", "here.h5", "--resume", "--workers", "2", *changes)
        self.assertIn("is finished", done.stderr)
        self.assertEqual(plateau.run("quick.toml", "program.h5", set=SHORT, resume=True).attrs["state"], "finished")

    def test_a_run_file_is_named_as_one(self):
        for call in (lambda: plateau.run("quick.toml", "run.CSV"), lambda: plateau.run("quick.toml", set={"output.file": "run.png"})):
            with self.assertRaisesRegex(
                plateau.InputError, "a run file is HDF5, expected a name such as run.h5; afterwards plateau.(export|plot) makes"
            ):
                call()

    def test_a_run_that_is_killed_goes_on_to_the_same_end(self):
        changes = {"operation.duration": "400 s", "output.checkpoint_every": "0.05 s", "output.maps_at": ["0 s"]}
        text = f"import plateau\nplateau.run('quick.toml', 'killed.h5', set={changes!r})"
        process = subprocess.Popen([sys.executable, "-c", text])
        until = time.monotonic() + 120
        while not pathlib.Path("killed.h5.checkpoint").exists():
            self.assertLess(time.monotonic(), until)
            time.sleep(0.005)
        process.send_signal(signal.SIGKILL)
        process.wait()
        with h5py.File("killed.h5", "r", swmr=True) as file:
            self.assertEqual(file.attrs["state"], "running")
        again = plateau.run("quick.toml", "killed.h5", set=changes, resume=True)
        whole = plateau.run("quick.toml", "whole.h5", set=changes)
        for name in ("series/contact_area", "series/worn_pin", "disc/height", "pin/height"):
            np.testing.assert_array_equal(again[name].values, whole[name].values)


class Studies(InFolder):
    def test_scenes_make_a_study(self):
        short = plateau.Scene("quick.toml", duration="5 s")
        scenes = [short, short.replace(normal_force="10 N"), short.replace(normal_force="10 N", rows=10)]
        path = plateau.study.of_scenes(scenes, "three", ["worn_pin:end", "contact_area"])
        table = plateau.sweep(path, jobs=2, progress=False).table
        self.assertEqual(table["operation.normal_force [N]"].tolist(), [5.0, 10.0, 10.0])
        self.assertEqual(table["mesh.rows"].tolist(), [20, 20, 10])
        expected = [plateau.run(scene, f"{place}.h5")["series/worn_pin"].values[-1] for place, scene in enumerate(scenes)]
        self.assertEqual(table["worn pin, end [m3]"].tolist(), expected)
        for wrong, message in [([short, short], "do not differ"), ([short, short.replace(maps_at=["1 s"])], "output.maps_at: .* a list")]:
            with self.assertRaisesRegex(plateau.InputError, message):
                plateau.study.of_scenes(wrong, "wrong")
        with self.assertRaisesRegex(plateau.InputError, "study.toml exists: .* force=True"):
            plateau.study.of_scenes(scenes, "three")

    def test_a_switch_is_a_factor(self):
        scenes = [plateau.Scene("quick.toml", duration="2 s", formation=forms) for forms in (True, False)]
        table = plateau.sweep(plateau.study.of_scenes(scenes, "switch", "deposited_disc:end"), progress=False).table
        with_plateaus, without = table["deposited disc, end [m3]"]
        self.assertGreater(with_plateaus, without)
        self.assertEqual(without, 0.0)
