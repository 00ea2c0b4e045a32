#!/usr/bin/env python3
"""Makes the numbers that tests/surrogate.rs compares with, with scikit-learn, scipy and SALib, and by definition with NumPy.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install scikit-learn==1.9.1 SALib==1.6.0 && /tmp/venv/bin/python make.py

Each Gaussian process is solved twice, by scikit-learn and by the definition of its likelihood, with every point left out in
turn; the two have to agree to 1e-8, or nothing is written. Where R has the package DiceKriging, that is a third one, which has
to agree as well. Data: the function of Branin on a grid, and the exercise data of Linnerud that come with scikit-learn.
"""

import json
import shutil
import subprocess
import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np
from SALib.analyze import morris as morris_analyze
from SALib.analyze import sobol as sobol_analyze
from scipy.linalg import null_space
from scipy.optimize import minimize
from sklearn.datasets import load_linnerud
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import Kernel

HERE = Path(__file__).parent
RSCRIPT = shutil.which("Rscript")
TOLERANCE = 1e-8

R_SCRIPT = """
suppressMessages(library(DiceKriging))
args <- commandArgs(TRUE)
data <- as.matrix(read.csv(args[1], header = FALSE)); new <- as.matrix(read.csv(args[2], header = FALSE))
numbers <- scan(args[3], quiet = TRUE)
d <- ncol(new); x <- data[, 1:d, drop = FALSE]; y <- data[, d + 1]
colnames(x) <- colnames(new) <- paste0("x", 1:d)
lengths <- numbers[1:d]; variance <- numbers[d + 1]; noise <- numbers[d + 2]
model <- km(formula = if (numbers[d + 3] == 1) ~. else ~1, design = data.frame(x), response = y, covtype = "matern5_2",
            coef.cov = lengths, coef.var = variance, noise.var = rep(noise, nrow(x)))
likelihood <- -0.5 * (nrow(x) * log(2 * pi) + 2 * sum(log(diag(model@T))) + sum(model@z^2))
found <- predict(model, data.frame(new), type = "UK", checkNames = FALSE)
cat(sprintf("%.17g", c(likelihood, found$mean, found$sd^2)), sep = "\\n")
"""


def correlation(x, z, lengths):
    """Product of Matern 5/2 correlations along the axes."""
    a = np.sqrt(5.0) * np.abs(x[:, None, :] - z[None, :, :]) / lengths
    return np.prod((1 + a + a * a / 3) * np.exp(-a), axis=2)


class Product(Kernel):
    """The same, for scikit-learn."""

    def __init__(self, lengths, variance):
        self.lengths, self.variance = lengths, variance

    def __call__(self, X, Y=None, eval_gradient=False):
        return self.variance * correlation(X, X if Y is None else Y, np.asarray(self.lengths))

    def diag(self, X):
        return np.full(len(X), self.variance)

    def is_stationary(self):
        return True


def trend(x, linear):
    return np.hstack([np.ones((len(x), 1)), x]) if linear else np.ones((len(x), 1))


def concentrated(x, y, lengths, noise, linear):
    """Log likelihood with the most likely trend and variance; and these."""
    c = correlation(x, x, lengths) + noise * np.eye(len(x))
    f = trend(x, linear)
    solve = np.linalg.solve
    beta = solve(f.T @ solve(c, f), f.T @ solve(c, y))
    left = y - f @ beta
    variance = left @ solve(c, left) / len(y)
    _, log_determinant = np.linalg.slogdet(c)
    return -0.5 * (len(y) * (np.log(2 * np.pi * variance) + 1) + log_determinant), beta, variance


def universal(x, y, new, lengths, noise, variance, linear):
    """Mean and variance of universal kriging."""
    c = correlation(x, x, lengths) + noise * np.eye(len(x))
    f, g, r = trend(x, linear), trend(new, linear), correlation(new, x, lengths)
    solve = np.linalg.solve
    inner = f.T @ solve(c, f)
    beta = solve(inner, f.T @ solve(c, y))
    left = g.T - f.T @ solve(c, r.T)
    mean = g @ beta + r @ solve(c, y - f @ beta)
    part = 1 - np.sum(r.T * solve(c, r.T), axis=0) + np.sum(left * solve(inner, left), axis=0)
    return mean, variance * part


