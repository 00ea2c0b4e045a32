"""Make the surfaces of the mesh study: ten sets on the finest mesh, and every second, fourth and eighth column of them.

A mesh with every second column has the same physical surface, sampled half as often. Rows that are refined repeat each
row, which is the same surface, too.
"""

import os
import subprocess
import tempfile
from pathlib import Path

import h5py
import numpy as np

FOLDER = Path(__file__).parent
PROGRAM = os.environ.get("PLATEAU_PROGRAM", "plateau")
SETS = range(1, 11)
STRIDES = (1, 2, 4, 8)


def finest(number: int, folder: Path) -> dict[str, np.ndarray]:
    """Return disc heights, pin heights and fibres of a set of seeds, shape (columns, rows)."""
    run = folder / f"{number}.h5"
    seeds = [f"{key}.synthetic.seed={number}" for key in ("disc.surface", "pin.base", "pin.surface")]
    sets = [*seeds, "operation.steps=1", "numerics.time_acceleration=1"]
    options = [word for one in sets for word in ("--set", one)]
    subprocess.run([PROGRAM, "run", FOLDER / "finest.toml", "-q", "-o", run, *options], check=True)
    with h5py.File(run) as file:
        return {"disc": file["/disc/height"][0], "pin": file["/pin/height"][0], "base": file["/pin/base"][...]}


def write(path: Path, surfaces: dict[str, np.ndarray]) -> None:
    """Write surfaces, cell for cell."""
    with h5py.File(path, "w") as file:
        for name, values in surfaces.items():
            file[name] = values


def main() -> None:
    """Write a file for each set and mesh."""
    target = FOLDER / "surfaces"
    target.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for number in SETS:
            surfaces = finest(number, Path(folder))
            for stride in STRIDES:
                sampled = {name: values[::stride] for name, values in surfaces.items()}
                write(target / f"set-{number}-columns-{len(sampled['disc'])}-rows-{sampled['disc'].shape[1]}.h5", sampled)
            for stride in STRIDES:
                refined = {name: np.repeat(values[::stride], 2, axis=1) for name, values in surfaces.items()}
                write(target / f"set-{number}-columns-{len(refined['disc'])}-rows-{refined['disc'].shape[1]}.h5", refined)


if __name__ == "__main__":
    main()
