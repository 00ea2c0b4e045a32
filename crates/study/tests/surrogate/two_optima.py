#!/usr/bin/env python3
"""Makes `most_likely` of two_optima.json, which tests/surrogate.rs compares with, with scipy.

    python3 -m venv /tmp/venv && /tmp/venv/bin/pip install numpy==2.4.6 scipy==1.17.1 && /tmp/venv/bin/python two_optima.py

Two sets of 26 points of sums of sines with noise, drawn by lot, whose likelihood has two hills: a smooth response with noise,
and a rough one without. The higher hill is the rough one. It is looked for from sixty places in the whole box that the program
has for lengths and noise.
"""

import json
from importlib.metadata import version
from pathlib import Path

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.optimize import minimize

FILE = Path(__file__).with_name("two_optima.json")
SEARCHES = 60


def loss(logs, x, y):
    """Minus the log likelihood with the most likely constant and variance."""
    a = np.sqrt(5.0) * np.abs(x[:, None, :] - x[None, :, :]) / np.exp(logs[:-1])
    c = np.prod((1 + a + a * a / 3) * np.exp(-a), axis=2) + np.exp(logs[-1]) * np.eye(len(x))
    try:
        factor = cho_factor(c, lower=True)
    except LinAlgError:
        return 1e10
    solved = cho_solve(factor, np.ones(len(x)))
    left = y - solved @ y / solved.sum()
    variance = left @ cho_solve(factor, left) / len(y)
    return 0.5 * (len(y) * (np.log(2 * np.pi * variance) + 1) + 2 * np.log(np.diag(factor[0])).sum())


def most_likely(x, y):
    d = x.shape[1]
    low, high = np.log(np.r_[np.full(d, 0.05), 1e-8]), np.log(np.r_[np.full(d, 40.0), 1e2])
    random = np.random.default_rng(1)
    starts = [low + (high - low) * random.random(d + 1) for _ in range(SEARCHES)]
    found = [minimize(loss, start, (x, y), "L-BFGS-B", bounds=list(zip(low, high))).fun for start in starts]
    return -min(found)


def main():
    document = json.loads(FILE.read_text())
    document["made with"] = {package: version(package) for package in ("numpy", "scipy")}
    for case in document["sets"]:
        case["most_likely"] = most_likely(np.array(case["points"]), np.array(case["responses"]))
    FILE.write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
