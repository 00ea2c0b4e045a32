#!/usr/bin/env python3
"""Exports a run for ParaView and compares what VTK's readers give with the run file."""

import os
import pathlib
import subprocess
import tempfile

import h5py
import numpy as np
import pyvista
import vtk
from vtk.util.numpy_support import vtk_to_numpy

PROGRAM = os.environ["PLATEAU_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parent.parent.parent / "data/scenes/quick.toml"


def areas(mesh):
    """Areas of the cells, by VTK."""
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(mesh)
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area"))


def check_grid(run, body, index, path):
    reader = vtk.vtkXMLStructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid, cell_data = reader.GetOutput(), reader.GetOutput().GetCellData()
    assert reader.GetErrorCode() == 0 and cell_data.GetNumberOfArrays() == len(run[body]), path
    for name, dataset in run[body].items():
        expected = dataset[:] if name == "base" else dataset[index]
        found = vtk_to_numpy(cell_data.GetArray(name))
        assert found.tobytes() == expected.ravel().tobytes(), (path, name)
    # A cell is a trapezium between two radii: (outer² - inner²) sin(angle) / 2.
    radius = run["radius"][:]
    half = (radius[1] - radius[0]) / 2
    expected = ((radius + half) ** 2 - (radius - half) ** 2) * np.sin(2 * np.pi / len(run["disc_angle"])) / 2
    np.testing.assert_allclose(areas(grid), np.tile(expected, len(run[f"{body}_angle"])), rtol=1e-10)


def check_series(run, body, path):
    reader = pyvista.get_reader(str(path))
    assert reader.time_values == list(run["map_time"][:]), reader.time_values
    for index, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        [grid] = reader.read()
        assert (grid.cell_data["height"] == run[body]["height"][index].ravel()).all(), (path, time)


with tempfile.TemporaryDirectory() as folder:
    changes = ["--set", 'operation.duration="5 s"', "--set", 'output.maps_at=["0 s", "2 s"]']
    for command in (["run", str(SCENE), "-o", "run.h5", *changes], ["export", "run.h5", "--to", "vtk"]):
        subprocess.run([PROGRAM, *command], check=True, capture_output=True, cwd=folder, timeout=300)
    grids = pathlib.Path(folder) / "run-vtk"
    with h5py.File(pathlib.Path(folder) / "run.h5") as run:
        for body in ("disc", "pin"):
            for index in range(len(run["map_time"])):
                check_grid(run, body, index, grids / f"{body}-{index:04}.vts")
            check_series(run, body, grids / f"{body}.pvd")
print(f"VTK {vtk.vtkVersion.GetVTKVersion()} and pyvista {pyvista.__version__} read what the run file holds")
