"""Figures of friction: against time, and with other numbers in its law.

usage: friction_figures.py, in the environment .venv of the checkout with PYTHONPATH=python, after evaluate.py; figures.sh calls it
"""

import numpy as np
from discs import NAMES
from figures import ACROSS, COLOURS, RESULTS, plt, save
from friction_tables import BETWEEN
from tables import m_of, shown

from plateau.style import wrapped

FRICTION = RESULTS["friction"]
# The law's numbers as figures have them: sign, factor, form, unit.
SIGNS = {"pressure_coefficient": ("α", 1, ".3f", ""), "shear_strength": ("τ₀", 1e-6, ".3f", " MPa"), "maximum": ("μ_max", 1, ".1f", "")}


def against_time() -> None:
    """Friction of the three discs with 95 % bands over the sets of surfaces, and the first 100 s of one set."""
    figure, (axes, start) = plt.subplots(1, 2, figsize=(ACROSS, 3.0), layout="constrained", width_ratios=[2, 1], sharey=True)
    for (heights, name), colour in zip(NAMES.items(), COLOURS, strict=True):
        for rule, how in (("pooled", {"lw": 0.9, "ls": "--"}), ("local", {"lw": 1.3, "label": name})):
            if rule not in FRICTION:
                continue
            time, mean, half = np.transpose(FRICTION[rule]["over_time"][heights])
            axes.plot(time, mean, color=colour, **how)
            axes.fill_between(time, mean - half, mean + half, color=colour, alpha=0.25, lw=0)
        start.plot(*np.transpose(FRICTION["runs"]["start"][heights]), color=colour, lw=1)
    axes.plot([], [], color="grey", lw=0.9, ls="--", label=f"pooled debris, m = {m_of('pooled-sets')}")
    for panel in (axes, start):
        panel.axhline(FRICTION["law"]["maximum"], color="grey", lw=0.6, ls=":")
    axes.annotate("ceiling", (3000, FRICTION["law"]["maximum"]), textcoords="offset points", xytext=(0, -9), ha="right", color="grey")
    axes.set(
        title=f"sets of surfaces, local debris, m = {m_of('sets')}, 95 % bands",
        xlabel="time, s",
        ylabel="coefficient of friction, means of 50 s",
        xlim=(0, 3000),
        ylim=(0.33, 0.62),
    )
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    start.set(title=f"the first 100 s of one set, local, m = {m_of('runs')}", xlabel="time, s", ylabel="means of 2 s", xlim=(0, 100))
    save(figure, "friction")


def label(key: str) -> str:
    """Which two values a row of the tornado has."""
    sign, factor, form, unit = SIGNS[key]
    low, high = (shown(FRICTION["choices"][f"{key} {end}"]["value"] * factor, form) for end in ("low", "high"))
    return f"{sign.replace('μ_max', 'ceiling')} {low}, {high}{unit}"


def tornado() -> None:
    """What other numbers in the law do to friction of each disc and to the difference between discs."""
    panels = {name: ("discs", heights) for heights, name in NAMES.items()} | {BETWEEN: ("between", "0.01 less 1")}
    figure, axes = plt.subplots(1, len(panels), figsize=(ACROSS, 2.1), layout="constrained", sharey=True)
    keys = list(SIGNS)[::-1]
    for panel, (title, (part, which)) in zip(axes, panels.items(), strict=True):
        default = FRICTION["choices"]["as chosen"][part][which][0]
        for place, key in enumerate(keys):
            # One above the other: both may lie on one side of the value that was chosen.
            for end, colour, above in (("low", COLOURS[2], 0.18), ("high", COLOURS[1], -0.18)):
                found = FRICTION["choices"][f"{key} {end}"]
                mean, half = found[part][which]
                panel.barh(place + above, mean - default, left=default, color=colour, height=0.34)
                panel.errorbar(mean, place + above, xerr=half, fmt="none", ecolor="black", elinewidth=0.8, capsize=2)
                if key != "maximum":
                    panel.plot(found["without_ceiling"][part][which][0], place + above, "D", mfc="none", mec="black", ms=4, mew=0.7)
        panel.axvline(default, color="black", lw=0.8)
        panel.set(title=wrapped(title, 22), xlabel=f"as chosen: {default:.3f}", xlim=(0, 0.09) if part == "between" else (0.38, 0.68))
    axes[0].set_yticks(range(len(keys)), [label(key) for key in keys])
    handles = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour in (COLOURS[2], COLOURS[1])]
    handles.append(plt.Line2D([], [], ls="", marker="D", mfc="none", mec="black", ms=4, mew=0.7))
    figure.legend(handles, ["first value", "second value", "without ceiling"], loc="outside lower center", ncols=3)
    save(figure, "friction-tornado")


def main() -> None:
    against_time()
    if FRICTION["choices"]:
        tornado()


if __name__ == "__main__":
    main()
