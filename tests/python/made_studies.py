"""Studies that tests and simulations make of columns, and those of fixtures."""

import math
from pathlib import Path

import numpy as np
import pandas
import xarray

from plateau.study.data import Factor, Response, Study

ENDS = {"low": -math.inf, "high": math.inf}


def number(name, *levels, is_range=False, unit="1", one=1.0, study_unit="", whole=False):
    """A factor of numbers."""
    return Factor(name, "key", unit, levels, is_range, False, whole, study_unit, one, 0.0)


def span(name, low=-1.0, high=1.0, **options):
    """A factor that may be anywhere between two ends."""
    return number(name, low, high, is_range=True, **options)


def word(name, *levels):
    """A factor of words."""
    return Factor(name, "", "", levels, False, False, False, "", 1.0, 0.0)


def study_of(factors, columns, design="full-factorial", transform="none", responses=None, title="t"):
    """A study of responses (name and unit; y alone unless given), of columns of factors, responses and, if there are sets of seeds, replicate."""
    runs = pandas.DataFrame(columns).reset_index(drop=True).rename(index=lambda at: at + 1).rename_axis("run")
    point = runs.groupby([factor.name for factor in factors], sort=False).ngroup() + 1
    own = pandas.DataFrame({"point": point, "replicate": 1, "order": runs.index, "same_as": runs.index, "state": "finished"}, index=runs.index)
    asked = [Response(name, unit, name, transform, -math.inf, math.inf, {}) for name, unit in (responses or {"y": "1"}).items()]
    runs = pandas.concat([own.drop(columns=[name for name in own if name in runs]), runs], axis=1)
    return Study(title, design, list(factors), asked, runs, pandas.DataFrame(), xarray.Dataset(), {}, None, Path())


def stored(said):
    """A study of a fixture."""
    factors = [Factor(**{**factor, "levels": tuple(factor["levels"])}) for factor in said["factors"]]
    responses = [Response(**{**ENDS, **{name: value for name, value in one.items() if value is not None}}) for one in said["responses"]]
    columns = pandas.DataFrame(said["runs"])
    columns = columns.astype({response.name: float for response in responses})
    made = study_of(factors, columns, said["design"], responses=dict.fromkeys((response.name for response in responses), "1"))
    runs = made.runs if "point" in columns else made.runs.assign(point=np.arange(1, len(columns) + 1))
    return Study(**{**vars(made), "title": said.get("title", ""), "responses": responses, "runs": runs})
