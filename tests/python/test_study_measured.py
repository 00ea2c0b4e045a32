"""What people measured: text tables of any program, quantities with units, values of responses from elsewhere, series."""

import tomllib
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from checkout import Folder

from plateau.errors import InputError, MissingFileError
from plateau.study.data import Response
from plateau.study.imports import import_values
from plateau.study.measured import measurements
from plateau.study.prediction import _rows
from plateau.study.results import analysed
from plateau.text_tables import read_text_table, written_table
from plateau.units import quantity

STUDY = """
version = 1
title = "Rig"
design = "full-factorial"
[[factor]]
name = "humidity"
levels = [{levels}]
[[factor]]
name = "batch"
levels = ["A", "=B"]
[[response]]
name = "wear"
imported = true
unit = "m3"
[[response]]
name = "friction"
imported = true
"""


class InFolder(Folder):
    def file(self, content, name="t.csv"):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def refused(self, words, function, *arguments, **options):
        with self.assertRaises(InputError) as raised:
            function(*arguments, **options)
        self.assertIn(words, str(raised.exception).replace(str(self.folder), "."))


class TextTableTest(InFolder):
    def test_every_dialect_and_encoding_gives_the_same_table(self):
        text = "# rig 2\nload [µN],worn\n7.5 N,-1.25e-3\n# no\n,dry\n\n# end\n"
        semicolons = "sep=;\r\nload [µN];worn\r\n7,5 N;-1,25e-3\r\n;dry\r\n"
        for content in (
            text.encode(),
            text.encode("utf-8-sig"),
            text.encode("utf-16"),
            text.encode("utf-16-le"),
            text.encode("utf-16-be"),
            text.encode("cp1252"),
            text.replace("\n", "\r").encode(),
            text.replace("\n", "\r\n").encode(),
            semicolons.encode(),
            b"load [\xb5N];worn;\n7.5 N;-1.25e-3;\n;dry;\n",
            '"load [µN]"\t"worn"\r"7,5 N"\t"-1,25e-3"\r\tdry\r'.encode(),
        ):
            with self.subTest(content=content):
                table = read_text_table(self.file(content))
                self.assertEqual((table.heads, table.rows), (["load [µN]", "worn"], [["7.5 N", "-1.25e-3"], ["", "dry"]]))
                self.assertEqual(table.named(0), ("load", "µN"))

    def test_what_is_wrong_is_refused_with_its_place(self):
        for text, words in (
            ("time [s];force [N]\n0;10,5\n3; 1.200\n", '/t.csv:3: "1.200" in line 3 and "10,5" in line 2: a decimal point'),
            ("a,b\n1,2\n\n3,4\n", "/t.csv:4: another table begins here"),
            ("a,b\n1,2\n\n# more\nc,d\n3,4\n", "/t.csv:5: another table begins here"),
            ("a,b\n1,2\na,b\n3,4\n", "/t.csv:3: another table begins here"),
            ('a,b\n1,"2\n3",4\n', "/t.csv:2: a quotation mark opens a cell"),
            ('a,b\n"1" 2,3\n', "/t.csv:2: a quotation mark opens a cell"),
            ("a,a\n1,2\n", 'column "a" is there twice'),
            ("a,b\n", "no points"),
            ("a,b\n1\n", "/t.csv:2: 1 cells, expected 2"),
            ("a,b\n5 N\x07,1\n", r"/t.csv:2: '5 N\x07' has a character that is no text"),
            (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0\0", "this is a workbook or an archive, expected text: save its sheet as CSV"),
            (b"PK\x03\x04", "this is a workbook or an archive, expected text: save its sheet as CSV"),
            (b"\x89HDF\r\n\x1a\n\0\0", "this is no text"),
        ):
            with self.subTest(text):
                self.refused(words, read_text_table, self.file(text))
        with self.assertRaises(MissingFileError):
            read_text_table(self.folder / "none.csv")
        self.refused("/dev/zero: this is a device", read_text_table, Path("/dev/zero"))

    def test_cells_that_spreadsheets_compute_come_back_as_they_were(self):
        cells = ["=1+1", "+A1", "@x", "-x", "'=1", "'word", 'a "b"', "x,y", "-5 mm", "1e-3"]
        written = written_table([["name"], *([cell] for cell in cells)])
        self.assertIn(b"'=1+1\n", written)
        self.assertIn(b"\n-5 mm\n", written)
        self.assertEqual([row[0] for row in read_text_table(self.file(written)).rows], cells)


class QuantityTest(unittest.TestCase):
    def test_units_by_their_definitions(self):
        for said, si, expected in (
            ("1.3 mm^2", "m2", 1.3e-6),
            ("1.3 mm²", "m2", 1.3e-6),
            ("0.2 um2", "m2", 0.2e-12),
            ("1.3 mm3", "m3", 1.3e-9),
            ("72 km/h", "m s-1", 20.0),
            ("60 rpm", "rad s-1", 2.0 * np.pi),
            ("5e-14 mm^3/(N m)", "Pa-1", 5e-23),
            ("5e-14 mm3/Nm", "1/Pa", 5e-23),
            ("2 min", "s", 120.0),
            ("23 degC", "K", 296.15),
            ("15 %", "1", 0.15),
            ("\N{MINUS SIGN}2.5%", "1", -0.025),
            (3, "m", 3.0),
        ):
            self.assertEqual(quantity(said, si), expected, said)
        self.assertEqual(quantity("5 degC", "K", is_difference=True), 5.0)
        self.assertEqual(quantity("1e-999999999 mm", "m"), 0.0)

    def test_what_is_none_is_refused(self):
        for said, si in (
            ("5", "m"),
            ("x %", "1"),
            ("1e400 m", "m"),
            ("1 kg", "m"),
            ("5 parsec", "m"),
            (True, "m"),
            (float("nan"), "m"),
            ("0.15", "1"),
            ("14 Hz", "rad s-1"),
            ("1 m999999999", "m"),
            ("1 m((((km/m)9)9)9)9", "m"),
        ):
            with self.subTest(said), self.assertRaises(InputError):
                quantity(said, si)


class ImportTest(InFolder):
    def study(self, levels='"20 %RH", "80 %RH"'):
        return self.file(STUDY.format(levels=levels), "s.toml")

    def take(self, text, **options):
        return import_values(self.study(), self.file(text), **options)

    def kept(self):
        return (self.folder / "s" / "imported.csv").read_text()

    def test_values_are_those_of_their_runs(self):
        found = self.take("humidity [%RH];batch;wear [mm3]\n20,00001;A;1,5\n80 %RH;'=B;\n")
        self.assertEqual(
            found.document() | {"file": ""},
            {"study": "Rig", "lines": 2, "responses": ["wear"], "new": 1, "changed": 0, "runs": 4, "complete": 0, "idle": [], "file": ""},
        )
        self.assertEqual(self.take("batch,humidity,wear [m3],friction\nA,20,,0.4\n").complete, 1)
        self.assertEqual(self.kept(), "humidity [%RH],batch,replicate,wear [m3],friction\n20.0,A,1,1.5e-09,0.4\n")
        study = analysed(self.study())
        self.assertEqual(study.runs["state"].tolist(), ["finished", "missing", "missing", "missing"])
        np.testing.assert_array_equal(study.runs["wear"], [1.5e-9, np.nan, np.nan, np.nan])
        self.assertEqual(study.table["wear [m3]"][0], 1.5e-9)

    def test_values_change_by_force_only(self):
        head = "humidity,batch,friction\n"
        self.take(head + "20,A,0.4\n")
        self.refused("/t.csv:2: 0.4 was imported before and 0.5 differs; force=True replaces it", self.take, head + "20,A,0.5\n")
        self.assertEqual(self.take(head + "20,A,0.5\n", force=True).changed, 1)
        self.assertIn("0.5", self.kept())

    def test_points_of_a_table_are_in_the_units_of_the_study(self):
        points, _ = _rows(analysed(self.study()), self.file("batch;humidity [%RH]\n'=B;35,5\nA;20 %RH\n"), {}, True)
        self.assertEqual(points.to_dict("list"), {"humidity": [35.5, 20.0], "batch": ["=B", "A"]})
        self.refused('/t.csv:2: "humidity [N]" is "5"', _rows, analysed(self.study()), self.file("humidity [N],batch\n5,A\n"), {}, True)

    def test_what_is_wrong_changes_nothing(self):
        head = "humidity,batch,friction\n"
        for text, words in (
            (head + "O.3,A,1\n", '/t.csv:2: "humidity" is "O.3", expected a number'),
            (head + "20,A,1e400\n", '/t.csv:2: "friction" is "1e400", expected a number such as 0.35'),
            (head + "20,A,x\n", '"friction" is "x"'),
            (head + "21,A,1\n", "humidity = 21 is in no point of the design, which has 20 %RH, 80 %RH"),
            (head + "20,C,1\n", "batch = C is in no point"),
            (head + "20,A,1\n20,A,1\n", "/t.csv:3: the design has this point once"),
            (head + ",A,1\n", '"humidity" is empty'),
            ("humidity,batch,replicate,friction\n20,A,2,1\n", "replicate 2, expected a number from 1 to 1"),
            ("humidity,friction\n20,1\n", 'no column of the factor "batch"'),
            ("humidity,batch\n20,A\n", "no column of a response with imported = true"),
            ("humidity,batch,other\n20,A,1\n", 'column "other" is neither a factor nor a response'),
            ("humidity,batch,wear\n20,A,1\n", 'expected "wear [m3]"'),
            ("humidity,batch,wear [N]\n20,A,1\n", 'expected "wear [m3]"'),
        ):
            with self.subTest(text):
                self.refused(words, self.take, text)
        self.assertFalse((self.folder / "s").exists())

    def test_what_the_study_no_longer_has_stays_and_is_named(self):
        self.take("humidity,batch,wear [m3],friction\n20,A,1e-9,0.4\n80,A,2e-9,0.5\n")
        corrected = self.study('"25 %RH", "80 %RH"')
        corrected.write_text(corrected.read_text().replace('name = "friction"', 'name = "mu"'))
        idle = import_values(corrected, self.file("humidity,batch,mu\n25,A,0.6\n")).idle
        self.assertEqual(idle, ["line of humidity [%RH] = 20.0, batch = A", 'column "friction"'])
        self.take("humidity,batch,friction\n20,=B,0.7\n")
        np.testing.assert_array_equal(analysed(self.study()).runs["friction"], [0.4, 0.5, 0.7, np.nan])

    def test_imports_at_the_same_time_lose_nothing(self):
        study = self.study()
        tables = [
            self.file(f"humidity,batch,friction\n{h},{b},0.{at + 1}\n", f"{at}.csv")
            for at, (b, h) in enumerate((b, h) for b in ("A", "'=B") for h in (20, 80))
        ]
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(lambda table: import_values(study, table), tables))
        self.assertEqual(analysed(study).runs["friction"].tolist(), [0.1, 0.2, 0.3, 0.4])


