"""What tests have in common: the checkout, the program that they are told, folders of their own, and calls."""

import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# As of a checkout that is not installed, in processes that tests begin, too; the program is the one that the tests are told.
sys.path[:0] = [str(ROOT / folder) for folder in ("python", "tests/python/coverage")]
os.environ["PYTHONPATH"] = str(ROOT / "python")
PROGRAM = os.environ.setdefault("PLATEAU_PROGRAM", str(ROOT / "plateau"))
os.environ["MPLBACKEND"] = "agg"
QUICK = ROOT / "data" / "scenes" / "quick.toml"
# Measured surfaces that are handed to developers and not part of the repository.
_NAMED = [pathlib.Path(os.environ["PLATEAU_SHARED"])] if "PLATEAU_SHARED" in os.environ else [above / "shared" for above in ROOT.parents]
SHARED = next((folder / "surfaces" for folder in _NAMED if (folder / "surfaces").is_dir()), None)


class Folder(unittest.TestCase):
    """Tests, each in an empty folder of its own."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.enterContext(contextlib.chdir(self.folder))


def changed(*changes):
    """Arguments of the program that change keys of a scene, such as ``"mesh.rows=10"``."""
    return [argument for change in changes for argument in ("--set", change)]


def called(*arguments, **options):
    """A call of the program that has ended, and what it said."""
    return subprocess.run([PROGRAM, *map(str, arguments)], **{"capture_output": True, "text": True, "timeout": 600, **options})


def program(*arguments, **options):
    """What the program prints in a call that ends well."""
    done = called(*arguments, **options)
    if done.returncode:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout


def python(text, **options):
    """What a Python of its own prints that ends well and says nothing."""
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=600, **options)
    if done.returncode or done.stderr:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout


def word(*arguments):
    """Exit status of a word that the package answers, what it prints and what it says."""
    from plateau import command_line

    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = command_line.main([str(argument) for argument in arguments])
    return status, out.getvalue(), err.getvalue()
