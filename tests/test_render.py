"""Render: pictures against closed forms, their errors and files, and bodies that must vanish in a furnace."""

from __future__ import annotations

import json
import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import radiokit as rk
from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.cli import main
from radiokit.faces.render.camera import Camera
from radiokit.faces.render.furnace import furnace_image
from radiokit.faces.render.picture import Image, srgb
from radiokit.faces.render.render import render
from radiokit.faces.render.scenes import SCENES, make_setting
from radiokit.facts.errors import MissingExtraError, ParameterError, RadiokitError, UnknownNameError
from radiokit.measure.statistics import sidak

MODELS = rk.list_bsdfs()
LEVEL = sidak(1e-3, 2 * len(MODELS) + 20)


# --- pictures ---


def test_a_diffuse_sphere_in_a_furnace_is_its_reflectance():
    picture = render("sphere", Lambert(reflectance=0.5), light="furnace", size=12)
    assert np.all(np.abs(picture.values[picture.surface] - 0.5) <= picture.error[picture.surface])
    assert np.all(picture.values[~picture.surface] == 1.0)
    assert not picture.error[~picture.surface].any()
    assert not picture.statistical.any()


LOSSLESS = [name for name in MODELS if rk.bsdf(name).claims.lossless and name != "lambert_transmitter"]


@pytest.mark.parametrize("name", LOSSLESS)
def test_a_lossless_sphere_vanishes_into_its_furnace(name):
    """All but one, of which ``shade`` takes the smooth part to reflect: half of it transmits."""
    picture = render("sphere", rk.bsdf(name), light="furnace", size=4, rtol=1e-6)
    assert picture.surface.any()
    assert np.all(np.abs(picture.values - 1.0) <= picture.error + 1e-9)
    assert picture.worst_error <= 1e-6


def test_a_diffuse_plane_under_a_lamp():
    """ρI cosθ/(πd²), pixel by pixel, and its mirror image."""
    picture = render("plane", Lambert(reflectance=0.8), light="lamp", size=9)
    setting = make_setting("plane", light="lamp", size=9)
    (lamp,) = SCENES["plane"]["lamp"]
    for row, column in np.argwhere(picture.surface):
        ray = setting.camera.rays[row, column]
        point = np.array(setting.camera.position) - ray * setting.camera.position[2] / ray[2]
        way = np.array(lamp.position) - point
        square = way @ way
        truth = 0.8 / math.pi * lamp.intensity * way[2] / square**1.5
        assert picture.values[row, column] == pytest.approx(truth, rel=1e-12)
    assert np.all(picture.values[~picture.surface] == 0.0)
    assert not picture.surface[0].any()  # the sky
    assert picture.surface[-1].all()


def test_every_pixel_is_what_shade_says():
    f = GGX(alpha=0.4)
    picture = render("sphere", f, light="sky", size=5, rtol=1e-4)
    row, column = 1, 2
    ray = Camera(position=(0, -6, 0), field=0.36, width=5, height=5).rays[row, column]
    b = 6 * ray[1]
    point = np.array([0, -6, 0]) + (b - math.sqrt(b * b - 35)) * ray
    found = rk.shade(f, SCENES["sphere"]["sky"], -ray, normal=point, position=point, rtol=1e-4)
    assert picture.values[row, column] == pytest.approx(found.value, rel=1e-6)


def test_the_box_under_its_panel():
    picture = render("box", size=8)
    assert picture.values.shape == (8, 8, 3)
    assert not picture.statistical.any()
    dark = picture.values.max(axis=-1) == 0  # the ceiling, in whose plane the panel lies
    assert dark.sum() == dark[0].sum() == 8
    assert picture.error[~dark].max() < 1e-13
    assert picture.error[dark].max() < 2e-13  # a rounded point may be a hair below the plane
    left, right = picture.values[4, 0], picture.values[4, 7]
    assert left[0] > 3 * left[1]  # red
    assert right[1] > 2 * right[0]  # green
    assert left[0] / 0.63 == pytest.approx(right[1] / 0.45, rel=1e-9)  # the panel lights both alike
    (panel,) = SCENES["box"]["panel"]
    setting = make_setting("box", size=8)
    hits = setting.trace(setting.camera)
    arriving = rk.irradiance(panel, normal=hits.normal[4, 4], position=hits.position[4, 4])
    assert picture.values[4, 4] == pytest.approx(0.73 / math.pi * arriving.value, rel=1e-12)


