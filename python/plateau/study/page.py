"""Pages of studies for the browser."""

from collections.abc import Mapping
from html import escape
from typing import TYPE_CHECKING, Any

from plateau.html_page import listed, page, pictures, table, table_of
from plateau.study.figure_axes import file_names

if TYPE_CHECKING:
    from plateau.study.analysis import Effects
    from plateau.study.scene_comparison import Comparison

NOTE = (
    "Differences are means over pairs of runs with the same seed, with t intervals ({level}); with more than two scenes, intervals and sureness hold for "
    "all differences of a response together (Bonferroni). Sure at: 1 − p/2, how sure the sign is."
)


def effects_page(found: "Effects", figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
    """The page of ``plateau sweep effects``."""
    from plateau.study.effects_text import told

    study = found.study
    factors = [[factor.name, factor.keys, " … ".join(map(factor.shown, factor.levels)) if factor.is_range else ", ".join(map(factor.shown, factor.levels))]
               for factor in study.factors]  # fmt: skip
    states = ", ".join(f"{count} {state}" for state, count in study.runs["state"].value_counts().items())
    cautions = [f"caution: {said}" for said in found.cautions]
    parts = [listed([f"design: {study.design}", f"runs: {states}", f"sets of seeds: {study.seeds}", *cautions])]
    parts.append(table(["factor", "keys", "values"], factors, "words"))
    for one, stem in zip(found.responses, file_names([one.response.name for one in found.responses]), strict=True):
        (name, *said), rows, below = told(one)
        parts += [f"<h2>{escape(name)}</h2>", listed(said)]
        parts += [table(rows[0], rows[1:])] if rows else []
        parts += [f"<pre>{escape(chr(10).join(below))}</pre>"] if below else []
        own = [f"{stem}-{kind}" for kind in ("pareto", "main-effects", "interactions", "residuals", "surface")]
        parts.append(pictures({name: figures[name] for name in own if name in figures}, files))
    return page(f"{study.title}: effects", *parts)


def comparison_page(found: "Comparison", figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
    """The page of ``plateau compare``."""
    scenes = table(["scene", "file"], list(map(list, found.scenes.items())), "words")
    note = f'<p class="quiet">{escape(NOTE.format(level=f"{100 * found.confidence:g} %"))}</p>'
    return page(found.title, scenes, listed(found.said()), table_of(found.shown()), note, pictures(figures, files))
