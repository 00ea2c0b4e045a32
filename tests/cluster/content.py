"""What an HDF5 file holds, for comparison to the last bit."""

from pathlib import Path

import h5py
import numpy as np


def bits(value: object) -> object:
    """A value, numbers as their bits."""
    array = np.asarray(value)
    numeric = array.dtype.kind in "fiub"
    return array.dtype.str, array.shape, array.tobytes() if numeric else array.tolist()


def content(path: Path) -> dict[str, object]:
    """Every dataset, by its path, and every attribute, as path@attribute."""
    found = {}
    with h5py.File(path) as file:

        def look(name: str, item: h5py.HLObject) -> None:
            for key in item.attrs:
                # References to datasets are addresses.
                if key not in ("DIMENSION_LIST", "REFERENCE_LIST"):
                    found[f"{name}@{key}"] = bits(item.attrs[key])
            if isinstance(item, h5py.Dataset):
                found[name] = bits(item[()])

        look("", file)
        file.visititems(look)
    return found


def differences(expected: dict[str, object], found: dict[str, object]) -> list[str]:
    """Names of what is not the same in both."""
    return [name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name)]
