"""A brake in a drive: from what a vehicle's logger, a spreadsheet or a regulation has, to the cycle and the scene of one of its brakes."""

import inspect
import json
import math
import os
import re
import tempfile
import warnings
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError, PlateauWarning
from plateau.opened_runs import counted
from plateau.output_folder import followed, put_together, refuse_file
from plateau.program import call, listen
from plateau.text_tables import TextTable, read_text_table
from plateau.units import NUMBER, in_si, quantity

# What a table may have, with the SI unit and the usual one; the first two it must have, and at most one of the others.
COLUMNS = {
    "time": ("s", "s"),
    "road_speed": ("m s-1", "km/h"),
    "deceleration": ("m s-2", "m/s^2"),
    "brake_torque": ("N m", "N m"),
    "brake_pressure": ("Pa", "bar"),
}
# What vehicle and brake have, with the SI unit, and from what to what that is plausible, from a light motorcycle to a lorry.
RANGES = {
    "mass": ("kg", "200 kg", "44000 kg"),
    "wheel_radius": ("m", "150 mm", "600 mm"),
    "pad_area": ("m2", "10 cm^2", "300 cm^2"),
    "pad_thickness": ("m", "3 mm", "40 mm"),
    "effective_radius": ("m", "50 mm", "300 mm"),
    "disc_mass": ("kg", "2 kg", "60 kg"),
    "piston_area": ("m2", "3 cm^2", "150 cm^2"),
}
# As regulations head the speed of the vehicle.
ALSO = {"speed": "road_speed"}
CLOCK = re.compile(r"(\d+):([0-5]?\d):([0-5]?\d(?:[.,]\d+)?)")
CLOCKS = ("h:mm:ss", "hh:mm:ss")
# Pressure in the line, Pa, below which no pad is pressed: pistons move against their seals.
LEAST_PRESSURE = 5e4
# Acceleration that is taken where brakings of a second would allow none: their part of the wear is small.
LEAST_ACCELERATION = 3
# Torque by which a vehicle that stands is held, N m: it has no effect but that the pads touch.
HOLD = 100.0
# What short brakings last at most, s: in a drive few do, of a noisy speed most.
SHORT = 2.0

OF_DISC = "# <- 0: this coating does not wear; grey iron does, with a specific_wear_rate of its own"

