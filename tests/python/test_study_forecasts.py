"""Forecasts of studies: the Gaussian process, which surrogate is taken, predictions, and parts of the variance."""

import json
import sys
import unittest
from pathlib import Path

import numpy as np
from plateau.study.process import Equations, Process

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "coverage"))
import forecasts

# Values of scikit-learn's GaussianProcessRegressor and of DiceKriging (R).
REFERENCES = json.loads((HERE / "expected" / "processes.json").read_text(encoding="utf-8"))


class ProcessTest(unittest.TestCase):
    def test_given_lengths_agree_with_scikit_learn_and_dicekriging(self):
        for case in REFERENCES["processes"]:
            x, y = np.array(case["points"]), np.array(case["responses"])
            logs = np.log([*case["lengths"], case["noise"]])[None]
            found = Equations(x, y, np.ones(len(y)), (0.0, 0), logs, np.arange(x.shape[1]))
            variance = found.square / len(y)
            likelihood = -0.5 * (len(y) * (np.log(2.0 * np.pi * variance) + 1.0) + found.log_determinant)
            weights, shares = found.forecast(np.array(case["new"]))
            left_out = np.array(case["left_out"])
            # The equations of the worst case have a condition of 1e7.
            for what, value, expected in (
                ("likelihood", likelihood[0], case["log_likelihood"]),
                ("variance", variance[0], case["variance"]),
                ("means", (weights @ y)[0], case["means"]),
                ("variances", (variance * shares)[0], case["variances"]),
                ("left out", y - found.left_out()[0][0], left_out[:, 0]),
                ("their variances", variance[0] / np.diag(found.inverse[0]), left_out[:, 1]),
            ):
                with self.subTest(case["name"], what=what):
                    np.testing.assert_allclose(value, expected, rtol=1e-8, atol=1e-11 * np.abs(expected).max())

    def test_replicates_are_as_likely_as_all_their_runs(self):
        case = REFERENCES["replicates"]
        y = np.array(case["responses"])
        process = Process(np.repeat(case["points"], y.shape[1], axis=0), y.ravel(), np.tile(np.arange(y.shape[1]), len(y)))
        found = process.solved(np.log([*case["lengths"], case["noise"]]))
        variance = found.square[0] / (found.freedom + 1)
        likelihood = -0.5 * ((found.freedom + 1) * (np.log(2.0 * np.pi * variance) + 1.0) + found.log_determinant[0])
        np.testing.assert_allclose([variance, likelihood], [case["variance"], case["log_likelihood"]], rtol=1e-8)

    def test_slopes_are_differences(self):
        x = np.array(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 4))).reshape(2, -1).T
        y, at, step = x[:, 0] ** 2 + x[:, 1] + 0.1 * np.sin(9.0 * x[:, 0]), np.log([[0.8, 1.7, 0.02]]), 1e-5 * np.eye(3)

        def solved(logs):
            return Equations(x, y, np.full(20, 1 / 3), (0.1, 38), logs, np.arange(2))

        difference = (solved(at + step).log_density - solved(at - step).log_density) / 2e-5
        np.testing.assert_allclose(solved(at).gradient()[0], difference, rtol=1e-6, atol=1e-6)

    def test_means_and_seeds_by_hand(self):
        # y = m + b exactly, so that the means come out whichever run is missing: 10, 20, 40 and -3, 0, 3.
        point, seed = np.array([0, 0, 1, 1, 2, 2, 2]), np.array([0, 1, 1, 2, 0, 1, 2])
        process = Process(point[:, None] - 1.0, np.array([10.0, 20.0, 40.0])[point] + np.array([-3.0, 0.0, 3.0])[seed], seed)
        np.testing.assert_allclose(process.means, [10.0, 20.0, 40.0], rtol=1e-9)
        # The variance of the seeds is 9.
        np.testing.assert_allclose(process.moments([[0.3]])[2], 9.0, rtol=1e-3)

    def test_pure_chance_is_not_foretold(self):
        foretold = 0
        for seed in range(24):
            random = np.random.default_rng(seed)
            y = random.uniform(-1.0, 1.0, 12)
            error, _ = Process(random.uniform(-1.0, 1.0, (12, 2)), y).loo()
            foretold += (error**2).mean() < 0.9 * y.var()
        self.assertLessEqual(foretold, 3)

    def test_words_are_indicators(self):
        random = np.random.default_rng(3)
        word, x = random.integers(0, 3, 40), random.uniform(-1.0, 1.0, 40)
        indicators = np.eye(3)[word]
        y = np.sin(2.0 * x) + np.array([0.0, 1.0, 5.0])[word]
        process = Process(np.column_stack([x, indicators]), y, axes=[0, 1, 1, 1])
        self.assertLess(np.abs(process.mean([[0.2, 0, 0, 1.0], [0.2, 1.0, 0, 0]]) - np.sin(0.4) - [5.0, 0.0]).max(), 0.1)

    def test_intervals_cover_the_truth(self):
        # Places of one function are alike: forty functions leave a standard error of 1 to 1.5 %.
        for study in (("very smooth", 2, 10, 2), ("comes to an end", 4, 20, 2), ("smooth", 3, 15, 1)):
            means, runs = forecasts.process_coverage(*study, 40)
            self.assertTrue(0.915 < means < 0.985 and 0.915 < runs < 0.985, (study, means, runs))


if __name__ == "__main__":
    unittest.main()
