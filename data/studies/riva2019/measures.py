"""The quantities by which the paper's claims are measured. Heights in m, disc and pin as [column, row]."""

import numpy as np
from scipy import ndimage, stats


def mean(values: np.ndarray, radius: np.ndarray) -> float:
    """Mean over cells, each counted with its area, which goes with its radius."""
    return float((values * radius).sum() / (radius.sum() * values.shape[0]))


def share(cells: np.ndarray, radius: np.ndarray) -> float:
    """Area fraction of some cells."""
    return mean(cells.astype(float), radius)


def sq(heights: np.ndarray, weights: np.ndarray) -> float:
    """Root mean square of heights about their mean, each counted with its weight."""
    middle = np.average(heights, weights=weights)
    return float(np.sqrt(np.average((heights - middle) ** 2, weights=weights)))


def gini(pressure: np.ndarray, radius: np.ndarray) -> float:
    """Gini coefficient of the pressure over the cells in contact, each counted with its area: 0 is even."""
    touching = pressure > 0
    order = np.argsort(pressure[touching])
    values = pressure[touching][order]
    areas = np.broadcast_to(radius, pressure.shape)[touching][order]
    areas = areas / areas.sum()
    load = np.cumsum(values * areas) / (values * areas).sum()
    # Twice the area between the diagonal and the curve of the load over the area.
    return float(1 - (areas * (load + np.r_[0.0, load[:-1]])).sum())


def area_in_contact(pressure: np.ndarray, area: np.ndarray) -> float:
    """Area of the cells that touch, from the area of a cell of each row."""
    return float(((pressure > 0) * area).sum())


def filled_volume(initial: np.ndarray, height: np.ndarray, radius: np.ndarray) -> float:
    """Part of the volume below the highest initial height that is filled (model.md section 5)."""
    top = initial.max()
    return 1 - mean((top - height).clip(0), radius) / mean(top - initial, radius)


def filled_area(initial: np.ndarray, height: np.ndarray, radius: np.ndarray, within: float) -> float:
    """Part of the area that was below the highest initial height that has come up to it, or so near."""
    top = initial.max()
    low = initial < top
    return share(low & (height >= top - within), radius) / share(low, radius)


def radial_filling(initial: np.ndarray, height: np.ndarray, radius: np.ndarray, bands: int) -> np.ndarray:
    """Filled part of the volume in bands of rows, from the inner radius to the outer."""
    top = initial.max()
    open_now, open_then = ((top - z).clip(0) * radius for z in (height, initial))
    parts = np.array_split(np.arange(len(radius)), bands)
    return np.array([1 - open_now[:, rows].sum() / open_then[:, rows].sum() for rows in parts])


def mean_of_last(values: np.ndarray, count: int) -> float:
    """Mean of the last values."""
    return float(values[-count:].mean())


def run_in(time: np.ndarray, values: np.ndarray, part: float) -> float:
    """The time at which a series first comes to a part of the mean of its last two values."""
    return float(time[np.argmax(values >= part * mean_of_last(values, 2))])


def change_point(time: np.ndarray, values: np.ndarray) -> float:
    """The time at which two straight lines that meet there fit a series best, by least squares."""

    def rest(at: float) -> float:
        basis = np.stack([np.ones_like(time), time, (time - at).clip(0)], axis=1)
        return float(((values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0]) ** 2).sum())

    return float(min(time[1:-1], key=rest))


def drift(time: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Slope of a series over its mean, 1/s, and the half width of its 95 % interval.

    Neighbours are alike, so the interval is that of as many independent values as the autocorrelation of the rest leaves.
    """
    fit = stats.linregress(time, values)
    rest = values - fit.intercept - fit.slope * time
    square = (rest**2).sum()
    alike = float((rest[1:] * rest[:-1]).sum() / square) if square > 0 else 0.0
    wider = np.sqrt((1 + max(alike, 0.0)) / (1 - min(max(alike, 0.0), 0.99)))
    half = stats.t.ppf(0.975, len(time) - 2) * fit.stderr * wider
    return float(fit.slope / values.mean()), float(half / values.mean())


def plateau_sizes(cells: np.ndarray, ring: bool) -> np.ndarray:
    """Sizes of the plateaus, in cells: pieces whose cells share edges; the disc closes round the ring."""
    labels, count = ndimage.label(cells)
    if ring and count:
        # A union of the pieces that touch across the first and the last column.
        parent = np.arange(count + 1)

        def root(piece: int) -> int:
            while parent[piece] != piece:
                piece = parent[piece]
            return piece

        for first, last in zip(labels[0], labels[-1], strict=True):
            if first and last:
                parent[root(first)] = root(last)
        labels = np.array([root(piece) for piece in range(count + 1)])[labels]
    sizes = np.bincount(labels.ravel())[1:]
    return sizes[sizes > 0]


def diameters(areas: np.ndarray, percent: list[int]) -> dict[str, float]:
    """Percentiles of the diameters of circles as large as the plateaus, each plateau counted with its area."""
    order = np.sort(areas)
    part = (np.cumsum(order) - order / 2) / order.sum()
    return {str(p): float(2 * np.sqrt(np.interp(p / 100, part, order) / np.pi)) for p in percent}


def open_where_deepest(initial: np.ndarray, height: np.ndarray, radius: np.ndarray, part: float) -> float:
    """Part of the volume that is still open which is where the disc was deepest, on that part of its area; 0 if none is open."""
    still = (initial.max() - height).clip(0) * radius
    deepest = initial <= np.quantile(initial, part)
    return float(still[deepest].sum() / still.sum()) if still.any() else 0.0


def wilson(hits: int, of: int) -> tuple[float, float]:
    """95 % interval of a share of which so many of so many were seen, by Wilson's score."""
    z, share_seen = stats.norm.ppf(0.975), hits / of
    middle = (share_seen + z**2 / (2 * of)) / (1 + z**2 / of)
    half = z / (1 + z**2 / of) * np.sqrt(share_seen * (1 - share_seen) / of + z**2 / (4 * of**2))
    return float(max(middle - half, 0.0)), float(min(middle + half, 1.0))


def interval(values: list[float]) -> tuple[float, float]:
    """Mean, and the half width of its 95 % interval by Student's t; of a single value no number."""
    sample = np.asarray(values, float)
    if len(sample) < 2:
        return float(sample.mean()), float("nan")
    half = stats.t.ppf(0.975, len(sample) - 1) * sample.std(ddof=1) / np.sqrt(len(sample))
    return float(sample.mean()), float(half)
