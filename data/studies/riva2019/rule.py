"""The step with local debris, model.md section 4 in the order of the text, with the reading of 4L as an argument.

Plain loops over cells, compiled by numba: for readings that no scene has. The disc does not wear here.
"""

import numpy as np
from numba import njit

# Statuses, as indices into moduli and wear rates: of the pin, of the disc.
NONE, PRIMARY, SECONDARY = 0, 1, 2
# What is summed over steps: contact area, m2; worn off plateaus and resin, deposited on pin and disc, m3.
SUMS = ("contact_area", "worn_pin", "worn_resin", "deposited_pin", "deposited_disc")


# Sums in any order, so that the compiler may take several cells at a time.
@njit(cache=True, fastmath={"reassoc", "nsz"})
def touching(gap, stiffness, delta):
    """Of the cells that touch: sum of stiffness, of stiffness times gap, and their number."""
    total, moment, count = 0.0, 0.0, 0
    for cell in range(gap.size):
        touches = gap[cell] < delta
        total += stiffness[cell] if touches else 0.0
        moment += stiffness[cell] * gap[cell] if touches else 0.0
        count += 1 if touches else 0
    return total, moment, count


@njit(cache=True)
def displacement(gap, stiffness, force, guess):
    """4.1: where the overlaps carry the load. Newton's method; its last step is exact on the cells that touch."""
    delta, before = guess, -1
    for _ in range(1000):
        total, moment, count = touching(gap, stiffness, delta)
        # Where nothing touches, it begins with all cells.
        following = (force + moment) / total if count > 0 else gap.max() + 1e-6
        if following == delta or (count == before and abs(following - delta) < 1e-18):
            return following
        delta, before = following, count
    return delta


@njit(cache=True)
def wear_of_the_pin(z, b, base, pressure, slide, kappa, wear_height):
    """4.2 for a cell in contact: new height and substrate, and what it lost."""
    secondary = z < b
    if base == NONE and not secondary:
        return z + wear_height, max(b, z + wear_height), wear_height
    loss = (kappa[SECONDARY] if secondary else kappa[PRIMARY]) * pressure * slide
    film = b - z
    if secondary and loss >= film:
        # The build-up first, then the substrate by its own wear rate.
        below = kappa[PRIMARY] * pressure * slide if base == PRIMARY else 0.0
        past = (1.0 - film / loss) * below
        return b + past, b + past, film + past
    return z + loss, max(b, z + loss), loss


@njit(cache=True)
def steps(first, count, disc, pin, mesh, materials, force, delta, reading, top, sums, pressure):
    """Takes some steps from number `first` on and changes disc and pin; returns the last displacement.

    disc: height, substrate [column, row]. pin: height, substrate, base. mesh: area and sliding distance of a cell by row.
    materials: stiffness per area by the statuses of pin and disc, wear rates by that of the pin, wear height of resin.
    reading: how debris is shared (0: the pin first, 1: as a_p to a_d), up to where the disc fills (0: `top`, 1: the disc
    ahead, 2: the pin ahead).
    """
    (z_d, b_d), (z_p, b_p, base), (area, slide) = disc, pin, mesh
    of_pair, kappa, wear_height = materials
    shared, level = reading
    columns, (pins, rows) = z_d.shape[0], z_p.shape
    gap, stiffness, lost = np.empty((pins, rows)), np.empty((pins, rows)), np.empty((pins, rows))
    plateau = np.empty((pins, rows), np.bool_)
    for n in range(first, first + count):
        # 4.1 Contact.
        for j in range(pins):
            c = (j - n) % columns
            for i in range(rows):
                status = SECONDARY if z_p[j, i] < b_p[j, i] else base[j, i]
                below = SECONDARY if z_d[c, i] > b_d[c, i] else PRIMARY
                plateau[j, i] = status != NONE
                gap[j, i] = z_p[j, i] - z_d[c, i]
                stiffness[j, i] = of_pair[status, below] * area[i]
        delta = displacement(gap.ravel(), stiffness.ravel(), force, delta)
        # 4.2 Wear.
        for j in range(pins):
            for i in range(rows):
                lost[j, i], pressure[j, i] = 0.0, 0.0
                if gap[j, i] < delta:
                    pressure[j, i] = stiffness[j, i] / area[i] * (delta - gap[j, i])
                    z_p[j, i], b_p[j, i], lost[j, i] = wear_of_the_pin(z_p[j, i], b_p[j, i], base[j, i], pressure[j, i], slide[i], kappa, wear_height)
                    sums[0] += area[i]
                    sums[1 if plateau[j, i] else 2] += area[i] * lost[j, i]
        # 4L Debris: a cell that has a gap gets what the cell ahead of it lost. From the first column on, so that the cell
        # ahead is as wear left it.
        for j in range(pins - 1):
            c, ahead = (j - n) % columns, (j + 1 - n) % columns
            for i in range(rows):
                if gap[j, i] < delta or lost[j + 1, i] == 0.0:
                    continue
                clearance = z_p[j, i] - z_d[c, i] - delta
                on_pin = max(0.0, z_p[j, i] - z_p[j + 1, i]) if plateau[j + 1, i] else 0.0
                up_to = top if level == 0 else z_d[ahead, i] if level == 1 else z_p[j + 1, i] - delta
                on_disc = max(0.0, up_to - z_d[c, i])
                d = min(clearance, on_pin + on_disc, lost[j + 1, i])
                if d <= 0.0:
                    continue
                d_p = d * on_pin / (on_pin + on_disc) if shared else min(d, on_pin)
                z_p[j, i] -= d_p
                z_d[c, i] += d - d_p
                sums[3] += area[i] * d_p
                sums[4] += area[i] * (d - d_p)
    return delta
