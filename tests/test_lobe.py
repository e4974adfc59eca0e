"""Lobes: the mesh is the function, at every width; the picture is drawn quietly, without a display."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from radiokit.contracts.blackbox import BlackBox
from radiokit.contracts.bsdf import DeltaLobe
from radiokit.faces.plots import offscreen
from radiokit.faces.plots.lobe import lobe_mesh, save_lobe, show_lobe
from radiokit.facts.directions import angle_between, reflect, spherical_to_cartesian, unit
from radiokit.facts.errors import MissingExtraError, ParameterError, RadiokitError
from radiokit.measure.slope import slope_rule

Function = Callable[[np.ndarray, np.ndarray], np.ndarray]


def microfacets(alpha: float) -> Function:
    """A GGX lobe without shadowing, of known width."""

    def f(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        h = wi + wo
        h = h / np.linalg.norm(h, axis=-1, keepdims=True)
        slope = h[:, 0] ** 2 + h[:, 1] ** 2 + alpha**2 * h[:, 2] ** 2
        return alpha**2 / (np.pi * slope**2) / 4

    return f


def lambert(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    return np.full(len(wi), 1 / np.pi)


@dataclass(frozen=True, kw_only=True)
class Glass(BlackBox):
    """A reflected and a transmitted delta lobe, and nothing else."""

    share: float = 0.75

    def delta_lobes(self, wo: np.ndarray) -> tuple[DeltaLobe, ...]:
        through = unit(reflect(wo) * [0.7, 0.7, -1.0])
        share = np.full(len(wo), self.share)
        return DeltaLobe(reflect(wo), share), DeltaLobe(through, 1 - share)


def glass(share: float) -> Glass:
    return Glass(function=lambda wi, wo: np.zeros(len(wi)), label="glass", share=share)


def integral(mesh: Any) -> float:
    """The integral of the mesh's value over solid angle, from nothing but its vertices and faces."""
    wi, value = np.asarray(mesh["wi"]), np.asarray(mesh["value"])
    faces = mesh.triangulate().regular_faces
    a, b, c = (wi[faces[:, k]] for k in range(3))
    # van Oosterom and Strackee (1983), with the triple product taken from the edges, which keeps its digits
    triple = np.abs(np.einsum("ij,ij->i", a, np.cross(b - a, c - a)))
    dots = sum(np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    total = 2 * np.arctan2(triple, 1 + dots) @ value[faces].mean(axis=-1)
    return float(total)


@pytest.fixture
def canvas(tmp_path: Path, missing_opengl: str) -> Path:
    """A file to draw into, where there is an OpenGL to draw with."""
    if missing_opengl:
        pytest.skip(missing_opengl)
    return tmp_path / "lobe.png"


def pixels(png: Path) -> np.ndarray:
    from PIL import Image

    with Image.open(png) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def count(image: np.ndarray, colour: tuple[int, int, int], distance: float = 60.0) -> int:
    return int((np.linalg.norm(image - np.array(colour), axis=-1) < distance).sum())


ORANGE, CRIMSON, TEAL = (190, 90, 8), (160, 20, 75), (33, 130, 115)


# --- the mesh


@pytest.mark.parametrize("cosine", [True, False])
@pytest.mark.parametrize("scale", ["linear", "log"])
def test_radius_is_the_value(cosine: bool, scale: Any) -> None:
    f, wo = microfacets(0.3), spherical_to_cartesian(0.8, 0.4)
    mesh = lobe_mesh(f, wo, cosine=cosine, scale=scale, decades=3.0)
    wi = np.asarray(mesh["wi"])
    value = f(wi, np.broadcast_to(wo, wi.shape)) * (wi[:, 2] if cosine else 1.0)
    np.testing.assert_allclose(mesh["value"], value, rtol=1e-14)
    radius = value if scale == "linear" else np.maximum(0, 1 + np.log10(value / value.max()) / 3)
    np.testing.assert_allclose(mesh.points, radius[:, None] * wi, rtol=0, atol=2e-6 * radius.max())
    assert (wi[:, 2] >= 0).all()
    np.testing.assert_allclose(np.linalg.norm(wi, axis=-1), 1, rtol=1e-14)


@pytest.mark.parametrize("theta", [0.0, 1.0, 1.5])
@pytest.mark.parametrize("alpha", [1e-3, 0.02, 0.3, 1.0])
def test_a_lobe_of_any_width_is_resolved(alpha: float, theta: float) -> None:
    f, wo = microfacets(alpha), spherical_to_cartesian(theta, 0.3)
    mesh = lobe_mesh(f, wo)
    peak = mesh["value"].max()
    # Between the vertices the surface is the lobe too, to 4 % of the peak...
    wi, faces = np.asarray(mesh["wi"]), mesh.triangulate().regular_faces
    centre = unit(wi[faces].mean(axis=1))
    value = f(centre, np.broadcast_to(wo, centre.shape)) * centre[:, 2]
    assert np.abs(np.asarray(mesh["value"])[faces].mean(axis=1) - value).max() < 0.04 * peak
    # ...no edge is longer than a tenth of the lobe, so that the outline is smooth...
    points = np.asarray(mesh.points)
    edges = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=-1)
    assert edges.max() < peak / 10
    # ...and a rule made for such lobes finds the same peak and nearly the same integral.
    wi, weight = slope_rule(wo, alpha, 128)
    value = f(wi, np.broadcast_to(wo, wi.shape)) * wi[:, 2]
    assert peak == pytest.approx(value.max(), rel=0.01)
    assert integral(mesh) == pytest.approx(value @ weight, rel=0.02)


