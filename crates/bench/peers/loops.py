"""The step as loops over cells (column, row), compiled by Numba. z grows from the disc to the pin."""
import math

from numba import njit

MOST_EVALUATIONS = 200


@njit
def step(fields, rules, turned, displacement, pool):
    """Displacement, contact area, pool, deposited volume and load evaluations of a step."""
    displacement, contact_area, evaluations = balance_load(fields, rules, turned, displacement)
    if rules.local:
        deposited = wear_with_local_debris(fields, rules, turned, displacement)
    else:
        pool, deposited = wear_with_pool(fields, rules, turned, displacement, contact_area, pool)
    return displacement, contact_area, pool, deposited, evaluations


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


@njit
def wear_with_pool(fields, rules, turned, displacement, contact_area, pool):
    """What all cells lose is shared out evenly in the next step."""
    z_p, b_p, fibre, z_d, gap, _ = fields
    area = rules.area
    columns, rows = z_p.shape
    ring = z_d.shape[0]
    open_area = rules.pin_area - contact_area
    share = max(pool / open_area, 0.0) if open_area > 0.0 else 0.0
    worn, returned, deposited = 0.0, 0.0, 0.0
    # Column by column: the one ahead, j + 1, is still as it was at the start of the step
    for j in range(columns):
        c = (j - turned) % ring
        for i in range(rows):
            supported = j + 1 < columns and (fibre[j + 1, i] or z_p[j + 1, i] < b_p[j + 1, i])
            overlap = displacement - gap[j, i]
            if overlap > 0.0:
                build_up = b_p[j, i] - z_p[j, i]
                wear_per_overlap = rules.wear_rate * rules.stiffness_plateau * rules.sliding[i]
                loss = loss_of(fibre[j, i], build_up, overlap, wear_per_overlap, rules.wear_height)
                worn += loss * area[i]
                z_p[j, i] = b_p[j, i] if loss == build_up else z_p[j, i] + loss
                b_p[j, i] = max(b_p[j, i], z_p[j, i])
            if not fibre[j, i] and z_p[j, i] < b_p[j, i] and not supported:
                returned += (b_p[j, i] - z_p[j, i]) * area[i]
                z_p[j, i] = b_p[j, i]
            clearance = z_p[j, i] - z_d[c, i] - displacement
            if overlap <= 0.0 and clearance > 0.0:
                deposit = min(clearance, share)
                on_pin = rules.pad_share * deposit if supported else 0.0
                z_p[j, i] -= on_pin
                z_d[c, i] += deposit - on_pin
                deposited += deposit * area[i]
    return pool + rules.captured * worn + returned - deposited, deposited