def most_likely(x, y, linear):
    """The best of many searches by scipy, within the bounds that the program has."""
    d = x.shape[1]
    low = np.log(np.r_[np.full(d, 0.05), 1e-8])
    high = np.log(np.r_[np.full(d, 40.0), 1e2])

    def loss(logs):
        try:
            return -concentrated(x, y, np.exp(logs[:d]), np.exp(logs[d]), linear)[0]
        except np.linalg.LinAlgError:
            return 1e10

    random = np.random.default_rng(1)
    starts = [low + (high - low) * random.random(d + 1) for _ in range(40)]
    found = [minimize(loss, start, method="L-BFGS-B", bounds=list(zip(low, high))) for start in starts]
    return -min(each.fun for each in found)


def same(one, other, what):
    one, other = np.asarray(one), np.asarray(other)
    scale = np.maximum(np.abs(other), 1e-3 * np.max(np.abs(other)))
    worst = np.max(np.abs(one - other) / scale)
    assert worst < TOLERANCE, f"{what}: {worst:.1e}"


def process(name, x, y, new, lengths, noise, linear):
    lengths = np.asarray(lengths)
    likelihood, beta, variance = concentrated(x, y, lengths, noise, linear)
    mean, spread = universal(x, y, new, lengths, noise, variance, linear)
    left_out = []
    for at in range(len(x)):
        keep = np.arange(len(x)) != at
        m, v = universal(x[keep], y[keep], x[[at]], lengths, noise, variance, linear)
        left_out.append([m[0], v[0] + noise * variance])
    # scikit-learn knows no trend: it gets what the trend leaves.
    left = y - trend(x, linear) @ beta
    peer = GaussianProcessRegressor(Product(lengths, variance), alpha=noise * variance, optimizer=None).fit(x, left)
    same(peer.log_marginal_likelihood_value_, likelihood, "likelihood")
    same(peer.predict(new) + trend(new, linear) @ beta, mean, "mean")
    if RSCRIPT:
        with tempfile.TemporaryDirectory() as folder:
            paths = [Path(folder) / file for file in ("data.csv", "new.csv", "numbers.txt", "run.R")]
            np.savetxt(paths[0], np.c_[x, y], delimiter=",", fmt="%.17g")
            np.savetxt(paths[1], new, delimiter=",", fmt="%.17g")
            np.savetxt(paths[2], np.r_[lengths, variance, noise * variance, float(linear)], fmt="%.17g")
            paths[3].write_text(R_SCRIPT)
            out = subprocess.run([RSCRIPT, paths[3], *paths[:3]], capture_output=True, text=True, check=True).stdout
        numbers = np.array(out.split(), dtype=float)
        same(numbers[0], likelihood, "likelihood of DiceKriging")
        same(numbers[1 : 1 + len(new)], mean, "mean of DiceKriging")
        same(numbers[1 + len(new) :], spread, "variance of DiceKriging")
    return {
        "name": name,
        "points": x.tolist(),
        "responses": y.tolist(),
        "linear": linear,
        "lengths": lengths.tolist(),
        "noise": noise,
        "log_likelihood": likelihood,
        "coefficients": beta.tolist(),
        "variance": variance,
        "new": new.tolist(),
        "means": mean.tolist(),
        "variances": spread.tolist(),
        "left_out": left_out,
        "most_likely": most_likely(x, y, linear),
    }


def replicates(random):
    """Three seeds at twelve points: the likelihood of all runs but for what the seeds add everywhere."""
    seeds, x = 3, 2 * random.random((12, 2)) - 1
    smooth = np.sin(2 * x[:, 0]) + x[:, 1] ** 2
    y = smooth[:, None] + np.array([0.3, -0.1, -0.2]) + 0.1 * random.standard_normal((12, seeds))
    lengths, noise = np.array([1.1, 2.3]), 0.03
    expand = np.kron(np.eye(12), np.ones((seeds, 1)))
    blocks = np.kron(np.ones((12, 1)), np.eye(seeds) - 1 / seeds)
    keep = null_space(blocks.T)
    values, f = keep.T @ y.ravel(), keep.T @ np.ones((12 * seeds, 1))
    c = keep.T @ (expand @ correlation(x, x, lengths) @ expand.T + noise * np.eye(12 * seeds)) @ keep
    solve = np.linalg.solve
    beta = solve(f.T @ solve(c, f), f.T @ solve(c, values))
    left = values - f @ beta
    variance = left @ solve(c, left) / len(left)
    _, log_determinant = np.linalg.slogdet(c)
    likelihood = -0.5 * (len(left) * (np.log(2 * np.pi * variance) + 1) + log_determinant)
    # Of means instead of sums over the root of the number of seeds.
    likelihood += 0.5 * 12 * np.log(seeds)
    return {
        "points": x.tolist(),
        "responses": y.tolist(),
        "lengths": lengths.tolist(),
        "noise": noise,
        "log_likelihood": likelihood,
        "variance": variance,
        "coefficient": beta[0],
    }


