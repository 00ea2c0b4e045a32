"""Comparison of scenes, the same seeds in all: differences of each response with intervals; a study of scenes that are given one by one."""

import math
import os
import re
import tomllib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau import html_page
from plateau.errors import InputError, PlateauWarning
from plateau.figures.series import PART, pulses, weighted
from plateau.output_folder import plain
from plateau.program import call, file_name
from plateau.quantities import series_of
from plateau.run_accessor import TOTALS
from plateau.scenes import scene_of
from plateau.study.data import Answer, Numbers, Response, Study
from plateau.study.runs import finished, write_study
from plateau.study.settings import each_of
from plateau.style import NARROW, QUIET, Figures, in_style, labelled, look, new, wrapped
from plateau.text_tables import listed
from plateau.toml_text import toml_of
from plateau.units import Unit, quantity, unit_for, unit_of, with_digits, with_minus

# What is compared unless asked otherwise: name, dataset with question, table of the scene without which there is no such series.
USUAL = [("contact area", "contact_area:mean", ""), ("running-in time", "contact_area:reaches 0.9", "")]
USUAL += [("filled fraction", "filled_fraction:end", ""), ("secondary on the pin", "pin_secondary:mean", "")]
USUAL += [("worn off the pin", "worn_whole_pin:end", ""), ("worn off the disc", "worn_disc:end", ""), ("emitted", "emitted:end", "")]
USUAL += [("friction coefficient", "friction_coefficient:mean", "friction"), ("temperature of the contact", "contact_temperature:mean", "thermal")]
USUAL += [("PM10", "pm10_mass:end", "emission")]
# What is asked of a series of which a response names no question: as above, else of totals, and of what is divided by one, the end.
QUESTIONS = {series: question for series, _, question in (asked.partition(":") for _, asked, _ in reversed(USUAL))}
NOTE = (
    "Differences are means over pairs of runs with the same seed, with t intervals ({level}); with more than two scenes, intervals and "
    "sureness hold for all differences of a response together (Bonferroni). Sure at: 1 − p, the confidence up to which the interval leaves out 0."
)
# Part by which cells of meshes for one purpose differ at most.
SAME_CELLS = 0.05
# Surfaces, and where it is said how they are extended.
SURFACES = {"disc.surface": "disc.prepare", "pin.base": "pin.base", "pin.surface": "pin.prepare"}