def test_the_integral_notices_a_lobe_that_is_not_resolved() -> None:
    mesh = lobe_mesh(lambert, [0.0, 0.0, 1.0])
    assert integral(mesh) == pytest.approx(1, rel=0.001)
    wi = np.asarray(mesh["wi"])
    f, wo = microfacets(1e-4), spherical_to_cartesian(0.6, np.pi / 144)  # between the vertices of that mesh
    mesh["value"] = f(wi, np.broadcast_to(wo, wi.shape)) * wi[:, 2]
    assert integral(mesh) != pytest.approx(integral(lobe_mesh(f, wo)), rel=0.5)


def test_a_lobe_away_from_the_mirror_direction_is_found(rng: np.random.Generator) -> None:
    centre = spherical_to_cartesian(rng.uniform(0.1, 1.4), rng.uniform(-np.pi, np.pi))

    def f(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        return np.exp(-0.5 * (angle_between(wi, centre) / 0.02) ** 2)

    mesh = lobe_mesh(f, [0.0, 0.0, 1.0], cosine=False)
    assert mesh["value"].max() == pytest.approx(1, abs=1e-6)
    assert integral(mesh) == pytest.approx(2 * np.pi * 0.02**2, rel=0.02)


def test_several_wavelengths_are_averaged() -> None:
    mesh = lobe_mesh(lambda wi, wo: np.full((len(wi), 3), [0.1, 0.2, 0.6]), [0.0, 0.0, 1.0], cosine=False)
    np.testing.assert_allclose(mesh["value"], 0.3, rtol=1e-14)


def test_a_value_that_is_none_has_no_radius() -> None:
    def f(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        return np.where(wi[:, 0] > 0, np.nan, np.where(wi[:, 1] > 0, 0.5, -0.5))

    mesh = lobe_mesh(f, [0.0, 0.0, 1.0], cosine=False)
    radius, value = np.linalg.norm(mesh.points, axis=-1), np.asarray(mesh["value"])
    assert np.isnan(value).any()
    assert (radius[~(value > 0)] == 0).all()
    np.testing.assert_allclose(radius[value > 0], 0.5, rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("scale", {"scale": "cubic"}),
        ("decades", {"decades": 0.0}),
        ("decades", {"decades": float("nan")}),
        ("resolution", {"resolution": 7}),
        ("resolution", {"resolution": 20.0}),
        ("wo", {"wo": [0.0, 0.0, -1.0]}),
        ("wo", {"wo": [[0.0, 0.0, 1.0]]}),
        ("wo", {"wo": [0.0, 0.0, 2.0]}),
    ],
)
def test_an_argument_that_is_not_allowed_is_named(name: str, options: dict[str, Any]) -> None:
    options = {"wo": [0.0, 0.0, 1.0], **options}
    with pytest.raises(ParameterError, match=f"^{name}"):
        lobe_mesh(lambert, **options)


# --- the picture


def test_a_picture_is_drawn_quietly(canvas: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert save_lobe(microfacets(0.3), theta=0.8, png=canvas, size=(600, 450)) == canvas
    assert capfd.readouterr() == ("", "")
    image = pixels(canvas)
    assert image.shape == (450, 600, 3)
    assert (image[[0, -1]] == 255).all()  # the paper is white, and nothing is cut off
    assert (image[:, [0, -1]] == 255).all()
    assert count(image, TEAL) > 2000
    assert count(image, CRIMSON) > 200
    assert count(image, ORANGE, 40) == 0


def test_a_fresh_process_without_a_display_is_quiet(canvas: Path) -> None:
    code = (
        "from radiokit.faces.plots.lobe import save_lobe\n"
        f"save_lobe(lambda wi, wo: wi[:, 2], theta=0.5, png={str(canvas)!r}, size=(400, 300))"
    )
    bare = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], env=bare, capture_output=True, text=True
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert count(pixels(canvas), TEAL) > 500


def test_the_scales_differ_and_the_same_call_draws_the_same(canvas: Path) -> None:
    drawn = [
        np.asarray(show_lobe(microfacets(0.02), theta=1.0, scale=scale, size=(400, 300)))
        for scale in ("linear", "linear", "log")
    ]
    assert (drawn[0] == drawn[1]).all()
    assert count(drawn[2].astype(int), TEAL) > 1.5 * count(drawn[0].astype(int), TEAL)


def test_delta_lobes_are_arrows_as_long_as_their_weight(canvas: Path) -> None:
    lobe = lobe_mesh(glass(0.5), [0.0, 0.6, 0.8])
    assert np.linalg.norm(lobe.points, axis=-1).max() == 0
    seen = []
    for share in (0.0, 0.4, 1.0):
        save_lobe(glass(share), theta=0.9, phi=-0.7, png=canvas, size=(600, 450))
        image = pixels(canvas)
        assert count(image, TEAL, 30) == 0
        above = image[: 450 * 55 // 100]
        seen.append(count(above, ORANGE))
    assert seen[0] < seen[1] < seen[2]


def test_values_that_cannot_be_drawn_do_not_stop_the_picture(canvas: Path) -> None:
    save_lobe(lambda wi, wo: np.where(wi[:, 0] > 0.5, np.nan, 1.0), theta=0.0, png=canvas, size=(400, 300))
    assert count(pixels(canvas), TEAL) > 500


def test_nothing_to_draw_is_a_picture_too(canvas: Path) -> None:
    save_lobe(lambda wi, wo: np.zeros(len(wi)), theta=1.5, png=canvas, size=(400, 300))
    assert count(pixels(canvas), CRIMSON) > 100


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("theta", {"theta": 1.6}),
        ("theta", {"theta": -0.1}),
        ("theta", {"theta": float("nan")}),
        ("phi", {"phi": float("inf")}),
        ("size", {"size": (100, 900)}),
        ("size", {"size": (900,)}),
        ("scale", {"scale": "cubic"}),
        ("png", {"png": "lobe.jpg"}),
        ("png", {"png": "no/such/folder/lobe.png"}),
    ],
)
def test_a_picture_that_cannot_be_drawn_names_the_reason(
    name: str, options: dict[str, Any], canvas: Path
) -> None:
    options = {"theta": 0.5, "png": canvas, **options}
    with pytest.raises(ParameterError, match=f"^{name}"):
        save_lobe(lambert, **options)
    assert not canvas.exists()