def branin(x):
    u, v = 7.5 * x[:, 0] + 2.5, 7.5 * x[:, 1] + 7.5
    a = v - 5.1 / (4 * np.pi**2) * u**2 + 5 / np.pi * u - 6
    return a**2 + 10 * (1 - 1 / (8 * np.pi)) * np.cos(u) + 10


def sobol_indices(random):
    """SALib's estimates from a sample of its own kind, rows of A, A with one factor of B, B."""
    d, rows = 3, 64
    a, b = random.random((rows, d)), random.random((rows, d))

    def function(u):
        x = np.pi * (2 * u - 1)
        return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])

    mixed = []
    for at in range(d):
        m = a.copy()
        m[:, at] = b[:, at]
        mixed.append(function(m))
    y = np.stack([function(a), *mixed, function(b)], axis=1)
    problem = {"num_vars": d, "names": ["x1", "x2", "x3"], "bounds": [[0, 1]] * d}
    found = sobol_analyze.analyze(problem, y.ravel(), calc_second_order=False, num_resamples=2, seed=1)
    return {
        "a": y[:, 0].tolist(),
        "b": y[:, -1].tolist(),
        "mixed": y[:, 1:-1].T.tolist(),
        "first": found["S1"].tolist(),
        "total": found["ST"].tolist(),
    }


def morris(random):
    """SALib's elementary effects of trajectories on four levels."""
    d, trajectories, levels = 3, 6, 4
    step = levels / (2 * (levels - 1))
    points = []
    for _ in range(trajectories):
        place = random.integers(0, levels, d) / (levels - 1)
        points.append(place.copy())
        for at in random.permutation(d):
            place[at] += step if place[at] < 0.5 else -step
            points.append(place.copy())
    x = np.array(points)
    y = x[:, 0] ** 2 + 2 * x[:, 1] * x[:, 2] - x[:, 2]
    problem = {"num_vars": d, "names": ["x1", "x2", "x3"], "bounds": [[0, 1]] * d}
    found = morris_analyze.analyze(problem, x, y, num_levels=levels, num_resamples=100, seed=1)
    return {
        "points": x.tolist(),
        "responses": y.tolist(),
        "mean_sizes": np.asarray(found["mu_star"]).tolist(),
        "means": np.asarray(found["mu"]).tolist(),
        "deviations": np.asarray(found["sigma"]).tolist(),
    }


def main():
    random = np.random.default_rng(20)
    grid = np.array([[u, v] for u in np.linspace(-1, 1, 4) for v in np.linspace(-1, 1, 4)])
    new = 2 * random.random((5, 2)) - 1
    bunch = load_linnerud()
    low, high = bunch.data.min(axis=0), bunch.data.max(axis=0)
    exercise = 2 * (bunch.data - low) / (high - low) - 1
    waist = bunch.target[:, 1]
    inside = 2 * random.random((5, 3)) - 1
    line = np.linspace(-1, 1, 9)[:, None]
    wave = np.exp(line[:, 0]) * np.sin(5 * line[:, 0])
    processes = [
        process("Branin", grid, branin(grid), new, [0.9, 1.6], 1e-4, False),
        process("Branin, linear trend", grid, branin(grid), new, [0.7, 2.1], 1e-3, True),
        process("Linnerud", exercise, waist, inside, [2.5, 1.2, 0.8], 0.4, False),
        process("Linnerud, linear trend", exercise, waist, inside, [1.0, 1.0, 3.0], 0.2, True),
        process("wave", line, wave, np.array([[-0.93], [0.11], [0.7]]), [0.6], 1e-6, False),
    ]
    versions = {package: version(package) for package in ("numpy", "scipy", "scikit-learn", "SALib")}
    if RSCRIPT:
        command = 'cat(paste(getRversion(), "DiceKriging", packageVersion("DiceKriging")))'
        versions["R"] = subprocess.run([RSCRIPT, "-e", command], capture_output=True, text=True, check=True).stdout
    written = {
        "made with": versions,
        "processes": processes,
        "replicates": replicates(random),
        "sobol": sobol_indices(random),
        "morris": morris(random),
    }
    (HERE / "expected.json").write_text(json.dumps(written, indent=1) + "\n")


if __name__ == "__main__":
    main()
