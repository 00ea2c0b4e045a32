"""The model once more, from its equations alone and in extended precision, to hold the program against.

Written without sight of the program, in NumPy's `longdouble`: 64 bits of mantissa on x86, where one rounding is 5e-20 of the
value, 2000 times less than in the program's float64. Functions stand in the order of a step: contact, wear, debris, advance.
Operation is constant, under a load or a braking torque; cycles and temperature are left out.
Arrays have the shape (columns, rows) of the files; units are SI. docs/model.md says in words what is computed.
"""

from dataclasses import dataclass, field

import numpy as np

Real = np.longdouble
PI = Real("3.14159265358979323846264338327950288")
NONE, PRIMARY, SECONDARY = 0, 1, 2
# Signs of the direction in which wear moves a surface: the pin away from the disc, the disc away from the pin.
PIN, DISC = 1, -1
VOLUMES = ["emitted", "returned", "deposited_pin", "deposited_disc", "worn_pin", "worn_resin", "worn_disc"]
IS_WIDER = np.finfo(Real).nmant > np.finfo(np.float64).nmant


@dataclass
class Material:
    youngs_modulus: Real
    poisson_ratio: Real
    specific_wear_rate: Real = Real(0)
    wear_height: Real = Real(0)
    # Of the pin: the rate where the disc is secondary, and the pressure that breaks a build-up on resin away.
    wear_rate_against_secondary: Real | None = None
    strength: Real = Real("inf")

    def __post_init__(self):
        if self.wear_rate_against_secondary is None:
            self.wear_rate_against_secondary = self.specific_wear_rate


@dataclass
class Friction:
    """Shear stress of a thin film for each status of the pin, in the order of the statuses, and a ceiling of the coefficient."""

    pressure_coefficient: np.ndarray
    shear_strength: np.ndarray
    maximum: Real = Real("inf")


@dataclass
class Parameters:
    """What a scene says; `pin` and `disc` are materials by status, the disc has none for `NONE`."""

    inner_radius: Real
    outer_radius: Real
    rows: int
    disc_columns: int
    pin_columns: int
    # None where the braking torque is given.
    normal_force: Real | None
    angular_speed: Real
    steps: int
    foundation_height: Real
    pin: dict[int, Material]
    disc: dict[int, Material]
    debris: str = "contact"
    captured_fraction: Real = Real(1)
    pad_share: Real = Real("0.5")
    formation: bool = True
    destruction: bool = True
    time_acceleration: int = 1
    integrator: str = "explicit"
    transport_length: Real | None = None
    braking_torque: Real | None = None
    friction: Friction | None = None

    def __post_init__(self):
        self.angle = 2 * PI / self.disc_columns
        self.width = (self.outer_radius - self.inner_radius) / self.rows
        self.radius = self.inner_radius + (np.arange(self.rows, dtype=Real) + Real("0.5")) * self.width
        self.area = self.radius * self.width * self.angle
        self.pin_area = self.pin_columns * self.area.sum()
        self.step_time = self.angle / self.angular_speed
        self.mean_radius = (self.inner_radius + self.outer_radius) / 2
        # Sliding distance of a step in each row.
        self.sliding = self.time_acceleration * self.radius * self.angle


@dataclass
class State:
    disc_height: np.ndarray
    disc_substrate: np.ndarray
    pin_height: np.ndarray
    pin_substrate: np.ndarray
    base: np.ndarray
    # One value for the whole contact, or one for each row.
    pool: np.ndarray
    # The highest initial height of the disc, and the volume below it that is open at first.
    reference: Real
    open_at_first: Real
    step: int = 0
    # Since the start.
    volumes: dict[str, Real] = field(default_factory=lambda: dict.fromkeys(VOLUMES, Real(0)))
    contact_areas: list[Real] = field(default_factory=list)
    # Load and coefficient of friction of each step.
    loads: list[Real] = field(default_factory=list)
    coefficients: list[Real] = field(default_factory=list)
    # Of the last step.
    displacement: Real = Real(0)
    pressure: np.ndarray | None = None


