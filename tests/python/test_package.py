"""The Python package makes runs, calls the program and opens what both write. Numbers are found another way: by h5py and NumPy, by hand, or are
those that the program itself prints."""

import csv
import doctest
import importlib
import io
import json
import os
import pathlib
import pickle
import pkgutil
import signal
import subprocess
import sys
import time
import tomllib
import unittest
import unittest.mock
import warnings

import h5py
import numpy as np
import pandas
import xarray
from checkout import QUICK, ROOT, python
from package_scenes import SHORT, STUDY, InFolder

import plateau
from plateau import program
from plateau.toml_text import toml_of
from plateau.units import quantity


def stand_in(text):
    """A program that is a shell script, in place of the real one."""
    path = pathlib.Path("stand-in").absolute()
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)
    return unittest.mock.patch.dict(os.environ, PLATEAU_PROGRAM=str(path))


class Documentation(InFolder):
    def test_examples_in_docstrings(self):
        plateau.run("quick.toml", set={"output.maps_at": ["0 s"]})
        one_factor = STUDY.split("[[factor]]")
        response = '[[response]]\nname = "contact area"\ndataset = "/series/contact_area_mean"\nat = "end"\n'
        pathlib.Path("loads.toml").write_text("[[factor]]".join(one_factor[:2]) + response)
        tried = 0
        # `commands` comes before `study`, which opens what it makes.
        for name in ["plateau", *(f"plateau.{module.name}" for module in pkgutil.iter_modules(plateau.__path__))]:
            result = doctest.testmod(importlib.import_module(name))
            self.assertEqual(result.failed, 0, name)
            tried += result.attempted
        self.assertGreater(tried, 40)

    def test_every_public_thing_says_what_it_is(self):
        for name in plateau.__all__:
            thing = getattr(plateau, name)
            self.assertTrue(thing.__doc__, name)
            if isinstance(thing, type) and thing.__module__.endswith("_accessor"):
                for member, value in vars(thing).items():
                    self.assertTrue(member.startswith("_") or value.__doc__, f"{name}.{member}")

    def test_lints_and_format(self):
        for words in (["check"], ["format", "--check"]):
            ruff = [sys.executable, "-m", "ruff", *words, "--no-cache", "--quiet", str(ROOT)]
            found = subprocess.run(ruff, capture_output=True, text=True, check=False)
            self.assertEqual(found.returncode, 0, found.stdout + found.stderr)

    def test_what_takes_long_to_import_is_imported_when_it_is_needed(self):
        heavy = "sorted({'numpy', 'pandas', 'xarray', 'scipy', 'matplotlib'} & set(sys.modules))"
        accessors = "[hasattr(kind, 'plateau') for kind in (xarray.DataTree, xarray.DataArray)]"
        self.assertEqual(python(f"import sys, plateau; print(set(plateau.__all__) <= set(dir(plateau)), {heavy})"), "True []\n")
        looked_for = "plateau, importlib.util; importlib.util.find_spec('xarray'); import xarray"
        for modules in ("plateau, xarray", "xarray, plateau", looked_for):
            self.assertEqual(python(f"import {modules}; print({accessors})"), "[True, True]\n")

    def test_types(self):
        try:
            import mypy.api
        except ImportError:
            self.skipTest("mypy is not installed")
        found, errors, status = mypy.api.run(
            ["--config-file", str(ROOT / "pyproject.toml"), "--cache-dir", str(ROOT / ".mypy_cache"), str(ROOT / "python" / "plateau")]
        )
        self.assertEqual(status, 0, found + errors)


