"""Scenes as data: built of files, text, dictionaries and keywords, completed and checked by the program's table of keys."""

import difflib
import functools
import os
import re
import tomllib
import warnings
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from plateau.errors import InputError, InputTypeError, PlateauError, PlateauWarning, UnknownNameError, shown
from plateau.native import native
from plateau.program import file_name
from plateau.toml_text import TOO_DEEP, change_of, in_utf8

if TYPE_CHECKING:
    from plateau._native import Scene as NativeScene

# Changes by whole paths, each of which is laid over those before.
Layers = tuple[Mapping[str, Any], ...]
# How a scene is called that is in no file; its run file is scene.h5.
UNNAMED = "scene"


class Scene:
    """A scene: completed, checked, never changed.

    Parameters
    ----------
    scene : path, str, mapping or Scene, optional
        A file; TOML text; tables or keys with their values; another scene.
    **changes
        Keys that are changed, by the last word of their path: ``normal_force="5 N"``; or whole tables: ``mesh={"rows": 10}``. A quantity
        is text with its unit, or a number with a unit (of pint, say). A mapping of whole paths may be given as ``scene``, or to `replace`.

    Raises
    ------
    InputError
        If a key or value is wrong; it names the key and where it stands.

    Examples
    --------
    >>> quick = Scene("quick.toml", normal_force="5 N")
    >>> quick["operation.normal_force"]
    '5 N'
    >>> quick.replace(normal_force="6 N", rows=10)["mesh.rows"]
    10
    >>> quick.replace(normal_force=6)
    Traceback (most recent call last):
    plateau.errors.InputError: operation.normal_force = 6: operation.normal_force: 6 has no unit, expected a force such as "47 N" (N, kN, mN)
    """

    __slots__ = ("_changes", "_path", "_resolved", "_text")

    def __init__(self, scene: "str | os.PathLike[str] | Mapping[str, Any] | Scene | None" = None, /, **changes: Any) -> None:
        self._build(*_source(scene), _layer(changes), 3)

    def _build(self, path: str, text: str | None, before: Layers, changes: Mapping[str, Any], stacklevel: int | None) -> None:
        """Reads the scene, and warns of it in the name of the caller so many calls up, unless None."""
        # Changes of what was changed last replace it, others are laid over it: they may choose another alternative.
        again = bool(before) and changes.keys() <= before[-1].keys()
        layers = (*before[:-1], {**before[-1], **changes}) if again else (*before, changes)
        self._path, self._text, self._changes = path, text, layers
        sets = [[change_of(key, value) for key, value in layer.items()] for layer in layers]
        try:
            self._resolved: NativeScene = native().Scene(path, text, sets)
        except PlateauError as error:
            error.args = (_as_data(str(error)), *error.args[1:])
            raise
        if stacklevel is not None:
            for warning in self._resolved.warnings:
                warnings.warn(_as_data(warning), PlateauWarning, stacklevel=stacklevel)

    def replace(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> "Scene":
        """The scene with other values.

        Parameters
        ----------
        changes : mapping, optional
            Keys by their whole paths, and their values.
        **more
            See `Scene`.

        Returns
        -------
        Scene
        """
        if changes is not None and not isinstance(changes, Mapping):
            raise InputTypeError(f'{changes!r}: expected a dictionary, such as {{"operation.normal_force": "20 N"}}')
        return self._changed({**_layer(changes or {}), **_layer(more)}, 4)

    def _changed(self, changes: Mapping[str, Any], stacklevel: int | None) -> "Scene":
        made = object.__new__(Scene)
        made._build(self._path, self._text, self._changes, changes, stacklevel)
        return made

    @property
    def toml(self) -> str:
        """The whole scene as TOML: every key with its value. ``print(scene)`` shows it."""
        return self._resolved.resolved

    @property
    def tables(self) -> dict[str, Any]:
        """The whole scene as dictionaries; quantities are text with their units."""
        return tomllib.loads(self.toml)

    @property
    def path(self) -> str | None:
        """The scene file, if there is one."""
        return self._path if self._text is None else None

    def __getitem__(self, key: str) -> Any:
        """The value of a key, by its whole path or its last word."""
        found: Any = self.tables
        for name in _path_of(key).split("."):
            if not isinstance(found, Mapping) or name not in found:
                raise UnknownNameError(f"{key} has no value in this scene")
            found = found[name]
        return found

    def __str__(self) -> str:
        return self.toml

    def __repr__(self) -> str:
        return f"<plateau.Scene {self.tables['title']!r}>"

    def __eq__(self, other: object) -> bool:
        return self.toml == other.toml if isinstance(other, Scene) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.toml)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._path, self._text, self._changes)