@dataclass
class Pairs:
    """The pin's cells and the disc's cells below them as they are at the start of a step."""

    columns: np.ndarray
    pin_status: np.ndarray
    disc_status: np.ndarray
    stiffness: np.ndarray
    gap: np.ndarray


def start(parameters, disc_height, pin_height, base):
    """The state before the first step, from heights in float64."""
    z_d, z_p = np.array(disc_height, dtype=Real), np.array(pin_height, dtype=Real)
    pools = parameters.rows if parameters.debris == "track" else 1
    open_volume = (parameters.area * (z_d.max() - z_d)).sum()
    pool = np.zeros(pools, dtype=Real)
    return State(z_d, z_d.copy(), z_p, z_p.copy(), np.array(base, dtype=int), pool, z_d.max(), open_volume)


def statuses(state, thinner=0):
    """Statuses of all cells of the pin and of the disc; build-ups thinner than `thinner` (m) are none."""

    def is_secondary(thickness):
        return (thickness > 0) & (thickness >= thinner)

    pin = np.where(is_secondary(state.pin_substrate - state.pin_height), SECONDARY, state.base)
    disc = np.where(is_secondary(state.disc_height - state.disc_substrate), SECONDARY, PRIMARY)
    return pin, disc


def by_status(materials, name, status):
    """A property of the material of each cell."""
    table = np.array([getattr(materials[s], name) if s in materials else Real("nan") for s in range(3)], dtype=Real)
    return table[status]


def neighbour(values, absent):
    """What the neighbour in the sliding direction has; the last column has no neighbour and gets `absent`."""
    return np.concatenate([values[1:], np.full_like(values[:1], absent)])


def pairs(state, parameters):
    """Which cells face each other in this step, and with which gap and stiffness per area."""
    columns = (np.arange(parameters.pin_columns) - state.step) % parameters.disc_columns
    pin_status, disc_status = statuses(state)
    disc_status = disc_status[columns]

    def compliance(materials, status):
        return (1 - by_status(materials, "poisson_ratio", status) ** 2) / by_status(materials, "youngs_modulus", status)

    modulus = 1 / (compliance(parameters.pin, pin_status) + compliance(parameters.disc, disc_status))
    gap = state.pin_height - state.disc_height[columns]
    return Pairs(columns, pin_status, disc_status, modulus / parameters.foundation_height, gap)


def displacement(gap, spring, force):
    """The displacement at which springs (N/m) that touch at the gaps carry the force together.

    Between two gaps the load is linear in the displacement. So with gaps in order, the springs in contact are those at whose gap
    the springs before them carry less than the force; one division gives the displacement.
    """
    order = np.argsort(gap, axis=None, kind="stable")
    first = gap.min()
    gap, spring = gap.ravel()[order] - first, spring.ravel()[order]
    stiffness, moment = np.cumsum(spring), np.cumsum(spring * gap)
    touching = np.count_nonzero(gap * stiffness - moment < force)
    return first + (force + moment[touching - 1]) / stiffness[touching - 1]


def raw_losses(pin_rate, disc_rate, overlap, stiffness, parameters):
    """Height that wear takes from pin and disc where nothing else limits it; rates in 1/Pa."""
    if parameters.integrator == "explicit":
        work = stiffness * overlap * parameters.sliding
        return pin_rate * work, disc_rate * work
    rate = pin_rate + disc_rate
    both = -overlap * np.expm1(-rate * stiffness * parameters.sliding)
    share = both / np.where(rate > 0, rate, 1)
    return pin_rate * share, disc_rate * share


def remove(height, substrate, secondary, raw, raw_of_substrate, direction):
    """New height and substrate of a surface, and the height it really lost.

    A build-up goes first. What is left of the step when it is worn through takes its part of the substrate.
    """
    build_up = np.abs(substrate - height)
    through = secondary & (raw >= build_up)
    rest = np.where(through, (1 - build_up / np.where(through, raw, 1)) * raw_of_substrate, 0)
    new_height = np.where(through, substrate + direction * rest, height + direction * raw)
    new_substrate = direction * np.maximum(direction * substrate, direction * new_height)
    return new_height, np.where(through, new_height, new_substrate), np.where(through, build_up + rest, raw)


