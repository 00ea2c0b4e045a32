"""What maps of the pin say of build-up and roughness, by what lies below: fibres, resin, plateaus."""

import measures
import numpy as np

# Build-up from which a cell counts as covered by more than a film, m.
THICK = 0.1e-6


def of_the_pin(height: np.ndarray, film: np.ndarray, base: np.ndarray, pressure: np.ndarray, radius: np.ndarray) -> dict[str, float]:
    """Build-up and roughness of the pin at a moment, from its heights, the thickness of its build-up, what lies below, and the pressure.
    Resin that touches loses 5 um at once, so the moment matters: means over several cycles of the resin do not depend on it."""
    fibre, weights = base == 1, np.broadcast_to(radius, height.shape)

    def part(cells: np.ndarray, of: np.ndarray) -> float:
        return float(weights[cells & of].sum() / weights[of].sum())

    secondary = film > 0
    touching = (pressure > 0) & (secondary | fibre)
    return {
        "pin_film": measures.mean(film, radius),
        "pin_covered": measures.share(secondary, radius),
        "pin_covered_fibres": part(secondary, fibre),
        "pin_covered_resin": part(secondary, ~fibre),
        # Build-up that carries load.
        "pin_loaded": measures.share(secondary & (pressure > 0), radius),
        "pin_thick": measures.share(film >= THICK, radius),
        "sq_fibres": measures.sq(height[fibre], weights[fibre]),
        "sq_resin": measures.sq(height[~fibre], weights[~fibre]),
        "sq_plateaus": measures.sq(height[secondary | fibre], weights[secondary | fibre]),
        "sq_touching": measures.sq(height[touching], weights[touching]),
        "sq_pin": measures.sq(height, weights),
    }
