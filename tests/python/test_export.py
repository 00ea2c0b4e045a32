"""What `plateau.export` writes, as pandas, NumPy, xarray, openpyxl and a plain XML parser read it: the numbers of the run file."""

import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree as xml

import h5py
import numpy as np
import pandas
import xarray
from checkout import QUICK, Folder, word
from package_scenes import MAPS

import plateau
from plateau import exports

EXPORTED = MAPS | {"pin_base": "pin/base"}
SHORT = {"operation.duration": "5 s", "output.maps_at": ["0 s", "2 s"], "output.roughness": True}


def grid(path):
    """Extent, cell data and points of a .vts file: the XML as XML, the numbers behind it by the format's description."""
    content = path.read_bytes()
    mark = content.index(b"_", content.index(b"<AppendedData"))
    tail = content[content.rindex(b"</AppendedData>") :]
    head = xml.fromstring(content[:mark] + tail)
    assert (head.get("type"), head.get("byte_order"), head.get("header_type")) == ("StructuredGrid", "LittleEndian", "UInt64")
    assert head.find("AppendedData").get("encoding") == "raw"

    def array(element):
        start = mark + 1 + int(element.get("offset"))
        size = int(np.frombuffer(content, "<u8", 1, start)[0])
        return np.frombuffer(content[start + 8 : start + 8 + size], {"Float64": "<f8", "UInt8": "u1"}[element.get("type")])

    piece = head.find("StructuredGrid/Piece")
    cells = {element.get("Name"): array(element) for element in piece.find("CellData")}
    return head.find("StructuredGrid").get("WholeExtent"), cells, array(piece.find("Points/DataArray")).reshape(-1, 3)


