"""What `plateau export` writes, as pandas, NumPy and a plain XML parser read it: the numbers of the run file, to the bit."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree as xml

import h5py
import numpy as np
import pandas

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("PLATEAU_PROGRAM", str(ROOT / "plateau"))
SCENE = str(ROOT / "data/scenes/quick.toml")
MAPS = {"disc_height": "disc/height", "disc_substrate": "disc/substrate", "disc_status": "disc/status",
        "pin_height": "pin/height", "pin_substrate": "pin/substrate", "pin_status": "pin/status",
        "pressure": "pin/pressure", "pin_base": "pin/base"}


def run_command(output, *changes):
    return [PROGRAM, "run", SCENE, "-o", output, *(word for change in changes for word in ("--set", change))]


def grid(path):
    """Head, cell data and points of a .vts file: the XML as XML, the numbers behind it by the format's description."""
    content = path.read_bytes()
    mark = content.index(b"_", content.index(b"<AppendedData"))
    tail = b"\n</AppendedData>\n</VTKFile>\n"
    assert content.endswith(tail)
    head = xml.fromstring(content[:mark] + tail)
    assert head.attrib == {"type": "StructuredGrid", "version": "1.0", "byte_order": "LittleEndian", "header_type": "UInt64"}
    assert head.find("AppendedData").get("encoding") == "raw"

    def array(element):
        start = mark + 1 + int(element.get("offset"))
        size = int(np.frombuffer(content, "<u8", 1, start)[0])
        kind = {"Float64": "<f8", "UInt8": "u1"}[element.get("type")]
        used.append((start, start + 8 + size))
        return np.frombuffer(content[start + 8 : start + 8 + size], kind)

    used = []
    piece = head.find("StructuredGrid/Piece")
    cells = {element.get("Name"): array(element) for element in piece.find("CellData")}
    points = array(piece.find("Points/DataArray")).reshape(-1, 3)
    # The arrays fill the room behind the mark without gaps.
    used.sort()
    assert used[0][0] == mark + 1 and used[-1][1] == len(content) - len(tail)
    assert all(one[1] == other[0] for one, other in zip(used, used[1:]))
    moment = float(head.find("StructuredGrid/FieldData/DataArray").text)
    return head.find("StructuredGrid").get("WholeExtent"), moment, cells, points


