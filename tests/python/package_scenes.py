"""Scenes and a study for the tests of the Python package, small enough for the program without optimisations."""

import os
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# As of a checkout that is not installed; the program is the one that the tests are told.
sys.path.insert(0, str(ROOT / "python"))
os.environ.setdefault("PLATEAU_PROGRAM", str(ROOT / "plateau"))
os.environ["MPLBACKEND"] = "agg"

QUICK = ROOT / "data" / "scenes" / "quick.toml"
SHORT = {"operation.duration": "20 s", "output.maps_at": ["0 s", "10 s"]}
# A fifth of a second for a pulse of the contact area, in place of 25 s.
PULSES = {"materials.pin_resin.wear_height": "0.04 um"}
ROUND = {**SHORT, "mesh": {"shape": "disc", "pin_width": "1 mm", "cell_size": "50 um", "mean_radius": "20.5 mm"}}
STUDY = f"""
version = 1
base = "{QUICK}"
set = ["operation.duration = '5 s'"]
design = "full-factorial"
[[factor]]
name = "load"
key = "operation.normal_force"
levels = ["5 N", "10 N"]
[[factor]]
name = "wear"
key = "materials.pin_primary.specific_wear_rate"
levels = ["2e-14 1/Pa", "4e-14 1/Pa"]
[[response]]
name = "worn"
dataset = "/series/worn_pin"
at = "end"
"""


class InFolder(unittest.TestCase):
    """Tests in a folder of their own, with quick.toml in it."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.addClassCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        pathlib.Path("quick.toml").symlink_to(QUICK)
