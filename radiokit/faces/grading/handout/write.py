"""Write: the files of a handout, each of which is made anew from the assignment."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.handout.cells import Cell, notebook, script
from radiokit.faces.grading.handout.copies import instructor_cells, student_cells
from radiokit.faces.grading.handout.nbgrader import CONFIG, STEP, nbgrader_cells
from radiokit.faces.grading.handout.otter import FOLDER, otter_cells
from radiokit.faces.grading.handout.worked import Solution, read_solution
from radiokit.faces.grading.rehearsal import rehearsed
from radiokit.faces.grading.words import checked_language
from radiokit.facts.errors import TargetError

__all__ = ["write_handout", "write_out"]


def write_handout(
    assignment: str | Path,
    *,
    to: str | Path | None = None,
    languages: Sequence[str] = ("en",),
    forms: Sequence[str] = (".ipynb", ".py"),
    solution: str | Path | None = None,
    otter: str | Path | None = None,
    nbgrader: str | Path | None = None,
    force: bool = False,
) -> list[Path]:
    """Write what students and instructors hold, and return the files.

    Parameters
    ----------
    assignment : str or Path
        A name among ``list_assignments()``, or a file of your own. Of your own, students' copies have no
        checks of one's own: they would need the file, and the references are in it.
    to : str or Path, optional
        Folder of the students' copies, ``NAME.LANGUAGE.ipynb`` and ``.py``; and of the instructor's,
        ``NAME.LANGUAGE.solution.ipynb``, where there is a solution.
    languages : sequence of str
        Of ``"en"`` and ``"ru"``; otter's and nbgrader's notebooks are in the first.
    forms : sequence of str
        ``".ipynb"`` for notebooks, ``".py"`` for scripts.
    solution : str or Path, optional
        A file of solutions.
    otter : str or Path, optional
        Folder of the master notebook for ``otter assign``.
    nbgrader : str or Path, optional
        Folder of an nbgrader course, for ``source/NAME/NAME.ipynb``. Its ``nbgrader_config.py`` is written
        where there is none; one that is there must have the lines that make points safe.
    force : bool
        Write over files that differ.

    Raises
    ------
    RadiokitError
        When there is no such assignment, language or solution, or a file is there and differs, or a
        course's configuration lacks what it needs.
    """
    work = rehearsed(assignment)
    for language in languages:
        checked_language(language, work.languages)
    solved = None if solution is None else read_solution(solution, work)
    own = Path(assignment).resolve() if Path(assignment).suffix == ".py" else None
    files: dict[Path, str] = {}
    if to is not None:
        for language in languages:
            files |= _copies(work, language, Path(to), forms, solved, "" if own else work.name)
    if otter is not None:
        graded_by = work.name if own is None else f"{FOLDER}/{own.name}"
        master = otter_cells(work, languages[0], solution=solved, graded_by=graded_by)
        files[Path(otter, f"{work.name}.ipynb")] = notebook(master)
        if own is not None:
            files[Path(otter, graded_by)] = own.read_text(encoding="utf-8")
    if nbgrader is not None:
        graded_by = work.name if own is None else str(own)
        source = nbgrader_cells(work, languages[0], solution=solved, graded_by=graded_by)
        files[Path(nbgrader, "source", work.name, f"{work.name}.ipynb")] = notebook(source)
        config = Path(nbgrader, "nbgrader_config.py")
        if not config.exists():
            files[config] = CONFIG
        elif STEP not in config.read_text(encoding="utf-8"):
            raise TargetError(
                f"{config} is there without {STEP}, so that notebooks could give themselves points; "
                "in an empty folder the lines that it needs are written"
            )
    for path, text in files.items():
        if not force and path.is_file() and path.read_bytes() != text.encode():
            raise TargetError(f"{path} is there and differs; --force writes over it")
    for path, text in files.items():
        write_out(path, text)
    return list(files)


def write_out(path: Path, text: str) -> None:
    """Write a file, and the folders that it is in.

    Raises
    ------
    TargetError
        When it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
    except OSError as error:
        raise TargetError(f"cannot write {path}: {error.strerror}") from error


def _copies(
    work: Assignment,
    language: str,
    folder: Path,
    forms: Sequence[str],
    solved: Solution | None,
    checked_by: str,
) -> dict[Path, str]:
    copies: dict[str, list[Cell]] = {
        f"{work.name}.{language}": student_cells(work, language, checked_by=checked_by)
    }
    if solved is not None:
        copies[f"{work.name}.{language}.solution"] = instructor_cells(
            work, language, solution=solved, checked_by=checked_by
        )
    made = {".ipynb": notebook, ".py": script}
    return {Path(folder, name + form): made[form](cells) for name, cells in copies.items() for form in forms}
