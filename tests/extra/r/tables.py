"""Writes tables of runs with what plateau.study says of them, for R to compute again: ``tables.py FILE``."""

import gzip
import json
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas

HERE = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(HERE / folder) for folder in ("python", "tests/python", "tests/python/coverage")]

from effects import cube
from made_studies import number, span, stored, study_of, word

from plateau.errors import PlateauWarning
from plateau.study.analysis import effects
from plateau.study.data import Study
from plateau.study.level_differences import levels
from plateau.study.model import Fitted


def columns(fit: Fitted, table: pandas.DataFrame) -> dict[str, Any]:
    """The factors as f1, f2, ...: numbers coded -1 to 1, or letters in the order of the levels."""
    found = {}
    for at, coding in enumerate(fit.codings, 1):
        places = coding.numbers(table[coding.factor.name])
        letters = ["abcdefghij"[int(row.argmax()) + 1 if row.max() > 0 else 0] for row in places]
        found[f"f{at}"] = places[:, 0].tolist() if coding.is_straight else letters
    return found


def label(term: tuple[int, ...]) -> str:
    """A term as R has it."""
    return f"I(f{term[0] + 1}^2)" if len(term) == 2 and term[0] == term[1] else ":".join(f"f{at + 1}" for at in term)


def case(name: str, study: Study, checks: str, model: str | None = None, response: str | None = None) -> dict[str, Any]:
    """A table of runs with the answers that are to be checked."""
    one = effects(study, model)[response or study.responses[0].name]
    fit, table, said, points = one.fit, one.table.set_index("term"), {}, {}
    labels = {fit.label(term): label(term) for term in fit.terms}
    terms, blocks = table.loc[[*labels]], ["replicate"] if fit.seeds > 1 else []
    if "anova" in checks:
        # With sets of seeds only they are tested against the residual.
        rows, tested = table.loc[[*blocks, *labels, "residual"]], table.loc[blocks or list(labels)]
        said["anova"] = {"freedom": rows["degrees_of_freedom"], "squares": rows["sum_of_squares"], "f": tested["f"], "p": tested["p"]}
    if "strata" in checks:
        said["strata"] = {"freedom": terms["error_freedom"], "f": terms["f"], "p": terms["p"]}
    if "slopes" in checks:
        said["slopes"] = {"coefficient": terms["coefficient"], "error": terms["standard_error"] / 2.0, "freedom": terms["error_freedom"]}
    of_levels = [coding.factor for coding in fit.codings if len(coding.classes or ()) > 2]
    for method, factor in ((method, factor) for method in ("tukey", "dunnett") if method in checks for factor in of_levels):
        rows = levels(study, factor.text(factor.levels[-1]) if method == "dunnett" else None, model).table
        rows = rows[(rows["response"] == fit.response.name) & (rows["factor"] == factor.name)]
        found = {key: rows[key] for key in ("difference", "standard_error", "freedom", "p")}
        found["reach"] = (rows["high"] - rows["low"]) / (2.0 * rows["standard_error"])
        said[f"{method} f{study.factors.index(factor) + 1}"] = found
    if "power" in checks:
        said["power"] = {"best": one.box_cox[:1], "ends": one.box_cox[1:]}
    if "polynomial" in checks:
        coded = np.random.default_rng(1).uniform(-1.1, 1.1, (20, len(study.factors)))
        places = pandas.DataFrame({factor.name: factor.value(coded[:, at]) for at, factor in enumerate(study.factors)})
        points, found = columns(fit, places), fit.forecast(places)
        said["polynomial"] = {"left out": fit.loo[fit.runs["point"]]} | dict(found[["value", "leverage", "mean_low", "mean_high"]])
    answers = {check: {key: np.asarray(values, float).tolist() for key, values in keys.items()} for check, keys in said.items()}
    runs = columns(fit, fit.runs) | {"y": fit.values.tolist(), "rep": [f"s{seed}" for seed in fit.runs["replicate"]]}
    own = {"name": f"{name}, {fit.response.name}", "blocks": bool(blocks), "terms": [*labels.values()], "runs": runs, "points": points}
    return own | {"said": answers}


warnings.simplefilter("ignore", PlateauWarning)
fixture = json.loads(gzip.decompress((HERE / "tests/python/data/effects.json.gz").read_bytes()))["studies"]
studies, random = {said["name"]: stored(said) for said in fixture}, np.random.default_rng(1)
runs = cube(4)
runs["y"] = random.normal(size=len(runs)) + runs["A"] * (1.0 + np.array([1.5, -2.0, 0.0, 1.0])[runs["replicate"] - 1])
cells = pandas.DataFrame([(a, b, n) for a in "pqrs" for b in "tuv" for n in (1, 2, 3, 4)], columns=["a", "b", "replicate"])
cells["y"] = np.exp(0.3 * random.normal(size=48) + 0.5 * (cells["a"] == "q") + 0.2 * cells["replicate"])
words, fewer = [word("a", *"pqrs"), word("b", *"tuv")], cells.drop([0, 5, 6, 17, 30, 31, 44])
points = pandas.DataFrame(random.uniform(-1.0, 1.0, (24, 3)), columns=list("ABC"))
points["y"] = np.exp(points["A"]) * (2.0 + points["B"]) + 0.1 * random.normal(size=24)
ranges = [span(name) for name in "ABC"]
cases = [
    case("full-words-mixed", studies["full-words-mixed"], "anova tukey dunnett"),
    case("csv-words-unbalanced", studies["csv-words-unbalanced"], "anova tukey dunnett", "main"),
    case("blocks-imported", studies["blocks-imported"], "anova strata slopes"),
    case("blocks-imported-missing", studies["blocks-imported-missing"], "anova"),
    case("full-3x3-seeds", studies["full-3x3-seeds"], "anova strata tukey dunnett"),
    case("box-cox", studies["box-cox"], "anova power", "main", "inverse"),
    case("hypercube-3", studies["hypercube-3"], "anova polynomial power"),
    case("2^3, 4 seeds", study_of([number(name, -1.0, 1.0) for name in "ABC"], runs), "anova strata slopes", "interactions"),
    case("4 x 3, 4 seeds", study_of(words, cells), "anova strata tukey dunnett power"),
    case("4 x 3, 4 seeds, 7 runs missing", study_of(words, fewer), "anova power"),
    case("4 x 3, unequal numbers", study_of(words, fewer.drop(columns="replicate")), "anova tukey dunnett power"),
    case("24 points at random", study_of(ranges, points, "latin-hypercube"), "anova polynomial", "quadratic"),
]
Path(sys.argv[1]).write_text(json.dumps(cases), encoding="utf-8")
