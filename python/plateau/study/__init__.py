"""Studies: their results, and what these tell.

``open_study`` opens what was collected; ``effects``, ``levels``, ``seeds_needed``, ``predict``, ``optimize``, ``sensitivity``, ``fit`` and
``compare`` answer, and ``of_scenes`` makes a study of scenes. They need the packages of ``pip install 'plateau-brake[all]'``, which are
imported when they are called.
"""

from typing import TYPE_CHECKING, Any

from plateau.late_names import found
from plateau.study.data import Factor, Response, Study
from plateau.study.results import open_study

if TYPE_CHECKING:
    from plateau.study.analysis import effects
    from plateau.study.fit_of_study import fit
    from plateau.study.imports import import_values
    from plateau.study.level_differences import levels
    from plateau.study.optimum import optimize
    from plateau.study.prediction import predict
    from plateau.study.scene_comparison import compare, of_scenes
    from plateau.study.seed_counts import seeds_needed
    from plateau.study.variance_parts import sensitivity

# Where each answer is found.
ANSWERS = {"effects": "analysis", "levels": "level_differences", "seeds_needed": "seed_counts", "predict": "prediction", "optimize": "optimum"}
ANSWERS |= {"sensitivity": "variance_parts", "fit": "fit_of_study", "import_values": "imports"}
ANSWERS |= dict.fromkeys(("compare", "of_scenes"), "scene_comparison")

__all__ = ["Factor", "Response", "Study", "compare", "effects", "fit", "import_values", "levels", "of_scenes", "open_study"]
__all__ += ["optimize", "predict", "seeds_needed", "sensitivity"]


def __getattr__(name: str) -> Any:
    globals()[name] = found(__name__, ANSWERS, name)
    return globals()[name]
