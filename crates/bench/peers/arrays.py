"""The step as operations on whole arrays (column, row), for NumPy. z grows from the disc to the pin."""
import math

import numpy as np

MOST_EVALUATIONS = 200


def step(fields, rules, turned, displacement, pool):
    """Displacement, contact area, pool, deposited volume and load evaluations of a step."""
    z_p, b_p, fibre, z_d, gap, stiffness = fields
    under = (np.arange(z_p.shape[0]) - turned) % z_d.shape[0]
    disc = z_d[under]
    secondary = z_p < b_p
    plateau = fibre | secondary
    plateau_ahead = np.zeros_like(plateau)
    plateau_ahead[:-1] = plateau[1:]

    # Load balance: Newton's method from the last displacement
    np.subtract(z_p, disc, out=gap)
    np.multiply(np.where(plateau, rules.stiffness_plateau, rules.stiffness_resin), rules.area, out=stiffness)
    if math.isnan(displacement):
        displacement = (gap + rules.force / stiffness).min()
    evaluations = 0
    while True:
        overlap = np.maximum(displacement - gap, 0.0)
        touches = overlap > 0.0
        load = (stiffness * overlap).sum()
        evaluations += 1
        if abs(load - rules.force) <= rules.tolerance * rules.force or evaluations == MOST_EVALUATIONS:
            break
        displacement += (rules.force - load) / (stiffness * touches).sum()
    contact_area = (touches * rules.area).sum()

    # Wear; a build-up on resin that is worn through leaves exactly what it lay on
    build_up = b_p - z_p
    loss = overlap * (rules.wear_rate * rules.stiffness_plateau * rules.sliding)
    worn_through = secondary & ~fibre & (loss >= build_up)
    loss = np.where(worn_through, build_up, loss)
    loss = np.where(plateau, loss, rules.wear_height * touches)
    z_p += loss
    np.copyto(z_p, b_p, where=worn_through)
    np.maximum(b_p, z_p, out=b_p)

    if rules.local:
        on_pin, deposit = local_debris(z_p, disc, gap, rules, displacement, touches, plateau_ahead, loss)
        returned = 0.0
    else:
        # Destruction of what no plateau ahead supports
        fallen = np.where(fibre | plateau_ahead, 0.0, b_p - z_p)
        np.copyto(z_p, b_p, where=fallen > 0.0)
        returned = (fallen * rules.area).sum()
        on_pin, deposit = pooled_debris(z_p, disc, rules, displacement, touches, plateau_ahead, contact_area, pool)
    z_p -= on_pin
    z_d[under] = disc + (deposit - on_pin)

    deposited = (deposit * rules.area).sum()
    if not rules.local:
        pool += rules.captured * (loss * rules.area).sum() + returned - deposited
    return displacement, contact_area, pool, deposited, evaluations


def local_debris(z_p, disc, gap, rules, displacement, touches, plateau_ahead, loss):
    """On the pin and in all: what the cell ahead loses fills the gap; what finds no room leaves the contact."""
    ahead = np.zeros_like(z_p)
    ahead[:-1] = z_p[1:]
    loss_ahead = np.zeros_like(loss)
    loss_ahead[:-1] = loss[1:]
    to_plateau = np.where(plateau_ahead, np.maximum(z_p - ahead, 0.0), 0.0)
    to_reference = np.maximum(rules.reference_height - disc, 0.0)
    clearance = np.where(touches, 0.0, gap - displacement)
    deposit = np.minimum(np.minimum(clearance, to_plateau + to_reference), rules.captured * loss_ahead)
    return np.minimum(deposit, to_plateau), deposit


def pooled_debris(z_p, disc, rules, displacement, touches, plateau_ahead, contact_area, pool):
    """On the pin and in all: the pool is shared evenly by the cells that do not touch."""
    open_area = rules.pin_area - contact_area
    share = max(pool / open_area, 0.0) if open_area > 0.0 else 0.0
    clearance = np.where(touches, 0.0, z_p - disc - displacement)
    deposit = np.clip(clearance, 0.0, share)
    return np.where(plateau_ahead, rules.pad_share * deposit, 0.0), deposit
