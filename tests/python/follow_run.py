#!/usr/bin/env python3
"""Follows a run file while it is written, and checks what a reader is promised.

    follow_run.py RUN.h5 [--idle SECONDS] [--samples N]

Whenever new times appear, every series must have at least as many values, all finite, and none that was seen before may
have changed; times must grow. The same holds for maps and map times. Ends when the run has ended, or when nothing new
has come for the given number of seconds. Fails if fewer than N samples were seen while the run was going on.
"""

import argparse
import sys
import time

import h5py
import numpy as np


def wait_for(path, seconds):
    """Opens a run file as a follower as soon as it exists."""
    end = time.monotonic() + seconds
    while True:
        try:
            return h5py.File(path, "r", swmr=True)
        except OSError as error:
            if time.monotonic() > end:
                sys.exit(f"FAILED: cannot follow {path}: {error}")
            time.sleep(0.02)


def is_being_written(path):
    """Whether the flags in the superblock (byte 11 of the file) say that a writer has the file open.

    Asked of the bytes: h5py would hand out the file that this process follows already.
    """
    with open(path, "rb") as file:
        return file.read(12)[11] != 0


class Follower:
    """Checks datasets that grow along one dimension of times."""

    def __init__(self, file, times, followers):
        self.times = file[times]
        self.followers = {name: file[name] for name in followers}
        self.seen = np.empty(0)
        self.values = {name: [] for name in followers}

    def look(self):
        """Checks what is new; returns how many times that is."""
        self.times.refresh()
        times = self.times[...]
        old, new = self.seen.size, times.size
        check(np.array_equal(times[:old], self.seen), f"{self.times.name}: times that were seen have changed")
        check((np.diff(times) > 0).all(), f"{self.times.name} does not grow")
        for name, dataset in self.followers.items():
            dataset.refresh()
            check(dataset.shape[0] >= new, f"{name} has {dataset.shape[0]} entries for {new} times")
            values = dataset[old:new]
            check(np.isfinite(values).all(), f"{name} has values that are not finite")
            if values.ndim == 1:
                before = np.array(self.values[name])
                check(np.array_equal(dataset[:old], before), f"{name}: values that were seen have changed")
                self.values[name].extend(values)
        self.seen = times
        return new - old


def check(condition, message):
    """Stops with the message unless the condition holds."""
    if not condition:
        sys.exit(f"FAILED: {message}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--idle", type=float, default=10.0, help="give up after so many seconds without news")
    parser.add_argument("--samples", type=int, default=1, help="samples that must be seen before the run ends")
    arguments = parser.parse_args()

    file = wait_for(arguments.file, arguments.idle)
    check(file.attrs["state"] == "running", f"state is {file.attrs['state']!r}: too late to follow")
    maps = [f"{body}/{name}" for body in ("disc", "pin") for name in file[body] if name != "base"]
    followers = [Follower(file, "time", [f"series/{name}" for name in file["series"]])]
    if "map_time" in file:
        followers.append(Follower(file, "map_time", maps))

    looks, news, ended = 0, time.monotonic(), False
    while not ended and time.monotonic() - news < arguments.idle:
        ended = not is_being_written(arguments.file)  # asked first, so that the last look sees everything
        found = [follower.look() for follower in followers]
        if any(found):
            looks += 1
            news = time.monotonic()
            print(", ".join(f"{follower.times.name}: {follower.seen.size}" for follower in followers))
        time.sleep(0.05)
    file.close()
    samples = followers[0].seen.size
    check(samples >= arguments.samples, f"{samples} samples seen, expected at least {arguments.samples}")
    print(f"ok: {samples} samples in {looks} looks; the run {'has ended' if ended else 'is idle'}")


if __name__ == "__main__":
    main()
