"""Words that the package answers for the program: options, text, JSON, files, exit statuses."""

import contextlib
import csv
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import time
import tomllib
import unittest
import unittest.mock

from checkout import QUICK, ROOT, Folder, program, word

from plateau import command_line, output_folder, progress, style
from plateau.command_line import shown
from plateau.errors import InputError, RunFailed, in_python
from plateau.output_folder import HEAD, LIST, all_or_none, put, write
from plateau.study import analysis, likelihood, variance_parts, words

# Paths of members of the documents of the program before its statistics were in Python (revision 342d63de).
BEFORE = json.loads((ROOT / "tests" / "python" / "expected" / "words.json").read_text())
# Members that are gone with what they told: powers of desirabilities, and the choice of terms by AICc.
GONE = {"optimize": {"goals[].weight"}, "effects": {"responses[].aicc", "responses[].terms_left_out"}}

MEASURED = """
version = 1
title = "Seal and oil"
design = "central-composite"
alpha = "face"
centre_points = 3
[[factor]]
name = "load"
range = ["1 N", "3 N"]
[[factor]]
name = "dose"
range = [0.0, 1.0]
[[response]]
name = "leak"
imported = true
unit = "mm3"
measured = "2.2 mm3"
uncertainty = "0.1 mm3"
[[response]]
name = "grip"
imported = true
measured = 0.6
uncertainty = 0.05
"""
RUNS = """
version = 1
base = "{base}"
set = ["operation.duration = '0.3 s'", "output.sample_every = '0.1 s'", "mesh.rows = 10"]
design = "full-factorial"
replicates = {{ keys = ["disc.surface.synthetic.seed"], seeds = [1, 2] }}
[[factor]]
name = "load"
key = "operation.normal_force"
levels = ["5 N", "10 N"]
[[response]]
name = "worn"
dataset = "/series/worn_whole_pin"
at = "end"
"""


def paths(value, at=""):
    """Paths of all members of a document."""
    if isinstance(value, dict):
        return {path for name, one in value.items() for path in {f"{at}.{name}".lstrip(".")} | paths(one, f"{at}.{name}".lstrip("."))}
    return {path for one in value for path in paths(one, f"{at}[]")} if isinstance(value, list) else set()