def test_an_unknown_backend_is_named() -> None:
    with pytest.raises(ParameterError, match=r"^backend = 'vr'"):
        show_lobe(lambert, theta=0.5, backend="vr")


def test_a_view_that_turns_names_the_extra_that_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "trame", None)
    with pytest.raises(MissingExtraError, match=r"needs trame: pip install 'radiokit\[viz\]'"):
        show_lobe(lambert, theta=0.5, backend="html")


@pytest.mark.parametrize("draw", [save_lobe, show_lobe])
def test_without_pyvista_the_extra_is_named(
    draw: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    options = {"png": tmp_path / "lobe.png"} if draw is save_lobe else {}
    with pytest.raises(MissingExtraError, match=r"pip install 'radiokit\[viz\]'"):
        draw(lambert, theta=0.5, **options)
    with pytest.raises(MissingExtraError, match="pyvista"):
        lobe_mesh(lambert, [0.0, 0.0, 1.0])


# --- OpenGL


@pytest.fixture
def fresh_probe() -> Iterator[None]:
    offscreen._window.cache_clear()
    yield
    offscreen._window.cache_clear()


@pytest.mark.usefixtures("fresh_probe")
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the system always has an OpenGL")
def test_no_opengl_is_an_error_and_not_a_crash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The probe is made to die as VTK does where there is no OpenGL.
    monkeypatch.setattr(offscreen, "_PROBE", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    png = tmp_path / "lobe.png"
    with pytest.raises(RadiokitError, match=r"needs OpenGL.*install Mesa"):
        save_lobe(lambert, theta=0.5, png=png)
    assert not png.exists()


@pytest.mark.usefixtures("fresh_probe")
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere VTK's own choice is right")
def test_the_first_window_that_works_is_used_and_the_environment_restored(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(offscreen, "_renders", lambda window: window == "vtkOSOpenGLRenderWindow")
    monkeypatch.delenv("DISPLAY", raising=False)
    for before in (None, "vtkEGLRenderWindow"):
        if before:
            monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", before)
        with offscreen.offscreen():
            assert os.environ["VTK_DEFAULT_OPENGL_WINDOW"] == "vtkOSOpenGLRenderWindow"
        assert os.environ.get("VTK_DEFAULT_OPENGL_WINDOW") == before


def test_what_libraries_write_to_stderr_is_lost_only_inside(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ZeroDivisionError), offscreen._quiet_stderr():  # noqa: PT012
        os.write(2, b"chatter")
        raise ZeroDivisionError
    os.write(2, b"heard")
    assert capfd.readouterr().err == "heard"
