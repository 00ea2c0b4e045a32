#!/usr/bin/env python3
"""Makes the numbers that tests/answers.rs compares with, one JSON file, with statsmodels and scipy.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install statsmodels scipy && /tmp/venv/bin/python make.py

The data of `poisons` are published (Box & Cox 1964, table 1), all others are random numbers about known effects.
"""

import itertools
import json
from pathlib import Path

import numpy as np
import scipy
import statsmodels
import statsmodels.api as sm
from scipy import optimize, stats

HERE = Path(__file__).parent

POISONS = """
.31 .45 .46 .43  .82 1.10 .88 .72  .43 .45 .63 .76  .45 .71 .66 .62
.36 .29 .40 .23  .92 .61 .49 1.24  .44 .35 .31 .40  .56 1.02 .71 .38
.22 .21 .18 .23  .30 .37 .38 .29  .23 .25 .24 .22  .30 .36 .31 .33
"""


def sum_contrasts(levels, count):
    """Columns of contrasts that add up to zero, the first level at -1."""
    columns = np.zeros((len(levels), count - 1))
    for row, level in enumerate(levels):
        columns[row] = -1 if level == 0 else np.eye(count - 1)[level - 1]
    return columns


def log_likelihood(power, matrix, y):
    """Of Box and Cox, as scipy.stats.boxcox_llf has it for one mean: with the Jacobian, not with the geometric mean."""
    z = np.log(y) if power == 0 else (y**power - 1) / power
    left = sm.OLS(z, matrix).fit().ssr
    return -0.5 * len(y) * np.log(left / len(y)) + (power - 1) * np.log(y).sum()


def box_cox(matrix, y):
    best = optimize.minimize_scalar(lambda p: -log_likelihood(p, matrix, y), bounds=(-4, 4), method="bounded", options={"xatol": 1e-10})
    least = -best.fun - stats.chi2.ppf(0.95, 1) / 2
    ends = [optimize.brentq(lambda p: log_likelihood(p, matrix, y) - least, best.x, end, xtol=1e-12) for end in (-5, 5)]
    return [best.x, *ends]


def quadratic(points):
    """Main effects, interactions, squares, in the order of the program."""
    count = points.shape[1]
    terms = [(f,) for f in range(count)] + list(itertools.combinations(range(count), 2)) + [(f, f) for f in range(count)]
    return terms, np.column_stack([np.prod(points[:, list(term)], axis=1) for term in terms])


def hierarchical(terms, kept):
    return all(not (set(part) <= set(whole) and len(part) < len(whole)) or part in kept for whole in kept for part in terms)


def aicc(matrix, y):
    n, k = len(y), matrix.shape[1] + 1
    left = sm.OLS(y, matrix).fit().ssr
    return n * np.log(left / n) + 2 * k + 2 * k * (k + 1) / (n - k - 1) if n - k - 1 > 0 else np.inf


def poisons():
    y = np.array([float(number) for number in POISONS.split()])
    poison, treatment = np.repeat([0, 1, 2], 16), np.tile(np.repeat([0, 1, 2, 3], 4), 3)
    matrix = np.column_stack([np.ones(48), sum_contrasts(poison, 3), sum_contrasts(treatment, 4)])
    return {"settings": np.column_stack([poison, treatment]).tolist(), "y": y.tolist(), "box_cox": box_cox(matrix, y)}


