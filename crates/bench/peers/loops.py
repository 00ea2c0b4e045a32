"""The step as loops over cells (column, row), compiled by Numba. z grows from the disc to the pin."""

import math

from numba import njit

MOST_EVALUATIONS = 200


@njit
def step(fields, rules, turned, displacement):
    """Displacement, contact area, deposited volume and load evaluations of a step."""
    displacement, contact_area, evaluations = balance_load(fields, rules, turned, displacement)
    deposited = wear_with_local_debris(fields, rules, turned, displacement)
    return displacement, contact_area, deposited, evaluations


@njit
def balance_load(fields, rules, turned, displacement):
    """Newton's method from the last displacement."""
    z_p, b_p, fibre, z_d, gap, stiffness = fields
    area = rules.area
    columns, rows = z_p.shape
    ring = z_d.shape[0]
    for j in range(columns):
        c = (j - turned) % ring
        for i in range(rows):
            gap[j, i] = z_p[j, i] - z_d[c, i]
            plateau = fibre[j, i] or z_p[j, i] < b_p[j, i]
            stiffness[j, i] = (rules.stiffness_plateau if plateau else rules.stiffness_resin) * area[i]
    if math.isnan(displacement):
        displacement = math.inf
        for j in range(columns):
            for i in range(rows):
                displacement = min(displacement, gap[j, i] + rules.force / stiffness[j, i])
    evaluations = 0
    while True:
        load, slope, contact_area = 0.0, 0.0, 0.0
        for j in range(columns):
            for i in range(rows):
                overlap = displacement - gap[j, i]
                if overlap > 0.0:
                    load += stiffness[j, i] * overlap
                    slope += stiffness[j, i]
                    contact_area += area[i]
        evaluations += 1
        if abs(load - rules.force) <= rules.tolerance * rules.force or evaluations == MOST_EVALUATIONS:
            return displacement, contact_area, evaluations
        displacement += (rules.force - load) / slope


@njit
def loss_of(fibre, build_up, overlap, wear_per_overlap, wear_height):
    """What a pin cell in contact loses: of a build-up on resin at most all, of bare resin its wear height."""
    if fibre:
        return wear_per_overlap * overlap
    if build_up > 0.0:
        return min(wear_per_overlap * overlap, build_up)
    return wear_height


@njit
def wear_with_local_debris(fields, rules, turned, displacement):
    """What a cell loses fills the gap behind it; what finds no room there leaves the contact."""
    z_p, b_p, fibre, z_d, gap, _ = fields
    columns, rows = z_p.shape
    ring = z_d.shape[0]
    deposited = 0.0
    for j in range(columns):
        behind = (j - 1 - turned) % ring
        for i in range(rows):
            overlap = displacement - gap[j, i]
            if overlap > 0.0:
                build_up = b_p[j, i] - z_p[j, i]
                plateau = fibre[j, i] or build_up > 0.0
                wear_per_overlap = rules.wear_rate * rules.stiffness_plateau * rules.sliding[i]
                loss = loss_of(fibre[j, i], build_up, overlap, wear_per_overlap, rules.wear_height)
                # A build-up that is worn through leaves exactly what it lay on
                z_p[j, i] = b_p[j, i] if loss == build_up else z_p[j, i] + loss
                b_p[j, i] = max(b_p[j, i], z_p[j, i])

                # Column j - 1 has been worn before, but nothing has been deposited in it yet
                if j > 0 and displacement <= gap[j - 1, i]:
                    to_plateau = max(z_p[j - 1, i] - z_p[j, i], 0.0) if plateau else 0.0
                    to_reference = max(rules.reference_height - z_d[behind, i], 0.0)
                    clearance = gap[j - 1, i] - displacement
                    deposit = min(clearance, to_plateau + to_reference, rules.captured * loss)
                    on_pin = min(deposit, to_plateau)
                    z_p[j - 1, i] -= on_pin
                    z_d[behind, i] += deposit - on_pin
                    deposited += deposit * rules.area[i]
    return deposited
