"""Answer of a fit: its keys and responses, and what is to be known before they are used."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.output_folder import plain
from plateau.study.calibration import ENDS, Outcome
from plateau.study.data import Answer, Factor, Numbers, Study
from plateau.study.figure_axes import dots, file_names, set_axis
from plateau.study.likelihood import SETTLED, Likelihood, Target, products, profile, region
from plateau.study.measured import Measurement
from plateau.study.settings import in_short, joined, not_smooth
from plateau.study.surrogate import missed_by
from plateau.style import LINES, NARROW, QUIET, WIDE, Figures, in_style, labelled, new
from plateau.text_tables import listed
from plateau.units import shown_unit, unit_for, with_minus

CHECKED = {
    "held": "the last runs, at the most likely place, agree with what was forecast there",
    "failed": "failed: runs at the most likely place contradict what was forecast there, so there is no interval",
    "none": "none: no runs were left for the most likely place",
}
# What else makes intervals shorter, by the end of the fit.
MORE = {
    "no gain": "all runs that [fit] allows besides would hardly lessen it: runs scatter too much. More sets of seeds in [replicates] lessen that.",
    "no runs": "more points in the design make the intervals shorter.",
}
OF_COMPONENTS = "uncertainties, of a component"


@dataclass(frozen=True, repr=False)
class Fit(Answer):
    """Answer of a fit: its keys and responses, in SI units.

    Attributes
    ----------
    study : Study
        Study as it was after the first runs.
    most : int
        Largest number of runs.
    runs : pandas.DataFrame
        Table of all runs.
    """

    study: Study
    target: Target
    outcome: Outcome
    confidence: float
    most: int
    runs: pandas.DataFrame

    @property
    def _likelihood(self) -> Likelihood:
        return self.outcome.likelihood

    @property
    def _threshold(self) -> float:
        return float(stats.chi2.ppf(self.confidence, 1))

    @cached_property
    def _profiles(self) -> list[tuple[Factor, Numbers, Numbers, list[tuple[float, float]]]]:
        return [(one, *profile(self._likelihood, at, self._threshold)) for at, one in enumerate(self.study.factors)]

    @property
    def _points(self) -> int:
        return len(np.unique(np.round(self._likelihood.runs.x, 9), axis=0))

    @cached_property
    def _intervals(self) -> list[tuple[Factor, float, list[dict[str, Any]]]]:
        """Each key with its most likely value, NaN where it may be anywhere or runs contradict the forecast, and the pieces of its interval."""
        found, has_failed, has_none = [], self.outcome.has_failed, bool(self.outcome.why_no_interval)
        for (factor, _, _, pieces), best in zip(self._profiles, self._likelihood.best, strict=True):
            likely = math.nan if has_failed or pieces == [(-1.0, 1.0)] else float(factor.value(best))
            ends = [(float(factor.value(low)), float(factor.value(high)), low == -1.0, high == 1.0) for low, high in pieces if not has_none]
            found.append((factor, likely, [{"low": low, "high": high, "open_below": below, "open_above": above} for low, high, below, above in ends]))
        return found

    @cached_property
    def keys(self) -> pandas.DataFrame:
        """A row for each piece of the interval of each key, with its ends; NaN where there is none, and why in ``cautions``, which are in short."""
        none = {"low": math.nan, "high": math.nan, "open_below": False, "open_above": False}
        rows = [(one.name, one.unit, likely, piece) for one, likely, pieces in self._intervals for piece in pieces or [none]]
        table = pandas.DataFrame([{"key": name, "unit": unit, "most_likely": likely, **piece} for name, unit, likely, piece in rows])
        return table.assign(cautions=joined([self.outcome.why_no_interval, in_short(said.removesuffix(".") for said in self.cautions)]))

    @property
    def profiles(self) -> pandas.DataFrame:
        """Rise of -2 ln L where a key is held at a value, and the threshold of its interval."""
        parts = [pandas.DataFrame({"key": one.name, "value": one.value(at), "rise": rises}) for one, at, rises, _ in self._profiles]
        return pandas.concat(parts, ignore_index=True).assign(threshold=self._threshold)

    @cached_property
    def _terms(self) -> pandas.DataFrame:
        """Forecast of each term at the most likely place and its deviations, by its measurement."""
        likelihood = self._likelihood
        processes = [term.process for term in likelihood.terms]
        means, own, seeds = (each[0] for each in likelihood.moments(likelihood.best[None]))
        sets = np.array([one.seeds if one.seeds > 1 else math.nan for one in processes])
        columns = {"forecast": means, "surrogate_deviation": np.sqrt(own), "seeds_deviation": np.sqrt(seeds)}
        columns |= {"seed_to_seed": np.sqrt([one.run_variance for one in processes] + seeds * sets)}
        columns |= {"apart": likelihood.apart(), "leave_one_out_error": [float(np.sqrt(np.square(one.loo[0]).mean())) for one in processes]}
        return pandas.DataFrame(columns, index=[term.of for term in likelihood.terms])

    @cached_property
    def responses(self) -> pandas.DataFrame:
        """Single values at the most likely place; ``surrogate_deviation`` is for want of runs, ``seeds_deviation`` for want of seeds, ``apart``
        the forecast less the measurement over all deviations.
        """
        singles, columns = self.target.singles, ["response", "unit", "measured", "uncertainty"]
        measured = [self.target.measured[at] for at in singles]
        rows = [(one.response.name, one.response.unit, one.values[0], one.uncertainties[0]) for one in measured]
        table = pandas.DataFrame(rows, columns=columns, index=singles).join(self._terms)
        return table.assign(discrepancy=abs(table["measured"] * [self.target.discrepancies[at] for at in singles]))

    @cached_property
    def series(self) -> pandas.DataFrame:
        """Measured series beside what is forecast at the most likely place, by time."""
        parts = [pandas.DataFrame(columns=["response"])]
        for at, components in self._likelihood.components.items():
            one, terms, seen = self.target.measured[at], self._terms.loc[[at]], components.root @ components.basis
            columns = {"response": one.response.name, "unit": one.response.unit, "time": one.times, "measured": one.values}
            columns |= {"uncertainty": one.uncertainties, "forecast": components.root @ components.mean + seen @ terms["forecast"].to_numpy()}
            variances = np.square(terms[["surrogate_deviation", "seeds_deviation"]]).sum(axis=1).to_numpy()
            parts.append(pandas.DataFrame(columns | {"forecast_deviation": np.sqrt(np.square(seen) @ variances)}))
        return pandas.concat(parts[len(parts) > 1 :], ignore_index=True)

    @property
    def checks(self) -> pandas.DataFrame:
        """Runs at most likely places against what was forecast there, for each response (a series as its components)."""
        parts = []
        for number, check in enumerate(self.outcome.checks, 1):
            keys = {one.name: float(one.value(at)) for one, at in zip(self.study.factors, check["place"], strict=True)}
            of = [self.target.measured[at] for at in check["of"]]
            names, units = zip(*((one.response.name, OF_COMPONENTS if one.is_series else one.response.unit) for one in of), strict=True)
            numbers = {name: check[name] for name in ("forecast", "deviation", "runs", "held")}
            parts.append(pandas.DataFrame({"check": number, **keys, "response": names, "unit": units, **numbers}))
        return pandas.concat(parts, ignore_index=True) if parts else pandas.DataFrame()

    @cached_property
    def misfit(self) -> float:
        """Squares of forecast less measured over the variances of measurement, stated discrepancy and seeds."""
        return float(self._likelihood.misfit(self._likelihood.best[None], with_processes=False)[0])

    @property
    def p(self) -> float:
        """Probability of a larger misfit; NaN without degrees of freedom."""
        return self._likelihood.p() if self._likelihood.freedom else math.nan

    @property
    def tables(self) -> dict[str, pandas.DataFrame]:
        """Tables by the names of their files."""
        found = {"keys.csv": self.keys, "responses.csv": self.responses, "profiles.csv": self.profiles, "runs.csv": self.runs}
        return found | {name: table for name, table in {"series.csv": self.series, "checks.csv": self.checks}.items() if len(table)}

    @cached_property
    def determined(self) -> str | None:
        """Products of keys that are determined where the keys are not, or far better than they are; None where there is nothing to say."""
        factors, best = self.study.factors, self._likelihood.best
        ends = np.array([factor.ends for factor in factors])
        if self.outcome.why_no_interval or (ends <= 0.0).any():
            return None
        halves = 0.5 * np.log(ends[:, 1] / ends[:, 0])
        values = np.array([float(factor.value(at)) for factor, at in zip(factors, best, strict=True)])
        by_log = np.where([factor.logarithmic for factor in factors], 1.0 / halves, 2.0 * values / (ends[:, 1] - ends[:, 0]))
        found, better = products(self._likelihood.slopes(best) * (by_log * halves), halves, self._threshold)

        def words(row: Numbers, times: float) -> str:
            order = sorted(np.flatnonzero(row).tolist(), key=lambda at: (row[at] != 1.0, at))
            powers = [(factors[at], round(float(row[at]), 4), values[at]) for at in order]
            name = " × ".join(factor.name if power == 1.0 else with_minus(f"{factor.name}^{power:g}") for factor, power, _ in powers)
            value = math.prod(float(factor.in_study_unit(value)) ** power for factor, power, value in powers)
            units = " and ".join(shown_unit(factor.study_unit) for factor, _, _ in powers if factor.study_unit)
            return f"{name} = {value:.4g} ({value / times:.4g} … {value * times:.4g}{', with ' + units if units else ''})"

        said = f"{' and '.join(words(*one) for one in found or better)} {'is' if len(found or better) == 1 else 'are'}"
        if found is None:
            return f"{said} known far better than the keys in it, near the most likely values." if better else None
        if not found:
            is_closed = (~self.keys["open_below"] & ~self.keys["open_above"]).any()
            return None if is_closed else "Near the most likely values these data determine none of the keys."
        if all(np.count_nonzero(row) < 2 for row, _ in found):
            return None
        return f"Only {said} determined by these data, near the most likely values."

    @cached_property
    def cautions(self) -> list[str]:
        """Cautions to read before intervals are used: a sentence each."""
        said, outcome, measured, freedom = list[str](), self.outcome, self.target.measured, self._likelihood.freedom
        if outcome.has_failed:
            check = outcome.checks[-1]
            places = zip(self.study.factors, check["place"], strict=True)
            where = ", ".join(f"{factor.name} = {factor.shown(float(factor.value(at)), 4)}" for factor, at in places)
            worst = check["of"][int(np.nanargmax(np.abs(check["runs"] - check["forecast"]) / check["deviation"]))]
            what = f"most in {measured[worst].response.name}, and no runs were left to find another place"
            said.append(f"Runs at the most likely place contradict the forecast ({where}), {what}; more runs in [fit] go on from here.")
        elif not outcome.checks:
            what = "the forecast there is not checked"
            if outcome.ended != "no runs":
                what = f"there is no interval; [fit] runs = {(self._points + 1) * self.study.seeds} allows them"
            said.append(f"No runs were made at the most likely place, so {what}.")
        # What little is known of responses is no reason.
        if self.p < 0.05 and self._likelihood.p(with_processes=True) < 0.05:
            test = f"misfit χ² = {self.misfit:.3g} with {_degrees(freedom)}, p = {self.p:.2g}"
            said.append(f"No values within these ranges give all that was measured: {test}. [fit] discrepancy lets the model be off.")
        if self.study.seeds < 2 and outcome.ended != "no runs":
            said.append("With one set of surfaces intervals may be too short; [replicates] with several tells what differs between them.")
        elif self.study.seeds == 2 and outcome.ended != "no runs":
            said.append("Two sets of seeds hardly tell what differs between sets, so intervals may be too short: take three or more.")
        for at, one in enumerate(measured):
            name, terms, uncertainty = one.response.name, self._terms.loc[[at]], 1.0 if one.is_series else one.uncertainties[0]
            # Of a series all components together, as far as the measurement can see them.
            missed = missed_by([term.process for term in self._likelihood.terms if term.of == at])
            said += [f"{caution}." for caution in not_smooth(missed, f"Points of {name}")]
            if terms["seed_to_seed"].max() > uncertainty:
                scatter = f"Runs with other seeds scatter in {name} by more than the uncertainty of the measurement"
                said.append(f"{scatter}; if specimens do so, too, add it to the uncertainty, unless a mean of many was measured.")
            if terms["seeds_deviation"].max() > 0.5 * uncertainty:
                known = f"The mean of {name} over the seeds is known no better than to half the uncertainty of the measurement"
                said.append(f"{known}: more seeds in [replicates] make the intervals shorter.")
        for row in self.responses.to_dict("records") if not freedom else ():
            if abs(row["apart"]) > 2.0:
                away = f"{row['response']} of the runs is {abs(row['apart']):.1f} deviations away at the most likely ones"
                said.append(f"No values within these ranges give what was measured: {away}.")
        for at, components in self._likelihood.components.items():
            said += _alike(measured[at], components.measured - components.mean - components.basis @ self._terms.loc[[at], "forecast"].to_numpy())
        shares = self._likelihood.share_by_term()
        if shares.max() > SETTLED and not outcome.why_no_interval:
            part = f"{100.0 * shares.max():.0f} % of" if shares.max() < 2.0 else f"{shares.max():.2g} times"
            name = measured[self._likelihood.terms[int(shares.argmax())].of].response.name
            more = MORE.get(outcome.ended, "more runs in [fit] make the intervals shorter.")
            said.append(f"Near the most likely values the variance of the forecasts is up to {part} that of the measurement of {name}; {more}")
        return said

    def document(self, files: Sequence[str] = ()) -> dict[str, Any]:
        """The JSON of ``plateau fit --json``; None where there is no number."""
        keys = []
        for factor, likely, pieces in self._intervals:
            is_open = len(pieces) == 1 and pieces[0]["open_below"] and pieces[0]["open_above"]
            about = {"name": factor.name, "keys": factor.keys.split(", "), "unit": factor.unit, "most_likely": likely}
            keys.append({**about, "interval": pieces, "undetermined": is_open})
        responses = self.responses.rename(columns={"response": "name"}).to_dict("records")
        found: dict[str, Any] = {"study": self.study.title, "keys": keys, "responses": responses, "confidence": self.confidence}
        found |= {"misfit": self.misfit, "degrees_of_freedom": self._likelihood.freedom, "p": self.p}
        found |= {"determined": self.determined, "notes": self.cautions, "runs": len(self._likelihood.runs.x), "runs_at_most": self.most}
        found |= {"rounds": self.outcome.rounds, "ended": self.outcome.ended, "check": self.outcome.check}
        found |= {"surrogate_share": float(self._likelihood.share_by_term().max())}
        return dict(plain(found | {"checks": self.checks.to_dict("records"), "files": list(files)}))

    def text(self) -> str:
        """The text that ``plateau fit`` prints."""
        keys, responses, level = [], [], f"{100.0 * self.confidence:g} % interval"
        for factor, likely, pieces in self._intervals:
            ends = " or ".join(_interval(factor, piece) for piece in pieces) or f"none: {self.outcome.why_no_interval}"
            keys.append({"key": factor.name, "most likely": factor.shown(likely, 4) if math.isfinite(likely) else "–", level: ends})
        for row in self.responses.to_dict("records"):
            unit = unit_for(row["unit"], max(abs(row["measured"]), abs(row["forecast"])))
            deviation, scatter = math.hypot(row["surrogate_deviation"], row["seeds_deviation"]), row["seed_to_seed"]
            cells = {"response": row["response"], "measured": unit.text(row["measured"], row["uncertainty"])}
            cells |= {"forecast": unit.text(row["forecast"], deviation)}
            cells |= {"seed to seed": f"{scatter * unit.per_si:.2g} {unit.symbol}".strip() if math.isfinite(scatter) else "not known"}
            responses.append(cells | {"apart": f"{row['apart']:.1f} deviations".replace("-0.0", "0.0")})
        lines = ["Keys", *listed(keys)]
        lines += ["", "Responses at the most likely values", *listed(responses)] if responses else []
        said = [*filter(None, [self.determined]), *self.cautions]
        lines += ["", "To be known", *(f"  {line}" for line in said)] if said else []
        runs, first, freedom = self._likelihood.runs, int(self.study.runs["point"].nunique()), self._likelihood.freedom
        each = f", {self.study.seeds} seeds each" if self.study.seeds > 1 else ""
        made = f"{len(runs.x)} of at most {max(self.most, len(runs.x))}: {first} points of the design and {self._points - first} more{each}"
        left, ended = self.most - len(runs.x), ENDS[self.outcome.ended]
        if self.outcome.ended == "budget" and left >= self.study.seeds:
            ended = f"the other {left} were kept in case the last had contradicted the forecast"
        test = f" with {_degrees(freedom)}, p = {self.p:.2g}"
        test = test if freedom else "; there are no more measurements than keys, so a small misfit says nothing"
        stated = [(one.response.name, size) for one, size in zip(self.target.measured, self.target.discrepancies, strict=True) if size]
        model = f"standard uncertainty of the model: {', '.join(f'{100.0 * size:.3g} % in {name}' for name, size in stated)}"
        model = model if stated else "taken for exact; [fit] discrepancy = 0.05 gives it an uncertainty of 5 %"
        check = "none: no runs are made" if self.outcome.ended == "no runs" else CHECKED[self.outcome.check]
        summary = [f"  runs     {made}; {ended}", f"  check    {check}", f"  misfit   χ² = {self.misfit:.3g}{test}"]
        return with_minus("\n".join([*lines, "", self.study.title, *summary, f"  model    {model}"]))

    @in_style
    def figures(self) -> Figures:
        """Draws profiles of the keys, regions of their pairs, and series beside what was measured."""
        factors, level = {factor.name: factor for factor in self.study.factors}, f"{100 * self.confidence:g} %"
        columns = min(len(factors), 3)
        caption = f"How far −2 ln L rises where a key is held at a value, the others at their most likely ones; shaded: {level} interval"
        rows, note = -(-len(factors) // columns), f"Dashed: threshold of the {level} interval, which is shaded"
        figure, axes = new(WIDE if columns > 1 else NARROW, 14 + 50 * rows, caption, rows, columns, note, sharey=True)
        for axis, (name, own) in zip(axes.flat, self.profiles.groupby("key", sort=False), strict=False):
            factor, threshold = factors[str(name)], float(own["threshold"].iloc[0])
            axis.plot(factor.in_study_unit(own["value"]), own["rise"], color=LINES[0])
            axis.axhline(threshold, color=QUIET, linestyle="--", linewidth=0.8)
            for ends in self.keys.loc[self.keys["key"] == name, ["low", "high"]].dropna().to_numpy():
                axis.axvspan(*factor.in_study_unit(ends), color=LINES[0], alpha=0.15, linewidth=0)
            axis.set_ylim(-0.05 * threshold, 3.0 * threshold)
            set_axis(axis, factor)
        for axis in axes.flat[len(factors) :]:
            axis.set_axis_off()
        for axis in axes[:, 0]:
            axis.set_ylabel("rise of −2 ln L")
        figures: Figures = {"profiles": figure}
        for (one, x), (other, y) in itertools.combinations(enumerate(self.study.factors), 2):
            across, along, rises = region(self._likelihood, one, other)
            shaded = f"{level} region; " if not self.outcome.why_no_interval else ""
            note = f"Shaded: {shaded}dots: runs" if shaded else "Dots: runs"
            figure, ((axis,),) = new(NARROW, 76, f"Where {x.name} and {y.name} may be: {shaded}dots: runs", note=note)
            if shaded:
                threshold, at = float(stats.chi2.ppf(self.confidence, 2)), (x.in_study_unit(x.value(across)), y.in_study_unit(y.value(along)))
                axis.contourf(*at, rises, [-1.0, threshold], colors=[LINES[0]], alpha=0.2)
                axis.contour(*at, rises, [threshold], colors=[LINES[0]], linewidths=1.0)
            dots(axis, x, y, self.runs, size=3.0)
            set_axis(axis, x)
            set_axis(axis, y, "y")
            figures[f"region-{'-'.join(file_names([x.name, y.name]))}"] = figure
        measured = dict(list(self.series.groupby("response", sort=False)))
        for (name, rows), stem in zip(measured.items(), file_names(list(map(str, measured))), strict=True):
            unit, time = unit_for(rows["unit"].iloc[0], float(rows["measured"].abs().max())), unit_for("s", float(rows["time"].max()))
            caption = f"{name}: measured, and forecast at the most likely values; bars: one standard deviation"
            figure, ((axis,),) = new(NARROW, 66, caption, note="Forecast: at the most likely values; bars: one standard deviation")
            # Forecasts are for the measured times alone: no line says what is between them.
            told: dict[str, tuple[str, str, dict[str, Any]]] = {
                "measured": ("measured", "uncertainty", {"fmt": "o", "color": "black", "ms": 4.0, "mfc": "white", "elinewidth": 0.6, "capsize": 2}),
                "forecast": ("forecast", "forecast_deviation", {"fmt": "s", "color": LINES[0], "ms": 2.5, "elinewidth": 1.4, "zorder": 3}),
            }
            for label, (middle, half, style) in told.items():
                values = unit.value(rows[middle].to_numpy()), unit.per_si * rows[half].to_numpy()
                axis.errorbar(time.value(rows["time"].to_numpy()), *values, label=label, **style)
            axis.set(xlabel=labelled("time", time.symbol), ylabel=labelled(str(name), unit.symbol))
            figure.legend(loc="outside upper left", ncols=2)
            figures[f"series-{stem}"] = figure
        return figures


def _degrees(count: int) -> str:
    return f"{count} {'degree' if count == 1 else 'degrees'} of freedom"


def _interval(factor: Factor, piece: dict[Any, Any]) -> str:
    low, high = factor.shown(piece["low"], 4), factor.shown(piece["high"], 4)
    bare = factor.shown(piece["low"], 4, with_unit=False)
    if piece["open_below"]:
        everywhere = f"not determined by these data: anywhere from {bare} to {high}"
        return everywhere if piece["open_above"] else f"up to {high}; the data set no lower limit"
    return f"from {low} on; the data set no upper limit" if piece["open_above"] else f"{bare} … {high}"


def _alike(one: Measurement, away: Numbers) -> list[str]:
    """Caution if successive points of a series deviate alike: `away` should be independent and of deviation 1."""
    alike = float((away[1:] * away[:-1]).sum() / max((away**2).sum(), 1e-300))
    if len(away) < 8 or alike <= 2.0 / math.sqrt(len(away)):
        return []
    time = -float(np.median(np.diff(one.times))) / math.log(min(alike, 0.99))
    advice = "a longer correlation_time" if one.correlation_time else f'correlation_time = "{time:.2g} s"'
    said = f"Successive points of {one.response.name} deviate alike (correlation {alike:.2g}), and the intervals are too short"
    return [f"{said}: the errors of the measurement need {advice} in its [[response]], or the runs cannot follow the series."]