SCENE = """
[operation.cycle]
file = {file}

[brake]                                 # masses and wear of the whole brake are counted for it
pad_area = {pad_area}
pad_thickness = {pad_thickness}
effective_radius = {effective_radius}
wheel_radius = {wheel_radius}
{piston}
[friction]
pressure_coefficient = 0.33
shear_strength = "0.75 MPa"
maximum = 0.6

[thermal]
ambient = "23 degC"

[thermal.disc]                          # area x thickness x density is the mass of the disc
conductivity = "50 W/(m K)"
density = "7200 kg/m^3"
specific_heat = "500 J/(kg K)"
area = "1010 cm^2"                      # <- of both faces
thickness = {thickness}
cooling = "9.3 W/K"                     # <- at rest
cooling_per_speed = "0.16 J/(K rad)"    # <- for each rad/s of the wheel

[thermal.pin]                           # both pads
conductivity = "1.5 W/(m K)"
density = "2600 kg/m^3"
specific_heat = "900 J/(kg K)"
area = {pads_area}
length = {pad_thickness}
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
    pad_area: float | str = "50 cm^2",
    pad_thickness: float | str = "12 mm",
    effective_radius: float | str = "115 mm",
    piston_area: float | str | None = None,
    disc_mass: float | str = "8 kg",
    force: bool = False,
) -> "Made":
    """Writes the cycle and the scene of a front brake of a vehicle in a drive.

    The brakes give what slows the vehicle down beyond its road load: from the deceleration, or from one row to the next,

        F_b = max(0, -m dv/dt - F_0 - F_1 v - F_2 v²),    T_b = s F_b r_w / 2,

    with the means of an interval between two rows, so that it has the energy of the vehicle. A table with the torque or the pressure of the
    brake needs none of this.

    Parameters
    ----------
    table : path
        Text with separators, or a workbook: a row for each moment, under headers with units in brackets. ``time`` (also h:mm:ss, from any
        time on) and ``road_speed``; and ``deceleration``, ``brake_torque`` or ``brake_pressure`` (in the line), if one of them is known.
    output : path
        The scene, ``NAME.toml``; the cycle is written beside it, as ``NAME-cycle.csv``.
    columns : mapping, optional
        Headers of the table by these names, where it has others: ``{"time": "Zeit", "road_speed": "Tempo [km/h]"}``. A unit is given in
        brackets where the table has none.
    mass : float or str
        Mass m of the vehicle, kg.
    road_load : three numbers
        Coefficients F_0, F_1 and F_2 in N, N/(km/h) and N/(km/h)², as a coast-down gives them.
    share : float
        Part s of the brake force that acts at the front axle.
    wheel_radius : float or str
        Rolling radius r_w, m.
    pad_area, pad_thickness : float or str
        Area and thickness of the friction material of one of the two pads, m² and m.
    effective_radius : float or str
        Radius at which the friction of the pads acts, m.
    piston_area : float or str, optional
        Area of the pistons that press one pad, m²; with a ``brake_pressure``, of which less than 0.5 bar is taken as none.
    disc_mass : float or str
        Mass of the disc, kg.
    force : bool
        Replace files that exist.

    Returns
    -------
    Made
        The scene, which is complete (lines with <- are to be looked at), and what was read.

    Warns
    -----
    PlateauWarning
        If the table has a gap, looks like noise, or can hardly be meant, such as by a wrong unit, or if an argument is not used.

    Raises
    ------
    InputError
        If the table cannot be read, or is no drive.
    """
    path = followed(Path(output))
    if path.suffix != ".toml":
        raise InputError(f"-o {path}: expected the name of a scene, such as brake.toml")
    of_cycle = path.with_name(f"{path.stem}-cycle.csv")
    for one in (path, of_cycle):
        refuse_file(one, force, (Path(table),), "name another scene with -o")
    given = {"mass": mass, "wheel_radius": wheel_radius, "pad_area": pad_area, "pad_thickness": pad_thickness}
    given |= {"effective_radius": effective_radius, "disc_mass": disc_mass}
    given |= {} if piston_area is None else {"piston_area": piston_area}
    size = {name: _size(name, said) for name, said in given.items()}
    if size["effective_radius"] >= size["wheel_radius"]:
        raise InputError(f"effective_radius: {effective_radius}, expected less than the wheel_radius of {wheel_radius}")
    if not 0.0 < share <= 1.0:
        raise InputError(f"share: {share:g}, expected more than 0 and at most 1, such as 0.7")
    if len(road_load) != 3 or not np.isfinite(road_load).all():
        raise InputError("road_load: expected three numbers")
    read = found = _read(Path(table), columns or {})
    held = ""
    if "brake_pressure" in found:
        if piston_area is None:
            raise InputError('a brake_pressure presses as the pistons are large: give the area of those of one pad, such as --piston-area "25 cm^2"')
        pressure = found["brake_pressure"]
        load, shown = (pressure * 1e-5).where(pressure >= LEAST_PRESSURE, 0.0), "brake_pressure [bar]"
    elif "brake_torque" in found:
        load, shown = found["brake_torque"], "brake_torque [N m]"
    else:
        if "deceleration" in found:
            found["force"] = _beyond_road(size["mass"], found["deceleration"], found["road_speed"], road_load)
        else:
            found = _intervals(found, size["mass"], road_load)
        load, shown = share * found["force"] * size["wheel_radius"] / 2.0, "brake_torque [N m]"
        stands = found["road_speed"].rolling(3, center=True, min_periods=1).max() == 0.0
        load = load.where(~stands, HOLD)
        held = f"; while the vehicle stands, {HOLD:g} N m hold it" if stands.any() else ""
    told, doubts = _told(read, found, load, shown)
    for name, value in size.items():
        _, least, most = RANGES[name]
        if not _size(name, least) <= value <= _size(name, most):
            doubts.append(f"{name} = {given[name]} is not from {least} to {most}: check its unit")
    if "force" not in found:
        # Only what is not the default is known to be given.
        of_vehicle = {"mass": mass, "road_load": tuple(road_load), "share": share}
        unused = [name for name, value in of_vehicle.items() if value != USUAL[name]]
        doubts += [f"no use is made of {' and '.join(unused)}: the table has the {shown.split(' [')[0]}"] if unused else []
    if piston_area is not None and "brake_pressure" not in found:
        doubts.append("no use is made of piston_area: the table has no brake_pressure")
    made = Made(str(path), str(of_cycle), told + held, doubts)
    for warned in made.warnings:
        warnings.warn(f"{table}: {warned}", PlateauWarning, stacklevel=2)
    lines = [f"time [s],road_speed [km/h],{shown}"]
    lines += [f"{time:.10g},{3.6 * speed:.6g},{value:.7g}" for time, speed, value in zip(found["time"], found["road_speed"], load, strict=True)]
    csv = ("\n".join(lines) + "\n").encode()

    def length(name: str, factor: float, unit: str) -> str:
        return _toml(f"{size[name] * factor:.6g} {unit}")

    piston = f"piston_area = {length('piston_area', 1e4, 'cm^2')}\n" if piston_area is not None else ""
    millimetres = {name: length(name, 1e3, "mm") for name in ("pad_thickness", "effective_radius", "wheel_radius")}
    areas = {"pad_area": length("pad_area", 1e4, "cm^2"), "pads_area": length("pad_area", 2e4, "cm^2")}
    thickness = _toml(f"{size['disc_mass'] / (7200.0 * 0.101) * 1e3:.3g} mm")
    tables = SCENE.format(file=_toml(of_cycle.name), piston=piston, thickness=thickness, **millimetres, **areas)
    put_together(path.parent, {of_cycle.name: csv, path.name: _scene(path, of_cycle, csv, tables, float(found["time"].iloc[-1])).encode()}, force)
    return made


# What is taken unless it is given.
USUAL = {name: parameter.default for name, parameter in inspect.signature(cycle).parameters.items()}


@dataclass(frozen=True)
class Made(os.PathLike[str]):
    """A scene that was made, and what was read for it; it can be used as the path of the scene."""

    path: str
    # The path of its cycle.
    cycle: str
    # Summary of what was read, in words.
    told: str
    warnings: list[str]

    def __fspath__(self) -> str:
        return self.path


def _told(read: pandas.DataFrame, found: pandas.DataFrame, load: "pandas.Series[float]", shown: str) -> tuple[str, list[str]]:
    """Summary of a table and of the load that is made of it, in words, and warnings of what in it can hardly be meant."""
    time, speed = read["time"].to_numpy(), read["road_speed"].to_numpy()
    spans = np.diff(time)
    way = float(np.sum(spans * (speed[1:] + speed[:-1]) / 2.0))
    slowing = (
        read["deceleration"].to_numpy() if "deceleration" in read else np.divide(-np.diff(speed), spans, out=np.zeros_like(spans), where=spans > 0)
    )
    moves = found["road_speed"] > 0.0
    brakes = ((load > 0.0) & moves).to_numpy()
    # First row of each braking, and the first one after it.
    brakings = np.flatnonzero(np.diff(brakes, prepend=False, append=False)).reshape(-1, 2)
    moments = found["time"].to_numpy()
    lasts = moments[np.minimum(brakings[:, 1], len(moments) - 1)] - moments[np.maximum(brakings[:, 0] - 1, 0)]
    short = [load.iloc[start:end].max() for start, end in brakings[lasts <= SHORT]]
    largest, unit = float(load.max()), shown.split("[")[1].rstrip("]")
    told = (
        f"{len(time)} rows, {time[-1]:g} s, {way / 1e3:.3g} km; at most {3.6 * speed.max():.3g} km/h, slows down by at most {slowing.max():.2g} m/s²"
    )
    told += f", at most {largest:.3g} {unit}; {counted(len(brakings), 'braking')}"
    warned = []
    usual = float(np.median(spans)) if len(spans) else 0.0
    wide = int(np.argmax(spans))
    if len(spans) > 4 and spans[wide] > 5.0 * usual > 0.0 and (speed[wide] > 0.0 or speed[wide + 1] > 0.0):
        rows = f"between the rows at {time[wide]:g} and {time[wide + 1]:g} s there are {spans[wide]:g} s"
        warned.append(f"{rows}, else about {usual:g} s: a straight line is taken")
    limits = [(3.6 * speed.max(), 300.0, "km/h"), (slowing.max(), 15.0, "m/s²"), (largest if unit == "bar" else 0.0, 250.0, "bar")]
    warned += [f"{value:.3g} {unit} is more than {most:g} {unit}: check the unit of the column" for value, most, unit in limits if value > most]
    if np.count_nonzero(brakes) > 0.7 * np.count_nonzero(moves):
        warned.append("the brake is on in most of the rows in which the vehicle moves: is that noise of a sensor?")
    if len(short) > max(len(brakings) / 4, 3):
        weak = sum(peak < 0.05 * largest for peak in short)
        source, of_load = next(name for name in reversed(COLUMNS) if name in read), shown.split(" [")[0]
        # Noise of a load has no negative part, so its mean is not 0.
        advice = f"set it to 0 in {source}" if source == of_load else f"smooth the {source} before, such as by a moving mean over some seconds"
        of_short = f"{len(short)} of {len(brakings)} brakings last {SHORT:g} s or less, {weak} of them below 5 % of the largest {of_load}"
        warned.append(f"{of_short}: if that is noise, {advice}")
    return told, warned


def _size(name: str, said: float | str) -> float:
    """A size of vehicle or brake, SI."""
    si, least, _ = RANGES[name]
    try:
        value = quantity(said, si, example=(USUAL[name] or least) if isinstance(said, str) else None)
    except InputError as error:
        raise type(error)(f"{name}: {error}") from None
    if not value > 0.0:
        raise InputError(f"{name}: expected more than 0")
    return value


def _toml(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _scene(path: Path, of_cycle: Path, csv: bytes, tables: str, duration: float) -> str:
    """Text of the scene, with a time acceleration from 3 to 100 that leaves every braking ten simulated revolutions, if one does."""
    with tempfile.TemporaryDirectory() as folder:
        made, cycle_made = Path(folder, path.name), Path(folder, of_cycle.name)
        listen(["-q", "new", made, "--duration", f"{duration:.10g} s"])
        # The cycle has load and speed.
        text = (
            re.sub(r"(?m)^(normal_force|sliding_speed|rotational_speed) = .*\n", "", made.read_text(encoding="utf-8")).replace(str(made), str(path))
            + tables
        )
        text = re.sub(r"(?m)^disc_primary = .*$", rf"\g<0>     {OF_DISC}", text)
        first = re.sub(r"(?m)^time_acceleration = .*$", "time_acceleration = 1", text)
        made.write_text(first, encoding="utf-8")
        cycle_made.write_bytes(csv)
        try:
            largest = call(["-q", "check", made])["cycle"]["largest_acceleration_without_warning"]
        except InputError as error:
            raise InputError(str(error).replace(str(made), str(path)).replace(str(cycle_made), str(of_cycle))) from None
        remark = (
            "every braking has ten simulated revolutions"
            if largest >= LEAST_ACCELERATION
            else "short brakings have less than ten simulated revolutions"
        )
        line = f"time_acceleration = {max(math.floor(min(largest, 100.0)), LEAST_ACCELERATION):<19} # 1 is the model itself; {remark}"
        return re.sub(r"(?m)^time_acceleration = .*$", line, text)


def _intervals(found: pandas.DataFrame, mass: float, road_load: Sequence[float]) -> pandas.DataFrame:
    """The table with the ends of its intervals, each with the mean force of the brakes in it, N: they have its energy for any spacing."""
    time, speed = (found[name].to_numpy() for name in ("time", "road_speed"))
    keep = np.flatnonzero(np.diff(time) > 0.0)
    spans, mean = np.diff(time)[keep], (speed[1:] + speed[:-1])[keep] / 2.0
    force = _beyond_road(mass, -np.diff(speed)[keep] / spans, mean, road_load)
    ends = {"time": np.ravel(np.column_stack([time[keep], time[keep + 1]])), "road_speed": np.ravel(np.column_stack([speed[keep], speed[keep + 1]]))}
    rows = pandas.DataFrame(ends | {"force": np.repeat(force, 2)})
    # Of two equal rows one suffices.
    return rows[(rows.diff() != 0.0).any(axis=1)].reset_index(drop=True)


def _beyond_road(mass: float, slowing: Any, speed: Any, road_load: Sequence[float]) -> Any:
    """Braking force of the vehicle beyond its road load, N, at least 0."""
    kmh = 3.6 * speed
    return np.maximum(mass * slowing - road_load[0] - road_load[1] * kmh - road_load[2] * kmh**2, 0.0)


def _read(path: Path, columns: Mapping[str, str]) -> pandas.DataFrame:
    """Columns of the table by name, SI, with times from 0."""
    if unknown := [name for name in columns if name not in COLUMNS]:
        raise InputError(f"column {unknown[0]!r} is unknown, expected some of {', '.join(COLUMNS)}")
    if path.suffix.lower() == ".xlsx":
        try:
            sheet = pandas.read_excel(path, dtype=str)
        except (OSError, ValueError, KeyError, ImportError, zipfile.BadZipFile) as error:
            raise InputError(f"{path}: cannot read it: {error}; save the sheet as CSV") from None
        cells = sheet.fillna("").to_numpy().tolist()
        table = TextTable(path, [str(head).strip() for head in sheet], cells, list(range(2, len(cells) + 2)))
    else:
        table = read_text_table(path)
    found = pandas.DataFrame(dict(_columns(table, columns)))
    steps = found["time"].diff()
    if steps.min() < 0.0:
        row = int(steps.idxmin())
        raise InputError(f"{table.place(row)}: its time is before that of the row above, expected times that do not go back, also at midnight")
    if not steps.max() > 0.0:
        raise InputError(f"{path}: expected two rows or more, with times that go on")
    found["time"] -= found["time"].iloc[0]
    return found


HEAD = re.compile(r"(.*?)\s*[\[(]([^\[(]*)[\])]\s*")


def _columns(table: TextTable, columns: Mapping[str, str]) -> Iterator[tuple[str, "pandas.Series[float]"]]:
    """Columns by name, SI."""
    parts = [found.groups() if (found := HEAD.fullmatch(head)) else (head, "") for head in table.heads]
    missing, loads = [], []
    for name in COLUMNS:
        wanted = columns.get(name, name)
        # The whole header first, then its name, then what else it is called.
        own = (found.groups() if (found := HEAD.fullmatch(wanted)) else (wanted, ""))[0]
        plain = [part[0].lower().replace(" ", "_") for part in parts]
        ways = [[head == wanted for head in table.heads], [part[0] == own for part in parts]]
        ways += [] if name in columns else [[one == name for one in plain], [ALSO.get(one) == name for one in plain]]
        same = next((which for way in ways if (which := [at for at, is_it in enumerate(way) if is_it])), [])
        if len(same) > 1:
            raise InputError(f'{table.path}: columns "{table.heads[same[0]]}" and "{table.heads[same[1]]}" are both {name}: give the whole header')
        if not same:
            missing += [name] if name in columns or name in ("time", "road_speed") else []
            continue
        told = found[2] if (found := HEAD.fullmatch(wanted)) else ""
        if told and parts[same[0]][1] and told != parts[same[0]][1]:
            raise InputError(f'{table.path}: column "{table.heads[same[0]]}" is in {parts[same[0]][1]}, not in {told}')
        unit = parts[same[0]][1] or told
        scale = _scale(table, same[0], name, unit)
        yield name, pandas.Series([_number(table, row, same[0], name, scale) for row in range(len(table.rows))], dtype=float)
        loads += [name] if name not in ("time", "road_speed") else []
    if missing:
        there = ", ".join(f'"{head}"' for head in table.heads)
        said = " and ".join(f'"{columns.get(name, name)}"' for name in missing)
        raise InputError(
            f"{table.path}: no column {said}; there are {there}: name {'it' if len(missing) == 1 else 'them'} by --column {missing[0]}=HEADER"
        )
    if len(loads) > 1:
        raise InputError(f"{table.path}: it has {' and '.join(loads)}, expected one of them: give the others another header")


def _scale(table: TextTable, column: int, name: str, unit: str) -> float:
    """Factor from the unit of a column to SI; NaN for times without a unit, which may be those of a clock."""
    if unit:
        return 1.0 if name == "time" and unit in CLOCKS else in_si(1.0, unit, COLUMNS[name][0])
    if name == "time":
        return math.nan
    raise InputError(f'{table.path}: "{table.heads[column]}" has no unit: give {_unit(table, column, name)}')


def _unit(table: TextTable, column: int, name: str) -> str:
    """Places where the unit of a column may stand, in words."""
    return f'one in brackets behind the header, in the file or as --column {name}="{table.heads[column]} [{COLUMNS[name][1]}]"'


def _number(table: TextTable, row: int, column: int, name: str, scale: float) -> float:
    """The value of a cell, SI."""
    cell = table.rows[row][column].replace("\N{MINUS SIGN}", "-")
    if name == "time" and (clock := CLOCK.fullmatch(cell)):
        return 3600.0 * int(clock[1]) + 60.0 * int(clock[2]) + float(clock[3].replace(",", "."))
    expected = f"h:mm:ss, or a number and for its unit {_unit(table, column, name)}" if math.isnan(scale) else "a number"
    if math.isnan(scale) or not re.fullmatch(NUMBER, cell) or not math.isfinite(float(cell)):
        raise InputError(f'{table.place(row)}: "{table.heads[column]}" is "{cell}", expected {expected}')
    if float(cell) < 0.0 and name != "deceleration":
        raise InputError(f'{table.place(row)}: "{table.heads[column]}" is {cell}, expected 0 or more')
    return float(cell) * scale
