#!/usr/bin/env python3
"""Makes the analyses that tests/effects.rs compares with, one JSON file each, with statsmodels.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install statsmodels==0.15.0 && /tmp/venv/bin/python make.py

Where R and its package car are installed, each analysis is made with them too (lm with contr.sum, car::Anova type 3)
and has to agree to 1e-8, or nothing is written. The data are random numbers about known effects, but for those of
`filtration`, which are published.
"""

import itertools
import json
import platform
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import scipy
import statsmodels
import statsmodels.api as sm
import statsmodels.formula.api as smf
from patsy import dmatrix
from scipy import stats

HERE = Path(__file__).parent
RSCRIPT = shutil.which("Rscript")
TOLERANCE = 1e-8

R_SCRIPT = """
suppressMessages(library(car))
args <- commandArgs(TRUE)
data <- read.csv(args[1])
for (name in names(data)) if (startsWith(name, "c") && length(unique(data[[name]])) > 1) data[[name]] <- factor(data[[name]])
for (name in names(data)) if (is.factor(data[[name]])) contrasts(data[[name]]) <- contr.sum(nlevels(data[[name]]))
fit <- lm(terms(as.formula(args[2]), keep.order = TRUE), data)
summary <- summary(fit)$coefficients
table <- Anova(fit, type = 3)
saturated <- lm(as.formula(args[3]), data)
number <- function(x) paste(ifelse(is.finite(x), sprintf("%.17g", x), "null"), collapse = ",")
cat('{"version":"R ', as.character(getRversion()), ', car ', as.character(packageVersion("car")), '",', sep = "")
cat('"coefficients":[', number(summary[, 1]), '],"errors":[', number(summary[, 2]), '],"ps":[', number(summary[, 4]),
    '],"squares":[', number(table[[1]]), '],"freedoms":[', number(table[[2]]), '],"fs":[', number(table[[3]]),
    '],"anova_ps":[', number(table[[4]]), '],"fitted":[', number(fitted(fit)), '],"r_squared":[',
    number(c(summary(fit)$r.squared, summary(fit)$adj.r.squared, sigma(fit))),
    '],"pure":[', number(c(df.residual(saturated), deviance(saturated))), ']}', sep = "")
"""


def levels(name, *labels):
    return {"name": name, "categories": list(labels)}


def values(name, *numbers):
    return {"name": name, "values": list(numbers)}


def span(name, low, high):
    return {"name": name, "range": [low, high]}


