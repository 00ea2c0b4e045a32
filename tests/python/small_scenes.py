"""Small scenes as files: random ones are written, and those of which every height comes from an HDF5 file are read."""

import tomllib
from pathlib import Path

import h5py
import numpy as np
from extended_precision import NONE, PI, PRIMARY, SECONDARY, Friction, Material, Parameters, Real, start

# Every property of every body and status differs from every other.
DIFFERENT = {
    "disc_primary": {"youngs_modulus": "2e11 Pa", "poisson_ratio": 0.25, "specific_wear_rate": "1e-15 1/Pa"},
    "disc_secondary": {"youngs_modulus": "5e9 Pa", "poisson_ratio": 0.33, "specific_wear_rate": "2e-14 1/Pa"},
    "pin_primary": {"youngs_modulus": "1e9 Pa", "poisson_ratio": 0.27, "specific_wear_rate": "5e-14 1/Pa"},
    "pin_secondary": {"youngs_modulus": "4e8 Pa", "poisson_ratio": 0.3, "specific_wear_rate": "8e-14 1/Pa"},
    "pin_resin": {"youngs_modulus": "3e5 Pa", "poisson_ratio": 0.45, "wear_height": "2e-06 m"},
}
# As in the paper: plateaus are alike, the disc does not wear.
ALIKE = {
    **dict.fromkeys(("disc_primary", "disc_secondary"), DIFFERENT["disc_primary"] | {"specific_wear_rate": "0 1/Pa"}),
    **dict.fromkeys(("pin_primary", "pin_secondary"), DIFFERENT["pin_primary"]),
    "pin_resin": {"youngs_modulus": "1e5 Pa", "poisson_ratio": 0.27, "wear_height": "5e-06 m"},
}


def lines(table, path=""):
    """A table as TOML; its strings need no escapes."""
    values = {key: value for key, value in table.items() if not isinstance(value, dict)}
    if path:
        yield f"[{path}]"
    for key, value in values.items():
        yield f"{key} = " + (f'"{value}"' if isinstance(value, str) else str(value).lower())
    for key in [key for key in table if key not in values]:
        yield from lines(table[key], f"{path}.{key}" if path else key)


def heights(random, columns, rows, roughness, smooth):
    """Random heights; each is the mean of so many neighbours on the ring, brought back to the roughness asked for."""
    height = random.standard_normal((columns, rows))
    height = sum(np.roll(height, shift, axis=0) for shift in range(smooth))
    return height * (roughness / height.std())


def write(
    folder,
    seed,
    *,
    plateaus,
    materials=DIFFERENT,
    mesh=(6, 60, 15),
    steps=250,
    sample_every_steps=1,
    time_acceleration=20,
    integrator="explicit",
    nominal_pressure=1.5e6,
    disc_roughness=2e-6,
    pin_roughness=0.5e-6,
    fibres=0.4,
    resin_recess=1e-6,
    smooth=3,
    friction=None,
    torque=False,
):
    """Writes a random scene and its heights into a folder; the path of the scene.

    With `torque` the load comes from the torque that it has at a coefficient of friction of 0.4.
    """
    random = np.random.default_rng(seed)
    rows, disc_columns, pin_columns = mesh
    disc = heights(random, disc_columns, rows, disc_roughness, smooth)
    # The highest part is cut off, as after grinding.
    disc = np.minimum(disc, disc.mean() + disc_roughness)
    fibre = heights(random, pin_columns, rows, 1.0, smooth)
    base = (fibre > np.quantile(fibre, 1 - fibres)).astype(np.uint8)
    pin = np.where(base == PRIMARY, 0.0, resin_recess) + heights(random, pin_columns, rows, pin_roughness, 1)
    with h5py.File(Path(folder) / "init.h5", "w") as file:
        file["/disc/height"], file["/pin/height"], file["/pin/base"] = disc, pin, base
    inner, outer = 0.02, 0.02 + 5e-5 * rows
    area = np.pi * (outer**2 - inner**2) * pin_columns / disc_columns
    force = float(nominal_pressure * area)
    scene = {
        "version": 1,
        "title": f"seed {seed}",
        "mesh": {
            "inner_radius": f"{inner!r} m",
            "outer_radius": f"{outer!r} m",
            "rows": rows,
            "disc_columns": disc_columns,
            "pin_columns": pin_columns,
        },
        "operation": {
            **({"braking_torque": f"{0.4 * force * (inner + outer) / 2!r} N m"} if torque else {"normal_force": f"{force!r} N"}),
            "rotational_speed": "850 rpm",
            "steps": steps,
        },
        "contact": {"foundation_height": "5e-05 m", "load_tolerance": 1e-12},
        "materials": materials,
        "plateaus": plateaus,
        "disc": {"surface": {"file": "init.h5", "dataset": "/disc/height"}},
        "pin": {"surface": {"file": "init.h5", "dataset": "/pin/height"}, "base": {"file": "init.h5", "dataset": "/pin/base"}},
        "numerics": {"time_acceleration": time_acceleration, "integrator": integrator},
        "output": {"file": "run.h5", "sample_every_steps": sample_every_steps},
    }
    if friction:
        scene["friction"] = friction
    path = Path(folder) / "scene.toml"
    path.write_text("\n".join(lines(scene)) + "\n")
    return path


