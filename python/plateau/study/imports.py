"""Values of responses from elsewhere, which become part of a study."""

import fcntl
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from plateau.errors import InputError, RunFailed
from plateau.output_folder import put
from plateau.study.data import Answer, Study
from plateau.study.kept_values import KeptValues, file_of
from plateau.study.results import analysed
from plateau.text_tables import read_text_table


@dataclass(frozen=True, repr=False)
class Imported(Answer):
    """Result of an import: what a table brought.

    Attributes
    ----------
    lines, new, changed, complete, runs : int
        Numbers of lines, of values that were not there before and that have changed, of runs with all imported responses, of all runs.
    responses : list of str
        Responses in the table.
    idle : list of str
        Kept lines and columns of points and responses that the study does not have now.
    file : Path
        File in which values are kept.
    """

    study: str
    lines: int
    responses: list[str]
    new: int
    changed: int
    runs: int
    complete: int
    idle: list[str]
    file: Path

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep import --json``."""
        return {**self.__dict__, "file": str(self.file)}

    def text(self) -> str:
        """The text that ``plateau sweep import`` prints."""
        lines = [f"  read      {self.lines} {'line' if self.lines == 1 else 'lines'} with {', '.join(self.responses)}"]
        lines += [f"  values    {self.new} new, {self.changed} changed", f"  complete  {self.complete} of {self.runs} runs"]
        kept = ["Kept, but of nothing that the study has now", *(f"  {line}" for line in self.idle)] if self.idle else []
        return "\n".join([self.study, *lines, f"  kept in   {self.file}", *kept])


def import_values(study: Study | str | os.PathLike[str], table: str | os.PathLike[str], force: bool = False) -> Imported:
    """Takes values of responses with ``imported = true`` into a study.

    Parameters
    ----------
    study : path or Study
        The study file, or a study that was opened by it.
    table : path
        Table in CSV: a column for each factor and for each response in it, and ``replicate`` where needed. Empty cells change nothing.
    force : bool
        Replace values that were imported before and differ.

    Returns
    -------
    Imported

    Raises
    ------
    InputError
        If a line fits no point, or a value is wrong or there already; with its line. Then nothing has changed.
    """
    opened = analysed(study)
    file, given, here = file_of(opened), read_text_table(Path(table)), opened.path or opened.directory
    inputs = [here, Path(table), *([here.parent / opened.document["file"]] if "file" in opened.document else [])]
    if file.exists() and any(one.exists() and file.samefile(one) for one in inputs):
        raise InputError(f"{file}: it is an input, and imported values would be kept in its place; give the study another directory")
    # A table with a mistake in it leaves no folder.
    KeptValues(opened).take(given, force)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with (file.parent / f".{file.name}.lock").open("a") as lock:
            # One import at a time: another one waits.
            fcntl.flock(lock, fcntl.LOCK_EX)
            kept = KeptValues(opened)
            responses, new, changed = kept.take(given, force)
            put(file, kept.written())
    except OSError as error:
        raise RunFailed(f"cannot write {file}: {error.strerror}") from error
    complete = int(kept.values.notna().all(axis=1).sum())
    return Imported(opened.title, len(given.rows), responses, new, changed, len(opened.runs), complete, kept.idle(), file)
