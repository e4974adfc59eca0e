"""Gradescope's autograder: the zip file that an instructor uploads."""

from __future__ import annotations

import re
import secrets
import sys
import zipfile
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

import radiokit
from radiokit.faces.grading.assignment import Assignment, assignment_from_source, assignment_source
from radiokit.faces.grading.rehearsal import rehearse
from radiokit.faces.grading.words import checked_language
from radiokit.facts.errors import ParameterError, TargetError

__all__ = ["gradescope_zip", "pinned_requirements"]

_SETUP = """\
#!/usr/bin/env bash
# Runs once, when Gradescope builds the image: Python {python} and what radiokit needs, in a place of its own.
# The image's own Python may be older; uv finds the right one, or fetches it.
set -euo pipefail
base=${{AUTOGRADER_BASE:-/autograder}}
here=$(cd "$(dirname "${{BASH_SOURCE[0]}}")" && pwd)
export UV_PYTHON_INSTALL_DIR=$base/python UV_CACHE_DIR=$base/cache UV_LINK_MODE=copy

if ! python3 -m pip --version >/dev/null 2>&1; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update
    apt-get install -y --no-install-recommends ca-certificates python3 python3-pip
fi
python3 -m pip install --quiet --target "$base/uv" "uv>=0.5"
uv=$base/uv/bin/uv
"$uv" venv --quiet --python {python} "$base/venv"
"$uv" pip install --quiet --python "$base/venv/bin/python" --requirement "$here/requirements.txt"
rm -rf "$base/uv" "$base/cache"
chmod -R a+rX "$base/venv"
if [ -d "$base/python" ]; then chmod -R a+rX "$base/python"; fi
"$base/venv/bin/python" -m compileall -q "$here/package"
PYTHONPATH=$here/package "$base/venv/bin/python" -P -m radiokit.faces.grading.autograder --check
"""

_RUN = """\
#!/usr/bin/env bash
# Runs for each submission, as root. What a student's code must not reach is closed before it starts.
set -euo pipefail
base=${{AUTOGRADER_BASE:-/autograder}}
umask 077
chmod -R go= "$base/source" "$base/results"
if [ -e "$base/submission_metadata.json" ]; then chmod go= "$base/submission_metadata.json"; fi
cd "$base"
export PYTHONPATH=$base/source/package
exec "${{AUTOGRADER_PYTHON:-$base/venv/bin/python}}" -P -B -m radiokit.faces.grading.autograder \\
    "$base" {language}
"""

_DATE = (1980, 1, 1, 0, 0, 0)
"""The date of all files, so that equal files make equal archives."""


def pinned_requirements(package: str = "radiokit", *, extra: str = "grading") -> list[str]:
    """Return all that a package needs, each in the version that is installed here: ``["numpy==2.3.5", ...]``.

    What an extra asks for is taken along where it is installed. What is not installed here, since another
    system needs it, is left to the installer.

    >>> any(each.startswith("numpy==") for each in pinned_requirements())
    True
    """
    from packaging.requirements import Requirement

    linux = {"sys_platform": "linux", "platform_system": "Linux", "os_name": "posix"}
    pins: dict[str, str] = {}
    seen: set[tuple[str, str]] = set()
    waiting = [(package, ""), (package, extra)]
    while waiting:
        name, wanted = waiting.pop()
        if (name, wanted) in seen:
            continue
        seen.add((name, wanted))
        try:
            found = distribution(name)
        except PackageNotFoundError:
            continue
        if name != package:
            pins[re.sub(r"[-_.]+", "-", name).lower()] = found.version
        for line in found.requires or ():
            requirement = Requirement(line)
            marker = requirement.marker
            if marker is None or marker.evaluate({**linux, "extra": wanted}):
                waiting += [(requirement.name, each) for each in ("", *requirement.extras)]
    return [f"{name}=={version}" for name, version in sorted(pins.items())]


def gradescope_zip(
    assignment: str | Path, out: str | Path, *, secret: str = "", language: str = "en"
) -> Path:
    """Write an autograder for Gradescope: upload it as it is, under Configure Autograder.

    It holds radiokit as it is installed here, the pinned versions of all that it needs, the assignment and
    the secret, and no solutions. The image is built with the Python of this version; whoever has the file
    has the secret.

    Parameters
    ----------
    assignment : str or Path
        A name among ``list_assignments()``, or a file of your own, which must stand alone.
    out : str or Path
        The zip file to write.
    secret : str
        What makes the inputs unforeseeable, by default a new one; keep the file to keep it.
    language : str
        ``"en"`` or ``"ru"``.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    RadiokitError
        When there is no such assignment, or the file cannot be written.
    """
    if isinstance(assignment, Assignment):
        raise ParameterError(
            "assignment", assignment.name, "its name or its file, which the zip file takes along"
        )
    source, name = assignment_source(assignment)
    work = assignment_from_source(source, name)
    checked_language(language, work.languages)
    if Path(assignment).suffix == ".py":
        rehearse(work)
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    files: dict[str, tuple[bytes, int]] = {
        "setup.sh": (_SETUP.format(python=python).encode(), 0o755),
        "run_autograder": (_RUN.format(language=language).encode(), 0o755),
        "requirements.txt": ("\n".join(pinned_requirements()).encode() + b"\n", 0o644),
        "assignment.py": (source.encode(), 0o600),
        "secret.txt": ((secret or secrets.token_hex(32)).encode() + b"\n", 0o600),
    }
    folder = f"package/radiokit-{version('radiokit')}.dist-info"
    files[f"{folder}/METADATA"] = ((distribution("radiokit").read_text("METADATA") or "").encode(), 0o644)
    root = Path(radiokit.__file__).parent
    for path in sorted(root.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            files[f"package/radiokit/{path.relative_to(root).as_posix()}"] = (path.read_bytes(), 0o644)
    path = Path(out)
    try:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, (data, mode) in sorted(files.items()):
                info = zipfile.ZipInfo(name, _DATE)
                info.external_attr = (0o100000 | mode) << 16
                info.create_system = 3
                info.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(info, data)
    except OSError as error:
        raise TargetError(f"cannot write {path}: {error.strerror}") from error
    return path
