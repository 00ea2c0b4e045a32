"""Draw the crates of revisions one under another: a room for each crate on top of those it depends on, folders and files by their lines.

usage: .venv/bin/python scripts/structure.py FILE.png REVISION ...
"""

import sys
import tomllib
from collections import defaultdict
from pathlib import PurePosixPath

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from size import contents, git, lines_of

#: Lines of a crate that is as wide as a panel.
WIDEST = 40_000
FLOOR_HEIGHT = 0.7


def rooms(revision: str) -> dict[str, dict[str, list[int]]]:
    """Return the lines of each file without its tests, by crate and folder of `src`."""
    found: dict[str, dict[str, list[int]]] = defaultdict(lambda: defaultdict(list))
    for path, text in contents(revision).items():
        parts = PurePosixPath(path).parts
        if path.endswith(".rs") and parts[0] == "crates" and parts[2] == "src":
            folder = parts[3] if len(parts) > 4 else "(top)"
            found[parts[1]][folder].append(lines_of(text, False)["lines"])
    return found


def dependencies(revision: str, crates: set[str]) -> dict[str, set[str]]:
    """Return the crates of the workspace that each crate depends on."""
    manifests = {crate: tomllib.loads(git("show", f"{revision}:crates/{crate}/Cargo.toml").decode()) for crate in crates}
    return {crate: {name.removeprefix("plateau-") for name in manifest["dependencies"]} & crates for crate, manifest in manifests.items()}


def draw(axes: Axes, revision: str) -> None:
    """Draw one revision."""
    found = rooms(revision)
    below = dependencies(revision, set(found))
    sizes = {crate: sum(map(sum, folders.values())) for crate, folders in found.items()}

    def floor(crate: str) -> int:
        return 1 + max((floor(other) for other in below[crate]), default=-1)

    centres: dict[str, float] = {}
    for level in range(1 + max(map(floor, found))):
        on_floor = sorted((crate for crate in found if floor(crate) == level), key=lambda crate: -sizes[crate])
        left = 0.0
        for crate in on_floor:
            start = left
            for folder, files in sorted(found[crate].items(), key=lambda item: -sum(item[1])):
                width = sum(files) / WIDEST
                axes.add_patch(_box(left, level, width, FLOOR_HEIGHT, "0.93", 0.8))
                foot = float(level)
                for lines in sorted(files, reverse=True)[:-1]:
                    foot += FLOOR_HEIGHT * lines / sum(files)
                    axes.plot([left, left + width], [foot, foot], color="0.6", linewidth=0.3)
                if width > 0.018:
                    axes.text(left + width / 2, level + FLOOR_HEIGHT / 2, folder, rotation=90, ha="center", va="center", fontsize=6)
                left += width
            axes.add_patch(_box(start, level, left - start, FLOOR_HEIGHT, "none", 1.5))
            words = f"{crate}: {sizes[crate]} lines, {sum(map(len, found[crate].values()))} files"
            axes.text(start, level + FLOOR_HEIGHT + 0.05, words, fontsize=7, fontweight="bold")
            centres[crate] = (start + left) / 2
            left += max(0.05, 0.22 - (left - start))
    for crate, others in below.items():
        # What another dependency brings anyhow would hide the picture.
        for other in sorted(others - set().union(*(below[between] for between in others))):
            ends = (centres[other], floor(other) + FLOOR_HEIGHT), (centres[crate], floor(crate))
            axes.annotate("", *ends, arrowprops={"arrowstyle": "->", "color": "tab:blue"})
    axes.set(xlim=(0, 1), ylim=(-0.05, 4.05), title=f"{revision}: {sum(sizes.values())} lines of Rust without tests")
    axes.axis("off")


def _box(left: float, foot: float, width: float, height: float, colour: str, line: float) -> Rectangle:
    return Rectangle((left, foot), width, height, facecolor=colour, edgecolor="black", linewidth=line)


def main() -> None:
    """Draw the revisions that the command line names."""
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    path, *revisions = sys.argv[1:]
    figure = Figure(figsize=(9, 4 * len(revisions)), layout="constrained")
    for axes, revision in zip(figure.subplots(len(revisions), squeeze=False)[:, 0], revisions, strict=True):
        draw(axes, revision)
    figure.savefig(path, dpi=130)


if __name__ == "__main__":
    main()
