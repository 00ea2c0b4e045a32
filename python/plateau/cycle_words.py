"""The word ``plateau cycle``: a thin layer on a function."""

import argparse
from pathlib import Path

from plateau.command_line import Words, of_all, options, several
from plateau.drive_cycle import COLUMNS, cycle


def add(words: Words) -> None:
    """Adds the word to a parser."""
    about = "Make the cycle and the scene of a front brake from a drive of a vehicle: a logger's table, a workbook, a regulation's trace"
    made = words.word("cycle", about, _cycle, "  plateau cycle data/cycles/wltc-class3b.csv -o brake.toml\n  plateau run brake.toml")
    made.add_argument("table", metavar="TABLE", help=f"Columns with units in brackets: {', '.join(COLUMNS)}; time and road_speed suffice")
    made.add_argument("-o", "--output", type=Path, default=Path("brake.toml"), metavar="SCENE", help="Scene to write; the cycle is written beside it, with the ending .csv [default: brake.toml]")
    several(made, "--column", "NAME=HEADER", 'Header of a column in the table ("road_speed=Tempo [km/h]"); may be repeated')
    made.add_argument("--mass", default="1500 kg", help="Of the vehicle [default: 1500 kg, a choice as all others]")
    road = "N, N/(km/h) and N/(km/h)^2 [default: 130 0 0.0347]"
    made.add_argument("--road-load", nargs=3, type=float, default=(130.0, 0.0, 0.0347), metavar=("F0", "F1", "F2"), help=road)
    made.add_argument("--share", type=float, default=0.7, help="Part of the brake force on the front axle [default: 0.7]")
    made.add_argument("--wheel-radius", default="310 mm", help="Rolling radius [default: 310 mm]")
    made.add_argument("--pad-area", default="50 cm^2", help="Friction material of one of the two pads [default: 50 cm^2]")
    made.add_argument("--pad-thickness", default="12 mm", help="Of it [default: 12 mm]")
    made.add_argument("--effective-radius", default="115 mm", help="Radius at which the friction of the pads acts [default: 115 mm]")
    made.add_argument("--disc-mass", default="8 kg", help="[default: 8 kg]")
    made.add_argument("--piston-area", help="Of the pistons that press one pad; with a brake_pressure")
    of_all(made, "Replace files that exist")


def _cycle(given: argparse.Namespace) -> str:
    columns = dict(one.split("=", 1) if "=" in one else (one, one) for one in given.column)
    settings = options(given, "mass", "road_load", "share", "wheel_radius", "piston_area", "force")
    settings |= options(given, "pad_area", "pad_thickness", "effective_radius", "disc_mass")
    scene = cycle(given.table, given.output, columns=columns, **settings)
    path = Path(scene)
    return f"{scene.told}\nwrote {path} and {path.with_suffix('.csv').name}: look at the lines with <-, then\n  plateau check {path}\n  plateau run {path}\n"
