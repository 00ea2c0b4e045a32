"""The digests of a run file, computed anew from docs/run-file.md by h5py and hashlib alone."""

import hashlib
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
OF_THE_EXECUTION = {"host", "instruction_set", "start_time", "end_time"}


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def texts(file, name, value):
    """What an attribute says, if it is one of the texts, or the scales of a dataset."""
    if name == "DIMENSION_LIST":
        return [file[scale].name for scales in value for scale in scales]
    if isinstance(value, str):
        return [value]
    if isinstance(value, numpy.ndarray) and value.dtype == object:
        return list(value)
    return None


def lines(file, path, thing):
    """The lines of a group or a dataset and of all that is below it."""
    for name, value in thing.attrs.items():
        said = None if name in OF_THE_EXECUTION | {"attributes_sha256"} else texts(file, name, value)
        if said is not None:
            yield f"{path}@{name}={','.join(said)}\n".encode()
    if isinstance(thing, h5py.Group):
        yield f"{path}: {','.join(thing)}\n".encode()
        for name in thing:
            yield from lines(file, path.rstrip("/") + "/" + name, thing[name])


class Digests(unittest.TestCase):
    def test_digests_are_those_of_the_values(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "run.h5"
            scene = ROOT / "data" / "scenes" / "quick.toml"
            maps = 'output.maps_at=["0 s", "20 s"]'
            subprocess.run(
                [os.environ["PLATEAU_PROGRAM"], "run", scene, "-o", path, "--set", maps], check=True, capture_output=True
            )
            with h5py.File(path) as file:
                self.check(file)

    def check(self, file):
        checked = []

        def visit(name, thing):
            if not isinstance(thing, h5py.Dataset):
                return
            digest = thing.attrs["sha256"]
            if isinstance(digest, str):
                self.assertEqual(sha256(thing[()].tobytes()), digest, name)
            else:
                self.assertEqual([sha256(thing[k].tobytes()) for k in range(len(thing))], list(digest), name)
            checked.append(name)

        file.visititems(visit)
        self.assertEqual(len(checked), 36)
        every = sorted(lines(file, "/", file))
        self.assertEqual(sha256(b"".join(every)), file.attrs["attributes_sha256"])


if __name__ == "__main__":
    unittest.main()