def test_walls_that_light_each_other(seed):
    """With all bounces nothing is darker, and the ceiling, which the panel does not light, is lit."""
    one = render("box", size=4)
    every = render("box", size=4, bounces="all", samples=64, rng=seed)
    assert every.statistical.all()
    assert np.all(every.values > one.values - 5 * every.error)
    assert np.all(every.values[0] > one.values[0])
    assert every.values[0].min() > 0
    assert every.evaluations == 64 * 16


def test_a_picture_is_the_same_for_any_number_of_workers(seed):
    options = {"light": "sky", "size": 5, "method": "mis", "samples": 64, "rng": seed}
    with ThreadPoolExecutor(3) as three:
        shared = render("sphere", GGX(alpha=0.4), executor=three, **options)
    alone = render("sphere", GGX(alpha=0.4), **options)
    assert np.array_equal(alone.values, shared.values)
    assert np.array_equal(alone.error, shared.error)
    assert alone.statistical[alone.surface].all()
    assert not np.array_equal(alone.values, render("sphere", GGX(alpha=0.4), **options | {"rng": 1}).values)


def test_pixels_that_do_not_converge_are_counted():
    picture = render(
        "sphere", GGX(alpha=0.4), light="furnace", size=1, method="mc-light", rtol=1e-7, samples=None
    )
    data = picture.to_json()
    assert data["unconverged_pixels"] == data["surface_pixels"] > 0


# --- files ---


def ramp(k=None):
    values = np.linspace(0, 1, 12).reshape(3, 4)
    values = values if k is None else np.repeat(values[:, :, None], k, axis=2)
    flags = np.zeros((3, 4), dtype=bool)
    return Image(values=values, error=0.1 * values, statistical=flags, converged=~flags, surface=~flags)


def test_srgb_and_its_inverse():
    x = np.linspace(0, 1, 1001)
    y = srgb(x)
    back = np.where(y <= 0.04045, y / 12.92, ((y + 0.055) / 1.055) ** 2.4)
    assert np.abs(back - x).max() < 1e-7  # as the standard's own numbers agree
    assert np.all(np.diff(y) > 0)
    assert srgb([-1.0, 2.0]).tolist() == pytest.approx([0.0, 1.0])


def test_png_files(tmp_path):
    from matplotlib.image import imread

    picture = ramp()
    read = imread(picture.save(tmp_path / "grey.png", white=0.5))[..., :3]
    assert np.abs(read[..., 0] - srgb(picture.values / 0.5)).max() <= 0.5 / 255 + 1e-6
    assert np.array_equal(read[..., 0], read[..., 2])
    errors = imread(picture.save_error(tmp_path / "error.png"))
    assert errors[2, 3, 0] == 1.0
    assert imread(ramp(3).save(tmp_path / "rgb.png")).shape[:2] == (3, 4)
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert ramp(2)._repr_png_() is None


def test_exr_files(tmp_path):
    OpenEXR = pytest.importorskip("OpenEXR")
    for k, names in ((None, {"Y", "error"}), (2, {"S0", "S1", "error.S0", "error.S1"})):
        picture = ramp(k)
        with OpenEXR.File(str(picture.save(tmp_path / f"{k}.exr")), separate_channels=True) as file:
            channels = file.channels()
            assert set(channels) == names
            first = min(names)
            assert channels[first].pixels.dtype == np.float32
            plane = picture.values if k is None else picture.values[..., 0]
            assert np.array_equal(channels[first].pixels, plane.astype(np.float32))
    with OpenEXR.File(str(ramp(3).save_error(tmp_path / "e.exr"))) as file:
        assert np.allclose(file.channels()["RGB"].pixels, ramp(3).error, rtol=1e-6)


