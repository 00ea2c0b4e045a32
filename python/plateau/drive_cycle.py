"""A brake in a drive: from what a vehicle's logger, a spreadsheet or a regulation has, to the cycle and the scene of one of its brakes."""

import itertools
import json
import math
import os
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.output_folder import followed, put_together, refuse_file
from plateau.program import call, listen
from plateau.units import in_si, quantity

# What a table may have, with the SI unit; the first two it must have, and at most one of the others.
COLUMNS = {"time": "s", "road_speed": "m s-1", "deceleration": "m s-2", "brake_torque": "N m", "brake_pressure": "Pa"}
# As regulations head the speed of the vehicle.
ALSO = {"speed": "road_speed"}
CLOCK = re.compile(r"(\d+):([0-5]?\d):([0-5]?\d(?:\.\d+)?)")
# Torque by which a vehicle that stands is held, N m: it has no effect but that the pads touch.
HOLD = 100.0

SCENE = """
[operation.cycle]
file = {file}

[brake]                                 # masses and wear of the whole brake are counted for it
pad_area = "50 cm^2"                    # <- friction material of one of the two pads
pad_thickness = "10 mm"                 # <- of it, that may wear
effective_radius = "115 mm"             # <- where the pads' friction acts
wheel_radius = {wheel_radius}
{piston}
[friction]
pressure_coefficient = 0.33
shear_strength = "0.75 MPa"
maximum = 0.6

[thermal]
ambient = "23 degC"

[thermal.disc]                          # <- area x thickness x density is the mass of the disc, here 8 kg
conductivity = "50 W/(m K)"
density = "7200 kg/m^3"
specific_heat = "500 J/(kg K)"
area = "1010 cm^2"
thickness = "11 mm"
cooling = "9.3 W/K"                     # <- at rest
cooling_per_speed = "0.16 J/(K rad)"    # <- for each rad/s of the wheel

[thermal.pin]                           # all pads
conductivity = "1.5 W/(m K)"
density = "2600 kg/m^3"
specific_heat = "900 J/(kg K)"
area = "100 cm^2"
length = "12 mm"
cooling = "2.5 W/K"

[emission]
pm10_fraction = 0.4                     # <- of the mass that leaves the brake
pm25_fraction = 0.15
number_per_mass = "1e15 1/kg"
pin_density = "2600 kg/m^3"
disc_density = "7200 kg/m^3"
"""