@dataclass(frozen=True, repr=False)
class Comparison(Answer):
    """Scenes side by side, numbers in SI units.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each response and each scene but the first, the reference: ``runs`` (pairs), ``difference`` to the reference, its interval ``low``,
        ``high``, ``p``, ``sureness`` (1 - p, the confidence up to which the interval leaves out 0); ``ratio`` of geometric means, ``ratio_low``,
        ``ratio_high``; ``words``; ``cautions``.
    means : pandas.DataFrame
        A row for each response and scene: ``runs``, ``mean``, ``deviation`` (standard deviation of a run).
    runs : pandas.DataFrame
        A row for each run: ``scene``, ``seed`` (0 of a scene without seeds), responses.
    curves : pandas.DataFrame
        Series against ``time``: ``mean`` and ``deviation`` over the seeds, and ``difference``, ``low``, ``high`` at each time alone; where runs
        pulse, of weighted means over a ``window``, s.
    scenes : dict
        Names and files; the first is the reference.
    titles : dict
        Names and what figures call the scenes: their titles, if these differ.
    confidence : float
        Confidence of the intervals.
    cautions : list of str
    directory : Path
        Folder in which runs are kept.
    """

    table: pandas.DataFrame
    means: pandas.DataFrame
    runs: pandas.DataFrame
    curves: pandas.DataFrame
    scenes: dict[str, str]
    titles: dict[str, str]
    confidence: float
    cautions: list[str]
    directory: Path

    @property
    def title(self) -> str:
        """Names of the scenes, the reference last."""
        first, *others = self.scenes
        return f"{', '.join(others)} against {first}"

    def shown(self) -> pandas.DataFrame:
        """The table for people."""
        both = self.means.merge(self.table.drop(columns=["runs", "unit"]), "left", on=["response", "scene"], sort=False)
        lines = []
        for _, row in both.iterrows():
            of = unit_for(row["unit"], float(self.means.loc[self.means["response"] == row["response"], "mean"].abs().max()))
            line = {name: row[name] for name in ("response", "scene", "runs")}
            line["mean ± of a run"] = of.text(row["mean"], row["deviation"])
            if np.isfinite(row["difference"]):
                line["difference"] = of.text(row["difference"], 0.5 * (row["high"] - row["low"]), is_difference=True)
                line |= {"ratio": _ratio(row), "sure at": _sure(row["sureness"])}
            lines.append(line)
        return pandas.DataFrame(lines).fillna("")

    def said(self) -> list[str]:
        """The differences in words, and what to know before they are used."""
        return [*self.table["words"], *(f"caution: {caution}" for caution in self.cautions)]

    def text(self) -> str:
        """The text that ``plateau compare`` prints."""
        lines = listed(self.shown().astype(str).to_dict("records"))
        return with_minus("\n".join([self.title, *lines, *(f"  {words}" for words in self.said()), ""]))

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau compare --json``; None where there is no number."""
        tables = {"differences": self.table, "means": self.means, "runs": self.runs}
        rows = {name: plain(table.to_dict("records")) for name, table in tables.items()}
        scenes = [{"name": name, "file": file} for name, file in self.scenes.items()]
        return {"scenes": scenes, "reference": scenes[0]["name"], "confidence": self.confidence, **rows, "cautions": self.cautions}

    @in_style
    def figures(self) -> Figures:
        """Draws each series against time, mean with the standard deviation of runs, and below it the differences with their intervals."""
        figures: Figures = {}
        reference = next(iter(self.titles.values()))
        for series, curves in self.curves.groupby("series", sort=False):
            known, of_time, window = (
                series_of(str(series), curves["unit"].iloc[0], curves["mean"]),
                unit_of("s", curves["time"]),
                curves["window"].iloc[0],
            )
            name, unit = known.title, known.unit
            level = f"{100 * self.confidence:g} %"
            caption = f"{name} against time: means over the seeds with the standard deviation of runs, and differences with {level} intervals"
            note = f"Bands: standard deviation of runs; below, {level} interval of the difference from {reference} at each time alone"
            note += f"; lines: weighted means over {of_time.per_si * window:.3g} {of_time.symbol}, as runs pulse" if window else ""
            figure, axes = new(NARROW, 92, caption, 2, 1, note, sharex=True, height_ratios=[2, 1])
            top, below = axes[:, 0]
            for number, (scene, curve) in enumerate(curves.groupby("scene", sort=False)):
                style, time = look(number), of_time.value(curve["time"])
                band = {"color": style["color"], "alpha": 0.18, "linewidth": 0}
                middle, half = unit.value(curve["mean"].to_numpy()), unit.per_si * curve["deviation"].fillna(0.0).to_numpy()
                change, low, high = (unit.per_si * curve[end].to_numpy() for end in ("difference", "low", "high"))
                top.plot(time, middle, label=wrapped(self.titles[str(scene)], 30), **style)
                top.fill_between(time, middle - half, middle + half, **band)
                below.plot(time, change, **style)
                below.fill_between(time, low, high, **band)
            # Titles of series are longer than the axis.
            top.set(title=wrapped(name, 46), ylabel=labelled("mean", unit.symbol))
            below.set(xlabel=labelled("time", of_time.symbol), ylabel=labelled("difference", unit.of_differences.replace("%", "points")))
            below.axhline(0.0, color=QUIET, linewidth=0.6)
            figure.legend(*top.get_legend_handles_labels(), loc="outside upper left", ncols=2, columnspacing=1.0)
            figure.align_ylabels()
            figures[str(series)] = figure
        return figures

    def page(self, figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
        """The page of ``plateau compare`` with figures and their files."""
        scenes = html_page.table(["scene", "file"], list(map(list, self.scenes.items())), "words")
        shown, note = self.shown(), f'<p class="quiet">{escape(NOTE.format(level=f"{100 * self.confidence:g} %"))}</p>'
        numbers, drawings = html_page.table(list(shown), shown.to_numpy().tolist()), html_page.pictures(figures, files)
        return html_page.page(self.title, scenes, html_page.listed(self.said()), numbers, note, drawings)


def compare(
    scenes: Sequence[str | os.PathLike[str]], seeds: int = 5, *, responses: Sequence[str] = (), set: Mapping[str, Any] | Sequence[str] = (),
    output: str | os.PathLike[str] = "comparison", confidence: float = 0.95,
    jobs: int | None = None, workers: int | None = None, progress: bool | None = None,
) -> Comparison:  # fmt: skip
    """Runs scenes with the same seeds and compares their responses; runs that exist are not made again.

    Parameters
    ----------
    scenes : sequence of path
        Two or more scenes; the first one is the reference.
    seeds : int
        Number of sets of surfaces, 1, 2, ...; all synthetic surfaces of a scene have the same seed.
    responses : sequence of str
        Each ``DATASET`` or ``DATASET:QUESTION``, such as ``"worn_pin:end"``, ``"contact_area:mean 10 s..20 s"``, ``"contact_area:reaches 0.8"``,
        ``"pin_primary:100 s"``, ``"/event/temperature:last"``; without a question the mean over the last tenth of the run, of totals and of the
        filled fraction the end. By default what usually matters.
    set : mapping or sequence of str
        Changes of all scenes, as for ``plateau.run``.
    output : path
        Folder in which the runs are kept.
    confidence : float
        Confidence of intervals.
    jobs, workers, progress : optional
        See ``plateau.sweep``.

    Returns
    -------
    Comparison
    """
    files = [Path(file_name(scene, "a scene")) for scene in scenes]
    if len(files) < 2:
        raise InputError(f"compare: found {len(files)}, expected two scenes or more")
    if seeds < 1 or not 0.0 < confidence < 1.0:
        raise InputError("compare: expected one seed or more, and a confidence between 0 and 1")
    stems = [file.stem for file in files]
    names = [stem if stems.count(stem) == 1 else f"{stem}-{number}" for number, stem in enumerate(stems, 1)]
    changes = [f"{key}={toml_of(value)}" for key, value in set.items()] if isinstance(set, Mapping) else list(set)
    flags = [text for change in changes for text in ("--set", change)]
    with warnings.catch_warnings(action="ignore", category=PlateauWarning):
        # They are given when the scenes are run.
        resolved = [tomllib.loads(call(["check", file, *flags])["scene"]) for file in files]
    usual = [(name, asked) for name, asked, needs in USUAL if not needs or all(needs in scene for scene in resolved)]
    tables = [response_of(name, asked) for name, asked in ([("", asked) for asked in responses] or usual)]
    directory, made, cautions = Path(output), {}, []
    for name, file, scene in zip(names, files, resolved, strict=True):
        keys = _seed_keys(scene)
        fixed = _fixed(scene)
        if not keys:
            cautions.append(f"{name} has no synthetic surface and so no seeds: it is one run, and no interval says how other specimens scatter")
        elif fixed:
            cautions.append(f"{name}: {', '.join(fixed)} is the same in all runs, so intervals say nothing of other specimens of it")
        # A title is no part of what a run is known by.
        study: dict[str, Any] = {"title": scene["title"], "base": os.path.abspath(file), "set": changes, "directory": "."}
        study |= {"order": "standard", "file": "seeds.csv", "factor": [{"name": "seed", "key": keys or "title"}], "response": tables}
        path = directory / name / "study.toml"
        write_study(path, study, pandas.DataFrame({"seed": range(1, seeds + 1) if keys else ["none"]}))
        with warnings.catch_warnings(record=True, action="always", category=PlateauWarning) as said:
            made[name] = finished(path, progress, jobs=jobs, workers=workers)
        for one in said:
            warnings.warn(f"{name}: {one.message}", one.category, stacklevel=2)
    if len({scene["operation"].get("duration") for scene in resolved}) > 1:
        cautions.append("the scenes have different durations, so values at the end are at different times")
    cells = [
        (quantity(mesh["outer_radius"], "m") - quantity(mesh["inner_radius"], "m")) / mesh["rows"] for scene in resolved for mesh in [scene["mesh"]]
    ]
    if np.ptp(cells) > SAME_CELLS * min(cells):
        sizes = ", ".join(f"{name} {1e6 * cell:.3g} µm" for name, cell in zip(names, cells, strict=True))
        cautions.append(f"the scenes have rows of different height ({sizes}), and results depend on the size of cells: give all the same")
    if len({*(accelerations := [str(scene["numerics"]["time_acceleration"]) for scene in resolved])}) > 1:
        cautions.append(f"the scenes have different time accelerations ({', '.join(accelerations)}), which shift pulses: give all the same")
    return _compared(made, dict(zip(names, map(str, files), strict=True)), confidence, cautions, directory, not responses)


def _compared(made: dict[str, Study], scenes: dict[str, str], confidence: float, cautions: list[str], directory: Path, are_usual: bool) -> Comparison:
    seeds = {scene: study.runs["seed"] if study.factors[0].is_number else [0] for scene, study in made.items()}
    runs = {scene: study.runs.set_index(pandas.Index(seeds[scene], name="seed", dtype=int)) for scene, study in made.items()}
    most = max(runs.values(), key=len).index
    # The one run of a scene without seeds stands beside all of the others.
    pairs = {scene: own.reindex(most, method="nearest") for scene, own in runs.items()}
    first, *others = made
    asked = [one for one in made[first].responses if not are_usual or any((own[one.name] != 0.0).any() for own in runs.values())]
    rows, means, general = [], [], [*cautions]
    for response in asked:
        name, common = response.name, {"response": response.name, "unit": response.unit}
        unit = unit_of(response.unit, [own[name].mean() for own in runs.values()])
        for scene, own in runs.items():
            values = own[name].dropna()
            means.append({**common, "scene": scene, "runs": len(values), "mean": values.mean(), "deviation": values.std()})
        for scene in others:
            pair = pandas.DataFrame({0: pairs[first][name], 1: pairs[scene][name]}).dropna()
            to_know = [*general]
            if len(pair) < len(most):
                late = "; runs that have not run in lack it, so that it is biased: make them longer" if name == "running-in time" else ""
                cautions.append(f"{scene}: {name} has a value in {len(pair)} of {len(most)} pairs of runs{late}")
                to_know.append(cautions[-1])
            found = difference(pair[0], pair[1], confidence, len(others))
            told = {"words": _words(f"{scene}: {name}", unit, found, confidence), "cautions": "; ".join(to_know)}
            rows.append({**common, "scene": scene, **found, **told})
    every = pandas.concat(runs, names=["scene"])[[one.name for one in asked]].reset_index()
    titles = {scene: study.title for scene, study in made.items()}
    titles = titles if len({*titles.values()}) == len(titles) else {scene: scene for scene in made}
    curves = _curves(made, asked, confidence)
    return Comparison(pandas.DataFrame(rows), pandas.DataFrame(means), every, curves, scenes, titles, confidence, cautions, directory)


def difference(reference: Any, other: Any, confidence: float = 0.95, comparisons: int = 1) -> dict[str, float]:
    """The mean difference of paired values and their ratio, with t intervals; of several comparisons together by Bonferroni."""
    one, two = np.asarray(reference, float), np.asarray(other, float)
    mean, low, high, p = _mean(two - one, confidence, comparisons)
    has_ratio = bool((one > 0.0).all() and (two > 0.0).all())
    ratios = np.exp(_mean(np.log(two / one), confidence, comparisons)[:3]).tolist() if has_ratio else [np.nan] * 3
    found = {"runs": len(one), "difference": mean, "low": low, "high": high, "p": p, "sureness": 1.0 - p}
    return found | dict(zip(("ratio", "ratio_low", "ratio_high"), ratios, strict=True))


def _mean(values: Numbers, confidence: float, comparisons: int) -> tuple[float, float, float, float]:
    """Mean, ends of its interval, p."""
    mean = float(values.mean()) if len(values) else np.nan
    if len(values) < 2:
        return mean, np.nan, np.nan, np.nan
    # What differs by rounding alone is the same.
    if np.ptp(values) <= 1e-14 * np.abs(values).max():
        return mean, mean, mean, float(mean == 0.0)
    test = stats.ttest_1samp(values, 0.0)
    low, high = test.confidence_interval(1.0 - (1.0 - confidence) / comparisons)
    return mean, float(low), float(high), min(1.0, comparisons * float(test.pvalue))


def _words(of: str, unit: Unit, found: dict[str, float], confidence: float) -> str:
    """A difference in a sentence."""
    change, half = found["difference"], 0.5 * (found["high"] - found["low"])
    if not np.isfinite(change):
        return f"{of} has no value in any pair of runs"
    if not np.isfinite(half):
        return f"{of} differs by {unit.text(change, is_difference=True)}; a single pair of runs does not say how sure that is"
    if found["low"] <= 0.0 <= found["high"]:
        return f"{of}: no sure difference, {unit.text(change, half, is_difference=True)} ({100 * confidence:g} %)"
    more = "larger" if change > 0.0 else "smaller"
    if of.endswith(": running-in time"):
        of, more = of.removesuffix(": running-in time") + " runs in", "more slowly" if change > 0.0 else "faster"
    # Where its own interval is less sure than that of the difference, it would only confuse.
    ratio = f", {_ratio(found)} times" if found["ratio_low"] > 1.0 or found["ratio_high"] < 1.0 else ""
    is_ = "" if of.endswith(" runs in") else " is"
    return (
        f"{of}{is_} {more} by {unit.text(abs(change), half, is_difference=True)} ({100 * confidence:g} %){ratio}, sure at {_sure(found['sureness'])}"
    )


def _sure(sureness: float) -> str:
    # Rounded down, so that nothing below the confidence looks as if it had come there.
    return "–" if not np.isfinite(sureness) else "more than 99.9 %" if sureness > 0.999 else f"{math.floor(round(1e3 * sureness, 6)) / 10:.1f} %"


def _ratio(row: Any) -> str:
    if not np.isfinite(row["ratio"]):
        return "–"
    # The interval is one of logarithms.
    half = 0.5 * math.log(row["ratio_high"] / row["ratio_low"])
    ratio, low, high = (with_digits(row[name], half * row[name]) for name in ("ratio", "ratio_low", "ratio_high"))
    return f"{ratio} ({low} … {high})" if low else ratio


# Columns of the curves.
ENDS = ["difference", "low", "high"]


def _curves(made: dict[str, Study], asked: Sequence[Response], confidence: float) -> pandas.DataFrame:
    first, parts = next(iter(made)), []
    has_cycle = any("normal_force" in study.data for study in made.values())
    # The contact area of single steps pulses.
    for name in dict.fromkeys("contact_area_mean" if one.series == "contact_area" else one.series for one in asked):
        data = {scene: study.data[name] for scene, study in made.items() if name in study.data and "time" in study.data[name].dims}
        runs = {scene: pandas.DataFrame(values.transpose("time", "run").values, values["time"].values) for scene, values in data.items()}
        unit = next((values.attrs.get("units", "1") for values in data.values()), "1")
        # As in figures of runs: pulses of runs drift apart; temperatures have peaks that nothing may take away.
        is_wavy = unit != "K" and not has_cycle and any(pulses(run) for lines in runs.values() for run in lines.to_numpy().T)
        window = PART * max(float(np.ptp(lines.index)) for lines in runs.values()) if is_wavy else 0.0
        runs = {scene: weighted(lines, window, float(np.ptp(lines.index))) for scene, lines in runs.items()}
        for scene, lines in runs.items():
            part = pandas.DataFrame({"mean": lines.mean(axis=1), "deviation": lines.std(axis=1), **dict.fromkeys(ENDS, np.nan)})
            reference = runs.get(first)
            if scene != first and reference is not None and (lines.shape[1] == reference.shape[1] or 1 in (lines.shape[1], reference.shape[1])):
                # Its samples may be at other times.
                others = [np.interp(lines.index, reference.index, run, left=np.nan, right=np.nan) for run in reference.to_numpy().T]
                change = pandas.DataFrame(lines.to_numpy() - np.transpose(others), lines.index)
                middle, half = change.mean(axis=1), stats.t.ppf(0.5 + confidence / 2.0, change.count(axis=1) - 1) * change.sem(axis=1)
                part[ENDS] = np.transpose([middle, middle - half, middle + half])
            parts.append(part.rename_axis("time").reset_index().assign(series=name, unit=unit, scene=scene, window=window))
    return pandas.concat(parts, ignore_index=True) if parts else pandas.DataFrame(columns=["series", "scene"])


def _seed_keys(scene: Mapping[str, Any]) -> list[str]:
    """Keys of a resolved scene that are seeds: of synthetic surfaces, and of those that are extended by their statistics."""
    return [key for key, _ in _leaves(scene) if key.endswith((".synthetic.seed", ".extend_seed"))]


def _fixed(scene: Mapping[str, Any]) -> list[str]:
    """Surfaces of a resolved scene that are the same with all seeds; of one that is extended by its statistics, the patch."""
    paths = [path for path, _ in _leaves(scene)]

    def has(place: str) -> bool:
        return any(path.startswith(place) for path in paths)

    found = {name: extended for name, extended in SURFACES.items() if has(f"{name}.") and not has(f"{name}.synthetic.")}
    return [f"{'the patch of ' if has(f'{extended}.extend_seed') else ''}{name}" for name, extended in found.items()]


def response_of(name: str, asked: str) -> dict[str, Any]:
    """The table of a response in a study file."""
    dataset, _, question = (part.strip() for part in asked.partition(":"))
    dataset = dataset if dataset.startswith("/") else f"/series/{dataset}"
    series = dataset.removeprefix("/series/")
    if not question and not dataset.startswith("/event"):
        is_at_end = series in TOTALS or series.endswith("_per_distance") or series == "pad_life"
        question = QUESTIONS.get(series) or ("end" if is_at_end else "mean")
    word, _, rest = question.partition(" ")
    name = name or re.sub(r"^/series/|^/", "", asked).replace("_", " ").replace(":", ", ").replace("/", " ")
    table: dict[str, Any] = {"name": name, "dataset": dataset}
    if dataset.startswith("/event"):
        return table | {"event": int(question) if question.isdigit() else question or "mean"}
    if word == "mean":
        return table | {"mean": [part.strip() for part in rest.split("..")] if rest else "last tenth"}
    if word == "reaches":
        if re.fullmatch(r"|0?\.\d+", rest) is None:
            raise InputError(f'--response "{asked}": expected a fraction, such as reaches 0.9')
        return table | {"reaches": float(rest or 0.9)}
    return table | {"at": question}


# What tells scenes apart and is no factor.
NAMES = {"title", "output.file"}


def of_scenes(
    scenes: Sequence[Any], directory: str | os.PathLike[str], responses: str | Sequence[str] = "contact_area:mean", *, force: bool = False
) -> Path:
    """Writes a study file whose runs are these scenes; ``plateau.sweep`` makes them.

    Parameters
    ----------
    scenes : sequence
        Two or more, each as for `Scene`, of the same parts of the model. A key in which they differ is a factor, with the name of the key.
    directory : path
        Folder of the study, which has the file ``study.toml`` then.
    responses : str or sequence of str
        Responses as for `compare`: ``"contact_area:mean"``, ``"worn_pin:end"``.
    force : bool
        Write the files of a study that is there anew; its results stay.

    Returns
    -------
    Path
        The study file.

    Raises
    ------
    InputError
        If the scenes do not differ, or a factor would have no single value in each of them, or there is a study in the folder.
    """
    made = [scene_of(scene, {}, 2) for scene in scenes]
    values = [dict(_leaves(scene.tables)) for scene in made]
    keys = sorted(set().union(*values) - NAMES)
    factors = [key for key in keys if any(one.get(key) != values[0].get(key) for one in values)]
    if not factors:
        raise InputError(f"{len(scenes)} scenes that do not differ: expected two or more, with other values of a key")
    for key in factors:
        if any(isinstance(one.get(key), list | type(None)) for one in values):
            raise InputError(f"{key}: the scenes differ in it, and it is a list or not in all of them, so it is no factor")
    path = Path(directory) / "study.toml"
    if path.exists() and not force:
        raise InputError(f"{path} exists: take another folder, or force=True to write its files anew")
    asked = [response_of("", one) for one in each_of(responses)]
    study: dict[str, Any] = {"title": str(values[0]["title"]), "base": "scene.toml", "directory": ".", "file": "points.csv"}
    study |= {"factor": [{"name": key, "key": key} for key in factors], "response": asked}
    texts = [{key: str(one[key]).lower() if isinstance(one[key], bool) else str(one[key]) for key in factors} for one in values]
    write_study(path, study, pandas.DataFrame(texts))
    path.with_name("scene.toml").write_text(made[0].toml, encoding="utf-8")
    return path


def _leaves(table: Mapping[str, Any], above: str = "") -> Any:
    """Paths of keys and their values."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{above}{name}.")
        else:
            yield f"{above}{name}", value