def surface(seed, points, noise):
    """Positive responses of three numbers; what is expected in between, on the scale of the logarithm."""
    random = np.random.default_rng(seed)
    x = random.uniform(-1, 1, (points, 3)).round(6)
    y = np.exp(0.4 + 0.5 * x[:, 0] - 0.3 * x[:, 1] + 0.25 * x[:, 0] ** 2 + noise * random.standard_normal(points))
    terms, columns = quadratic(x)
    matrix = sm.add_constant(columns)
    fit = sm.OLS(np.log(y), matrix).fit()
    at = np.vstack([random.uniform(-1, 1, (4, 3)).round(6), [[1, 1, -1], [1.5, 0, -1.2]]])
    rows = np.column_stack([np.ones(len(at)), quadratic(at)[1]])
    forecasts = []
    for level in (0.95, 0.8):
        table = fit.get_prediction(rows).summary_frame(alpha=1 - level)
        names = ["mean", "mean_ci_lower", "mean_ci_upper", "obs_ci_lower", "obs_ci_upper"]
        forecasts.append({"confidence": level, "numbers": np.exp(table[names].to_numpy()).tolist()})
    # Each response by a fit without it, literally.
    missed = [y[i] - np.exp(sm.OLS(np.delete(np.log(y), i), np.delete(matrix, i, 0)).fit().predict(matrix[i : i + 1])[0]) for i in range(points)]
    influence = fit.get_influence()
    # The best of all hierarchical choices of terms.
    choices = []
    for count in range(len(terms) + 1):
        for kept in itertools.combinations(terms, count):
            if hierarchical(terms, kept):
                chosen = np.column_stack([np.ones(points)] + [columns[:, terms.index(term)] for term in kept])
                choices.append((aicc(chosen, np.log(y)), [list(term) for term in kept]))
    choices.sort(key=lambda choice: choice[0])
    return {
        "x": x.tolist(),
        "y": y.tolist(),
        "box_cox": box_cox(matrix, y),
        "at": at.tolist(),
        "forecasts": forecasts,
        "leave_one_out": float(np.sqrt(np.mean(np.square(missed)))),
        "standardised": influence.resid_studentized_internal.tolist(),
        "aicc": choices[0][0],
        "aicc_of_all": aicc(matrix, np.log(y)),
        "kept": choices[0][1],
    }


def blocks(seed):
    """Four corners, five blocks that differ: variances of balanced analysis, by least squares of each part."""
    random = np.random.default_rng(seed)
    x = np.array(list(itertools.product([-1, 1], repeat=2)), float)
    count = 5
    shift = 2.0 * random.standard_normal(count)
    y = np.array([[3 + 1.5 * a - 0.7 * b + shift[k] + 0.5 * random.standard_normal() for a, b in x] for k in range(count)])
    means, of_blocks = y.mean(axis=0), y.mean(axis=1)
    matrix = np.column_stack([np.ones(4), x])
    fit = sm.OLS(means, matrix).fit()
    between = len(x) * np.square(of_blocks - y.mean()).sum()
    fitted = fit.predict(matrix)[None, :] + (of_blocks - y.mean())[:, None]
    error_freedom = y.size - 3 - (count - 1)
    error = np.square(y - fitted).sum() / error_freedom
    between /= count - 1
    variance = (between - error) / len(x)
    at = np.array([[1, 1], [0, 0], [0.5, -0.25]], float)
    numbers = []
    for a, b in at:
        # Orthogonal: the mean of 20 runs, and two slopes with 20 runs each.
        slopes = (a * a + b * b) / 20
        mean = fit.predict([[1, a, b]])[0]
        of_mean = variance / count + error / 20 + error * slopes
        of_run = of_mean + variance + error
        row = [mean]
        for total, part in ((of_mean, 1 / 20), (of_run, 1 / 20 + 1 / len(x))):
            # The parts of both mean squares in the total.
            own, rest = part * between, total - part * between
            freedom = total**2 / (own**2 / (count - 1) + rest**2 / error_freedom)
            reach = stats.t.ppf(0.975, freedom) * np.sqrt(total)
            row += [mean - reach, mean + reach]
        numbers.append(row)
    return {"x": x.tolist(), "y": y.tolist(), "at": at.tolist(), "numbers": numbers}


def main():
    made = {
        "made_with": {"numpy": np.__version__, "scipy": scipy.__version__, "statsmodels": statsmodels.__version__},
        "poisons": poisons(),
        "surfaces": [surface(1, 30, 0.1), surface(2, 24, 0.4), surface(3, 45, 0.02)],
        "blocks": blocks(7),
    }
    (HERE / "answers.json").write_text(json.dumps(made) + "\n")


main()