class Words(Folder):
    def setUp(self):
        super().setUp()
        os.environ["PLATEAU_CALLED"] = "plateau"
        # Most calls draw one format alone, profiles of few places and few functions that may be true, which is quicker.
        self.patch(style, "FORMATS", {"svg": style.FORMATS["svg"]})
        self.patch(likelihood, "PLACES", 5)
        self.patch(likelihood, "AROUND", 3)
        self.patch(variance_parts, "FUNCTIONS", 10)

    def patch(self, module, name, value):
        patch = unittest.mock.patch.object(module, name, value)
        patch.start()
        self.addCleanup(patch.stop)

    def draw_nothing(self):
        """For what is no matter of figures, which take half of the time."""
        self.patch(analysis, "DRAWINGS", {})
        self.patch(words, "saved", lambda figures, progress: {})

    def call(self, *words, status=0):
        """What is printed and said."""
        found, out, err = word(*words)
        self.assertEqual(found, status, err)
        return out, err

    def document(self, *words):
        return json.loads(self.call(*words, "--json", "-q")[0])

    def refused(self, *words, said):
        out, err = self.call(*words, status=2)
        self.assertEqual(out, "")
        self.assertRegex(err, rf"^plateau: .*{said}")
        self.assertEqual(err.count("\n"), 1, err)

    def import_all(self, text=MEASURED, table="measured.csv", names=("load", "grip")):
        pathlib.Path("study.toml").write_text(text)
        program("sweep", "plan", "study.toml", "--csv", "plan.csv", "-q")
        with open("plan.csv", newline="") as file, open(table, "w", newline="") as to:
            lines = csv.writer(to)
            lines.writerow([names[0], "dose", "leak [mm3]", names[1]])
            for at, row in enumerate(csv.DictReader(file)):
                load, dose = float(row[names[0]].split()[0]), float(row["dose"])
                noise = 0.05 * (-1) ** at * (1 + at % 3)
                lines.writerow(
                    [row[names[0]], row["dose"], 1 + load - dose + 0.3 * load * dose + 0.4 * dose**2 + noise, 0.5 + 0.2 * dose + 0.2 * noise]
                )
        return self.call("sweep", "import", "study.toml", table)[0]

    def test_names_of_columns_of_tables_are_names_of_factors_and_responses(self):
        self.draw_nothing()
        text = MEASURED.replace('name = "load"', 'name = "state"').replace('name = "grip"', 'name = "order"')
        self.import_all(text, names=("state", "order"))
        document = self.document("sweep", "effects", "study.toml")
        self.assertEqual([term["label"] for term in document["responses"][1]["terms"]][:2], ["state (factor)", "dose"])
        self.assertEqual([response["name"] for response in document["responses"]], ["leak", "order (response)"])
        [place] = self.document("sweep", "predict", "study.toml", "--at", "state=2 N", "--at", "dose=1")["places"]
        self.assertEqual([setting["number"] for setting in place["settings"]], [2.0, 1.0])

    def test_what_would_take_forever_is_refused_at_once(self):
        self.import_all()
        self.refused("sweep", "predict", "study.toml", "--grid", "99999999999999999999", said="more than 1000000 places")
        self.refused("sweep", "predict", "study.toml", "--at", "load=6 kg", said='--at: load = 6 kg: "kg" measures something else')
        os.mkdir("out")
        os.mkfifo("out/files.txt")
        self.refused("sweep", "sensitivity", "study.toml", "-o", "out", said="out/files.txt is not a regular file")

    def test_where_there_are_no_results_commands_of_the_program_are_named(self):
        self.refused("sweep", "effects", ".", said="results.csv: there is no such file; plateau sweep collect makes it")

    def test_programs_that_are_another_one_are_named(self):
        pathlib.Path("study.toml").write_text(MEASURED)
        with unittest.mock.patch.dict(os.environ, {"PLATEAU_PROGRAM": "/bin/echo"}):
            _, err = self.call("sweep", "effects", "study.toml", status=1)
        self.assertRegex(err, "^plateau: /bin/echo printed no JSON .*\\n$")

    def test_signals_end_runs_and_what_made_them(self):
        scene = QUICK.read_text()
        for name in ("one.toml", "two.toml"):
            pathlib.Path(name).write_text(scene)
        words = ["compare", "one.toml", "two.toml", "--seeds", "1", "--set", "operation.duration='10000 s'", "-q"]
        called = subprocess.Popen(
            [sys.executable, "-m", "plateau.command_line", *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True
        )
        try:
            until = time.monotonic() + 60
            while not any(pathlib.Path("comparison").glob("*/under-way/*")) and time.monotonic() < until:
                time.sleep(0.05)
            called.terminate()
            # The end of the pipe: nobody is left who could write into it.
            _, said = called.communicate(timeout=60)
            self.assertEqual((called.returncode, said), (128 + signal.SIGTERM, b""))
            with self.assertRaises(ProcessLookupError):
                os.killpg(called.pid, 0)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(called.pid, signal.SIGKILL)

    def is_as_before(self, word, document):
        self.assertEqual(set(BEFORE[word]) - paths(document) - GONE.get(word, set()), set(), word)
        files = {"csv", "html", "png", "svg", "pdf"}
        for file in document.get("files", []):
            self.assertTrue(pathlib.Path(file).is_file() and pathlib.Path(file).suffix[1:] in files, file)

    def test_measured_values(self):
        self.assertEqual(
            self.import_all().splitlines()[1:4],
            ["  read      11 lines with leak, grip", "  values    22 new, 0 changed", "  complete  11 of 11 runs"],
        )
        self.is_as_before("import", self.document("sweep", "import", "study.toml", "measured.csv"))
        for answer in ("effects", "predict", "sensitivity"):
            self.is_as_before(answer, self.document("sweep", answer, "study.toml"))
        with unittest.mock.patch.object(style, "FORMATS", {**style.FORMATS, "png": {}, "pdf": {}}):
            self.is_as_before("optimize", self.document("sweep", "optimize", "study.toml", "--minimize", "leak", "--limit", "grip>=0.55"))
        self.is_as_before("fit", self.document("fit", "study.toml"))
        self.is_as_before("fit --plan", self.document("fit", "study.toml", "--plan"))
        with open("study/effects/effects.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0])[:18], BEFORE["effects.csv"])
        page = pathlib.Path("study/effects/effects.html").read_text()
        kinds = {"leak-pareto", "leak-main-effects", "leak-interactions", "leak-residuals", "leak-surface", "grip-pareto"}
        names = {path.stem for path in pathlib.Path("study/effects").glob("*.svg")}
        self.assertTrue(kinds <= names, names)
        self.assertEqual(page.count("<svg"), len(names))
        self.assertNotIn("<script", page)
        for folder, file in (("optimum", "profiler.pdf"), ("optimum", "contour.png"), ("sensitivity", "leak-indices.svg"), ("fit", "profiles.svg")):
            self.assertTrue(pathlib.Path("study", folder, file).is_file(), file)
        # Text has the same folders; those of an earlier call are replaced with --force alone.
        self.refused("sweep", "effects", "study.toml", said="study/effects has the files of an earlier call; give --force")
        text, _ = self.call("sweep", "effects", "study.toml", "--model", "main", "--force", "-q")
        self.assertRegex(text, r"(?s)^leak\n  model: main effects.*\n\nSeal and oil\n  written  study/effects/effects.csv\n")
        self.assertFalse(pathlib.Path("study/effects/leak-interactions.svg").exists())
        self.refused("sweep", "sensitivity", "study.toml", "-o", "study/fit", said="has the files of an earlier call")

    def test_results_in_another_folder(self):
        self.draw_nothing()
        self.import_all()
        pathlib.Path("study").rename("there")
        settings = {"optimize": ["--minimize", "leak"], "predict": ["--at", "load=2 N", "--at", "dose=0.5"], "import": ["measured.csv"]}
        for answer in ("effects", "sensitivity", "optimize", "predict", "import"):
            self.call("sweep", answer, "study.toml", *settings.get(answer, []), "--directory", "there", "-q")
        self.call("fit", "study.toml", "--directory", "there", "-q")
        self.document("fit", "study.toml", "--directory", "there", "--plan")
        self.assertFalse(pathlib.Path("study").exists())
        self.assertLessEqual({"effects", "sensitivity", "optimum", "fit", "imported.csv"}, {path.name for path in pathlib.Path("there").iterdir()})

    def test_predictions_and_optima(self):
        self.draw_nothing()
        self.import_all()
        self.call("sweep", "predict", "study.toml", "--grid", 3, "-o", "grid.csv", "-q")
        with open("grid.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual((len(rows), list(rows[0])[:4]), (9, ["load [N]", "dose", "leak [m3]", "leak mean low [m3]"]))
        self.refused("sweep", "predict", "study.toml", "-o", "grid.csv", said="grid.csv exists; give --force to replace it, or write elsewhere")
        self.refused("sweep", "predict", "study.toml", "-o", "study.toml", "--force", said="study.toml is an input and is not replaced")
        self.refused("sweep", "predict", "study.toml", "--at", "load=9 N", said="give --extrapolate to see")
        self.assertIn("load = 9 N", self.call("sweep", "predict", "study.toml", "--at", "load=9 N", "--extrapolate", "-q")[0])
        # A wrong goal is said before a folder that is in the way.
        pathlib.Path("taken").mkdir()
        pathlib.Path("taken/optimum.csv").touch()
        self.refused("sweep", "optimize", "study.toml", "--minimize", "leek", "-o", "taken", said="there is none of this name")
        self.refused("sweep", "optimize", "study.toml", "--minimize", "leak", "-o", "taken", said="taken")
        out, err = self.call("sweep", "optimize", "study.toml", "--minimize", "leak", "--limit", "grip>=5", "-q", status=1)
        self.assertIn("missed", out)
        self.assertEqual(err, "plateau: no settings within the ranges keep all limits\n")
        contour = ("--minimize", "leak", "--contour", "load,oil", "--force")
        self.refused("sweep", "optimize", "study.toml", *contour, said="--contour load,oil: expected two different factors")

    def test_wrong_words(self):
        for wrong, said in (
            (["sweep", "effects"], "STUDY; plateau sweep effects --help tells more"),
            (["sweep", "effects", "no.toml"], "no.toml"),
            (["sweep", "effects", "no.toml", "--model", "cubic"], "invalid choice: 'cubic'"),
            (["sweep", "effects", "no.toml", "--confidence", "95"], "expected more than 0 and less than 1"),
            (["sweep", "effects", "no.toml", "--conf", "0.9"], "unrecognized arguments: --conf 0.9; plateau sweep effects --help tells more"),
            (["sweep", "predict", "no.toml", "--grid", "0"], "expected a whole number of at least 1"),
            (["compare", str(QUICK)], "two scenes or more"),
            (["sweep", "tell"], "invalid choice: 'tell'"),
        ):
            with self.subTest(wrong):
                self.refused(*wrong, said=said)
        pathlib.Path("study.toml").write_text(MEASURED)
        _out, err = self.call("sweep", "effects", "study.toml", status=1)
        self.assertRegex(err, "^plateau: study.toml: there is no result to analyse yet; plateau sweep import")

    def test_names_do_nothing_to_terminals_pages_and_spreadsheets(self):
        name = "=<b>leak</b>"
        text = MEASURED.replace('"leak"', f'"{name}"').replace("Seal and oil", "Seal & <i>oil</i>")
        self.import_all(text.replace(name, "leak"))
        pathlib.Path("study.toml").write_text(text)
        kept = pathlib.Path("study/imported.csv")
        kept.write_text(kept.read_text().replace("leak [m3]", f"{name} [m3]"))
        self.call("sweep", "effects", "study.toml", "-q")
        page = pathlib.Path("study/effects/effects.html").read_text()
        self.assertIn("Seal &amp; &lt;i&gt;oil&lt;/i&gt;", page)
        self.assertIn("&lt;b&gt;leak", page)
        self.assertFalse({"<b>", "<i>"} & set(re.findall("<.*?>", page)))
        self.assertIn(f"\n'{name},", pathlib.Path("study/effects/effects.csv").read_text())
        self.assertEqual(shown("a\tb\n\x07\x1b[31m\u202e"), "a\tb\n\\u{7}\\u{1b}[31m\\u{202e}")

    def test_real_runs(self):
        pathlib.Path("study.toml").write_text(RUNS.format(base=QUICK))
        program("sweep", "run", "study.toml", "-q")
        document = self.document("sweep", "effects", "study.toml")
        self.assertEqual([term["label"] for term in document["responses"][0]["terms"]], ["replicate", "load"])
        _, err = self.call("sweep", "predict", "study.toml", "--at", "load=7 N")
        self.assertRegex(err, "^plateau: warning: no curve of load: the runs have two values of it")
        with unittest.mock.patch.object(progress, "shower", wraps=progress.shower) as shower:
            [place] = self.document("sweep", "predict", "study.toml", "--at", "load=7 N", "--confirm")["places"]
        # Quiet, also in a terminal.
        self.assertEqual({call.args for call in shower.call_args_list}, {(False,)})
        self.assertEqual(place["confirmed"][0]["runs"], 2)
        # Another scene, and the same from the program, with the packages of this Python.
        pathlib.Path("fast.toml").write_text(f'version = 1\nextends = "{QUICK}"\n[operation]\nrotational_speed = "1200 rpm"\n')
        changes = [part for key in ("operation.duration = '0.3 s'", "mesh.rows = 10") for part in ("--set", key)]
        words = ["compare", str(QUICK), "fast.toml", "--seeds", "2", *changes, "--response", "worn_whole_pin:end"]
        document = self.document(*words)
        self.assertEqual([row["scene"] for row in document["differences"]], ["fast"])
        self.assertEqual({pathlib.Path(file).name for file in document["files"] if not file.endswith(("svg", "png", "pdf"))},
                         {"comparison.html", "comparison.csv", "means.csv", "runs.csv", "curves.csv"})  # fmt: skip
        command = [sys.executable, "-m", "plateau.command_line", *words, "--json", "-q"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        self.assertEqual((done.stderr, done.returncode), ("", 0))
        again = json.loads(done.stdout)
        self.assertEqual((again.pop("files")[:3], again), (document.pop("files")[:3], document))
        # What was asked for before does not go unasked; its runs are there.
        *same, _ = words
        self.refused(*same, "emitted:end", said="comparison has the files of another call, of compare .*worn_whole_pin:end; give --force")
        self.assertTrue(pathlib.Path("comparison/worn_whole_pin.png").is_file())
        self.document(*same, "emitted:end", "--force")
        self.assertFalse(pathlib.Path("comparison/worn_whole_pin.png").is_file())

    def test_what_is_not_installed_is_said_in_one_line(self):
        for name in ("numpy", "pandas"):
            pathlib.Path(f"{name}.py").write_text(f"raise ModuleNotFoundError('No module', name='{name}')")
            environment = os.environ | {"PYTHONPATH": f"{os.getcwd()}{os.pathsep}{ROOT / 'python'}"}
            words = [sys.executable, "-m", "plateau.command_line", "sweep", "effects", "s.toml"]
            done = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=60)
            said = f"plateau: {name} is not installed: pip install 'plateau-brake[all]'\n"
            self.assertEqual((done.stderr, done.returncode), (said, 1))
            pathlib.Path(f"{name}.py").unlink()

    def test_a_signal_where_an_object_is_destroyed_ends_the_word(self):
        class Destroyed:
            def __del__(self):
                os.kill(os.getpid(), signal.SIGINT)

        def answer(_):
            Destroyed()
            return "answer"

        # Of tests in the background, signals of the keyboard are ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        with unittest.mock.patch.object(words, "_import", answer), unittest.mock.patch.object(sys, "unraisablehook", lambda _: None):
            self.assertEqual(self.call("sweep", "import", "s.toml", "t.csv", status=128 + signal.SIGINT), ("", ""))

    def test_examples_name_what_there_is(self):
        examples, word = [], command_line.Words.word

        def read(self, name, about, answer, example=""):
            examples.append(example)
            return word(self, name, about, answer, example)

        parser = command_line.Parser(prog="plateau")
        with unittest.mock.patch.object(command_line.Words, "word", read):
            words.add(command_line.Words(parser.add_subparsers(), "plateau"))
        self.assertEqual(len(examples), 7)
        for example in examples:
            given = parser.parse_args(shlex.split(example)[1:])
            named = getattr(given, "scenes", [given.study] if "study" in given and "table" not in given else [])
            for path in named:
                document = tomllib.loads((ROOT / path).read_text())
            factors, responses = ({one["name"] for one in document.get(kind, [])} for kind in ("factor", "response"))
            self.assertLessEqual({text.split("=")[0] for text in getattr(given, "at", [])}, factors)
            self.assertLessEqual(set(getattr(given, "minimize", [])), responses)

    def test_messages_in_python(self):
        for said, here in (
            ("give --extrapolate to see", "give extrapolate=True to see"),
            ("--limit-on runs keeps a margin", 'limit_on="runs" keeps a margin'),
            ("`plateau sweep effects` tells", "`plateau.study.effects` tells"),
            ("plateau sweep import a.toml TABLE.csv brings them", "plateau.study.import_values a.toml TABLE.csv brings them"),
        ):
            self.assertEqual(in_python(said), here)
            self.assertEqual(in_python(here), here)


class Folders(Folder):
    def write(self, folder, names, *, force=False, inputs=(), of=None):
        return write(folder, {name: name.encode() for name in names}, of=of, force=force, inputs=inputs)

    def names(self, folder):
        return sorted(path.name for path in folder.iterdir())

    def test_files_of_an_earlier_call_are_replaced_and_removed_with_force_only(self):
        folder = self.folder / "effects"
        self.write(folder, ["a.png", "b.png"])
        (folder / "mine.txt").write_text("mine")
        with self.assertRaisesRegex(InputError, "replace them, or name another folder"):
            self.write(folder, ["b.png", "c.png"])
        self.assertEqual(self.names(folder), ["a.png", "b.png", LIST, "mine.txt"])
        self.write(folder, ["b.png", "c.png"], force=True)
        self.assertEqual(self.names(folder), ["b.png", "c.png", LIST, "mine.txt"])

    def test_what_goes_on_replaces_its_own_files_and_no_others(self):
        folder = self.folder / "fit"
        self.write(folder, ["a.png", "b.png"], of="fit ../s.toml")
        self.assertIn("\n# of fit ../s.toml\n", (folder / LIST).read_text())
        self.write(folder, ["b.png"], of="fit ../s.toml")
        self.assertEqual(self.names(folder), ["b.png", LIST])
        # Of another study, of somebody else, and what is no file any more.
        with self.assertRaisesRegex(InputError, "has the files of another call, of fit ../s.toml"):
            self.write(folder, ["b.png"], of="fit ../t.toml")
        (folder / "c.png").write_text("mine")
        with self.assertRaisesRegex(InputError, "c.png exists"):
            self.write(folder, ["b.png", "c.png"], of="fit ../s.toml")
        (folder / "b.png").unlink()
        (folder / "b.png").symlink_to("c.png")
        with self.assertRaisesRegex(InputError, "b.png exists"):
            self.write(folder, ["b.png"], of="fit ../s.toml")
        self.write(folder, ["b.png"], of="fit ../s.toml", force=True)
        self.assertEqual((folder / "c.png").read_text(), "mine")
        self.assertFalse((folder / "b.png").is_symlink())

    def test_the_list_of_a_full_disk_names_what_is_there(self):
        folder, real = self.folder / "effects", output_folder.put
        self.write(folder, ["old.png"])

        def put(path, content):
            if path.name == "b.png":
                raise RunFailed("cannot write b.png: No space left on device")
            real(path, content)

        with unittest.mock.patch.object(output_folder, "put", put), self.assertRaisesRegex(RunFailed, "No space left"):
            self.write(folder, ["a.png", "b.png", "c.png"], force=True)
        self.assertEqual(self.names(folder), ["a.png", LIST])
        self.assertEqual((folder / LIST).read_text().splitlines()[1:], ["a.png"])

    def test_files_that_are_replaced_keep_their_permissions(self):
        for name in ("put", "together"):
            (self.folder / name).write_text("before")
            (self.folder / name).chmod(0o640)
        put(self.folder / "put", b"after")
        all_or_none(self.folder, {"together": lambda place: place.write_text("after")}, True)
        for name in ("put", "together"):
            self.assertEqual(((self.folder / name).stat().st_mode & 0o777, (self.folder / name).read_text()), (0o640, "after"), name)

    def test_a_link_to_nothing_is_said(self):
        (self.folder / "link").symlink_to("nowhere")
        with self.assertRaisesRegex(InputError, "link is a link to nowhere, which is not there; make that, or name"):
            self.write(self.folder / "link", ["a.png"])

    def test_a_file_of_someone_else_and_an_input_stay(self):
        own = self.folder / "effects.csv"
        own.write_text("mine")
        with self.assertRaisesRegex(InputError, "exists"):
            self.write(self.folder, ["effects.csv"])
        with self.assertRaisesRegex(InputError, "is an input"):
            self.write(self.folder, ["effects.csv"], force=True, inputs=(own,))
        self.assertEqual(self.names(self.folder), ["effects.csv"])
        # A list that was edited does not reach beyond the folder, and does not take away an input.
        folder = self.folder / "in"
        folder.mkdir()
        (folder / LIST).write_text(f"{HEAD}\n../effects.csv\npoints.csv\n")
        (folder / "points.csv").write_text("points")
        self.write(folder, ["a.png"], force=True, inputs=(folder / "points.csv",))
        self.assertEqual(self.names(folder), ["a.png", LIST, "points.csv"])
        self.assertEqual(own.read_text(), "mine")
        with self.assertRaisesRegex(InputError, "cannot make the folder"):
            self.write(own, ["a.png"])
