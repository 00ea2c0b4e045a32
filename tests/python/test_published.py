"""The study of published findings (data/studies/published): its page has the numbers of results.json, and those are of its study files."""

import math
import subprocess
import sys
import tomllib
import unittest
from pathlib import Path
from unittest import mock

STUDY = Path(__file__).parents[2] / "data/studies/published"
sys.path.insert(0, str(STUDY))
import page  # noqa: E402, where the study is


class Page(unittest.TestCase):
    def test_the_page_has_the_numbers_of_the_study(self) -> None:
        check = subprocess.run([sys.executable, "-B", str(STUDY / "page.py"), "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    def test_the_page_of_a_drive_has_what_load_does_to_friction(self) -> None:
        drive = (STUDY.parents[2] / "docs/drive.md").read_text()
        self.assertIn(f"{page.change('factors/effects/coefficient of friction/load')} from 1 to 2 MPa nominal", drive)
        factors = {factor["name"]: factor["levels"] for factor in tomllib.loads((STUDY / "factors.toml").read_text())["factor"]}
        # The pin of pair.toml has 1 mm by 2 mm.
        self.assertEqual(factors["load"], ["2 N", "4 N"])

    def test_results_are_of_the_studies_as_they_stand(self) -> None:
        for rule in ("plain", "strength"):
            for name, points in (("skewness", 6), ("factors", 16)):
                study, found = tomllib.loads((STUDY / f"{name}.toml").read_text()), page.RESULTS[rule][name]
                seeds = len(study["replicates"]["seeds"])
                self.assertEqual((found["seeds"], found["runs"]), (seeds, seeds * points))
                asked = [response["name"] for response in study["response"]]
                self.assertEqual(list(found["effects" if name == "factors" else "means"]), asked)
                if name == "factors":
                    self.assertEqual(list(found["effects"]["PM10"]), [factor["name"] for factor in study["factor"]])

    def test_differences_are_shown_and_judged(self) -> None:
        # ln 2 is twice: +100 %; its interval reaches from 1.5 to 2.5 times.
        effects = {"PM10": {"load": [math.log(2.0), math.log(1.5), math.log(2.5)]}}
        effects["filled"] = {"load": [-0.05, -0.0625, -0.0375], "fibres": [0.01, -0.01, 0.03]}
        rules = {"plain": {"factors": {"effects": effects}}}
        with mock.patch.object(page, "RESULTS", rules):
            self.assertEqual(page.change("factors/effects/PM10/load"), "+100.0 ± 50.0")
            self.assertEqual(page.change("factors/effects/filled/load"), "−5.0 ± 1.2")
            said = {sign: page.judged(sign, "factors/effects/filled/load", "plain") for sign in "+-?"}
            shown = "−5.0 ± 1.2 points"
            self.assertEqual(said, {"+": f"{shown}, **does not agree**", "-": f"{shown}, agrees", "?": shown})
            self.assertEqual(page.judged("+", "factors/effects/filled/fibres", "plain"), "+1.0 ± 2.0 points, not resolved")

    def test_signs_that_a_strength_changes_are_named(self) -> None:
        def rule(load: float) -> dict[str, object]:
            one = [load, load - 0.1, load + 0.1]
            effects = {response: {"load": one if response == "filled" else [0.0, -1.0, 1.0]} for response in page.SHOWN}
            return {"factors": {"effects": effects}, "skewness": {"differences": {key: {"1 less -1": [0.5, 0.1, 0.9]} for key in page.SHOWN}}}

        with mock.patch.object(page, "RESULTS", {"plain": rule(1.0), "strength": rule(-1.0)}):
            self.assertEqual(page.changed(), "1 of 10: load (filled)")
