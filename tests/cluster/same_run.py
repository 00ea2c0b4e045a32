"""Whether a run that was warned, stopped or killed and gone on with gives the run file of an undisturbed one.

usage: same_run.py REFERENCE OTHER, two run files
"""

import sys

import h5py
import numpy as np

# What differs from one making of a run to the next.
ATTRIBUTES = ["start_time", "end_time", "wall_time"]


def content(path: str) -> tuple[dict[str, object], dict[str, object]]:
    """Every dataset and every attribute, numbers as their bits."""

    def bits(value: object) -> object:
        array = np.asarray(value)
        numeric = array.dtype.kind in "fiub"
        return array.dtype.str, array.shape, array.tobytes() if numeric else array.tolist()

    datasets, attributes = {}, {}
    with h5py.File(path) as file:

        def look(name: str, item: h5py.HLObject) -> None:
            for key in item.attrs:
                # References to datasets are addresses.
                if key not in ("DIMENSION_LIST", "REFERENCE_LIST"):
                    attributes[f"{name}@{key}"] = bits(item.attrs[key])
            if isinstance(item, h5py.Dataset):
                datasets[name] = bits(item[()])

        look("", file)
        file.visititems(look)
        assert file.attrs["state"] == "finished", f"{path} is {file.attrs['state']}, not finished"
        assert len(file["time"]) > 1000 and len(file["map_time"]) > 3, f"{path} holds too little to compare"
    for name in ATTRIBUTES:
        del attributes[f"@{name}"]
    return datasets, attributes


def main() -> None:
    reference, other = (content(path) for path in sys.argv[1:])
    for expected, found in zip(reference, other, strict=True):
        different = [name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name)]
        assert not different, f"{sys.argv[2]} differs from {sys.argv[1]}: {different}"
    print(f"{len(other[0])} datasets and {len(other[1])} attributes equal to the last bit")


main()