def wear(state, pair, overlap, parameters):
    """Wears both surfaces; the heights that the cells of pin and disc lost."""
    pin, disc = parameters.pin, parameters.disc

    def rate_of_pin(status):
        alone, on_build_up = (by_status(pin, name, status) for name in ("specific_wear_rate", "wear_rate_against_secondary"))
        return np.where(pair.disc_status == SECONDARY, on_build_up, alone)

    pin_rate = rate_of_pin(pair.pin_status)
    disc_rate = by_status(disc, "specific_wear_rate", pair.disc_status)
    pin_base_rate = np.where(state.base == PRIMARY, rate_of_pin(np.full_like(state.base, PRIMARY)), Real(0))
    pin_raw, disc_raw = raw_losses(pin_rate, disc_rate, overlap, pair.stiffness, parameters)
    pin_base, _ = raw_losses(pin_base_rate, disc_rate, overlap, pair.stiffness, parameters)
    _, disc_base = raw_losses(pin_rate, disc[PRIMARY].specific_wear_rate, overlap, pair.stiffness, parameters)
    resin = (pair.pin_status == NONE) & (overlap > 0)
    pin_raw = np.where(resin, pin[NONE].wear_height, pin_raw)

    below = pair.columns
    state.pin_height, state.pin_substrate, pin_lost = remove(
        state.pin_height, state.pin_substrate, pair.pin_status == SECONDARY, pin_raw, pin_base, PIN
    )
    state.disc_height[below], state.disc_substrate[below], disc_lost = remove(
        state.disc_height[below], state.disc_substrate[below], pair.disc_status == SECONDARY, disc_raw, disc_base, DISC
    )
    of_resin = pair.pin_status == NONE
    state.volumes["worn_pin"] += (parameters.area * np.where(of_resin, 0, pin_lost)).sum()
    state.volumes["worn_resin"] += (parameters.area * np.where(of_resin, pin_lost, 0)).sum()
    state.volumes["worn_disc"] += (parameters.area * disc_lost).sum()
    return pin_lost, disc_lost


def break_away(state, pair, parameters):
    """Takes build-ups on resin that are pressed harder than their strength; the height that each cell loses."""
    over = (pair.pin_status == SECONDARY) & (state.base == NONE) & (state.pressure > parameters.pin[SECONDARY].strength)
    broken = np.where(over, state.pin_substrate - state.pin_height, 0)
    state.pin_height = np.where(over, state.pin_substrate, state.pin_height)
    state.volumes["returned"] += (parameters.area * broken).sum()
    return broken


def deposit(state, pair, on_pin, on_disc, parameters):
    """Adds debris of these heights; substrates stay."""
    state.pin_height = state.pin_height - on_pin
    state.disc_height[pair.columns] += on_disc
    state.volumes["deposited_pin"] += (parameters.area * on_pin).sum()
    state.volumes["deposited_disc"] += (parameters.area * on_disc).sum()


def clearance(state, pair, contact):
    """What is open between pin and disc at the displacement of this step; 0 in contact."""
    open_height = state.pin_height - state.disc_height[pair.columns] - state.displacement
    return np.where(contact, 0, np.maximum(open_height, 0))


