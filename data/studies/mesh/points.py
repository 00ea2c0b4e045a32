"""Write the points of the mesh study: with a transport length (`length.csv`), with a strength of the build-up, too (`strength.csv`), and
with the plain rule (`cell.csv`)."""

import csv
from pathlib import Path

FOLDER = Path(__file__).parent
HEIGHTS = (1, 0.1, 0.01)
#: Columns of the disc and of the pin: cells of 100, 50, 25 and 12.5 um along the sliding direction.
MESHES = ((346, 20), (692, 40), (1384, 80), (2768, 160))
FINEST = 2768
SETS = range(1, 11)
#: Sets with the finest mesh, and with rows of half the size.
FEW_SETS = range(1, 4)
COMMON = ["surfaces", "heights", "disc columns", "pin columns", "rows", "time acceleration"]


def points(meshes, sets, rows=20, acceleration=100):
    """Yield the common columns of the three discs on each set and mesh."""
    for disc, pin in meshes:
        for number in FEW_SETS if disc == FINEST else sets:
            for height in HEIGHTS:
                file = f"surfaces/set-{number}-columns-{disc}-rows-{rows}.h5"
                yield [file, height, disc, pin, rows, acceleration]


def write(name, columns, lines):
    """Write a table."""
    with (FOLDER / name).open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(lines)


def main() -> None:
    """Write the tables."""
    lines = []
    for length in ("200 um", "150 um", "100 um"):
        lines += [[*point, length] for point in points(MESHES, SETS)]
    lines += [[*point, "200 um"] for point in points(MESHES[1:3], FEW_SETS, rows=40)]
    lines += [[*point, "200 um"] for point in points(MESHES[1:2], [1], acceleration=1)]
    write("length.csv", [*COMMON, "transport length"], lines)
    lines = [*points(MESHES[1:], SETS), *points(MESHES[1:2], [1], acceleration=1)]
    write("strength.csv", COMMON, lines)
    write("cell.csv", COMMON, points(MESHES[:3], SETS))


if __name__ == "__main__":
    main()
