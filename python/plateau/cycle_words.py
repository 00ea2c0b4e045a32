"""The word ``plateau cycle``: a thin layer on a function."""

import argparse
from pathlib import Path

from plateau.command_line import Words, of_all, options, several
from plateau.drive_cycle import COLUMNS, USUAL, cycle

# What there is to say of vehicle and brake.
SIZES = {
    "mass": "Of the vehicle; a choice, as all others",
    "share": "Part of the brake force on the front axle",
    "wheel_radius": "Rolling radius",
    "pad_area": "Friction material of one of the two pads",
    "pad_thickness": "Of it",
    "effective_radius": "Radius at which the friction of the pads acts",
    "disc_mass": "Of the disc",
    "piston_area": "Of the pistons that press one pad; with a brake_pressure",
}


def add(words: Words) -> None:
    """Adds the word to a parser."""
    about = "Make the cycle and the scene of a front brake from a drive of a vehicle: a logger's table, a workbook, a regulation's trace"
    made = words.word("cycle", about, _cycle, "  plateau cycle data/cycles/wltc-class3b.csv -o brake.toml\n  plateau run brake.toml")
    made.add_argument("table", metavar="TABLE", help=f"Columns with units in brackets: {', '.join(COLUMNS)}; time and road_speed suffice")
    about = f"Scene to write; the cycle is written beside it, as NAME-cycle.csv [default: {USUAL['output']}]"
    made.add_argument("-o", "--output", type=Path, default=Path(USUAL["output"]), metavar="SCENE", help=about)
    several(made, "--column", "NAME=HEADER", 'Header of a column in the table ("road_speed=Tempo [km/h]"); may be repeated')
    road = "N, N/(km/h) and N/(km/h)^2 [default: " + " ".join(f"{one:g}" for one in USUAL["road_load"]) + "]"
    made.add_argument("--road-load", nargs=3, type=float, default=USUAL["road_load"], metavar=("F0", "F1", "F2"), help=road)
    for name, what in SIZES.items():
        usual = "" if USUAL[name] is None else f" [default: {USUAL[name]}]"
        made.add_argument(f"--{name.replace('_', '-')}", type=type(USUAL[name] or ""), default=USUAL[name], help=f"{what}{usual}")
    of_all(made, "Replace files that exist")


def _cycle(given: argparse.Namespace) -> str:
    columns = dict(one.split("=", 1) if "=" in one else (one, one) for one in given.column)
    scene = cycle(given.table, given.output, columns=columns, **options(given, *SIZES, "road_load", "force"))
    written = f"wrote {scene.path} and {scene.cycle}"
    not_own = "not of your car: materials and friction (a cermet-coated disc), the disc's size but for its mass, its cooling (that of drive.toml)"
    return f"{scene.told}\n{written}\n{not_own}\nlook at the lines with <-, then\n  plateau check {scene.path}\n  plateau run {scene.path}\n"