def gathered_and_spread(lost, pair, contact, parameters):
    """Height of debris offered to each open cell where it is gathered and spread over the transport length.

    Plateaus that touch in an unbroken row give to the open cell behind them, and that hands the mean to the open cells behind it.
    """
    cells = max(1, int(np.rint(parameters.transport_length / (parameters.mean_radius * parameters.angle))))
    compacts = np.where(contact & (pair.pin_status != NONE), lost, 0)
    unbroken, touching, gathered = ~contact, contact, np.zeros_like(lost)
    for _ in range(cells):
        touching, compacts = neighbour(touching, False), neighbour(compacts, 0)
        unbroken = unbroken & touching
        gathered = gathered + np.where(unbroken, compacts, 0)
    handed, offered = parameters.captured_fraction * gathered / cells, np.zeros_like(lost)
    for _ in range(cells):
        offered = offered + handed
        handed = np.where(contact, 0, neighbour(handed, 0))
    return offered


def local_debris(state, pair, contact, lost, broken, parameters):
    """The wear ahead fills the gap behind it, on the pin and on the disc."""
    if parameters.formation:
        if parameters.transport_length is None:
            offered = neighbour(parameters.captured_fraction * lost, 0)
        else:
            offered = gathered_and_spread(lost, pair, contact, parameters)
        recess = state.pin_height - neighbour(state.pin_height, 0)
        room_pin = np.where(neighbour(pair.pin_status, NONE) != NONE, np.maximum(recess, 0), 0)
        room_disc = np.maximum(state.reference - state.disc_height[pair.columns], 0)
        filled = np.minimum(np.minimum(clearance(state, pair, contact), room_pin + room_disc), offered)
        on_pin = np.minimum(filled, room_pin)
        on_disc = filled - on_pin
    else:
        on_pin = on_disc = filled = np.zeros_like(lost)
    deposit(state, pair, on_pin, on_disc, parameters)
    state.volumes["emitted"] += (parameters.area * (lost + broken - filled)).sum()


def of_pools(values, parameters):
    """Sums of values of the pin's cells over what shares a pool."""
    return values.sum(axis=0) if parameters.debris == "track" else values.sum().reshape(1)


def destruction(state, pair, parameters):
    """Build-ups on resin without a plateau ahead lose their support; the volume that goes back to each pool."""
    secondary = state.pin_height < state.pin_substrate
    lost = secondary & (state.base == NONE) & (neighbour(pair.pin_status, NONE) == NONE)
    if not parameters.destruction:
        lost[:] = False
    back = np.where(lost, parameters.area * (state.pin_substrate - state.pin_height), 0)
    state.pin_height = np.where(lost, state.pin_substrate, state.pin_height)
    state.volumes["returned"] += back.sum()
    return of_pools(back, parameters)


def pooled_debris(state, pair, contact, lost, broken, parameters):
    """Debris that is in the contact settles in equal height wherever it is open."""
    returned = of_pools(parameters.area * broken, parameters) + destruction(state, pair, parameters)
    open_area = of_pools(np.where(contact, 0, parameters.area), parameters)
    has_room = open_area > 0
    layer = np.where(has_room & parameters.formation, state.pool / np.where(has_room, open_area, 1), 0)
    filled = np.minimum(clearance(state, pair, contact), layer)
    pad_share = np.where(neighbour(pair.pin_status, NONE) != NONE, parameters.pad_share, Real(0))
    on_pin = pad_share * filled
    deposit(state, pair, on_pin, filled - on_pin, parameters)

    worn = of_pools(parameters.area * lost, parameters)
    deposited = of_pools(parameters.area * filled, parameters)
    # Where every open cell took the whole layer nothing is left, whatever the sums round to.
    short = of_pools(~contact & (filled < layer), parameters) > 0
    emptied = ~short & has_room & parameters.formation
    left = np.where(emptied, 0, state.pool - deposited)
    state.pool = left + parameters.captured_fraction * worn + returned
    state.volumes["emitted"] += (1 - parameters.captured_fraction) * worn.sum()


def load(state, parameters):
    """The load of a step: the one given, or what the torque needs at the coefficient of friction of the step before."""
    if parameters.braking_torque is None:
        return parameters.normal_force
    coefficient = state.coefficients[-1] if state.coefficients else parameters.friction.maximum
    if coefficient < Real("0.01"):
        raise ValueError(f"the coefficient of friction before step {state.step + 1} is {coefficient:.3g}, less than 0.01")
    return parameters.braking_torque / (parameters.mean_radius * coefficient)