def _again(path: str, text: str | None, changes: Layers) -> Scene:
    """A scene that another process sends."""
    made = object.__new__(Scene)
    made._build(path, text, changes, {}, None)
    return made


def scene_of(scene: Any, changes: Mapping[str, Any], stacklevel: int) -> Scene:
    """A scene of what functions take for one, changed; warnings are in the name of the caller so many calls up."""
    if scene is None:
        raise InputTypeError("None: expected a scene, or the path of one")
    if isinstance(scene, Scene):
        return scene._changed(_layer(changes), None) if changes else scene
    made = object.__new__(Scene)
    made._build(*_source(scene), _layer(changes), stacklevel + 2)
    return made


def engine_name(engine: object) -> str:
    """Name of the engine that takes the steps; refuses others than ``"fast"`` and ``"plain"``."""
    if engine not in ("fast", "plain"):
        raise InputError(f'engine {shown(engine)}: expected "fast" or "plain"')
    return str(engine)


def _source(scene: Any) -> tuple[str, str | None, Layers]:
    """Path, text unless it is in a file, and changes of what a scene is built of."""
    if isinstance(scene, Scene):
        return scene._path, scene._text, scene._changes
    if scene is None or isinstance(scene, Mapping):
        return UNNAMED, "", ({"version": 1, **_layer(scene or {})},)
    if isinstance(scene, str) and ("\n" in scene or ("=" in scene and not os.path.exists(scene))):
        return UNNAMED, in_utf8(scene, "the text of the scene"), ()
    return file_name(scene, "a scene"), None, ()


@functools.cache
def _keys() -> frozenset[str]:
    return frozenset(native().keys())


def _layer(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Whole paths of keys and their values."""
    try:
        return dict(_flat(tables))
    except RecursionError:
        raise InputError(f"the tables are {TOO_DEEP}") from None


def _flat(tables: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Whole paths of keys and their values; single words are keys of any table."""
    for name, value in tables.items():
        if not isinstance(name, str) or "=" in name:
            raise InputError(f'{shown(name)} is not a key of a scene, expected text such as "operation.normal_force"')
        path = f"{above}.{name}" if above else name if isinstance(value, Mapping) else _path_of(name)
        if isinstance(value, Mapping) and value and path not in _keys():
            yield from _flat(value, path)
        else:
            yield path, value


def _path_of(name: Any) -> str:
    """The whole path of a key that is given by its last word."""
    if not isinstance(name, str):
        raise InputTypeError(f'{shown(name)} is not a key of a scene, expected text such as "operation.normal_force"')
    if "." in name or name in _keys():
        return name
    # Columns of a cycle are called as keys are.
    found = sorted(key for key in _keys() if key.rsplit(".", 1)[-1] == name and ".columns." not in key)
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(f"{name}: there are several such keys, give one of {', '.join(found)}")
    if any(key.startswith(f"{name}.") for key in _keys()):
        return name
    near = difflib.get_close_matches(name, {key.rsplit(".", 1)[-1] for key in _keys()}, 1)
    raise UnknownNameError(f"{name} is no key of scenes" + (f", did you mean {near[0]}?" if near else ""))


# A change as messages name it: as an option of the program, or in the words of `plateau.run`.
CHANGE = re.compile(r'(?:--set |\bset\[")([\w.-]+)(?:"\] = |=)')


def _as_data(message: str) -> str:
    """A message that names changes as keys with their values."""
    return CHANGE.sub(r"\1 = ", message)