class Export(Folder):
    @classmethod
    def setUpClass(cls):
        cls.made = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory())) / "run.h5"
        plateau.run(QUICK, cls.made, set=SHORT)

    def same(self, found, expected):
        found, expected = np.ascontiguousarray(found), np.ascontiguousarray(expected)
        self.assertEqual((found.shape, found.itemsize), (expected.shape, expected.itemsize))
        self.assertEqual(found.tobytes(), expected.tobytes())

    def test_csv(self):
        written = plateau.export(self.made, "csv", maps=True)
        self.assertEqual(written[0], "run.csv")
        with h5py.File(self.made) as run:
            table = pandas.read_csv("run.csv", float_precision="round_trip")
            names = {f"{name} [{series.attrs['units']}]": series for name, series in run["series"].items()}
            self.assertEqual(set(table.columns), {"time [s]", *names})
            self.same(table["time [s]"], run["time"][:])
            for name, series in names.items():
                self.same(table[name], series[:])
            for body in ("disc", "pin"):
                angle, radius = np.meshgrid(run[f"{body}_angle"][:], run["radius"][:], indexing="ij")
                for index, moment in enumerate(run["map_time"][:]):
                    table = pandas.read_csv(f"run-{body}-{index:04}.csv", float_precision="round_trip")
                    self.same(table["angle [rad]"], angle.ravel())
                    self.same(table["radius [m]"], radius.ravel())
                    self.assertEqual(set(table["time [s]"]), {moment})
                    for name, maps in run[body].items():
                        values = maps[:] if name == "base" else maps[index]
                        self.same(table[f"{name} [{maps.attrs['units']}]"].astype(values.dtype), values.ravel())
                    self.assertEqual(len(table.columns), 3 + len(run[body]))

    def test_csv_with_a_decimal_comma(self):
        plateau.export(self.made, "csv", "comma.csv", decimal=",", separator=";")
        table = pandas.read_csv("comma.csv", sep=";", decimal=",", float_precision="round_trip")
        with h5py.File(self.made) as run:
            self.same(table["contact_area [m2]"], run["series/contact_area"][:])
        for decimal, separator in ((",", ","), (".", "."), (";", ","), (".", "e"), (".", "ab")):
            with self.subTest(decimal, separator=separator), self.assertRaisesRegex(plateau.InputError, "expected . or ,"):
                plateau.export(self.made, "csv", "other.csv", decimal=decimal, separator=separator)
        with self.assertRaisesRegex(plateau.InputError, "npz has no decimal mark"):
            plateau.export(self.made, "npz", decimal=",")
        self.assertEqual(os.listdir(), ["comma.csv"])

    def test_xlsx(self):
        plateau.export(self.made, "xlsx")
        run, book = plateau.open_run(self.made), pandas.read_excel("run.xlsx", sheet_name=None)
        self.assertEqual(list(book), ["series", "about"])
        # Excel keeps 16 digits.
        for name, series in run.plateau.series.items():
            unit = run["series"][name].attrs["units"]
            np.testing.assert_allclose(book["series"][f"{name} [{unit}]"], series, rtol=1e-15)
        text = book["about"].groupby("what", sort=False)["text"].agg(lambda lines: "\n".join(lines.fillna("")) + "\n")
        self.assertEqual((text["title"], text["scene"]), (f"{run.attrs['title']}\n", run.attrs["scene"]))
        hostile = run.copy()
        hostile.attrs |= {"title": "=1+1", "program": '=HYPERLINK("http://a")'}
        plateau.export(hostile, "xlsx", "hostile.xlsx")
        import openpyxl

        cells = [cell for sheet in openpyxl.load_workbook("hostile.xlsx") for row in sheet for cell in row]
        self.assertIn("=1+1", [cell.value for cell in cells])
        self.assertFalse([cell for cell in cells if cell.data_type == "f" or cell.hyperlink])
        with unittest.mock.patch.object(exports, "MOST_ROWS", 10), self.assertRaisesRegex(plateau.InputError, "a sheet of Excel has 10"):
            plateau.export(self.made, "xlsx", "long.xlsx")

    def test_npz(self):
        plateau.export(self.made, "npz", "out.npz")
        with h5py.File(self.made) as run, np.load("out.npz", allow_pickle=False) as arrays:
            paths = {name: name for name in ("time", "map_time", "radius", "disc_angle", "pin_angle")}
            paths |= {name: f"series/{name}" for name in run["series"]} | EXPORTED
            texts = {"title", "state", "scene", "units"}
            self.assertEqual(set(arrays.files), set(paths) | texts)
            for name, path in paths.items():
                self.same(arrays[name], run[path][...])
            for name in texts - {"units"}:
                self.assertEqual(str(arrays[name]), run.attrs[name])
            self.assertEqual(json.loads(str(arrays["units"])), {name: run[path].attrs["units"] for name, path in paths.items()})

    def test_a_series_and_a_map_may_have_one_name(self):
        run = plateau.open_run(self.made).copy()
        run["series/pin_temperature"], run["pin/temperature"] = run["series/pool"], run["pin/pressure"]
        plateau.export(run, "npz", "hot.npz")
        with np.load("hot.npz") as arrays:
            self.same(arrays["pin_temperature"], run["series/pool"])
            self.same(arrays["temperature"], run["pin/pressure"])

    def test_netcdf(self):
        plateau.export(self.made, "netcdf")
        with xarray.open_datatree("run.nc", engine="h5netcdf") as found:
            self.assertTrue(found.identical(plateau.open_run(self.made)))

    def test_vtk(self):
        plateau.export(self.made, "vtk")
        with h5py.File(self.made) as run:
            radius = run["radius"][:]
            rows, height = len(radius), radius[1] - radius[0]
            edges = radius[0] + height * (np.arange(rows + 1) - 0.5)
            for body in ("disc", "pin"):
                collection = xml.parse(f"run-vtk/{body}.pvd").getroot()
                files = [(float(entry.get("timestep")), entry.get("file")) for entry in collection.iter("DataSet")]
                self.assertEqual([moment for moment, _ in files], list(run["map_time"][:]))
                for index, (_, name) in enumerate(files):
                    extent, cells, points = grid(self.folder / "run-vtk" / name)
                    columns = len(run[f"{body}_angle"])
                    self.assertEqual(extent, f"0 {rows} 0 {columns} 0 0")
                    self.assertEqual(set(cells), set(run[body]))
                    for name, values in cells.items():
                        self.same(values, (run[body][name][:] if name == "base" else run[body][name][index]).ravel())
                    # Corners at the edges of the cells: x + iy = r exp(i angle).
                    angle = np.arange(columns + 1) * 2 * np.pi / len(run["disc_angle"])
                    expected = (np.exp(1j * angle)[:, None] * edges).ravel()
                    np.testing.assert_allclose(points[:, 0] + 1j * points[:, 1], expected, rtol=0, atol=1e-15)
                    self.assertTrue((points[:, 2] == 0).all())
                    if body == "disc":
                        self.same(points[-rows - 1 :], points[: rows + 1])

    def test_without_maps(self):
        plateau.run(QUICK, "bare.h5", set={"operation.duration": "1 s", "output.maps": []})
        with self.assertWarnsRegex(plateau.PlateauWarning, "no maps of the (disc|pin)"):
            self.assertEqual(plateau.export("bare.h5", "vtk"), [])
        with self.assertWarnsRegex(plateau.PlateauWarning, "no maps of the (disc|pin)"):
            self.assertEqual(plateau.export("bare.h5", "csv", maps=True), ["bare.csv"])
        plateau.export("bare.h5", "npz")
        with np.load("bare.npz") as arrays:
            self.assertFalse({"map_time", "disc_height", "pin_status"} & set(arrays))

    def test_a_single_map_of_a_single_cell(self):
        changes = {"mesh.rows": 1, "mesh.disc_columns": 1, "mesh.pin_columns": 1, "output.maps": ["pressure"], "operation.steps": 3,
                   "disc.surface.flat": True, "pin.base.uniform": "primary", "pin.surface.flat": True}  # fmt: skip
        plateau.run(QUICK, "cell.h5", set=changes)
        for kind in exports.FORMATS:
            with contextlib.suppress(plateau.PlateauWarning):
                plateau.export("cell.h5", kind, maps=kind == "csv")
        with h5py.File("cell.h5") as run:
            extent, cells, points = grid(self.folder / "cell-vtk/pin-0001.vts")
            self.assertEqual((extent, set(cells), len(points)), ("0 1 0 1 0 0", {"pressure", "base"}, 4))
            self.same(cells["pressure"], run["pin/pressure"][1].ravel())
            np.testing.assert_allclose(np.hypot(points[:2, 0], points[:2, 1]), [0.02, 0.021])

    def test_events_of_a_round_pin(self):
        round_pin = {"mesh": {"shape": "disc", "pin_width": "1 mm", "cell_size": "50 um", "mean_radius": "20.5 mm"}}
        stops = QUICK.with_name("stops.toml")
        plateau.run(stops, "stops.h5", set={**round_pin, "operation.cycle.repeat": 1})
        plateau.export("stops.h5", "csv", maps=True)
        events, pin = pandas.read_csv("stops-events.csv", float_precision="round_trip"), pandas.read_csv("stops-pin-0000.csv")
        with h5py.File("stops.h5") as run:
            self.assertEqual(list(events["event"]), list(range(1, len(run["event/worn"]) + 1)))
            self.same(events["worn [m3]"], run["event/worn"][:])
        outside = pin["status [1]"] == 3
        self.assertTrue(outside.any() and pin["height [m]"][outside].isna().all() and (pin["base [1]"][outside] == 3).all())

    def test_all_or_nothing_is_written(self):
        pathlib.Path("run-events.csv").touch()
        pathlib.Path("run-pin-0001.csv").write_text("kept")
        with self.assertRaisesRegex(plateau.InputError, "run-pin-0001.csv exists; give force=True"):
            plateau.export(self.made, "csv", maps=True)
        with unittest.mock.patch("zipfile.ZipFile.close", side_effect=OSError(28, "No space left on device")):
            with self.assertRaisesRegex(plateau.RunFailed, "No space left"):
                plateau.export(self.made, "npz")
        with self.assertRaisesRegex(plateau.InputError, "is an input and is not replaced"):
            plateau.export(shutil.copy(self.made, "copy.nc"), "netcdf", force=True)
        self.assertEqual(sorted(os.listdir()), ["copy.nc", "run-events.csv", "run-pin-0001.csv"])
        plateau.export(self.made, "csv", maps=True, force=True)
        self.assertNotEqual(pathlib.Path("run-pin-0001.csv").read_text(), "kept")

    def test_a_disk_that_is_full_is_told_in_one_line(self):
        # In a process of its own, which HDF5 ended by a signal where it wrote by itself.
        limited = (
            "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)); "
            "from plateau.command_line import main; sys.exit(main(['export', *sys.argv[1:]]))"
        )
        for to in exports.FORMATS:
            with self.subTest(to):
                done = subprocess.run([sys.executable, "-c", limited, self.made, "--to", to], capture_output=True, text=True, check=False)
                self.assertRegex(done.stderr, r"\Aplateau: cannot write into (\.|run-vtk): File too large; name another place with -o\n\Z")
                self.assertEqual((done.returncode, [path for path in pathlib.Path().rglob("*") if path.is_file()]), (1, []))

    def test_endings_are_those_of_the_format(self):
        for to, name, told in (
            ("npz", "a.nc", r"ends in \.npz, such as a\.npz"),
            ("csv", "a.xlsx", r"\.csv or \.tsv or \.txt"),
            ("netcdf", "a.h5", r"\.nc or"),
        ):
            with self.subTest(to), self.assertRaisesRegex(plateau.InputError, told):
                plateau.export(self.made, to, name)
        self.assertEqual(os.listdir(), [])
        self.assertEqual(plateau.export(self.made, "csv", "a.TSV", separator="tab"), ["a.TSV"])
        self.assertEqual(plateau.export(self.made, "npz", "a"), ["a"])
        self.assertEqual(len(plateau.export(self.made, "vtk", "a-0.5")), 8)

    def test_a_link_stays_and_what_it_points_to_is_replaced(self):
        pathlib.Path("elsewhere").mkdir()
        target, link, lost = (pathlib.Path(name) for name in ("elsewhere/real.csv", "link.csv", "lost.csv"))
        target.write_text("before")
        target.chmod(0o640)
        link.symlink_to(target)
        lost.symlink_to("nowhere.csv")
        with self.assertRaisesRegex(plateau.InputError, "real.csv exists; give force=True"):
            plateau.export(self.made, "csv", link)
        with self.assertRaisesRegex(plateau.InputError, "lost.csv is a link to nowhere.csv, which is not there"):
            plateau.export(self.made, "csv", lost, force=True)
        plateau.export(self.made, "csv", link, force=True)
        self.assertTrue(link.is_symlink() and target.read_text().startswith("time [s],"))
        self.assertEqual((target.stat().st_mode & 0o777, os.listdir("elsewhere")), (0o640, ["real.csv"]))

    def test_what_cannot_be_read_is_not_laid_on_the_folder(self):
        shutil.copy(self.made, "damaged.h5")
        with h5py.File("damaged.h5") as file:
            chunk = file["series/contact_area"].id.get_chunk_info(0)
        with open("damaged.h5", "r+b") as file:
            file.seek(chunk.byte_offset)
            file.write(bytes(chunk.size))
        for to in ("xlsx", "npz", "netcdf"):
            with self.subTest(to), self.assertRaisesRegex(OSError, "^Can't .*read data"):
                plateau.export("damaged.h5", to)
        self.assertEqual(os.listdir(), ["damaged.h5"])

    def test_runs_with_few_samples(self):
        changes = {"operation.duration": "2 s", "output.sample_every": "1 s"}
        plateau.run(QUICK, "two.h5", set=changes)
        for count in (2, 1, 0):
            run = plateau.open_run("two.h5").isel(time=slice(count))
            for to in exports.FORMATS:
                plateau.export(run, to, f"{count}{exports.FORMATS[to][0]}", maps=to == "csv")
            self.assertEqual(len(pandas.read_csv(f"{count}.csv")), count)
            self.assertEqual(len(pandas.read_excel(f"{count}.xlsx", sheet_name="series")), count)
            with np.load(f"{count}.npz") as arrays:
                self.assertEqual((len(arrays["time"]), len(arrays["contact_area"])), (count, count))

    def test_no_head_is_a_formula(self):
        run = plateau.open_run(self.made).copy()
        for name in ("=1+1", "+1", "-1", "@a", "|a"):
            run[f"series/{name}"] = run["series/pool"]
        plateau.export(run, "csv", "heads.csv")
        plateau.export(run, "xlsx", "heads.xlsx")
        for table in (pandas.read_csv("heads.csv"), pandas.read_excel("heads.xlsx")):
            self.assertEqual(
                [head for head in table.columns if not head[0].isalnum()], [f"'{name} [m3]" for name in ("=1+1", "+1", "-1", "@a", "|a")]
            )

    def test_what_is_not_installed_is_told(self):
        with (
            unittest.mock.patch.dict(sys.modules, {"pyevtk": None, "pyevtk.hl": None}),
            self.assertRaisesRegex(plateau.MissingPackageError, "brake.all"),
        ):
            plateau.export(self.made, "vtk")

    def test_the_word(self):
        wanted = (["--to", "csv", "--decimal", ",", "--separator", "tab"], ["--to", "csv"], ["--to", "mat"])
        done, out, err = zip(*(word("export", self.made, *more) for more in wanted), strict=True)
        self.assertEqual(done, (0, 2, 2))
        self.assertRegex("".join(out), r"^wrote run.csv \(\d+\.\d kB\)\n$")
        self.assertIn("run.csv exists; give --force to replace it", err[1])
        self.assertTrue(pathlib.Path("run.csv").read_text().startswith("time [s]\tdisplacement [m]\t"))