class Export(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_scene(self, name, *changes):
        subprocess.run(run_command(name, *changes), check=True, capture_output=True, timeout=300, cwd=self.folder)

    def export(self, *arguments):
        command = [PROGRAM, "export", *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=self.folder)

    def short_run(self):
        self.run_scene("run.h5", 'operation.duration="5 s"', 'output.maps_at=["0 s", "2 s"]', "output.roughness=true")
        return h5py.File(self.folder / "run.h5")

    def same(self, found, expected):
        found, expected = np.ascontiguousarray(found), np.ascontiguousarray(expected)
        self.assertEqual((found.shape, found.itemsize), (expected.shape, expected.itemsize))
        self.assertEqual(found.tobytes(), expected.tobytes())

    def test_csv(self):
        with self.short_run() as run:
            self.assertEqual(self.export("run.h5", "--to", "csv", "--maps").returncode, 0)
            table = pandas.read_csv(self.folder / "run.csv")
            names = {f"{name} [{series.attrs['units']}]": series for name, series in run["series"].items()}
            self.assertEqual(set(table.columns), {"time [s]", *names})
            self.same(table["time [s]"], run["time"][:])
            for name, series in names.items():
                self.same(table[name], series[:])
            for body in ("disc", "pin"):
                angle, radius = np.meshgrid(run[f"{body}_angle"][:], run["radius"][:], indexing="ij")
                for index, moment in enumerate(run["map_time"][:]):
                    path = self.folder / f"run-{body}-{index:04}.csv"
                    table = pandas.read_csv(path)
                    self.same(table["angle [rad]"], angle.ravel())
                    self.same(table["radius [m]"], radius.ravel())
                    self.assertEqual(set(table["time [s]"]), {moment})
                    for name, maps in run[body].items():
                        values = maps[:] if name == "base" else maps[index]
                        self.same(table[f"{name} [{maps.attrs['units']}]"].astype(values.dtype), values.ravel())
                    self.assertEqual(len(table.columns), 3 + len(run[body]))

    def test_npz(self):
        with self.short_run() as run:
            self.assertEqual(self.export("run.h5", "--to", "npz", "-o", "out.npz").returncode, 0)
            with np.load(self.folder / "out.npz", allow_pickle=False) as arrays:
                paths = {name: name for name in ("time", "map_time", "radius", "disc_angle", "pin_angle")}
                paths |= {name: f"series/{name}" for name in run["series"]} | MAPS
                texts = {"title", "state", "scene", "units"}
                self.assertEqual(set(arrays.files), set(paths) | texts)
                for name, path in paths.items():
                    self.same(arrays[name], run[path][...])
                for name in texts - {"units"}:
                    self.assertEqual(str(arrays[name]), run.attrs[name])
                units = {name: run[path].attrs["units"] for name, path in paths.items()}
                self.assertEqual(json.loads(str(arrays["units"])), units)

    def test_vtk(self):
        with self.short_run() as run:
            self.assertEqual(self.export("run.h5", "--to", "vtk").returncode, 0)
            folder = self.folder / "run-vtk"
            radius = run["radius"][:]
            rows, height = len(radius), radius[1] - radius[0]
            edges = radius[0] + height * (np.arange(rows + 1) - 0.5)
            for body in ("disc", "pin"):
                collection = xml.parse(folder / f"{body}.pvd").getroot()
                files = [(float(entry.get("timestep")), entry.get("file")) for entry in collection.iter("DataSet")]
                self.assertEqual([moment for moment, _ in files], list(run["map_time"][:]))
                for index, (moment, name) in enumerate(files):
                    extent, found, cells, points = grid(folder / name)
                    columns = len(run[f"{body}_angle"])
                    self.assertEqual((extent, found), (f"0 {rows} 0 {columns} 0 0", moment))
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
        self.run_scene("run.h5", 'operation.duration="1 s"', "output.maps=[]")
        done = self.export("run.h5", "--to", "vtk")
        self.assertEqual((done.returncode, done.stderr.count("no maps of the")), (0, 2), done.stderr)
        self.assertEqual(self.export("run.h5", "--to", "csv", "--maps").returncode, 0)
        self.assertEqual(self.export("run.h5", "--to", "npz").returncode, 0)
        with np.load(self.folder / "run.npz") as arrays, h5py.File(self.folder / "run.h5") as run:
            self.same(arrays["map_time"], np.empty(0))
            self.same(arrays["contact_area"], run["series/contact_area"][:])
            self.assertNotIn("disc_height", arrays)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["run.csv", "run.h5", "run.h5.checkpoint", "run.npz"])

    def test_a_single_map_of_a_single_cell(self):
        changes = ["mesh.rows=1", "mesh.disc_columns=1", "mesh.pin_columns=1", 'output.maps=["pressure"]', "operation.steps=3"]
        changes += ["disc.surface.flat=true", 'pin.base.uniform="primary"', "pin.surface.flat=true"]
        self.run_scene("run.h5", *changes)
        for kind in ("csv", "npz", "vtk"):
            done = self.export("run.h5", "--to", kind, "--maps")
            self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "run.h5") as run:
            extent, _, cells, points = grid(self.folder / "run-vtk/pin-0001.vts")
            self.assertEqual((extent, set(cells), len(points)), ("0 1 0 1 0 0", {"pressure", "base"}, 4))
            self.same(cells["pressure"], run["pin/pressure"][1].ravel())

    def test_a_run_that_goes_on_and_one_that_was_killed(self):
        changes = ["operation.steps=100000000", 'output.sample_every="0.05 s"']
        run = subprocess.Popen(run_command("run.h5", *changes), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               cwd=self.folder)
        try:
            for _ in range(600):
                time.sleep(0.1)
                done = self.export("run.h5", "--to", "npz", "-o", "alive.npz", "--force")
                if done.returncode == 0 and np.load(self.folder / "alive.npz")["time"].size >= 50:
                    break
            else:
                self.fail(f"no 50 samples within a minute: {done.stderr}")
        finally:
            run.send_signal(signal.SIGKILL)
            run.wait()
        self.assertIn("is not finished: its state is running (or it was killed)", done.stderr)
        self.assertEqual(self.export("run.h5", "--to", "npz", "-o", "killed.npz").returncode, 0)
        with np.load(self.folder / "alive.npz") as alive, np.load(self.folder / "killed.npz") as killed:
            samples = alive["time"].size
            self.assertGreaterEqual(killed["time"].size, samples)
            with h5py.File(self.folder / "run.h5", swmr=True) as file:
                for name in ("time", "contact_area", "pool"):
                    values = file["time" if name == "time" else f"series/{name}"][:]
                    self.same(killed[name], values[: killed["time"].size])
                    self.same(alive[name], values[:samples])
            self.assertEqual(str(killed["state"]), "running")


if __name__ == "__main__":
    unittest.main()
