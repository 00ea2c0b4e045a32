"""Scenes and a study for the tests of the Python package, small enough for the program without optimisations."""

import contextlib
import pathlib
import tempfile
import unittest

from checkout import QUICK

SHORT = {"operation.duration": "20 s", "output.maps_at": ["0 s", "10 s"]}
# A fifth of a second for a pulse of the contact area, in place of 25 s.
PULSES = {"materials.pin_resin.wear_height": "0.04 um"}
ROUND = {**SHORT, "mesh": {"shape": "disc", "pin_width": "1 mm", "cell_size": "50 um", "mean_radius": "20.5 mm"}}
# Maps of a run file by their names in scenes.
MAPS = {
    "disc_height": "disc/height",
    "disc_substrate": "disc/substrate",
    "disc_status": "disc/status",
    "pin_height": "pin/height",
    "pin_substrate": "pin/substrate",
    "pin_status": "pin/status",
    "pressure": "pin/pressure",
}
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
        folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        cls.enterClassContext(contextlib.chdir(folder))
        pathlib.Path("quick.toml").symlink_to(QUICK)