def quantity(text):
    """A quantity in SI units, or a speed in rpm; the number is the float64 that its text stands for."""
    value, unit = text.split(" ", 1)
    if unit not in ("m", "N", "N m", "Pa", "1/Pa", "rpm"):
        raise ValueError(f"{text}: the unit is not one that is read here")
    return Real(float(value)) * (2 * PI / 60 if unit == "rpm" else 1)


def optional(table, key):
    return quantity(table[key]) if key in table else None


def material(table):
    return Material(**{key: quantity(value) if isinstance(value, str) else Real(value) for key, value in table.items()})


def friction_law(table):
    """The laws of resin, primary and secondary plateaus; resin and secondary are as primary where they give no key."""
    laws = [table | table.get(name, {}) for name in ("resin", "primary", "secondary")]
    return Friction(
        np.array([Real(law["pressure_coefficient"]) for law in laws]),
        np.array([quantity(law["shear_strength"]) for law in laws]),
        Real(table.get("maximum", "inf")),
    )


def read(path):
    """Parameters and initial state of a scene of constant operation, in extended precision; of optional parts friction alone."""
    scene = tomllib.loads(Path(path).read_text())
    mesh, operation, plateaus = scene["mesh"], scene["operation"], scene["plateaus"]
    materials = {name: material(table) for name, table in scene["materials"].items()}
    parameters = Parameters(
        inner_radius=quantity(mesh["inner_radius"]),
        outer_radius=quantity(mesh["outer_radius"]),
        rows=mesh["rows"],
        disc_columns=mesh["disc_columns"],
        pin_columns=mesh["pin_columns"],
        normal_force=optional(operation, "normal_force"),
        angular_speed=quantity(operation["rotational_speed"]),
        steps=operation["steps"],
        foundation_height=quantity(scene["contact"]["foundation_height"]),
        pin={NONE: materials["pin_resin"], PRIMARY: materials["pin_primary"], SECONDARY: materials["pin_secondary"]},
        disc={PRIMARY: materials["disc_primary"], SECONDARY: materials["disc_secondary"]},
        debris=plateaus.get("debris") or plateaus["debris_pool"],
        captured_fraction=Real(plateaus["captured_fraction"]),
        pad_share=Real(plateaus.get("pad_share", 0.5)),
        formation=plateaus["formation"],
        destruction=plateaus.get("destruction", True),
        time_acceleration=scene["numerics"]["time_acceleration"],
        integrator=scene["numerics"]["integrator"],
        transport_length=optional(plateaus, "transport_length"),
        braking_torque=optional(operation, "braking_torque"),
        friction=friction_law(scene["friction"]) if "friction" in scene else None,
    )

    def dataset(source):
        with h5py.File(Path(path).parent / source["file"]) as file:
            return file[source["dataset"]][()]

    surfaces = dataset(scene["disc"]["surface"]), dataset(scene["pin"]["surface"])
    return parameters, start(parameters, *surfaces, dataset(scene["pin"]["base"]))