class Runs(InFolder):
    def test_a_run_and_its_summary(self):
        run = plateau.run("quick.toml", "short.h5", set=SHORT)
        summary = run.attrs["summary"]
        with h5py.File("short.h5") as file:
            self.assertEqual(summary["contact_area"], file["series/contact_area"][-1])
            np.testing.assert_array_equal(run["disc/height"].values, file["disc/height"][:])
            np.testing.assert_array_equal(run["time"].values, file["time"][:])
            self.assertEqual(json.loads(json.dumps(run.plateau.scene))["operation"]["duration"], "20 s")
        # What exists is left alone, replaced, or left as it is when it is finished.
        with self.assertRaisesRegex(plateau.InputError, "short.h5 exists; give force=True to replace it, .* with output=FILE") as caught:
            plateau.run("quick.toml", "short.h5", set=SHORT)
        self.assertEqual(caught.exception.status, 2)
        plateau.run("quick.toml", "short.h5", set=SHORT | {"operation.duration": "10 s"}, force=True)
        self.assertEqual(len(plateau.open_run("short.h5")["map_time"]), 2)
        again = plateau.run("quick.toml", "short.h5", set=SHORT | {"operation.duration": "10 s"}, resume=True)
        self.assertNotIn("summary", again.attrs)
        named = SHORT | {"operation.duration": "10 s", "output.file": "short.h5"}
        self.assertEqual(plateau.run("quick.toml", set=named, resume=True).sizes, again.sizes)
        longer = plateau.run("quick.toml", "short.h5", extend_to=20, set=SHORT | {"operation.duration": "10 s"})
        np.testing.assert_array_equal(longer["series/pool"].values, run["series/pool"].values)
        np.testing.assert_array_equal(longer["disc/height"][-1].values, run["disc/height"][-1].values)

    def test_check(self):
        found = plateau.check(QUICK, set={"mesh": {"rows": 10}}, workers=2)
        # 60 s at 850 turns a minute, of which one simulated stands for 20: 42.5 of 690 columns each.
        self.assertEqual((found["rows"], found["steps"], found["workers"]), (10, 29325, 2))

    def test_check_and_commands_of_a_scene_that_is_in_no_file(self):
        scene = plateau.Scene(QUICK, rows=10).replace(captured_fraction=0.4)
        for given in (scene, scene.tables, scene.toml):
            found = plateau.check(given, set={"operation.normal_force": "5 N"})
            self.assertEqual((found["rows"], tomllib.loads(found["scene"])["plateaus"]["captured_fraction"]), (10, 0.4))
        self.assertNotIn("reads", [file["access"] for file in plateau.check(scene)["files"]])
        self.assertEqual([surface["rows"] for surface in plateau.command("surface", "--prepare", scene, json=True)], [10, 10])
        with self.assertRaisesRegex(plateau.InputError, "mesh.rows"):
            plateau.check({"mesh": {"rows": 0}})
        self.assertFalse([name for name in os.listdir() if name.startswith(".scene")])

    def test_warnings_of_the_program(self):
        with self.assertWarnsRegex(plateau.PlateauWarning, "nominal pressure of 669.6 MPa"):
            plateau.check("quick.toml", set={"operation.normal_force": "5 kN"})

    def test_values_of_keys_are_what_they_were(self):
        values = ["5 N", 'a "quoted" \\ text', "µm", True, False, 7, 5e-14, 2.5, ["0 s", "10 s"], {"tolerance": 0.01, "max": 100}]
        for value in [*values, [{"a b": 1}, [True]], (1, 2)]:
            expected = list(value) if isinstance(value, tuple) else value
            found = tomllib.loads(f"value = {toml_of(value)}")["value"]
            self.assertEqual((type(found), found), (type(expected), expected))
        self.assertEqual(tomllib.loads(f"value = {toml_of(np.array([1.5, 2.0]))}")["value"], [1.5, 2.0])
        self.assertEqual(toml_of(np.float64(0.1)), "0.1")
        with self.assertRaisesRegex(TypeError, "not a value of a scene") as caught:
            toml_of(object())
        self.assertIsInstance(caught.exception, plateau.PlateauError)

    def test_arguments_of_a_wrong_type(self):
        for call in (plateau.run, plateau.check):
            with self.assertRaisesRegex(plateau.InputTypeError, "set = 'operation.normal_force=10 N': expected a dictionary"):
                call("quick.toml", set="operation.normal_force=10 N")
            with self.assertRaisesRegex(plateau.InputError, "has a character 0"):
                call("quick\0.toml")

    def test_errors_are_those_of_the_exit_status(self):
        kinds = {1: plateau.RunFailed, 2: plateau.InputError, 143: plateau.RunStopped, 7: plateau.PlateauError}
        for status, kind in kinds.items():
            said = f"printf 'plateau: warning: beware\\nplateau: a note\\nplateau: what happened\\n  and where\\n' >&2; exit {status}"
            with stand_in(said), self.assertWarnsRegex(plateau.PlateauWarning, "^beware$"), self.assertRaises(kind) as caught:
                program.call(["run"])
            self.assertIs(type(caught.exception), kind)
            self.assertEqual((str(caught.exception), caught.exception.status), ("what happened\n  and where", status))
        with stand_in("kill -KILL $$"), self.assertRaisesRegex(plateau.PlateauError, "ended with status -9"):
            program.call(["run"])

    def test_a_file_that_is_not_there_is_told_as_such(self):
        calls = [
            lambda path: plateau.run(path),
            lambda path: plateau.run(path, resume=True),
            plateau.check,
            plateau.sweep,
            plateau.collect,
            plateau.study.effects,
            plateau.open_run,
            plateau.open_study,
            lambda path: plateau.command("surface", path, json=True),
            lambda path: plateau.command("plot", path),
        ]
        for call in calls:
            for path in ("none.toml", pathlib.Path("no/none.toml")):
                with self.assertRaisesRegex(plateau.MissingFileError, "none.toml") as caught:
                    call(path)
                self.assertIsInstance(caught.exception, FileNotFoundError)
        # A file that is there, and is wrong, is not missing.
        pathlib.Path("wrong.toml").write_text("[mesh]\nrows = 0\n")
        with self.assertRaises(plateau.InputError) as caught:
            plateau.check("wrong.toml")
        self.assertIs(type(caught.exception), plateau.InputError)

    def test_what_is_no_path_and_what_is_no_key(self):
        for call in (plateau.run, plateau.check, plateau.sweep, plateau.collect, plateau.study.effects, plateau.open_study, plateau.open_run):
            for wrong in (None, 3, {}):
                # The number of an open file, and a scene without keys.
                if (call, wrong) not in [(plateau.open_run, 3), (plateau.run, {}), (plateau.check, {})]:
                    self.assertRaises(plateau.InputTypeError, call, wrong)
        with self.assertRaisesRegex(plateau.InputError, "is empty"):
            plateau.open_run("")
        for key in ("mesh.rows=3", 5):
            with self.assertRaisesRegex(plateau.InputError, "is not a key of a scene"):
                plateau.check("quick.toml", set={key: 1})
        # What begins as an option does is a file nevertheless.
        pathlib.Path("-h").write_text('extends = "quick.toml"\n')
        self.assertEqual(plateau.check("-h", set={"mesh.rows": 10})["rows"], 10)

    def test_any_command(self):
        said = 'for word; do printf "<%s>" "$word"; done'
        with stand_in(said):
            found = plateau.command(
                "sweep",
                "predict",
                pathlib.Path("a b.toml"),
                3,
                max_failures=2,
                force=True,
                retry=False,
                output=None,
                figure=["one", "two"],
                set={"operation.normal_force": "5 N", "mesh.rows": 10},
            )
        self.assertEqual(
            found,
            "<sweep><predict><a b.toml><3><--max-failures><2><--force><--figure><one><--figure><two>"
            '<--set><operation.normal_force="5 N"><--set><mesh.rows=10>',
        )
        with stand_in('printf \'{"arguments": "%s"}\' "$*"'):
            self.assertEqual(plateau.command("fit", "study.toml", json=True), {"arguments": "fit study.toml --json"})
        with stand_in("echo 'plateau: warning: beware' >&2"), self.assertWarnsRegex(plateau.PlateauWarning, "^beware$") as warned:
            self.assertIsNone(plateau.command("surface", json=True))
        self.assertEqual(warned.filename, __file__)
        [disc, pin] = plateau.command("surface", "--prepare", "quick.toml", json=True)
        self.assertEqual((disc["name"], disc["rows"], pin["name"]), ("disc", 20, "pin"))
        with self.assertRaisesRegex(plateau.InputError, "--colour"):
            plateau.command("plot", "quick.h5", colour="red")

    def test_messages_are_in_the_words_of_python(self):
        said = {
            "/a b/--force.h5 exists; give --force to replace it": "/a b/--force.h5 exists; give force=True to replace it",
            "x; without --resume, --force begins again": "x; without resume=True, force=True begins again",
            "a.h5 is finished; --extend-to TIME goes on": "a.h5 is finished; extend_to=TIME goes on",
            "--extend-to: it has come to 5 s": "extend_to: it has come to 5 s",
            "numerics.workers, --workers and --pin have no effect": "numerics.workers, workers and --pin have no effect",
            "--set mesh.rows=a=b: mesh.rows": 'set["mesh.rows"] = a=b: mesh.rows',
            "`/bin/plateau run` needs --force, or -o FILE": "`plateau.run` needs force=True, or output=FILE",
            "plateau sweep run makes them": "plateau.sweep makes them",
            "--model full fits better; another --model": 'model="full" fits better; another model',
            "close it with `plateau repair`": "close it with `plateau repair`",
        }
        for message, expected in said.items():
            with stand_in(f"echo 'plateau: {message}' >&2; exit 2"), self.assertRaises(plateau.InputError) as caught:
                program.call(["run"])
            self.assertEqual(str(caught.exception), expected)

    def test_times(self):
        told = {"30 s": 30.0, "1.5min": 90.0, " 2 h ": 7200.0, "5e2 ms": 0.5, 7: 7.0, np.float64(2.5): 2.5, ".5 s": 0.5}
        self.assertEqual([quantity(time, "s") for time in told], list(told.values()))
        for wrong in ("30", "30 sec", "s", "1,5 s", "1 N", None, [1], "nan s"):
            with self.assertRaisesRegex(plateau.InputError, "expected a number in s, or text with a unit"):
                quantity(wrong, "s")

    def test_errors_can_be_sent_to_another_process(self):
        for kind in (plateau.MissingFileError, plateau.UnknownNameError, plateau.InputTypeError, plateau.RunFailed):
            again = pickle.loads(pickle.dumps(kind("what happened", ["run"], 2)))
            self.assertEqual((type(again), str(again), again.command, again.status), (kind, "what happened", ["run"], 2))

    def test_progress_is_shown_and_taken_away(self):
        with unittest.mock.patch("plateau.progress.PATIENCE", 0.0), unittest.mock.patch("sys.stderr", io.StringIO()) as shown:
            plateau.run("quick.toml", "seen.h5", set={"operation.duration": "200 s"}, progress=True)
            plateau.run("quick.toml", "unseen.h5", set={"operation.duration": "2 s"}, progress=False)
        self.assertRegex(shown.getvalue(), r"^(\r\x1b\[2K#*\.* +\d+ %  [\d.]+ of 200  (\d+ s|\?) left)+\r\x1b\[2K$")

    def test_a_notebook_shows_progress_in_the_cell(self):
        # The least of IPython that is used: a kernel, and a place in the output that is updated.
        display, handle = unittest.mock.MagicMock(), unittest.mock.MagicMock()
        display.display.return_value = handle
        display.Pretty = str
        modules = {"IPython": unittest.mock.MagicMock(), "IPython.display": display}
        with unittest.mock.patch.dict(sys.modules, modules), unittest.mock.patch("plateau.progress.PATIENCE", 0.0):
            plateau.Simulation("quick.toml").advance(20000)
        *lines, last = [call.args[0] for call in handle.update.call_args_list]
        self.assertEqual(last, "")
        self.assertRegex(lines[-1], r"^#{28} 100 %  step 20000 of 20000  0 s left$")

    def test_an_interrupt_of_python_alone_closes_the_run_file(self):
        text = (
            # A shell may have had what runs in its background ignore the signal.
            "import signal, plateau\nsignal.signal(signal.SIGINT, signal.default_int_handler)\ntry:\n"
            "    plateau.run('quick.toml', 'long.h5', set={'operation.duration': '100000 s'})\n"
            "except KeyboardInterrupt:\n    print('interrupted')"
        )
        process = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True)
        end = time.monotonic() + 120
        while not pathlib.Path("long.h5").exists():
            self.assertLess(time.monotonic(), end, "no run file after two minutes")
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=120)
        self.assertEqual(out, "interrupted\n")
        with h5py.File("long.h5") as file:
            self.assertEqual(file.attrs["state"], "interrupted")


