"""Evaluates both studies with the package, and writes results.json.

usage: evaluate.py, after run.sh has made the runs
"""

import dataclasses
import json
import warnings
from pathlib import Path

import plateau.study
from plateau.errors import PlateauWarning

HERE = Path(__file__).parent
# Folders of the study files, by the base scene: pair.toml and pair-strength.toml.
RULES = {"plain": HERE, "strength": HERE / "strength"}


def of_skewness(folder: Path) -> dict[str, object]:
    """Means of every disc, and differences between skewnesses of discs that are not cut, with 95 % intervals; logarithms where it is fitted so."""
    study = plateau.study.open_study(folder / "skewness.toml")
    skewness, cut = study.factors
    means = {}
    for one in plateau.study.effects(study).responses:
        table = one.means(skewness.name, cut.name).to_dict("records")
        means[one.response.name] = {f"{row['skewness']:g}, {row['cut']}": [row["mean"], row["low"], row["high"]] for row in table}
    uncut = dataclasses.replace(study, factors=[skewness], runs=study.runs[study.runs[cut.name] == "none"])
    differences: dict[str, dict[str, list[float]]] = {}
    for row in plateau.study.levels(uncut).table.to_dict("records"):
        pair = f"{row['level']} less {row['other']}"
        differences.setdefault(row["response"], {})[pair] = [row["difference"], row["low"], row["high"]]
    return {"runs": len(study.runs), "seeds": int(study.runs["replicate"].nunique()), "means": means, "differences": differences}


def of_factors(folder: Path) -> dict[str, object]:
    """Main effects with 95 % intervals, logarithms where it is fitted so."""
    study = plateau.study.open_study(folder / "factors.toml")
    found = {}
    for one in plateau.study.effects(study, model="main").responses:
        rows = {row["term"]: row for row in one.terms.to_dict("records")}
        found[one.response.name] = {factor.name: [rows[factor.name][key] for key in ("effect", "low", "high")] for factor in study.factors}
    return {"runs": len(study.runs), "seeds": int(study.runs["replicate"].nunique()), "effects": found}


def main() -> None:
    warnings.simplefilter("ignore", PlateauWarning)
    results = {rule: {"skewness": of_skewness(folder), "factors": of_factors(folder)} for rule, folder in RULES.items()}
    (HERE / "results.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