def test_what_cannot_be_saved(tmp_path, monkeypatch):
    with pytest.raises(ParameterError, match=r"\.png or \.exr"):
        ramp().save("picture.jpg")
    with pytest.raises(ParameterError, match="wavelengths = 2"):
        ramp(2).save(tmp_path / "two.png")
    with pytest.raises(ParameterError, match="white"):
        ramp().save(tmp_path / "x.png", white=0.0)
    with pytest.raises(RadiokitError, match="cannot write"):
        ramp().save(tmp_path / "nowhere" / "x.png")
    monkeypatch.setitem(__import__("sys").modules, "OpenEXR", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'radiokit\[images\]'"):
        ramp().save(tmp_path / "x.exr")


# --- bodies that vanish ---


@pytest.mark.parametrize("name", MODELS)
def test_every_model_vanishes_unless_it_claims_otherwise(name, seed):
    f = rk.bsdf(name)
    picture = furnace_image(f, size=8, samples=1 << 11, rng=seed)
    verdict = picture.verdict(LEVEL)
    lawful = f.claims.conserves and f.claims.reciprocity != "no"
    assert verdict.ok or not lawful, str(verdict)
    if not verdict.ok:
        assert str(verdict.outcome) == "violated"
        assert "it claims that it" in verdict.message
        assert verdict.witness is not None
    if f.claims.lossless:
        assert np.all(np.abs(picture.emissivity) < 1e-7)
    assert np.all(picture.values[~picture.surface] == 1.0)
    assert np.all(picture.emissivity[picture.surface] >= -1e-9) or not f.claims.conserves


@pytest.mark.parametrize("name", ["cook_torrance", "phong_original"])
def test_what_breaks_the_laws_is_seen(name, seed):
    verdict = furnace_image(rk.bsdf(name), size=8, samples=1 << 11, rng=seed).verdict(LEVEL)
    assert str(verdict.outcome) == "violated"
    json.dumps(verdict.to_json(), allow_nan=False)


def planted(base, factor):
    """Return a model whose samples weigh too much, while its values are right."""

    class Heavy(type(base)):
        name = ""

        def sample(self, u, wo):
            wi, weight = super().sample(u, wo)
            return wi, factor * weight

    return Heavy(**base.parameters())


@pytest.mark.parametrize("base", [Lambert(reflectance=0.5), GGX(alpha=0.3, eta=0.2, k=3.0)], ids=repr)
def test_a_sampler_that_is_two_percent_off_is_seen(base, seed):
    good = furnace_image(base, size=8, samples=1 << 14, rng=seed)
    assert good.verdict(LEVEL).ok
    heavy = furnace_image(planted(base, 1.02), size=8, samples=1 << 14, rng=seed)
    assert str(heavy.verdict(LEVEL).outcome) == "violated"


def test_a_gain_of_energy_and_a_lack_of_reciprocity_are_seen(seed):
    gain = furnace_image(lambda wi, wo: 1.02 / np.pi, size=6, rng=seed).verdict(LEVEL)
    assert "gains energy" in gain.message
    one_way = rk.as_bsdf(lambda wi, wo: 0.8 * wi[:, 2] / np.pi)
    skewed = furnace_image(one_way, size=6, samples=1 << 12, rng=seed).verdict(LEVEL)
    assert str(skewed.outcome) == "violated"
    assert "gains" not in skewed.message


def test_an_uncertain_picture_is_inconclusive(seed):
    picture = furnace_image(GGX(alpha=0.8, eta=0.2, k=3.0), size=6, samples=8, rng=seed)
    assert str(picture.verdict(1e-12).outcome) == "inconclusive"


def test_wavelengths_vanish_too(seed):
    picture = furnace_image(Lambert(reflectance=[0.2, 0.5, 0.9]), size=6, samples=256, rng=seed)
    assert picture.values.shape == (6, 6, 3)
    assert picture.verdict(LEVEL).ok
    assert picture.emissivity[3, 3] == pytest.approx([0.8, 0.5, 0.1])
    assert isinstance(picture.model, BSDF)


def test_an_anisotropic_body_is_asked_pixel_by_pixel(seed):
    f = rk.bsdf("ward_gmd", alpha_x=0.3, alpha_y=0.6)
    picture = furnace_image(f, size=4, samples=1 << 10, rng=seed)
    assert len(picture.balances) == picture.surface.sum()
    assert picture.verdict(LEVEL).ok


# --- what is refused ---


@pytest.mark.parametrize(
    ("error", "message", "options"),
    [
        (UnknownNameError, "sphere", {"scene": "sphre"}),
        (UnknownNameError, "light of scene 'sphere'", {"light": "panel"}),
        (UnknownNameError, "light of scene 'box'", {"scene": "box", "light": "sky"}),
        (UnknownNameError, "method", {"method": "magic"}),
        (UnknownNameError, "method", {"scene": "box", "bounces": "all", "method": "mis"}),
        (ParameterError, "size", {"size": 0}),
        (ParameterError, "bounces", {"bounces": "all"}),
        (ParameterError, "bounces", {"scene": "box", "bounces": "two"}),
        (ParameterError, "walls of its own", {"scene": "box", "f": Lambert()}),
        (UnknownNameError, "light of scene 'plane'", {"scene": "plane", "light": "isothermal"}),
        (ParameterError, "rtol", {"rtol": 2.0}),
    ],
    ids=str,
)
def test_bad_arguments_are_named(error, message, options):
    scene = options.pop("scene", "sphere")
    with pytest.raises(error, match=message):
        render(scene, **{"size": 2} | options)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("field", {"field": 4.0}),
        ("up", {"up": (0, 1, 0)}),
        ("width", {"width": 0}),
        ("position", {"position": "x"}),
    ],
    ids=str,
)
def test_bad_cameras_are_named(name, change):
    with pytest.raises(ParameterError, match=name):
        Camera(**{"position": (0, -1, 0)} | change)