class Programs(InFolder):
    def test_where_it_is_looked_for(self):
        with unittest.mock.patch.dict(os.environ, PLATEAU_PROGRAM="/no/such"):
            with self.assertRaisesRegex(plateau.PlateauError, "PLATEAU_PROGRAM is '/no/such'"):
                plateau.find_program()
        with unittest.mock.patch.dict(os.environ):
            del os.environ["PLATEAU_PROGRAM"]
            self.assertEqual(plateau.find_program(), str(ROOT / "plateau"))
            # Installed: the package is somewhere else, its program among the scripts of the environment.
            site = pathlib.Path("lib/site-packages").absolute()
            site.mkdir(parents=True)
            scripts = {"prefix": "bin", "user": "user/bin"}
            with (
                unittest.mock.patch.object(program, "__file__", str(site / "plateau" / "program.py")),
                unittest.mock.patch.object(program, "_scheme", lambda key: key),
                unittest.mock.patch("sysconfig.get_path", lambda name, scheme: str(pathlib.Path(scripts[scheme]).absolute())),
            ):
                os.environ["PATH"] = str(pathlib.Path("path").absolute())
                with self.assertRaisesRegex(plateau.PlateauError, "neither beside the Python package nor on PATH"):
                    plateau.find_program()
                for folder in ("path", "lib/site-packages/bin", "user/bin", "bin"):
                    pathlib.Path(folder).mkdir(parents=True)
                    path = pathlib.Path(folder, "plateau").absolute()
                    path.write_text("#!/bin/sh\n")
                    path.chmod(0o755)
                    self.assertEqual(plateau.find_program(), str(path))

    def test_matplotlib_is_asked_for_by_figures_alone(self):
        text = (
            "import sys, plateau\nassert not any(name.startswith('matplotlib') for name in sys.modules)\n"
            "sys.modules['matplotlib'] = None\n"
            "try:\n    plateau.plot([])\nexcept plateau.PlateauError as error:\n    assert isinstance(error, ImportError)\n    print(error)\n"
        )
        self.assertEqual(python(text), "figures need matplotlib: pip install 'plateau-brake[all]', or pip install matplotlib\n")


