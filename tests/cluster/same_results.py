"""Whether a study that was shared, killed and taken up again gives what an undisturbed one gives.

usage: same_results.py REFERENCE OTHER, two folders of collected studies
"""

import json
import sys
import zlib
from collections import Counter
from pathlib import Path

from content import content, differences

# What differs from one making of a run to the next, and from one build of a program to the next.
DATASET = "wall_time"
ATTRIBUTES = ["collected", "source_revision"]


def result(path: Path) -> dict[str, object]:
    """What a study gives."""
    found = content(path)
    for name in [DATASET, *(f"@{name}" for name in ATTRIBUTES)]:
        del found[name]
    return found


def records(folder: Path) -> list[str]:
    """The identities of all records of a journal that are whole."""
    identities = []
    for shard in folder.iterdir():
        for line in shard.read_bytes().splitlines():
            if len(line) > 9 and int(line[:8], 16) == zlib.crc32(line[9:]):
                identities.append(json.loads(line[9:])["identity"])
    return identities


def main() -> None:
    reference, other = (Path(argument) for argument in sys.argv[1:])
    tables = [(folder / "results.csv").read_bytes() for folder in (reference, other)]
    runs = len(tables[0].splitlines()) - 1
    assert runs > 0 and tables[0].count(b"finished") == runs, f"{reference} is not complete"
    assert tables[1] == tables[0], f"{other}/results.csv differs from that of {reference}"
    expected, found = (result(folder / "results.h5") for folder in (reference, other))
    different = differences(expected, found)
    assert not different, f"{other}/results.h5 differs from that of {reference}: {different}"
    made = records(other / "journal")
    twice = [identity for identity, count in Counter(made).items() if count > 1]
    assert not twice and len(made) == runs, f"{other}/journal: {len(made)} records of {runs} runs, {len(twice)} twice"
    print(f"{runs} runs, each made once; table and {len(found)} datasets and attributes equal to the last bit")


main()