# --- the command ---


def run(capsys, *words):
    with pytest.raises(SystemExit) as stop:
        main(["render", *map(str, words)])
    out, err = capsys.readouterr()
    return stop.value.code, out, err


def test_the_command_writes_a_picture_and_says_what_it_shows(capsys, tmp_path):
    png, error = tmp_path / "a.png", tmp_path / "e.png"
    words = ("sphere", "--model", "ggx", "--alpha", 0.3, "--light", "lamp", "--size", 6, "--workers", 1)
    code, out, err = run(capsys, *words, "--png", png, "--error-png", error)
    assert (code, err) == (0, "")
    assert "6 x 6 pixels" in out
    assert str(png) in out
    assert png.exists()
    assert error.exists()
    code, out, _ = run(capsys, *words, "--png", png, "--json")
    data = json.loads(out)
    assert data["files"] == [str(png)]
    assert data["maximum"] > 0


def test_the_command_judges_an_isothermal_furnace(capsys, tmp_path):
    words = ("sphere", "--light", "isothermal", "--size", 6, "--workers", 1, "--png", tmp_path / "f.png")
    code, out, _ = run(capsys, *words, "--model", "lambert", "--reflectance", 0.5, "--json")
    assert code == 0
    assert json.loads(out)["verdict"]["outcome"] == "holds"
    code, out, _ = run(capsys, *words, "--model", "cook_torrance", "--samples", 2048)
    assert code == 1
    assert "gains energy" in out


def test_all_models_on_one_sheet(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("radiokit.contracts.bsdf.list_bsdfs", lambda: ["cook_torrance", "lambert"])
    words = ("sphere", "--model", "all", "--light", "isothermal", "--size", 4, "--workers", 1)
    code, out, _ = run(capsys, *words, "--samples", 512, "--png", tmp_path / "s.png")
    assert code == 0  # it claims not to conserve energy
    assert "lambert: holds" in out
    assert "cook_torrance: violated" in out
    assert (tmp_path / "s.png").exists()


def test_a_function_in_a_file_is_rendered(capsys, tmp_path):
    file = tmp_path / "mine.py"
    file.write_text("def half(wi, wo):\n    return 0.5 / 3.141592653589793\n")
    words = (
        "sphere",
        "--model",
        f"{file}:half",
        "--light",
        "furnace",
        "--size",
        3,
        "--png",
        tmp_path / "x.png",
    )
    code, out, _ = run(capsys, *words)
    assert code == 0
    assert "as_bsdf(half)" in out
    code, _, err = run(capsys, *words, "--workers", 2)
    assert code == 2
    assert "to be rendered by other processes" in err


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ("unknown scene", ("cube",)),
        ("model = None", ("sphere", "--alpha", 0.3)),
        ("unknown model", ("sphere", "--model", "gxg")),
        ("isothermal", ("sphere", "--model", "all")),
        ("folder that exists", ("sphere", "--png", "nowhere/x.png")),
        ("ends in .exr", ("sphere", "--exr", "x.png")),
        ("unexpected argument", ("sphere", "--model", "ggx", "alpha")),
        ("the only file", ("sphere", "--model", "all", "--light", "isothermal", "--exr", "x.exr")),
    ],
    ids=str,
)
def test_mistakes_on_the_command_line(capsys, message, words):
    code, out, err = run(capsys, *words, "--workers", 1)
    assert code == 2
    assert message in err
    assert out == ""
    assert err.count("\n") == 1
