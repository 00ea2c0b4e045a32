"""A simulation as an object: its steps, its fields as arrays, rules and controllers between two steps."""

import os
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas

from plateau.errors import InputError, InputTypeError
from plateau.native import native
from plateau.program import file_name
from plateau.progress import Progress
from plateau.scenes import Scene, engine_name, scene_of
from plateau.units import quantity, whole

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from plateau._native import Simulation as Native

# Fewer steps than these show no progress.
MANY_STEPS = 1000
FIELDS_OF_HEIGHTS = ("disc_height", "disc_substrate", "pin_height", "pin_substrate")


class Simulation:
    """A pin on a disc, taken step by step in this process. Steps have the same bits as those of the program.

    Between two steps its fields can be read and heights, load and speed be set. Fields are arrays of shape (columns, rows): of the disc
    (disc columns, rows) in its own frame, of the pin (pin columns, rows); axis 0 goes along the sliding direction, axis 1 outwards. Each
    reading is a copy, not to be changed, that stays as it is when the simulation goes on or is gone: a change goes into a ``copy()``
    that is set. z of both bodies grows away from the disc, so wear lowers the disc and raises the pin. Columns of the disc come to the
    pin at its column 0 and go on to larger ones.

    The scene's duration and ``[output]`` do not count: it goes on as long as it is told to, and writes nothing.

    One thread uses it at a time; a fork and pickling are refused (`save` and `load` carry it elsewhere). Any number of simulations may
    exist side by side. A scene that has its run choose the time acceleration is refused.

    Parameters
    ----------
    scene : path, str, mapping or Scene
        See `Scene`.
    workers : int or "auto", optional
        Threads that share the ring; by default those of the scene. No bit depends on it.
    engine : {"fast", "plain"}
        The engine, or the plain model, cell by cell. Pooled debris is always the plain model's.
    progress : bool, optional
        Show the progress of many steps; by default in notebooks and terminals.

    Examples
    --------
    >>> simulation = Simulation("quick.toml")
    >>> simulation.advance(690)
    >>> simulation.steps, simulation.pin_height.shape, simulation.sample()["contact_area"] > 0
    (690, (40, 20), True)
    """

    __slots__ = ("_native", "_progress", "_samples", "_scene")

    def __init__(
        self,
        scene: "str | os.PathLike[str] | Mapping[str, Any] | Scene",
        *,
        workers: int | str | None = None,
        engine: str = "fast",
        progress: bool | None = None,
    ) -> None:
        self._scene = scene_of(scene, {} if workers is None else {"numerics.workers": workers}, 2)
        self._progress = progress
        self._samples: list[dict[str, float]] = []
        self._native: Native = native().Simulation(self._scene._resolved, engine_name(engine), Progress(False).tell)

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, workers: int | None = None, progress: bool | None = None) -> "Simulation":
        """The simulation of a state that `save` wrote; its coming steps are bit for bit those of the one that was saved.

        Parameters
        ----------
        path : path
        workers, progress : optional
            See `Simulation`.

        Returns
        -------
        Simulation
        """
        made = object.__new__(cls)
        made._native = native().Simulation.load(
            file_name(path, "a state"), None if workers is None else str(whole(workers, "workers", 1)), Progress(False).tell
        )
        made._scene, made._progress, made._samples = scene_of(made._native.scene.resolved, {}, 2), progress, []
        return made

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the state to a file, which replaces another state when it is complete.

        Parameters
        ----------
        path : path
        """
        self._native.save(file_name(path, "a state"))

    def advance(self, steps: int | None = None, *, time: float | str | None = None, watch: bool = True) -> None:
        """Takes steps; the interpreter is free for other threads meanwhile. Ctrl-C ends it between two steps, and it may go on.

        Parameters
        ----------
        steps : int, optional
            Number of steps, by default one.
        time : float or str, optional
            Time to come to instead, s, or text with a unit; nothing is done where that has passed. The last step ends there or
            up to one step later, of a cycle earlier.
        watch : bool
            Keep `pressure`, `sample` and `displacement` of the last step available. A single step of a small scene takes two thirds of the
            time without.

        Raises
        ------
        RunFailed
            If no displacement carries the load, or numbers leave their range. Nothing follows then.
        """
        if time is not None:
            if steps is not None:
                raise InputError("advance: expected steps or a time, not both")
            steps = max(0, self._native.steps_until(quantity(time, "s")) - self._native.steps)
        steps = 1 if steps is None else whole(steps, "steps")
        if steps < MANY_STEPS:
            self._native.advance(steps, watch)
            return
        with Progress(self._progress) as progress:
            self._native.advance(steps, watch, progress.steps)

    def observe(self, steps: int | None = None, *, time: float | str | None = None, every: int | None = None) -> pandas.DataFrame:
        """Takes steps as `advance` does, and a sample after each `every` of them. What Ctrl-C leaves is in `observed`.

        Parameters
        ----------
        steps, time : optional
            See `advance`.
        every : int, optional
            Steps between two samples; by default those of a revolution.

        Returns
        -------
        pandas.DataFrame
            A row for each sample, as `sample`, by the number of its step.
        """
        if (steps is None) is (time is None):
            raise InputError("observe: expected a number of steps, or a time to come to")
        first = self.steps
        last = self._native.steps_until(quantity(time, "s")) if time is not None else first + whole(steps, "steps")
        every = self.revolution if every is None else whole(every, "steps", 1)
        self._samples = []
        with Progress(self._progress) as progress:
            while self.steps < last:
                self._native.advance(min(last - self.steps, every))
                self._samples.append(self.sample())
                progress.steps(self.steps - first, last - first)
        return self.observed

    @property
    def observed(self) -> pandas.DataFrame:
        """The table of the last `observe`, also of one that Ctrl-C or an error ended."""
        return pandas.DataFrame(self._samples).set_index("step") if self._samples else pandas.DataFrame()

    def sample(self) -> dict[str, float]:
        """The series of a run file after the last step, in SI units (`units`); ``step`` and ``time`` first. ``contact_area``,
        ``friction_coefficient`` and pressures are of that one step, names with ``_mean`` of the last revolution. Heights that were set
        since show in the roughness alone before the next step.

        Returns
        -------
        dict
        """
        return self._native.sample()

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each series of `sample`."""
        return {"step": "1", "time": "s"} | {name: unit for name, unit, _ in self._native.quantities()}

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self._scene

    @property
    def engine(self) -> str:
        """Name of the engine that takes the steps, ``"fast"`` or ``"plain"``."""
        return self._native.execution[0]

    @property
    def workers(self) -> int:
        """Number of threads that take the steps."""
        return self._native.execution[1]

    @property
    def steps(self) -> int:
        """Number of steps taken."""
        return self._native.steps

    @property
    def time(self) -> float:
        """Time at the end of the last step, s."""
        return self._native.time

    @property
    def displacement(self) -> float:
        """Displacement of the rigid pin toward the disc in the last step, m, from where heights are 0; `sample` has it, too."""
        return float(self._native.sample()["displacement"])

    @property
    def revolution(self) -> int:
        """Number of steps of a revolution, one for each column of the disc; a revolution stands for as many as the time acceleration."""
        return self._native.mesh[1]

    @property
    def step_angle(self) -> float:
        """Angle of a column, rad: how far a step turns the disc, without time acceleration."""
        return self._native.mesh[3]

    @property
    def radius(self) -> "NDArray[np.float64]":
        """Radius of each row, m."""
        return np.array(self._native.rows[0])

    @property
    def cell_area(self) -> "NDArray[np.float64]":
        """Area of a cell in each row, m2."""
        return np.array(self._native.rows[1])

    @property
    def under_pin(self) -> "NDArray[np.intp]":
        """Disc column under each pin column in the coming step: ``disc_height[under_pin]`` lies under ``pin_height``."""
        _, disc, pin, _, first = self._native.mesh
        return (first + np.arange(pin)) % disc

    @property
    def normal_force(self) -> float:
        """Normal force of the coming steps, N, which may be set; NaN where the scene gives a braking torque; of a cycle the largest."""
        load, _, by_torque = self._native.operation
        return float("nan") if by_torque else load

    @normal_force.setter
    def normal_force(self, force: float | str) -> None:
        self._operate(False, force, "N")

    @property
    def braking_torque(self) -> float:
        """Braking torque of the coming steps, N m, which may be set where the scene gives one; else NaN."""
        load, _, by_torque = self._native.operation
        return load if by_torque else float("nan")

    @braking_torque.setter
    def braking_torque(self, torque: float | str) -> None:
        self._operate(True, torque, "N m")

    @property
    def rotational_speed(self) -> float:
        """Rotational speed of the coming steps, rad/s, which may be set where the scene has no cycle."""
        return self._native.operation[1]

    @rotational_speed.setter
    def rotational_speed(self, speed: float | str) -> None:
        self._native.operate(self._native.operation[0], quantity(speed, "rad/s"))

    def _operate(self, is_torque: bool, load: float | str, unit: str) -> None:
        _, speed, by_torque = self._native.operation
        if by_torque is not is_torque:
            given = "a braking torque" if by_torque else "a normal force"
            raise InputError(f"the scene gives {given}, so that is what may be set between steps")
        self._native.operate(quantity(load, unit), speed)

    @property
    def disc_height(self) -> "NDArray[np.float64]":
        """Surface of the disc, m; it may be set, and is nowhere below `disc_substrate`."""
        return self._numbers("disc_height")

    @disc_height.setter
    def disc_height(self, heights: Any) -> None:
        self._set("disc_height", heights)

    @property
    def disc_substrate(self) -> "NDArray[np.float64]":
        """The disc below its compacted debris, m; it may be set. Build-up is ``disc_height - disc_substrate``."""
        return self._numbers("disc_substrate")

    @disc_substrate.setter
    def disc_substrate(self, heights: Any) -> None:
        self._set("disc_substrate", heights)

    @property
    def pin_height(self) -> "NDArray[np.float64]":
        """Surface of the pin, m, NaN outside a round pin; it may be set, and is nowhere above `pin_substrate`."""
        return self._numbers("pin_height")

    @pin_height.setter
    def pin_height(self, heights: Any) -> None:
        self._set("pin_height", heights)

    @property
    def pin_substrate(self) -> "NDArray[np.float64]":
        """The pin below its compacted debris, m, NaN outside a round pin; it may be set. Build-up is ``pin_substrate - pin_height``."""
        return self._numbers("pin_substrate")

    @pin_substrate.setter
    def pin_substrate(self, heights: Any) -> None:
        self._set("pin_substrate", heights)

    @property
    def disc_status(self) -> "NDArray[np.uint8]":
        """Statuses of the disc as in run files: 1 primary, 2 secondary."""
        return self._words("disc_status")

    @property
    def pin_status(self) -> "NDArray[np.uint8]":
        """Statuses of the pin as in run files: 0 none, 1 primary, 2 secondary, 3 absent."""
        return self._words("pin_status")

    @property
    def pin_base(self) -> "NDArray[np.uint8]":
        """Material of the pin, by cell: 0 resin, 1 fibre, 3 absent."""
        return self._words("pin_base")

    @property
    def pressure(self) -> "NDArray[np.float64]":
        """Pressure on each pin cell in the last step, Pa; 0 where nothing touches, NaN outside a round pin."""
        return self._numbers("pressure")

    def set_heights(self, *, disc_height: Any = None, disc_substrate: Any = None, pin_height: Any = None, pin_substrate: Any = None) -> None:
        """Takes over several fields of heights at once, m; those that are None stay.

        Volumes count what steps moved: ``balance_residual`` shows what was changed here. It copies the whole state, which takes as long
        as some hundred steps.

        Parameters
        ----------
        disc_height, disc_substrate, pin_height, pin_substrate : array, optional
            Heights, m, of the shape of the property of this name.

        Raises
        ------
        InputError
            If an array is not of real numbers, or masked, a shape is wrong, or a height is no finite number, on the wrong side of its
            substrate, or above the highest initial height of the disc, up to which debris fills it.
        """
        given = (disc_height, disc_substrate, pin_height, pin_substrate)
        rows, disc, pin, *_ = self._native.mesh
        named = zip(FIELDS_OF_HEIGHTS, given, (disc, disc, pin, pin), strict=True)
        self._native.set_heights([None if one is None else _heights(name, one, (columns, rows)) for name, one, columns in named])

    def _set(self, name: str, heights: Any) -> None:
        if heights is None:
            raise InputTypeError(f"{name} is None, expected an array of numbers, in m")
        self.set_heights(**{name: heights})

    def _numbers(self, name: str) -> "NDArray[np.float64]":
        return np.frombuffer(self._native.field(name), dtype=np.float64).reshape(-1, self._native.mesh[0])

    def _words(self, name: str) -> "NDArray[np.uint8]":
        return np.frombuffer(self._native.field(name), dtype=np.uint8).reshape(-1, self._native.mesh[0])

    def __repr__(self) -> str:
        return f"<plateau.Simulation {self._scene['title']!r}, step {self.steps}, {self.time:.6g} s>"

    def __reduce__(self) -> Any:
        raise TypeError("a simulation cannot be pickled or copied: save its state, and load it where it is to go on")


def _heights(name: str, heights: Any, expected: tuple[int, int]) -> "NDArray[np.float64]":
    """Heights that are given, of this shape."""
    if isinstance(heights, np.ma.MaskedArray):
        raise InputTypeError(f"{name} is a masked array, in which heights are missing: expected one of numbers, fill it first")
    try:
        given = np.asarray(heights)
    except (OverflowError, RecursionError, TypeError, ValueError) as error:
        raise InputTypeError(f"{name} is no array: {error}; expected one of numbers, in m") from None
    if given.dtype.kind not in "iuf":
        raise InputTypeError(f"{name} is an array of {given.dtype}, expected one of numbers, in m")
    if given.shape != expected:
        raise InputError(f"{name} has the shape {given.shape}, expected {expected}: columns and rows")
    return np.ascontiguousarray(given, dtype=np.float64)