class MeasurementTest(InFolder):
    def measured(self, response, table=""):
        self.file(table)
        asked = {"dataset": "/series/contact_area", **tomllib.loads(response)}
        area = Response("area", "m2", "contact_area", "none", 0.0, np.inf, asked)
        return measurements(SimpleNamespace(path=self.folder / "s.toml", title="Rig", responses=[area]))

    def test_values_in_any_unit(self):
        (value,) = self.measured('measured = "1.3 mm^2"\nuncertainty = "2e4 um2"\n')
        self.assertEqual((value.values[0], value.uncertainties[0], value.is_series), (1.3e-6, 2e-8, False))

    def test_uncertainties_without_a_unit_are_in_that_of_what_they_belong_to(self):
        (value,) = self.measured('measured = "1.3 mm^2"\nuncertainty = 0.02\n')
        self.assertEqual(value.uncertainties[0], 2e-8)
        (series,) = self.measured('measured_file = "t.csv"\n', "time [s],area [mm2],uncertainty\n1,2,0.5\n2,3,0.25\n")
        self.assertEqual(series.uncertainties.tolist(), [5e-7, 2.5e-7])

    def test_what_is_wrong_names_response_and_key(self):
        for response, words in (
            ('measured = "1.3 N"\nuncertainty = 1\n', 'response "area": measured = "1.3 N": "N" measures something else than m2'),
            ("measured = 1.3\n", "measured and uncertainty belong together"),
            ("measured = 1.3\nuncertainty = 0\n", "uncertainty = 0, expected more than 0"),
            ('measured = 1.3\nuncertainty = 1\ncorrelation_time = "2 s"\n', "correlation_time belongs to measured_file"),
            ('measured_file = "none.csv"\n', "there is no such table"),
        ):
            with self.subTest(response):
                self.refused(words, self.measured, response)

    def test_series_come_in_the_units_of_their_heads(self):
        table = "# rig 2\ntime [min],area [mm2],uncertainty [um2],humidity\n0,1.5,2e4,40\n2,2.5,3e4,\n"
        (series,) = self.measured('measured_file = "t.csv"\ncorrelation_time = "2 min"\n', table)
        np.testing.assert_array_equal([series.times, series.values, series.uncertainties], [[0.0, 120.0], [1.5e-6, 2.5e-6], [2e-8, 3e-8]])
        np.testing.assert_allclose(series.correlations, [[1.0, np.exp(-1.0)], [np.exp(-1.0), 1.0]])
        (series,) = self.measured('measured_file = "t.csv"\nuncertainty = 1e-7\n', "time [s],area\n1,2e-6\n2,3e-6\n")
        self.assertEqual(series.uncertainties.tolist(), [1e-7, 1e-7])

    def test_what_is_wrong_in_a_series_is_told_with_its_line(self):
        head = "time [s],area [mm2],uncertainty [mm2]\n"
        for table, words in (
            (head + "0,1,0.1\n", "1 point, expected at least 2"),
            (head + "0,1,0.1\n1,NaN,0.1\n", '/t.csv:3: "area [mm2]" is "NaN", expected a number such as 0.35'),
            (head + "0,1,0.1\n1,,0.1\n", '/t.csv:3: "area [mm2]" is empty'),
            (head + "0,1,0.1\n1,2,0\n", '/t.csv:3: "uncertainty [mm2]" is not more than 0'),
            (head + "1,1,0.1\n1,2,0.1\n", '/t.csv:3: "time [s]" is not after the line before'),
            (head + "-1,1,0.1\n1,2,0.1\n", '/t.csv:2: "time [s]" is before the run'),
            ("time,area,uncertainty\n1,1,1\n2,2,2\n", 'column "time" has no unit'),
            ("time [s],area\n1,1\n2,2\n", "no column uncertainty"),
            ("time [s],x,uncertainty\n1,1,1\n2,2,2\n", 'no column "area"'),
        ):
            with self.subTest(table):
                self.refused(words, self.measured, 'measured_file = "t.csv"\n', table)