def coefficient_of_friction(state, pair, contact, force, parameters):
    """Shear force of what touches over the load, with the law of each status of the pin and a ceiling for all."""
    law = parameters.friction
    stress = law.shear_strength[pair.pin_status] + law.pressure_coefficient[pair.pin_status] * state.pressure
    return min((parameters.area * np.where(contact, stress, 0)).sum() / force, law.maximum)


def advance(state, parameters):
    """One step: all cells at once, from the state at its start."""
    pair = pairs(state, parameters)
    force = load(state, parameters)
    state.displacement = displacement(pair.gap, pair.stiffness * parameters.area, force)
    overlap = np.maximum(state.displacement - pair.gap, 0)
    contact = overlap > 0
    state.pressure = pair.stiffness * overlap
    state.contact_areas.append((parameters.area * contact).sum())
    if parameters.friction:
        state.loads.append(force)
        state.coefficients.append(coefficient_of_friction(state, pair, contact, force, parameters))
    pin_lost, disc_lost = wear(state, pair, overlap, parameters)
    broken = break_away(state, pair, parameters)
    debris = local_debris if parameters.debris == "local" else pooled_debris
    debris(state, pair, contact, pin_lost + disc_lost, broken, parameters)
    state.step += 1


def friction_sample(state, parameters):
    """What is reported of friction, and of the operation that follows from it."""
    loads, coefficients = np.array(state.loads), np.array(state.coefficients)
    last = slice(-parameters.disc_columns, None)
    distance = parameters.time_acceleration * parameters.angle * parameters.mean_radius
    reported = {
        "friction_coefficient": coefficients[-1],
        "friction_coefficient_mean": (coefficients[last] * loads[last]).sum() / loads[last].sum(),
        "friction_work": (coefficients * loads).sum() * distance,
    }
    if parameters.braking_torque is not None:
        reported |= {"normal_force": loads[-1], "rotational_speed": parameters.angular_speed}
    return reported


def sample(state, parameters):
    """What is reported, under the names of the run file; `contact_area` and what rests on it belong to the last step."""
    p = parameters
    # Model 2: reports leave out what is thinner than 1e-15 m.
    pin, disc = statuses(state, 1e-15)
    contact_area = state.contact_areas[-1]
    step_time = p.time_acceleration * p.step_time
    open_volume = (p.area * np.maximum(state.reference - state.disc_height, 0)).sum()
    return {
        "time": state.step * step_time,
        "displacement": state.displacement,
        "contact_area": contact_area,
        "contact_area_mean": np.mean(state.contact_areas[-p.disc_columns :]),
        "contact_area_integral": np.sum(state.contact_areas) * step_time,
        "sliding_distance": state.step * p.time_acceleration * p.angle * p.mean_radius,
        "contact_ratio": contact_area / p.pin_area,
        "mean_pressure": (p.area * state.pressure).sum() / contact_area,
        "max_pressure": state.pressure.max(),
        "pool": state.pool.sum(),
        **state.volumes,
        "pin_primary": (p.area * (pin == PRIMARY)).sum() / p.pin_area,
        "pin_secondary": (p.area * (pin == SECONDARY)).sum() / p.pin_area,
        "pin_none": (p.area * (pin == NONE)).sum() / p.pin_area,
        "disc_secondary": (p.area * (disc == SECONDARY)).sum() / (p.disc_columns * p.area.sum()),
        "filled_fraction": 1 - open_volume / state.open_at_first if state.open_at_first > 0 else Real(0),
        **(friction_sample(state, p) if p.friction else {}),
    }


def run(parameters, state, every=1):
    """Takes every step; each series as an array over every so many steps."""
    samples = []
    for _ in range(parameters.steps):
        advance(state, parameters)
        if state.step % every == 0:
            samples.append(sample(state, parameters))
    return {name: np.array([entry[name] for entry in samples]) for name in samples[0]}
