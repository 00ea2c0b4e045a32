"""Whether a run that was warned, stopped or killed and gone on with gives the run file of an undisturbed one.

usage: same_run.py REFERENCE OTHER, two run files
"""

import sys

import h5py
from content import content, differences

# What differs from one making of a run to the next, and the digest of that.
ATTRIBUTES = ["start_time", "end_time", "wall_time", "execution_sha256"]


def result(path: str) -> dict[str, object]:
    """What a run gives."""
    with h5py.File(path) as file:
        assert file.attrs["state"] == "finished", f"{path} is {file.attrs['state']}, not finished"
        assert len(file["time"]) > 1000 and len(file["map_time"]) > 3, f"{path} holds too little to compare"
    found = content(path)
    for name in ATTRIBUTES:
        del found[f"@{name}"]
    return found


def main() -> None:
    expected, found = (result(path) for path in sys.argv[1:])
    different = differences(expected, found)
    assert not different, f"{sys.argv[2]} differs from {sys.argv[1]}: {different}"
    attributes = sum("@" in name for name in found)
    print(f"{len(found) - attributes} datasets and {attributes} attributes equal to the last bit")


main()
