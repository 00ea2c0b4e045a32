"""Runs of a fit: where they teach most about values of keys, and the last of them at the most likely place, which they check."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import stats

from plateau.study.data import Numbers
from plateau.study.likelihood import SETTLED, Likelihood, Runs, Target

# Points before the next fit; points that are kept for the most likely place; rounds without a gain after which none is expected.
AT_A_TIME, RESERVE, PATIENCE = 4, 2, 3
# Confidence of the check of a forecast and of the misfit, and by how much -2 ln L may be above the least at a place that runs have checked.
CHECK, SAME = 0.99, 1.0
ENDS = {
    "settled": "further runs are expected to change little",
    "budget": "the limit of runs in [fit] is reached",
    "nowhere else": "every place that counts was run",
    "no gain": "more would hardly help, for runs scatter too much",
    "no runs": "what is fitted was imported, and no runs are made",
}


@dataclass(frozen=True)
class Outcome:
    """The last fit, how many were made one after the other, why no more runs were (one of `ENDS`), and runs at most likely places."""

    likelihood: Likelihood
    rounds: int
    ended: str
    checks: list[dict[str, Any]]

    @property
    def check(self) -> str:
        """Result of the check of the forecast at the most likely place: ``"held"``, ``"failed"``, or ``"none"`` without runs there."""
        return "none" if not self.checks else "held" if self.checks[-1]["held"] else "failed"

    @property
    def has_failed(self) -> bool:
        """True if runs contradict the forecast at the most likely place."""
        return self.check == "failed"

    @cached_property
    def why_no_interval(self) -> str:
        """Reason why there is no interval; empty where there is one."""
        if self.has_failed:
            return "runs contradict the forecast"
        if self.likelihood.p(with_processes=True) < 1.0 - CHECK:
            return "no values within the ranges give what was measured"
        return "no runs at the most likely place" if self.check == "none" and self.ended != "no runs" else ""


def calibrated(target: Target, runs: Runs, make: Callable[[Numbers], Runs], seeds: int, most: int, can_run: Sequence[bool]) -> Outcome:
    """Makes runs where they teach most, and the last of them at the most likely place; where these contradict, all is fitted again.

    `make` makes runs at coded places with all seeds; `can_run` tells of each measurement whether runs give it.
    """
    shares, checks, ended = list[float](), list[dict[str, Any]](), ""
    for rounds in itertools.count(1):
        likelihood = Likelihood(target, runs)
        asked = np.array([can_run[term.of] for term in likelihood.terms])
        left = (most - len(runs.x)) // seeds if asked.any() else 0
        if checks:
            # What the runs say themselves: the place that they were made at is still the most likely one, or nearly.
            checks[-1]["held"] &= bool(likelihood.rise(checks[-1]["place"])[0] <= SAME and not likelihood.agrees_by_ignorance)
            if checks[-1]["held"]:
                break
        free = left - min(RESERVE, left)
        places, _ = likelihood.next_places(min(AT_A_TIME, free), seeds, can_run)
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
        if asked.any() and (np.abs(runs.x - place).max(axis=1) < 1e-9).any():
            check = _check(likelihood, place, asked, None)
            # The same runs would tell the same: others beside it are made.
            places = places[:0] if check["held"] else likelihood.next_places(min(1, left), seeds, can_run)[0]
            if not len(places):
                checks.append(check)
                break
            runs = runs.with_more(make(places))
        elif left:
            more = make(place[None])
            checks.append(_check(likelihood, place, asked, more))
            runs = runs.with_more(more)
            shares.clear()
        else:
            break
    return Outcome(likelihood, rounds, ended, checks)


def _has_no_gain(shares: Sequence[float], then: float) -> bool:
    """Tells whether runs are not expected to shorten an interval by more than what a settled fit leaves, or have not for some rounds."""

    def gains(before: float, after: float) -> bool:
        return 1.0 + before > (1.0 + SETTLED) * (1.0 + after)

    if then <= SETTLED:
        return False
    rounds = len(shares) - PATIENCE
    return not gains(shares[-1], then) or (rounds > 0 and not gains(min(shares[:rounds]), min(shares[rounds:])))


def _check(likelihood: Likelihood, place: Numbers, asked: Any, more: Runs | None) -> dict[str, Any]:
    """Check of the forecast at a place against runs there; runs that the fit has already are left out of the forecast."""
    processes = [term.process for term in likelihood.terms]
    if more is None:
        at = [int(np.abs(process.points - place).max(axis=1).argmin()) for process in processes]
        told = [(process.means[one], process.loo[0][one], process.loo[1][one] ** 2) for process, one in zip(processes, at, strict=True)]
        found, errors, variances = np.array(told).T
        means = found - errors
    else:
        means, own, _ = (each[0] for each in likelihood.moments(place[None]))
        found = np.nanmean(likelihood.of_runs(more), axis=0)
        variances = own + np.array([process.run_variance for process in processes]) / len(more.x)
    # What is small against the measurement does not count.
    squares = (found - means) ** 2 / (variances + SETTLED * np.diag(likelihood.covariance))
    known = asked & np.isfinite(squares)
    held = bool(known.any() and squares[known].sum() <= stats.chi2.ppf(CHECK, known.sum()))
    said = {"place": place, "forecast": means, "deviation": np.sqrt(variances), "runs": found}
    return {**said, "held": held, "of": [term.of for term in likelihood.terms]}
