"""Fit to an experiment: which values of keys make runs give what was measured, how well that is known, and whether runs there agree."""

import itertools
import math
import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.errors import InputError, PlateauWarning, RunFailed
from plateau.program import call
from plateau.study.likelihood import NEAR, SETTLED, Likelihood, Runs, Target
from plateau.study.measured import measurements
from plateau.study.results import Factor, Numbers, Study, analysed
from plateau.study.runs import finished, made_study
from plateau.study.units import unit_for

# Points before the next fit; points that are kept for the most likely place; rounds without a gain after which none is expected.
AT_A_TIME, RESERVE, PATIENCE = 4, 2, 3
# Confidence of the check of a forecast, and by how much -2 ln L may be above the least at a place that runs have checked.
CHECK, SAME = 0.99, 1.0
# Places of a profile, and along each key of a region: without other keys, and where each place is a search.
PLACES, SIDES = 41, (41, 15)
# Exponents of products below this are none; how many times as well as its leading key a product is known that is told beside the keys.
EXPONENT, BETTER = 0.05, 3.0
ENDS = {
    "settled": "further runs are expected to change little",
    "budget": "the limit of runs in [fit] is reached",
    "nowhere else": "every place that counts was run",
    "no gain": "more would hardly help, for runs scatter too much",
    "no runs": "what is fitted was imported, and no runs are made",
}


@dataclass(frozen=True)
class Outcome:
    """The last fit and how it came about.

    Attributes
    ----------
    likelihood : Likelihood
    rounds : int
        Fits that were made one after the other.
    ended : str
        Why no more runs were made; one of `ENDS`.
    checks : list of dict
        Runs at most likely places: place, forecasts and runs of each term, and whether they agreed.
    """

    likelihood: Likelihood
    rounds: int
    ended: str
    checks: list[dict[str, Any]]

    @property
    def has_failed(self) -> bool:
        """Whether runs contradict the forecast at the most likely place."""
        return bool(self.checks) and not self.checks[-1]["held"]


def calibrated(target: Target, runs: Runs, make: Callable[[Numbers], Runs], seeds: int, most: int, can_run: Sequence[bool]) -> Outcome:
    """Makes runs where they teach most, and the last of them at the most likely place; where these contradict, all is fitted again.

    Parameters
    ----------
    target : Target
    runs : Runs
        Of the study's design.
    make : callable
        Makes runs at coded places, with all seeds.
    seeds, most : int
        Runs at a place, and in all.
    can_run : sequence of bool
        For each measurement, whether runs give it.

    Returns
    -------
    Outcome
    """
    shares, checks, ended = list[float](), list[dict[str, Any]](), ""
    asked = np.array([])
    for rounds in itertools.count(1):
        likelihood = Likelihood(target, runs)
        asked = np.array([can_run[term.of] for term in likelihood.terms])
        if checks:
            # What the runs say themselves: the place that they were made at is still the most likely one, or nearly.
            last = checks[-1]
            last["rise"] = float(likelihood.rise(last["place"])[0])
            last["held"] = last["held"] and last["rise"] <= SAME
            if last["held"]:
                return Outcome(likelihood, rounds, ended, checks)
        left = (most - len(runs.x)) // seeds if asked.any() else 0
        free = left - min(RESERVE, left)
        places, then = likelihood.next_places(min(AT_A_TIME, free), seeds, can_run)
        share = float(likelihood.share_by_term()[asked].max()) if asked.any() else 0.0
        if not asked.any():
            ended = "no runs"
        elif share <= SETTLED:
            ended = "settled"
        elif not free:
            ended = "budget"
        elif not len(places):
            ended = "nowhere else"
        elif _has_no_gain([*shares, share], likelihood.next_places(min(free, 24), seeds, can_run)[1]):
            ended = "no gain"
        else:
            shares.append(share)
            runs = runs.with_more(make(places))
            continue
        place = likelihood.snapped(likelihood.best)
        known = np.abs(runs.x - place).max(axis=1) < 1e-9
        if asked.any() and known.any():
            checks.append(_check(likelihood, place, asked, None))
            if checks[-1]["held"]:
                checks[-1]["rise"] = float(likelihood.rise(place)[0])
                return Outcome(likelihood, rounds, ended, checks)
            # The same runs would tell the same: others beside it are made.
            places = likelihood.next_places(min(1, left), seeds, can_run)[0]
            if not len(places):
                return Outcome(likelihood, rounds, ended, checks)
            runs = runs.with_more(make(places))
            checks.pop()
            continue
        if not left:
            return Outcome(likelihood, rounds, ended, checks)
        more = make(place[None])
        checks.append(_check(likelihood, place, asked, more))
        runs = runs.with_more(more)
        shares.clear()
    raise RunFailed("the fit did not end")


def _has_no_gain(shares: Sequence[float], then: float) -> bool:
    """Whether runs are not expected to shorten an interval by more than what a settled fit leaves, or have not for some rounds."""

    def gains(before: float, after: float) -> bool:
        return 1.0 + before > (1.0 + SETTLED) * (1.0 + after)

    if then <= SETTLED:
        return False
    rounds = len(shares) - PATIENCE
    return not gains(shares[-1], then) or rounds > 0 and not gains(min(shares[:rounds]), min(shares[rounds:]))


def _check(likelihood: Likelihood, place: Numbers, asked: Any, more: Runs | None) -> dict[str, Any]:
    """What was forecast at a place against what runs give there; against the runs left out where there are some already."""
    means, own, _ = (each[0] for each in likelihood.moments(place[None]))
    processes = [term.process for term in likelihood.terms]
    if more is None:
        at = [int(np.abs(process.points - place).max(axis=1).argmin()) for process in processes]
        errors, deviations = (np.array([process.loo()[which][one] for process, one in zip(processes, at, strict=True)]) for which in (0, 1))
        found, variances = np.array([process.means[one] for process, one in zip(processes, at, strict=True)]), deviations**2
        means = found - errors
    else:
        found = np.nanmean(likelihood.of_runs(more), axis=0)
        variances = own + np.array([process.run_variance for process in processes]) / len(more.x)
    # What is small against the measurement does not count.
    squares = (found - means) ** 2 / (variances + SETTLED * np.diag(likelihood.covariance))
    told = asked & np.isfinite(squares)
    held = told.any() and bool(squares[told].sum() <= stats.chi2.ppf(CHECK, told.sum()))
    return {"place": place, "forecast": means, "deviation": np.sqrt(variances), "runs": found, "held": held, "of": [t.of for t in likelihood.terms]}
