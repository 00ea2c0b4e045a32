"""The digests of a run file, computed anew from docs/run-file.md by h5py and hashlib alone."""

import hashlib
import json
import struct

import h5py
import numpy
from checkout import QUICK, Folder, called, changed, program

OF_THE_EXECUTION = {"decomposition", "host", "instruction_set", "start_time", "end_time", "workers", "wall_time"}
DIGESTS = {"attributes_sha256", "execution_sha256"}


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


def number(value):
    """Whole numbers have their digits, others the 64 bits of IEEE 754."""
    return str(value) if isinstance(value, numpy.integer) else struct.pack(">d", value).hex()


def line(file, path, name, value):
    """The line of an attribute of any kind."""
    said = texts(file, name, value)
    if isinstance(value, bytes):
        said = [value.decode()]
    elif said is None and isinstance(value, (numpy.number, numpy.ndarray)) and value.dtype.kind in "iuf":
        said = [number(each) for each in numpy.ravel(value)]
    return (f"{path}@{name}" + ("" if said is None else f"={','.join(said)}") + "\n").encode()


def other_lines(file):
    """The lines of all attributes that have none in `lines`, but for those of the execution."""
    things = [("/", file)]
    file.visititems(lambda name, thing: things.append((f"/{name}", thing)))
    # `visititems` does not follow the link.
    things.append(("/series/time", file["series/time"]))
    for path, thing in things:
        for name, value in thing.attrs.items():
            if (path != "/" or name not in OF_THE_EXECUTION | DIGESTS) and texts(file, name, value) is None:
                yield line(file, path, name, value)


def lines(file, path, thing):
    """The lines of a group or a dataset and of all that is below it."""
    for name, value in thing.attrs.items():
        said = None if name in OF_THE_EXECUTION | DIGESTS else texts(file, name, value)
        if said is not None:
            yield f"{path}@{name}={','.join(said)}\n".encode()
    if isinstance(thing, h5py.Group):
        yield f"{path}: {','.join(thing)}\n".encode()
        for name in thing:
            yield from lines(file, path.rstrip("/") + "/" + name, thing[name])


class Digests(Folder):
    def test_digests_are_those_of_the_values(self):
        path = self.folder / "run.h5"
        program("run", QUICK, "-o", path, *changed('output.maps_at=["0 s", "20 s"]'))
        with h5py.File(path) as file:
            self.check(file)
        self.check_verdict(path, "intact", True)
        # As earlier programs left it.
        with h5py.File(path, "r+") as file:
            for name in ["numbers_sha256", "execution_sha256", "attributes_sha256"]:
                del file.attrs[name]
            file.attrs["attributes_sha256"] = sha256(b"".join(sorted(lines(file, "/", file))))
        self.check_verdict(path, "intact", False)

    def check_verdict(self, path, verdict, covers_numbers):
        found = json.loads(called("verify", path, "--json").stdout)[0]
        self.assertEqual((found["verdict"], found["covers_numbers"]), (verdict, covers_numbers), found)

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
        self.assertEqual(len(checked), 38)
        every = sorted(lines(file, "/", file))
        self.assertEqual(sha256(b"".join(every)), file.attrs["attributes_sha256"])
        others = sorted(other_lines(file))
        self.assertIn(b"/@format_version=1\n", others)
        self.assertEqual(sha256(b"".join(others)), file.attrs["numbers_sha256"])
        execution = sorted(line(file, "/", name, file.attrs[name]) for name in OF_THE_EXECUTION)
        self.assertEqual(sha256(b"".join(execution)), file.attrs["execution_sha256"])
