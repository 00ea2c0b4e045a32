"""What the paper concludes of rough (1), smoother (0.1) and smoothest (0.01) disc, as something to be seen in one set of surfaces."""

from collections.abc import Callable

import measures

# A quantity of a disc.
Of = Callable[[str, str], float]


def rising(key: str) -> Callable[[Of], bool]:
    """The smoother the disc, the more of it."""
    return lambda of: of(key, "1") < of(key, "0.1") < of(key, "0.01")


def falling(key: str) -> Callable[[Of], bool]:
    """The smoother the disc, the less of it."""
    return lambda of: of(key, "1") > of(key, "0.1") > of(key, "0.01")


def lower(part: float) -> Callable[[Of], bool]:
    """The roughest disc has less contact area than this part of either smooth disc's."""
    key = "contact_area_mean"
    return lambda of: of(key, "1") < part * min(of(key, "0.1"), of(key, "0.01"))


def near_the_paper(of: Of) -> bool:
    """About 70 %, about 90 %, almost filled."""
    return abs(of("filled", "1") - 0.7) <= 0.1 and abs(of("filled", "0.1") - 0.9) <= 0.05 and of("filled", "0.01") >= 0.98


# By its name, and the quantity that it needs.
CLAIMS = {
    "filled in order": ("filled", lambda of: of("filled", "1") < of("filled", "0.1") <= of("filled", "0.01")),
    "filled as in the paper": ("filled", near_the_paper),
    "more on the disc": ("disc_secondary", rising("disc_secondary")),
    "more on the pin, by status": ("pin_covered", rising("pin_covered")),
    "more on the pin, by volume": ("pin_film", rising("pin_film")),
    "more on the pin, that carries load": ("pin_loaded", rising("pin_loaded")),
    "smoother pin": ("sq_pin", falling("sq_pin")),
    "smoother fibres": ("sq_fibres", falling("sq_fibres")),
    "smoother plateaus": ("sq_plateaus", falling("sq_plateaus")),
    "smoother where it touches": ("sq_touching", falling("sq_touching")),
    "smoother resin": ("sq_resin", falling("sq_resin")),
    "more even pressure": ("pressure_gini", falling("pressure_gini")),
    "lower contact area": ("contact_area_mean", lower(1.0)),
    "less than three quarters of it": ("contact_area_mean", lower(0.75)),
    "longer run-in": ("run_in", falling("run_in")),
    "baseline not steady": ("drift", lambda of: of("drift", "1") > of("drift_error", "1")),
    "heights / 10 not steady": ("drift", lambda of: of("drift", "0.1") > of("drift_error", "0.1")),
    "fuller inside": ("inner_over_outer", lambda of: of("inner_over_outer", "1") > 0),
    "higher pressure": ("mean_pressure", falling("mean_pressure")),
    "higher friction": ("friction", rising("friction")),
}


def holds(discs: dict[str, list[dict[str, float]]]) -> dict[str, dict[str, float]]:
    """In how many sets of surfaces each claim holds, and the 95 % interval of that share by Wilson's score."""
    sets, found = len(discs["1"]), {}
    for claim, (needs, test) in CLAIMS.items():
        if all(needs in numbers for runs in discs.values() for numbers in runs):
            hits = sum(bool(test(lambda key, heights, number=number: discs[heights][number][key])) for number in range(sets))
            low, high = measures.wilson(hits, sets)
            found[claim] = {"hits": hits, "of": sets, "low": low, "high": high}
    return found


def intervals(runs: list[dict[str, float]]) -> dict[str, tuple[float, float]]:
    """Mean and half width of its 95 % interval of every number of some runs."""
    return {key: measures.interval([run[key] for run in runs]) for key in runs[0]}


def ratio(discs: dict[str, list[dict[str, float]]], key: str, of: str, over: str) -> tuple[float, float]:
    """Ratio of a quantity of two discs, each pair with the same surfaces."""
    return measures.interval([one[key] / other[key] for one, other in zip(discs[of], discs[over], strict=True)])
