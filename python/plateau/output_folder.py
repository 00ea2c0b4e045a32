"""A folder of files that one call of a command makes and that belong together: tables, figures, a page.

A list of them is among them, so that a later call replaces all of them or none, and removes those that it does not make itself: a
figure of a response that is no longer asked for does not stay beside the new ones.
"""

import math
import os
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from plateau.errors import InputError, RunFailed
from plateau.units import with_hyphen

LIST = "files.txt"
# Its first line, by which it is known.
HEAD = "# plateau wrote these files; a later call with --force replaces them and removes those that it does not write"
OF = "# of "
# Files by their names, each with what writes it to a path.
Files = Mapping[str, Callable[[Path], object]]


def refuse_earlier(folder: Path, of: str | None, force: bool) -> None:
    """Refuses a folder that has the files of an earlier call, before any work is done; those `of` the same are replaced."""
    followed(folder)
    earlier = _list(folder)
    if earlier is None or force or (of is not None and earlier[0] == of):
        return
    words = f"another call{'' if earlier[0] is None else ', of ' + earlier[0]}" if of is not None else "an earlier call"
    raise InputError(f"{folder} has the files of {words}; give --force to replace them, or name another folder with -o")


def followed(path: Path) -> Path:
    """Path that is written to: the target of a link, else the path itself."""
    if path.is_symlink() and not path.exists():
        raise InputError(f"{path} is a link to {os.readlink(path)}, which is not there; make that, or name another place with -o")
    return path.resolve() if path.is_symlink() else path


def write(folder: Path, files: Mapping[str, bytes], *, of: str | None = None, force: bool = False, inputs: tuple[Path, ...] = ()) -> list[str]:
    """Writes files, content by name, into a folder, with the list of them, each under its name when it is complete; gives their paths.

    Nothing is changed if a file would be replaced that must not be: an input, or a file of others without `force`. `of` names what the
    files are of; a later call of the same replaces them.
    """
    refuse_earlier(folder, of, force)
    earlier = _list(folder)
    own = earlier[1] if earlier is not None and (force or earlier[0] == of) else []
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = "there is a file of that name" if folder.exists() else error.strerror
        raise InputError(f"cannot make the folder {folder}: {reason}; name another one with -o") from error
    real = {os.path.realpath(path) for path in inputs}

    def is_own(name: str) -> bool:
        path = folder / name
        return force or ((name in own or (name == LIST and bool(own))) and path.is_file() and not path.is_symlink())

    for name in (*files, LIST):
        refuse_file(folder / name, is_own(name), inputs, "name another folder with -o")
    for name in own:
        path = folder / name
        if name not in files and path.is_file() and is_own(name) and os.path.realpath(path) not in real:
            path.unlink()
    head = [HEAD] if of is None else [HEAD, OF + of]
    (folder / LIST).unlink(missing_ok=True)
    written: list[str] = []
    try:
        for name, content in files.items():
            put(folder / name, content)
            written.append(name)
    except BaseException:
        # Where the disk is full, the list names what is there, or is not there itself.
        with suppress(RunFailed):
            put(folder / LIST, _lines(*head, *written))
        raise
    put(folder / LIST, _lines(*head, *written))
    return [str(folder / name) for name in files]


def refuse_file(path: Path, force: bool, inputs: tuple[Path, ...], to_do: str = "write elsewhere with -o FILE") -> None:
    """Refuses to write where something is that is not to be replaced; `to_do` says what else can be done."""
    if path.exists() and os.path.realpath(path) in map(os.path.realpath, inputs):
        raise InputError(f"{path} is an input and is not replaced; {to_do}")
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is not a regular file and is not replaced; {to_do}")
    if os.path.lexists(path) and not force:
        raise InputError(f"{path} exists; give --force to replace it, or {to_do}")


def relative(path: Path, folder: Path) -> str:
    """Path from a folder to a file: the same wherever both are moved together."""
    return os.path.relpath(os.path.realpath(path), os.path.realpath(folder)).replace("\n", "\\n")


def put(path: Path, content: bytes) -> None:
    """Writes a file that appears under its name when it is complete; a link of this name is replaced, not followed."""
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False) as file:
            try:
                file.write(content)
                file.flush()
                _put_in_place(Path(file.name), path)
            except BaseException:
                os.unlink(file.name)
                raise
    except OSError as error:
        raise RunFailed(f"cannot write {path}: {error.strerror}") from error


def all_or_none(folder: Path, files: Files, force: bool, inputs: tuple[Path, ...] = ()) -> list[str]:
    """Writes files that appear in their folder, made if it is not there, when all of them are complete; gives their paths."""
    for name in files:
        refuse_file(folder / name, force, inputs, "name another place with -o")
    if not files:
        return []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder, prefix=".plateau-") as place:
            for name, write in files.items():
                write(Path(place, name))
            for name in files:
                _put_in_place(Path(place, name), folder / name)
    except OSError as error:
        if folder.exists() and not folder.is_dir():
            raise InputError(f"{folder} is a file, expected a folder; name another one with -o") from error
        # HDF5 gives no number where a run file cannot be read.
        if error.errno is None:
            raise
        raise RunFailed(f"cannot write into {folder}: {error.strerror}; name another place with -o") from error
    return [str(folder / name) for name in files]


def put_together(folder: Path, files: Mapping[str, bytes], force: bool, inputs: tuple[Path, ...] = ()) -> None:
    """Writes files of this content that appear in their folder, made if it is not there, when all of them are complete."""
    all_or_none(folder, {name: partial(Path.write_bytes, data=content) for name, content in files.items()}, force, inputs)


def _put_in_place(complete: Path, path: Path) -> None:
    """Gives a complete file its name when it is on the disk, with the permissions of the file that it replaces, if there is one."""
    with complete.open("rb") as file:
        os.fsync(file.fileno())
    complete.chmod(path.stat().st_mode & 0o777 if path.is_file() else 0o666 & ~_umask())
    complete.replace(path)


def _lines(*lines: str) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def _list(folder: Path) -> tuple[str | None, list[str]] | None:
    """Subject of the files of an earlier call, and their names; whoever edits the list cannot make it name a file elsewhere."""
    if not (folder / LIST).is_file():
        return None
    try:
        lines = (folder / LIST).read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        return None
    if not lines or lines[0] != HEAD:
        return None
    of = next((line.removeprefix(OF) for line in lines if line.startswith(OF)), None)
    return of, [line for line in lines[1:] if not line.startswith("#") and os.path.basename(line) == line and line]


def plain(value: Any) -> Any:
    """Value as files for programs have it: null for what is no number, no types of NumPy, and a hyphen before numbers in words."""
    if isinstance(value, Mapping):
        return {str(name): plain(one) for name, one in value.items()}
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    if isinstance(value, str):
        return with_hyphen(value)
    return None if isinstance(value, float) and not math.isfinite(value) else str(value) if isinstance(value, Path) else value
