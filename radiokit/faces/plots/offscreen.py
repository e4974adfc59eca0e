"""Off screen: finding an OpenGL that works without a display, and keeping a renderer's chatter off stderr."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from radiokit.facts.errors import MissingExtraError, RadiokitError

__all__ = ["offscreen", "require_pyvista"]

_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
_WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")
_PROBE_TIMEOUT = 60.0

# VTK does not report a missing OpenGL: it crashes. So the question is put to a process that may crash.
_PROBE = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
window, renderer, pixel = vtkRenderWindow(), vtkRenderer(), vtkUnsignedCharArray()
renderer.SetBackground(1.0, 0.0, 0.0)
window.SetOffScreenRendering(1)
window.SetSize(8, 8)
window.AddRenderer(renderer)
window.Render()
window.GetPixelData(4, 4, 4, 4, 0, pixel, 0)
raise SystemExit(pixel.GetTuple3(0) != (255.0, 0.0, 0.0))
"""


def require_pyvista(task: str) -> None:
    """Raise unless PyVista can be imported.

    Raises
    ------
    MissingExtraError
        When PyVista is not installed; ``task`` says what needs it.
    """
    try:
        import pyvista  # noqa: F401
    except ImportError:
        raise MissingExtraError(task, "pyvista", "viz") from None


@contextmanager
def offscreen() -> Iterator[None]:
    """Let VTK open windows without a display, and write nothing to file descriptor 2, within the block.

    Raises
    ------
    RadiokitError
        When VTK finds no OpenGL that works; the message says what to install.
    """
    window = _window("DISPLAY" in os.environ)
    before = os.environ.get(_VARIABLE)
    if window:
        os.environ[_VARIABLE] = window
    try:
        with _quiet_stderr():
            yield
    finally:
        if before is not None:
            os.environ[_VARIABLE] = before
        elif window:
            del os.environ[_VARIABLE]


@cache
def _window(display: bool) -> str:
    """Return the class of render window that works here; empty for VTK's own choice."""
    if sys.platform != "linux":
        return ""
    candidates = ("", *_WINDOWS) if display or _VARIABLE in os.environ else (*_WINDOWS, "")
    for window in candidates:
        if _renders(window):
            return window
    raise RadiokitError(
        "drawing in three dimensions needs OpenGL, and VTK finds none that works: install Mesa's EGL "
        "(Debian, Ubuntu: apt-get install libegl1 libgl1-mesa-dri; Fedora: dnf install mesa-libEGL "
        "mesa-dri-drivers)",
        tried=[window or "default" for window in candidates],
    )


def _renders(window: str) -> bool:
    environment = {**os.environ, _VARIABLE: window} if window else os.environ
    try:
        done = subprocess.run(
            [sys.executable, "-c", _PROBE],
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_PROBE_TIMEOUT,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0


@contextmanager
def _quiet_stderr() -> Iterator[None]:
    """Send what libraries write to file descriptor 2 to a file that is thrown away."""
    if sys.stderr is not None:
        sys.stderr.flush()
    with tempfile.TemporaryFile() as sink:
        try:
            saved = os.dup(2)
        except OSError:  # the process has no standard error
            yield
            return
        os.dup2(sink.fileno(), 2)
        try:
            yield
        finally:
            if sys.stderr is not None:
                sys.stderr.flush()
            os.dup2(saved, 2)
            os.close(saved)