class Case:
    """A study; `larger` is a model that explains more of it, to be tested against its own."""

    def __init__(self, factors, settings, replicates, responses, model="interactions", blocks=True, terms=None, shift=0, larger=None):
        self.factors, self.model, self.shift, self.larger = factors, model, shift, larger
        self.settings = [list(point) for point in settings]
        self.replicates = list(replicates)
        self.responses = [None if np.isnan(y) else float(y) for y in responses]
        self.blocks = blocks and len(set(self.replicates)) > 1
        self.asked_blocks = blocks
        self.kept_terms = terms

    def is_class(self, index):
        factor = self.factors[index]
        return self.model != "quadratic" and len(factor.get("values", [])) > 2 or len(factor.get("categories", [])) > 2

    def number(self, index, setting):
        """What a setting is in coded units."""
        factor = self.factors[index]
        if "range" in factor or self.is_class(index):
            return setting
        if "categories" in factor:
            return 2 * setting - 1
        numbers = factor["values"]
        middle, half = (max(numbers) + min(numbers)) / 2, (max(numbers) - min(numbers)) / 2
        return (numbers[setting] - middle) / half

    def terms(self):
        count = len(self.factors)
        if self.kept_terms:
            return self.kept_terms
        order = {"main": 1, "interactions": 2, "quadratic": 2, "full": count}[self.model]
        terms = [t for o in range(1, order + 1) for t in itertools.combinations(range(count), o)]
        if self.model == "quadratic":
            terms += [(f, f) for f in range(count) if "categories" not in self.factors[f]]
        return terms

    def label(self, term):
        names = [self.factors[f]["name"] for f in term]
        return names[0] + "²" if len(term) == 2 and term[0] == term[1] else " × ".join(names)

    def variable(self, index):
        return f"c{index}" if self.is_class(index) else f"x{index}"

    def texts(self, language):
        """The blocks, if any, and the terms as formulas of the language have them."""
        classes = (lambda name: name) if language == "R" else (lambda name: f"C({name}, Sum)")
        power = "^" if language == "R" else " ** "

        def text(term):
            if len(term) == 2 and term[0] == term[1]:
                return f"I(x{term[0]}{power}2)"
            return ":".join(classes(self.variable(f)) if self.is_class(f) else self.variable(f) for f in term)

        return [classes("cblock")] * self.blocks + [text(term) for term in self.terms()]

    def frame(self):
        rows = [i for i, y in enumerate(self.responses) if y is not None]
        data = {"y": [self.responses[i] - self.shift for i in rows]}
        for f in range(len(self.factors)):
            data[self.variable(f)] = [self.number(f, self.settings[i][f]) for i in rows]
        data["cblock"] = [self.replicates[i] for i in rows]
        keys = [tuple(self.settings[i]) for i in rows]
        names = {key: i for i, key in enumerate(sorted(set(keys)))}
        data["cpoint"] = [names[key] for key in keys]
        return pd.DataFrame(data), rows

    def design_row(self, fit, settings):
        """The row of the model matrix at settings, averaged over blocks."""
        info = fit.model.data.model_spec
        frame = self.frame()[0]
        data = {self.variable(f): [self.number(f, s)] for f, s in enumerate(settings)}
        rows = []
        for block in sorted(set(frame["cblock"])):
            rows.append(np.asarray(dmatrix(info, pd.DataFrame(data | {"cblock": [block]})))[0])
        return np.mean(rows, axis=0)

    def analyse(self):
        frame, rows = self.frame()
        fit = smf.ols("y ~ " + " + ".join(self.texts("python")), frame).fit(method="qr")
        # They put terms with numbers last.
        texts = self.texts("python")
        order = [texts.index(name) for name in fit.model.data.model_spec.term_names[1:]]
        names = ["replicate"] * self.blocks + [self.label(t) for t in self.terms()]
        names = [names[i] for i in order]
        saturated_formula = "y ~ C(cpoint)" + (" + C(cblock)" if self.blocks else "")
        saturated = smf.ols(saturated_formula, frame).fit()
        total = float(np.sum((frame["y"] - frame["y"].mean()) ** 2))
        expected = {"constant": fit.params.iloc[0] + self.shift, "total": [len(rows) - 1, total]}
        expected["fitted"] = list(fit.fittedvalues + self.shift)
        expected["residuals"] = list(fit.resid)
        if fit.df_resid == 0:
            slots = list(fit.params.items())[1:]
            expected["terms"] = {n: {"coefficient": c, "squares": [1, len(rows) * c * c]} for n, (_, c) in zip(names, slots)}
            return expected
        table = sm.stats.anova_lm(fit, typ=3)
        interval = fit.conf_int(0.05)
        expected["terms"], at = {}, 1
        for name, (_, row) in zip(names, list(table.iterrows())[1:-1], strict=True):
            term = {"squares": [int(row["df"]), row["sum_sq"]], "test": [row["F"], row["PR(>F)"]]}
            if row["df"] == 1 and name != "replicate":
                term["coefficient"] = fit.params.iloc[at]
                term["uncertainty"] = [fit.bse.iloc[at], fit.tvalues.iloc[at], fit.pvalues.iloc[at]]
                term["uncertainty"] += list(interval.iloc[at])
            expected["terms"][name] = term
            at += int(row["df"])
        assert at == len(fit.params)
        expected["residual"] = [int(fit.df_resid), fit.ssr]
        expected["r_squared"] = [fit.rsquared, fit.rsquared_adj, 1 - fit.get_influence().ess_press / total]
        expected["deviation"] = float(np.sqrt(fit.scale))
        if saturated.df_resid > 0:
            freedom = int(fit.df_resid - saturated.df_resid)
            missed = float(np.sum((saturated.fittedvalues - fit.fittedvalues) ** 2))
            expected["pure_error"] = [int(saturated.df_resid), saturated.ssr]
            expected["lack_of_fit"] = [freedom, missed]
            if freedom:
                f = missed / freedom / (saturated.ssr / saturated.df_resid)
                expected["lack_of_fit_test"] = [f, stats.f.sf(f, freedom, saturated.df_resid)]
        reach = stats.t.ppf(0.975, fit.df_resid)
        expected["predictions"] = []
        for point in self.settings[:: max(1, len(self.settings) // 5)]:
            row = self.design_row(fit, point)
            value = row @ fit.params
            error = float(np.sqrt(row @ fit.cov_params() @ row))
            numbers = [value + self.shift, error, value - reach * error + self.shift, value + reach * error + self.shift]
            expected["predictions"].append({"settings": point, "numbers": numbers})
        half = lambda n: reach * np.sqrt(fit.scale / n)
        group = lambda fs: self.means(frame, rows, fs, half)
        expected["level_means"] = [group([f]) for f in range(len(self.factors))]
        expected["cell_means"] = group([0, len(self.factors) - 1]) if len(self.factors) > 1 else []
        if self.model == "quadratic":
            expected["surface"] = self.surface(fit)
        if self.larger:
            other = Case(self.factors, self.settings, self.replicates, self.shifted(), self.larger, self.asked_blocks)
            more = smf.ols("y ~ " + " + ".join(other.texts("python")), frame).fit(method="qr")
            expected["misfit"] = [*more.compare_f_test(fit)[:2], more.rsquared]
        self.check_with_r(frame, fit, table, saturated, order)
        return expected

    def shifted(self):
        return [np.nan if y is None else y - self.shift for y in self.responses]

    def means(self, frame, rows, factors, half):
        keys = [tuple(self.settings[i][f] for f in factors) for i in rows]
        if any("range" in self.factors[f] and len({k[i] for k in keys}) > 10 for i, f in enumerate(factors)):
            return []
        grouped = frame["y"].groupby(pd.Series(keys, index=frame.index))
        cells = []
        for key, ys in sorted(grouped, key=lambda pair: pair[0]):
            key = key if isinstance(key, tuple) else (key,)
            mean, reach = ys.mean() + self.shift, half(len(ys))
            cells.append({"settings": list(key), "count": len(ys), "numbers": [mean, mean - reach, mean + reach]})
        return cells

    def surface(self, fit):
        """Found by evaluating the model, not from its coefficients: values at points of a lattice determine it."""
        numeric = [f for f, factor in enumerate(self.factors) if "categories" not in factor]
        base = [0 if "categories" in factor else None for factor in self.factors]
        ranges = [self.factors[f].get("range") or [min(self.factors[f]["values"]), max(self.factors[f]["values"])] for f in numeric]
        kept = self.number
        self.number = lambda f, s: s if f in numeric else kept(f, s)

        def value(point):
            settings = [point[numeric.index(f)] if f in numeric else base[f] for f in range(len(base))]
            return self.design_row(fit, settings) @ fit.params

        count = len(numeric)
        unit = np.eye(count)
        constant = value(np.zeros(count))
        linear = np.array([(value(unit[i]) - value(-unit[i])) / 2 for i in range(count)])
        square = lambda i: (value(unit[i]) + value(-unit[i])) / 2 - constant
        matrix = np.diag([square(i) for i in range(count)])
        for i, j in itertools.combinations(range(count), 2):
            corner = value(unit[i] + unit[j]) - constant - linear[i] - linear[j] - matrix[i, i] - matrix[j, j]
            matrix[i, j] = matrix[j, i] = corner / 2
        self.number = kept
        point = np.linalg.solve(-2 * matrix, linear)
        middle = np.array([(low + high) / 2 for low, high in ranges])
        half = np.array([(high - low) / 2 for low, high in ranges])
        return {
            "settings": [0 for _ in self.factors],
            "constant": constant + self.shift,
            "linear": list(linear),
            "quadratic": [list(row) for row in matrix],
            "eigenvalues": list(np.linalg.eigvalsh(matrix)),
            "stationary": list(point),
            "natural": list(middle + half * point),
            "response": constant + self.shift + linear @ point / 2,
        }

    def check_with_r(self, frame, fit, table, saturated, order):
        global r_version
        if not RSCRIPT:
            return
        with tempfile.TemporaryDirectory() as folder:
            path, script = Path(folder) / "data.csv", Path(folder) / "check.R"
            frame.to_csv(path, index=False, float_format="%.17g")
            script.write_text(R_SCRIPT)
            points = "y ~ cpoint" + (" + cblock" if self.blocks else "")
            formula = "y ~ " + " + ".join(self.texts("R")[i] for i in order)
            command = [RSCRIPT, str(script), str(path), formula, points]
            found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        r_version = found["version"]
        close(found["coefficients"], fit.params, np.abs(fit.params).max() * 1e-6)
        close(found["errors"], fit.bse)
        close(found["ps"], fit.pvalues)
        close(found["squares"], table["sum_sq"])
        close(found["freedoms"], table["df"])
        close(found["fs"][:-1], table["F"][:-1])
        close(found["anova_ps"][:-1], table["PR(>F)"][:-1])
        close(found["fitted"], fit.fittedvalues, np.abs(fit.fittedvalues).max())
        close(found["r_squared"], [fit.rsquared, fit.rsquared_adj, np.sqrt(fit.scale)])
        if saturated.df_resid > 0:
            close(found["pure"], [saturated.df_resid, saturated.ssr])

    def write(self, name, note):
        expected = self.analyse()
        provenance = {
            "made_by": "make.py",
            "note": note,
            "python": platform.python_version(),
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "statsmodels": statsmodels.__version__,
        }
        if RSCRIPT and "residual" in expected:
            provenance["agrees_with"] = r_version
        document = {
            "provenance": provenance,
            "factors": self.factors,
            "model": self.model,
            "blocks": self.asked_blocks,
            "settings": self.settings,
            "replicates": self.replicates,
            # Apart, so that no reader of decimal numbers rounds their sum.
            "shift": self.shift,
            "responses": [None if y is None else y - self.shift for y in self.responses],
            "expected": expected,
        }
        text = json.dumps(document, indent=1, ensure_ascii=False, default=lambda number: number.item())
        (HERE / f"{name}.json").write_text(compact(text) + "\n", encoding="utf-8")
        print(name)


def compact(text):
    """Lists of numbers on one line."""
    number = r"(?:-?[0-9][-+.e0-9]*|null)"
    return re.sub(rf"\[\s*({number}(?:,\s*{number})*)\s*\]", lambda m: "[" + re.sub(r"\s+", " ", m[1]) + "]", text)


def close(found, expected, scale=0.0):
    found, expected = np.array(found, float), np.array(expected, float)
    assert np.all(np.abs(found - expected) <= TOLERANCE * np.maximum(np.abs(expected), scale)), (found, expected)


def corners(count):
    """All combinations of two levels, the first factor varying fastest."""
    return [tuple(reversed(point)) for point in itertools.product((0, 1), repeat=count)]


def repeated(points, times):
    return [p for _ in range(times) for p in points], [r for r in range(times) for _ in points]


def main():
    rng = np.random.default_rng(20261121)
    noise = lambda count, deviation=1.0: rng.normal(0.0, deviation, count)

    four = [levels("pad", "soft", "hard"), span("load", 50.0, 150.0), values("speed", 1.0, 4.0), levels("disc", "cast", "carbon")]
    coded = [(a, 2 * b - 1, c, d) for a, b, c, d in corners(4)]
    points, replicates = repeated(coded, 3)
    x = np.array([(2 * a - 1, b, 2 * c - 1, 2 * d - 1) for a, b, c, d in points])
    y = 12.0 + 1.7 * x[:, 0] - 0.9 * x[:, 1] + 0.35 * x[:, 0] * x[:, 1] + 0.2 * x[:, 2] + 0.5 * x[:, 0] * x[:, 2] * x[:, 3]
    y += np.repeat([0.8, -0.5, -0.3], 16) + noise(48, 0.6)
    Case(four, points, replicates, y.round(4)).write("blocks", "2⁴ in three blocks, two-factor interactions")
    Case(four, points, replicates, y.round(4), model="full").write("blocks_full", "the same with all interactions")
    Case(four, points, replicates, y.round(4), blocks=False).write("no_blocks", "the same without blocks")

    # Montgomery, D. C.: Design and Analysis of Experiments, example 6.2: filtration rate, gal/h.
    rates = [45, 71, 48, 65, 68, 60, 80, 65, 43, 100, 45, 104, 75, 86, 70, 96]
    named = [levels(name, "low", "high") for name in ("temperature", "pressure", "concentration", "stirring")]
    source = "Montgomery, Design and Analysis of Experiments, example 6.2 (filtration rate)"
    Case(named, corners(4), [0] * 16, rates, model="full").write("filtration", source)
    Case(named, corners(4), [0] * 16, rates).write("filtration_pooled", source)

    # Three pads, two discs, four blocks, six runs failed; then with three levels of a number.
    mixed = [levels("pad", "soft", "medium", "hard"), levels("disc", "cast", "carbon")]
    points, replicates = repeated(list(itertools.product(range(3), range(2))), 4)
    y = np.array([[3.1, 4.0], [2.2, 5.9], [4.4, 4.9]])[tuple(np.array(points).T)] + noise(24, 0.4)
    y[[0, 7, 8, 15, 20, 23]] = np.nan
    Case(mixed, points, replicates, y.round(5)).write("missing", "3 × 2 in four blocks, six responses missing")
    three = mixed + [values("temperature", 20.0, 300.0, 150.0)]
    points, replicates = repeated(list(itertools.product(range(3), range(2), range(3))), 3)
    a = np.array(points)
    y = 2.0 + 0.5 * a[:, 0] - 0.7 * a[:, 1] + 0.4 * (a[:, 2] == 1) + 0.3 * a[:, 0] * (a[:, 2] == 2) + noise(54, 0.3)
    y[[1, 2, 3, 17, 30, 31, 45, 53]] = np.nan
    Case(three, points, replicates, y.round(5)).write("missing_three", "3 × 2 × 3 in three blocks, eight responses missing")

    # Half of 2⁵, E = ABCD, twice; a quarter, D = AB and E = AC, twice.
    names = ("pad", "load", "speed", "disc", "grain")
    five = [levels(name, "low", "high") for name in names]
    sign = lambda *signs: (int(np.prod([2 * s - 1 for s in signs])) + 1) // 2
    points, replicates = repeated([p + (sign(*p),) for p in corners(4)], 2)
    x = 2 * np.array(points) - 1
    y = 100 + 8 * x[:, 0] - 3 * x[:, 4] + 2.5 * x[:, 1] * x[:, 2] + np.repeat([1.0, -1.0], 16) + noise(32, 1.5)
    Case(five, points, replicates, y.round(3)).write("half", "2⁵⁻¹ in two blocks: all pairs can be estimated")
    points, replicates = repeated([(a, b, c, sign(a, b), sign(a, c)) for a, b, c in corners(3)], 2)
    x = 2 * np.array(points) - 1
    y = 100 + 8 * x[:, 0] - 3 * x[:, 4] + 2.5 * x[:, 1] * x[:, 2] + np.repeat([1.0, -1.0], 8) + noise(16, 1.5)
    kept = [(0,), (1,), (2,), (3,), (4,), (1, 2), (1, 4)]
    Case(five, points, replicates, y.round(3), terms=kept).write("quarter", "2⁵⁻² in two blocks, D = AB and E = AC: pairs are aliased")

    # Central composite, rotatable, six centre points, no blocks: repeated centre points are the same study.
    alpha = 8**0.25
    axial = [tuple(s * alpha if f == g else 0.0 for g in range(3)) for f in range(3) for s in (-1, 1)]
    points = list(itertools.product((-1.0, 1.0), repeat=3)) + axial + [(0.0, 0.0, 0.0)] * 6
    x = np.array(points)
    y = 80 + 2 * x[:, 0] - 1.5 * x[:, 1] + 0.7 * x[:, 2] - 4 * x[:, 0] ** 2 - 3 * x[:, 1] ** 2 - 2 * x[:, 2] ** 2
    y += 1.1 * x[:, 0] * x[:, 1] - 0.6 * x[:, 1] * x[:, 2] + noise(20, 0.5)
    ranges = [span("load", 50.0, 150.0), span("speed", 1.0, 4.0), span("temperature", 20.0, 300.0)]
    Case(ranges, points, [0] * 20, y.round(4), model="quadratic").write("composite", "central composite, quadratic")
    # A surface for each pad, over a range and three levels, in two blocks, with failed runs.
    over = [levels("pad", "soft", "medium", "hard"), span("load", 10.0, 30.0), values("speed", 1.0, 2.0, 4.0)]
    points, replicates = repeated(list(itertools.product(range(3), (-1.0, 0.0, 1.0), range(3))), 2)
    a = np.array(points)
    s = np.array([-1.0, -1 / 3, 1.0])[a[:, 2].astype(int)]
    y = 5 + a[:, 0] * 0.4 + a[:, 1] * (1 + 0.3 * a[:, 0]) - 0.8 * s + a[:, 1] ** 2 - 0.5 * s**2 + noise(54, 0.2)
    y[[4, 9, 33, 50]] = np.nan
    Case(over, points, replicates, y.round(5), model="quadratic").write("saddle", "quadratic over numbers, categories, blocks, missing responses")

    # Latin hypercube.
    count = 60
    columns = [(2 * (rng.permutation(count) + 0.5) / count - 1).round(6) for _ in range(4)]
    points = [tuple(map(float, point)) for point in zip(*columns)]
    x = np.array(points)
    y = 3 + x[:, 0] - 0.4 * x[:, 1] + 0.8 * x[:, 0] * x[:, 3] + 0.15 * np.sin(3 * x[:, 2]) + noise(count, 0.1)
    free = [span(name, 0.0, 10.0) for name in ("load", "speed", "temperature", "grain")]
    Case(free, points, [0] * count, y.round(6)).write("hypercube", "Latin hypercube, two-factor interactions")

    # The same with curves: interactions alone miss them.
    curved = np.random.default_rng(20261122)
    count = 40
    columns = [(2 * (curved.permutation(count) + 0.5) / count - 1).round(6) for _ in range(4)]
    points = [tuple(map(float, point)) for point in zip(*columns)]
    x = np.array(points)
    y = 5 + 1.2 * x[:, 0] - 0.7 * x[:, 1] + 2 * x[:, 0] ** 2 - 1.1 * x[:, 2] ** 2 + 0.5 * x[:, 0] * x[:, 3]
    y = (y + curved.normal(0, 0.15, count)).round(6)
    Case(free, points, [0] * count, y, model="quadratic").write("hypercube_quadratic", "Latin hypercube, quadratic")
    Case(free, points, [0] * count, y, larger="quadratic").write("hypercube_curved", "the same, two-factor interactions")

    # Effects that leave no doubt, and the same on a large offset. Multiples of 2⁻¹⁶ have the offset exactly.
    plain = [levels(name, "low", "high") for name in ("pad", "load", "speed")]
    points, replicates = repeated(corners(3), 8)
    x = 2 * np.array(points) - 1
    y = 50 * x[:, 0] + 12 * x[:, 1] + 0.3 * x[:, 0] * x[:, 1] + np.repeat(noise(8), 8) + noise(64, 0.5)
    y = np.round(y * 2**16) / 2**16
    Case(plain, points, replicates, y).write("certain", "p-values far below 1e-30")
    y = np.round((y / 2**10) * 2**16) / 2**16 + 1e6
    Case(plain, points, replicates, y, shift=1e6).write("offset", "responses of 1e6 and a little, without it for statsmodels")


main()