class Studies(InFolder):
    def test_a_study_from_its_runs_to_its_effects(self):
        pathlib.Path("study.toml").write_text(STUDY)
        for path in ("study", "study.toml", "none.toml"):
            with self.assertRaisesRegex(plateau.MissingFileError, "plateau.collect|no such study") as caught:
                plateau.open_study(path)
            self.assertIsInstance(caught.exception, FileNotFoundError)
        with warnings.catch_warnings(action="error"):
            made = plateau.sweep("study.toml", jobs=2, progress=False)
        for study in (made, plateau.open_study("study"), plateau.open_study("study.toml"), plateau.collect("study.toml")):
            self.assertEqual(study.data["contact_area"].dims, ("run", "time"))
            pandas.testing.assert_frame_equal(study.table, made.table)
        # Answers can make runs of it.
        self.assertEqual(made.path, pathlib.Path("study.toml"))
        with open("study/results.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(made.table), list(rows[0]))
        self.assertEqual(made.table["worn [m3]"].tolist(), [float(row["worn [m3]"]) for row in rows])
        np.testing.assert_array_equal(made.table["worn [m3]"], made.data["worn"].values)
        found = plateau.study.effects("study.toml", model="main", confidence=0.9)
        # Main effects of two levels are differences of means.
        worn = made.table.groupby("load [N]")["worn [m3]"].mean()
        row = found.table.set_index("term").loc["load"]
        self.assertAlmostEqual(row["effect"] / (worn[10.0] - worn[5.0]), 1.0, delta=1e-9)
        self.assertEqual((row["response"], row["unit"], found["worn"].fit.model), ("worn", "m3", "main"))
        self.assertAlmostEqual(found.summary.loc["worn", "mean"] / made.table["worn [m3]"].mean(), 1.0, delta=1e-9)
        self.assertIn("worn-main-effects", found.figures())
        # Messages are in the words of Python.
        with self.assertRaisesRegex(plateau.InputError, "give extrapolate=True"):
            plateau.study.predict("study.toml", {"load": "50 N"})

    def test_factors_and_seeds_are_coordinates_of_results_anywhere(self):
        seeds = '[replicates]\nkeys = ["disc.surface.synthetic.seed"]\nseeds = [11, 12]\n'
        pathlib.Path("seeds.toml").write_text(STUDY.replace("[[factor]]", seeds + "[[factor]]", 1))
        made = plateau.sweep("seeds.toml", jobs=2, progress=False, directory="there", keep_files=True)
        names = ["point", "replicate", "seed", "load", "wear"]
        with h5py.File("there/results.h5") as file:
            for name in ("contact_area", "worn", "state"):
                self.assertEqual(file[name].attrs["coordinates"].split(), names, name)
            self.assertEqual((file["load"].attrs["units"], file["wear"].attrs["units"]), ("N", "1/Pa"))
            self.assertEqual(file["seed"][:].tolist(), [11, 12] * 4)
            self.assertNotIn("coordinates", file["load"].attrs)
        worn = made.table.groupby("load [N]")["worn [m3]"].mean()
        with xarray.open_dataset("there/results.h5", engine="h5netcdf") as opened:
            for data in (opened, made.data, plateau.open_study("seeds.toml", directory="there").data):
                self.assertEqual(set(data.coords), {"run", "time", *names})
                by_load = data["worn"].groupby("load").mean()
                np.testing.assert_allclose(by_load.sel(load=[5.0, 10.0]), worn[[5.0, 10.0]], rtol=1e-12)
                self.assertEqual(data["contact_area"].set_xindex("seed").sel(seed=12)["run"].values.tolist(), [2, 4, 6, 8])
                self.assertEqual(set(data["contact_area"].groupby("wear").mean().dims), {"time", "wear"})
        # Answers, and the files of the runs, are there, too.
        plateau.command("sweep", "effects", "seeds.toml", directory="there")
        files = sorted(pathlib.Path("there/runs").iterdir())
        self.assertEqual([file.name[:9] for file in files], [f"run-{number:04}-" for number in range(1, 9)])
        third = plateau.open_run(files[2])
        np.testing.assert_array_equal(third["series/contact_area"], made.data["contact_area"].sel(run=3))
        self.assertIn("height", third["pin"])
        self.assertTrue(pathlib.Path("there/effects/effects.html").is_file())
        self.assertFalse(pathlib.Path("seeds").exists())

    def test_what_answers_is_imported_when_it_is_called(self):
        text = "import plateau, sys; print([name for name in ('scipy', 'matplotlib') if name in sys.modules]); plateau.study.effects"
        self.assertEqual(python(text), "[]\n")
        for name in plateau.study.__all__:
            self.assertTrue(hasattr(plateau.study, name), name)

    def test_the_table_has_the_units_of_the_study(self):
        study = STUDY.replace("operation.normal_force", "operation.rotational_speed").replace('"5 N", "10 N"', '"425 rpm", "850 rpm"')
        pathlib.Path("speeds.toml").write_text(study.replace('"4e-14 1/Pa"', '"4e-14 m^2/N"'))
        made = plateau.sweep("speeds.toml", progress=False)
        # Where the levels have several units, it is that of SI. Data has SI units.
        self.assertEqual(list(made.table)[4:6], ["load [rpm]", "wear [1/Pa]"])
        self.assertEqual(sorted(set(made.table["load [rpm]"])), [425, 850])
        np.testing.assert_allclose(made.data["load"], made.table["load [rpm]"] * 2 * np.pi / 60, rtol=1e-15)
        self.assertEqual(set(made.table["wear [1/Pa]"]), {2e-14, 4e-14})

    def test_words_of_a_study_are_words_whatever_they_look_like(self):
        words = ["nan", "inf", "1e3", "1000", "007", "-", "=1+1", "A"]
        pathlib.Path("words.toml").write_text(
            f'version = 1\ndesign = "full-factorial"\n[[factor]]\nname = "grade"\nlevels = {words}\n[[response]]\nname = "wear"\nimported = true\n'
        )
        pathlib.Path("words.csv").write_text("grade,wear\n" + "".join(f"{word},{at}\n" for at, word in enumerate(words)))
        plateau.command("sweep", "import", "words.toml", "words.csv")
        table, data = plateau.collect("words.toml")
        self.assertEqual((table["grade"].tolist(), data["grade"].values.tolist()), (words, words))
        self.assertEqual(table["wear"].tolist(), list(range(len(words))))

    def test_a_study_that_is_wrong(self):
        pathlib.Path("bad.toml").write_text(STUDY.replace("5 N", "5 kg"))
        with self.assertRaisesRegex(plateau.InputError, "(?s)bad.toml.*5 kg"):
            plateau.sweep("bad.toml")
        pathlib.Path("text.toml").write_text("no table")
        with self.assertRaisesRegex(plateau.InputError, "text.toml: cannot be read as a study"):
            plateau.open_study("text.toml")
        pathlib.Path("damaged").mkdir()
        pathlib.Path("damaged/results.csv").write_text("run,state\n1,finished\n")
        pathlib.Path("damaged/results.h5").write_text("no HDF5")
        with self.assertRaisesRegex(plateau.InputError, "damaged: the results cannot be read"):
            plateau.open_study("damaged")
