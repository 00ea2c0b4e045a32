"""Other readings of the local debris rule, which no scene has (rule.py), on the reduced mesh.

usage: variants.py, in an environment with requirements.txt and with the package plateau; run.sh calls it

Writes runs/readings.json: the rule as it stands checked against the program, and of every reading, disc and set of
surfaces what evaluate.py reads of a run. Numbers that are there already are not made again.
"""

import json
import warnings
from pathlib import Path

import measures
import numpy as np
import xarray
from discs import SCENES
from history import END, history
from pin import of_the_pin
from readings import READINGS, SEEDS
from rule import SUMS, steps

import plateau

HERE = Path(__file__).parent
RUNS = HERE / "runs"
RESULTS = RUNS / "readings.json"
# Length of the check, steps, and the maps that are compared.
CHECKED = (1, 5000, 10_000, 20_000)


def run(name: str, seed: int, heights: str, count: int) -> xarray.DataTree:
    """A run of the program on the reduced mesh with a set of surfaces, of some steps."""
    keys = ("disc.surface.synthetic.seed", "pin.base.synthetic.seed", "pin.surface.synthetic.seed")
    changes = dict.fromkeys(keys, seed) | {"disc.prepare.scale": float(heights), "operation.steps": count, "output.maps_at": ["0 s"]}
    with warnings.catch_warnings():
        # That a run of one step has a single sample is meant.
        warnings.simplefilter("ignore", plateau.PlateauWarning)
        return plateau.run(HERE / "reduced.toml", RUNS / f"{name}.h5", set=changes, workers=1, force=True, progress=False)


class Model:
    """The rule from the initial state of a run on, with the scene of that run."""

    def __init__(self, run: xarray.DataTree, reading: tuple[int, int]) -> None:
        scene = run.plateau.scene
        disc, pin = (run[f"{body}/height"][0].values for body in ("disc", "pin"))
        self.radius, self.base = run["radius"].values, run["pin/base"].values.astype(np.int64)
        self.disc, self.pin = (disc, disc.copy()), (pin, pin.copy(), self.base)
        self.initial, self.reading = disc.copy(), reading
        number = lambda text: float(str(text).split()[0])  # noqa: E731, with the units of reduced.toml
        mesh, operation, materials = scene["mesh"], scene["operation"], scene["materials"]
        turn = 2 * np.pi / mesh["disc_columns"]
        across = (number(mesh["outer_radius"]) - number(mesh["inner_radius"])) * 1e-3 / mesh["rows"]
        acceleration = scene["numerics"]["time_acceleration"]
        self.step = acceleration * turn / (number(operation["rotational_speed"]) * 2 * np.pi / 60)
        self.area, self.slide = self.radius * turn * across, acceleration * self.radius * turn
        self.force = number(operation["normal_force"])
        height = number(scene["contact"]["foundation_height"]) * 1e-6

        def modulus(name: str) -> float:
            of = materials[name]
            return number(of["youngs_modulus"]) / (1 - of["poisson_ratio"] ** 2) / height

        def rate(name: str) -> float:
            return number(materials[name]["specific_wear_rate"])

        of_pin = np.array([modulus("pin_resin"), modulus("pin_primary"), modulus("pin_secondary")])
        of_disc = np.array([np.nan, modulus("disc_primary"), modulus("disc_secondary")])
        self.materials = (
            1 / (1 / of_pin[:, None] + 1 / of_disc),
            np.array([0.0, rate("pin_primary"), rate("pin_secondary")]),
            number(materials["pin_resin"]["wear_height"]) * 1e-6,
        )
        self.taken, self.delta, self.sums = 0, -np.inf, np.zeros(len(SUMS))
        self.pressure = np.zeros_like(pin)

    def advance(self, count: int) -> None:
        """Takes some steps."""
        self.delta = steps(
            self.taken,
            count,
            self.disc,
            self.pin,
            (self.area, self.slide),
            self.materials,
            self.force,
            self.delta,
            self.reading,
            self.initial.max(),
            self.sums,
            self.pressure,
        )
        self.taken += count

    def sample(self) -> dict[str, float]:
        """What a run file would have in its series now."""
        (z_d, b_d), (z_p, b_p, _) = self.disc, self.pin
        totals = dict(zip(SUMS, self.sums.tolist(), strict=True))
        time = self.taken * self.step
        return {
            "time": time,
            "sliding_distance": self.taken * float(self.slide.mean()),
            "contact_area_integral": totals.pop("contact_area") * self.step,
            **totals,
            "filled_fraction": measures.filled_volume(self.initial, z_d, self.radius),
            "pin_secondary": measures.share(z_p < b_p, self.radius),
            "disc_secondary": measures.share(z_d > b_d, self.radius),
            "pressure_gini": measures.gini(self.pressure, self.radius),
            "mean_pressure": self.force / measures.area_in_contact(self.pressure, self.area),
        }


def numbers_of(model: Model) -> dict[str, float]:
    """A run to the end, as evaluate.py has it of the program's."""
    total, every = int(np.ceil(END / model.step - 1e-9)), round(2.0 / model.step)
    samples, pins = [], []
    while model.taken < total:
        model.advance(min(every, total - model.taken))
        samples.append(model.sample())
        if samples[-1]["time"] > END - 56.0:
            height, substrate, base = model.pin
            pins.append(of_the_pin(height, substrate - height, base, model.pressure, model.radius))
    series = {key: np.array([sample[key] for sample in samples]) for key in samples[0]}
    return history(series) | {key: float(np.mean([pin[key] for pin in pins])) for key in pins[0]}


def check() -> list[dict[str, float]]:
    """Largest differences of heights between the program and the rule as it stands, after some steps, m."""
    found = []
    for heights in SCENES:
        model = None
        for count in CHECKED:
            with run("check", 1, heights, count) as made:
                model = model or Model(made, READINGS["the rule as it stands"])
                model.advance(count - model.taken)
                pairs = [(made["disc/height"], model.disc[0]), (made["pin/height"], model.pin[0])]
                of_disc, of_pin = (float(np.abs(one[-1].values - other).max()) for one, other in pairs)
            found.append({"heights": heights, "steps": count, "disc": of_disc, "pin": of_pin})
    return found


def main() -> None:
    found = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    if "check" not in found:
        found["check"] = check()
    for name, reading in READINGS.items():
        for heights in SCENES:
            for seed in SEEDS:
                key = f"{name}, {heights}, {seed}"
                if key in found:
                    continue
                with run("initial", seed, heights, 1) as initial:
                    model = Model(initial, reading)
                found[key] = numbers_of(model)
                RESULTS.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