def cycle(
    table: str | os.PathLike[str],
    output: str | os.PathLike[str] = "brake.toml",
    *,
    columns: Mapping[str, str] | None = None,
    mass: float | str = "1500 kg",
    road_load: Sequence[float] = (130.0, 0.0, 0.0347),
    share: float = 0.7,
    wheel_radius: float | str = "310 mm",
    piston_area: float | str | None = None,
    force: bool = False,
) -> str:
    """Writes the cycle and the scene of a front brake of a vehicle in a drive.

    The brakes give what slows the vehicle down beyond its road load: from the deceleration, or from one row to the next,

        F_b = max(0, -m dv/dt - F_0 - F_1 v - F_2 v²),    T_b = s F_b r_w / 2,

    and a row has the mean of the T_b before and after it. A table with the torque or the pressure of the brake needs none of this.

    Parameters
    ----------
    table : path
        Text with separators, or a workbook: a row for each moment, under headers with units in brackets. ``time`` (also h:mm:ss, from any
        time on) and ``road_speed``; and ``deceleration``, ``brake_torque`` or ``brake_pressure`` (in the line), if one of them is known.
    output : path
        The scene; the cycle is written beside it, with the ending ``.csv``.
    columns : mapping, optional
        Headers of the table by these names, where it has others: ``{"time": "Zeit", "road_speed": "Tempo [km/h]"}``. A unit is given in
        brackets where the table has none.
    mass : float or str
        m of the vehicle, kg.
    road_load : three numbers
        F_0, F_1 and F_2 in N, N/(km/h) and N/(km/h)², as a coast-down gives them.
    share : float
        s, the front axle's part of the brake force.
    wheel_radius : float or str
        r_w, the rolling radius, m.
    piston_area : float or str, optional
        Of the pistons that press one pad, m²; with a ``brake_pressure``.
    force : bool
        Replace files that exist.

    Returns
    -------
    str
        The path of the scene, which is complete; lines with <- are to be looked at.

    Raises
    ------
    InputError
        If the table cannot be read, or is no drive.
    """
    path = followed(Path(output))
    if path.suffix != ".toml":
        raise InputError(f"-o {path}: expected the name of a scene, such as brake.toml")
    of_cycle = path.with_suffix(".csv")
    for one in (path, of_cycle):
        refuse_file(one, force, (Path(table),), "name another scene with -o")
    radius = quantity(wheel_radius, "m")
    found = _read(Path(table), columns or {})
    if "brake_pressure" in found:
        if piston_area is None:
            raise InputError("a brake_pressure presses as the pistons are large: give the area of those of one pad, such as piston_area 25 cm^2")
        load, shown = found["brake_pressure"] * 1e-5, "brake_pressure [bar]"
    elif "brake_torque" in found:
        load, shown = found["brake_torque"], "brake_torque [N m]"
    else:
        if not (len(road_load) == 3 and 0.0 < share <= 1.0 and radius > 0.0 and quantity(mass, "kg") > 0.0):
            raise InputError("expected a mass and a wheel radius above 0, three numbers as road load, and a share from 0 to 1")
        forces = _brake_force(found, quantity(mass, "kg"), road_load)
        load, shown = share * forces * radius / 2.0, "brake_torque [N m]"
        # One row beside it is still of a drive.
        moves = found["road_speed"].rolling(3, center=True, min_periods=1).max() > 0.0
        load = load.where(moves, HOLD)
    lines = [f"time [s],road_speed [km/h],{shown}"]
    lines += [f"{time:.10g},{3.6 * speed:.6g},{value:.7g}" for time, speed, value in zip(found["time"], found["road_speed"], load, strict=True)]
    csv = ("\n".join(lines) + "\n").encode()
    area = quantity(piston_area, "m2") if piston_area is not None else 0.0
    piston = f'piston_area = "{area * 1e4:.6g} cm^2"\n' if area else ""
    tables = SCENE.format(file=_toml(of_cycle.name), wheel_radius=_toml(f"{radius * 1e3:.6g} mm"), piston=piston)
    put_together(path.parent, {of_cycle.name: csv, path.name: _scene(path, csv, tables, float(found["time"].iloc[-1])).encode()}, force)
    return str(path)


def _toml(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _scene(path: Path, csv: bytes, tables: str, duration: float) -> str:
    """The scene, as large an acceleration in it as leaves every braking ten simulated revolutions."""
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder, path.name)
        listen(["-q", "new", made, "--duration", f"{duration:.10g} s"])
        # The cycle has load and speed.
        text = re.sub(r"(?m)^(normal_force|sliding_speed|rotational_speed) = .*\n", "", made.read_text(encoding="utf-8")).replace(str(made), str(path)) + tables
        first = re.sub(r"(?m)^time_acceleration = .*$", "time_acceleration = 1", text)
        made.write_text(first, encoding="utf-8")
        made.with_suffix(".csv").write_bytes(csv)
        largest = call(["-q", "check", made])["cycle"]["largest_acceleration_without_warning"]
        line = f"time_acceleration = {max(math.floor(min(largest, 100.0)), 1):<19} # so every braking has ten simulated revolutions; 1 is the model itself"
        return re.sub(r"(?m)^time_acceleration = .*$", line, text)


def _brake_force(found: pandas.DataFrame, mass: float, road_load: Sequence[float]) -> "pandas.Series[float]":
    """What the brakes of the vehicle give at every row, N."""
    time, speed = (found[name].to_numpy() for name in ("time", "road_speed"))

    def beyond_road(deceleration: Any, speed: Any) -> Any:
        kmh = 3.6 * speed
        return np.maximum(mass * deceleration - road_load[0] - road_load[1] * kmh - road_load[2] * kmh**2, 0.0)

    if "deceleration" in found:
        return beyond_road(found["deceleration"], found["road_speed"])
    span = np.diff(time)
    # Nothing brakes in a jump, nor before the first row and after the last.
    slope = np.divide(-np.diff(speed), span, out=np.zeros_like(span), where=span > 0.0)
    between = np.concatenate([[0.0], beyond_road(slope, (speed[1:] + speed[:-1]) / 2.0), [0.0]])
    return pandas.Series((between[1:] + between[:-1]) / 2.0, found.index)


def _read(path: Path, columns: Mapping[str, str]) -> pandas.DataFrame:
    """What the table has, by name, SI, from time 0."""
    unknown = [name for name in columns if name not in COLUMNS]
    if unknown:
        raise InputError(f"column {unknown[0]!r} is unknown, expected some of {', '.join(COLUMNS)}")
    try:
        if path.suffix.lower() in (".xlsx", ".ods", ".xls"):
            table = pandas.read_excel(path, dtype=str)
        else:
            text = path.read_bytes().decode("utf-8-sig", errors="replace")
            lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
            separator = max("\t;,", key=(lines or [""])[0].count)
            cells = [[cell.strip().strip('"') for cell in line.split(separator)] for line in lines]
            if len(cells) < 2 or any(len(row) != len(cells[0]) for row in cells):
                raise ValueError(f"expected a header and rows of as many fields, parted by {separator!r}")
            table = pandas.DataFrame(cells[1:], columns=cells[0])
            if separator != ",":
                table = table.map(lambda cell: cell.replace(",", "."))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot read it: {getattr(error, 'strerror', None) or error}") from error
    found = pandas.DataFrame(dict(_columns(path, table, columns)))
    if found["time"].diff().min() < 0.0:
        row = int(found["time"].diff().idxmin())
        raise InputError(f"{path}: row {row + 1}: its time is before that of the row above, expected times that do not go back")
    found["time"] -= found["time"].iloc[0]
    return found


def _columns(path: Path, table: pandas.DataFrame, columns: Mapping[str, str]) -> Iterator[tuple[str, "pandas.Series[float]"]]:
    """Columns by name, SI."""
    heads = {str(head): re.fullmatch(r"(.*?)\s*[\[(](.*)[\])]\s*", str(head)) for head in table}
    names = {head: (found[1].strip() if found else head.strip()) for head, found in heads.items()}
    loads = []
    for name, si in COLUMNS.items():
        wanted = re.fullmatch(r"(.*?)\s*(?:[\[(](.*)[\])])?\s*", columns.get(name, name))
        assert wanted is not None
        same = [head for head, own in names.items() if own == wanted[1] or name not in columns and ALSO.get(own.lower(), own.lower().replace(" ", "_")) == name]
        if not same:
            if name in columns or name in ("time", "road_speed"):
                there = ", ".join(f'"{head}"' for head in names)
                raise InputError(f'{path}: no column "{columns.get(name, name)}"; there are {there}: name it by --column {name}=HEADER')
            continue
        unit = (found[2] if (found := heads[same[0]]) else None) or wanted[2] or ""
        yield name, table[same[0]].map(lambda cell, name=name, unit=unit, si=si, head=same[0]: _number(path, head, str(cell), unit, si))
        loads += [name] if si not in ("s", "m s-1") else []
    if len(loads) > 1:
        raise InputError(f"{path}: it has {' and '.join(loads)}, expected one of them: name the others otherwise")


def _number(path: Path, head: str, cell: str, unit: str, si: str) -> float:
    """The value of a cell, SI."""
    clock = CLOCK.fullmatch(cell.strip()) if si == "s" else None
    try:
        if clock:
            return 3600.0 * int(clock[1]) + 60.0 * int(clock[2]) + float(clock[3])
        if not unit:
            raise InputError(f"it has no unit: give it in brackets behind the header, such as {head} [{si}]")
        value = in_si(str(float(cell)), unit, si)
    except ValueError as error:
        said = error if isinstance(error, InputError) else f'found "{cell}", expected a number'
        raise InputError(f"{path}: {head}: {said}") from None
    if value < 0.0 and si != "m s-2":
        raise InputError(f"{path}: {head}: found {cell}, expected 0 or more")
    return value
