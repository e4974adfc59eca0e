"""Command: ``radiokit render``, a small picture with the error of each pixel."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, write
from radiokit.facts.errors import ParameterError
from radiokit.facts.report import EXIT_CODES
from radiokit.facts.verdict import Outcome

__all__ = ["render"]


def render(
    context: typer.Context,
    scene: Annotated[str, typer.Argument(help="sphere, plane or box.")],
    model: Annotated[
        str | None, typer.Option(help="A model's name, file.py:function, or all (of the isothermal furnace).")
    ] = None,
    light: Annotated[
        str | None, typer.Option(help="furnace, isothermal, lamp or sky; panel in the box.")
    ] = None,
    size: Annotated[int, typer.Option(help="Width and height in pixels.")] = 64,
    method: Annotated[str, typer.Option(help="How pixels are shaded, as radiokit.shade has it.")] = "auto",
    bounces: Annotated[str, typer.Option(help="In the box: one, or all by a random walk.")] = "one",
    rtol: Annotated[float | None, typer.Option(help="Relative error asked for in each pixel.")] = None,
    samples: Annotated[int | None, typer.Option(help="Samples in each pixel.")] = None,
    seed: Annotated[int, typer.Option(help="Seed of the Monte Carlo methods.")] = 0,
    workers: Annotated[int | None, typer.Option(help="Local processes; all processors by default.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a Dask scheduler to use.")] = None,
    png: Annotated[Path | None, typer.Option(help="File to write; render.png if no other is named.")] = None,
    exr: Annotated[
        Path | None, typer.Option(help="OpenEXR file, with the errors (needs the images extra).")
    ] = None,
    error_png: Annotated[
        Path | None, typer.Option(help="The errors as a picture; white is the worst.")
    ] = None,
    error_exr: Annotated[Path | None, typer.Option(help="The errors as an OpenEXR file.")] = None,
    white: Annotated[float, typer.Option(help="Radiance shown as white.")] = 1.0,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Render a small picture, each pixel with its error; a model's parameters go as --NAME VALUE."""
    from radiokit.faces.render.picture import check_file
    from radiokit.faces.render.render import render as picture_of
    from radiokit.faces.targets import load_target, parse_parameters
    from radiokit.faces.workers import available_workers, open_executor

    parameters = parse_parameters(context.args)
    if model is None and parameters:
        raise ParameterError("model", model, f"given, since {', '.join(parameters)} is a parameter of one")
    files = {"png": png, "exr": exr, "error-png": error_png, "error-exr": error_exr}
    if not any(files.values()):
        files["png"] = Path("render.png")
    for option, file in files.items():
        if file is not None:
            check_file(file, f".{option[-3:]}")
    count = workers
    if model is not None and ":" in model:  # other processes do not know a function in a file
        if scheduler is not None or workers not in (None, 1):
            raise ParameterError("model", model, "a model's name, to be rendered by other processes")
    elif workers is None and scheduler is None:
        count = available_workers()
    how: dict[str, Any] = {"size": size, "method": method, "rtol": rtol, "samples": samples, "rng": seed}
    if model == "all":
        if scene != "sphere" or light != "isothermal" or parameters:
            raise ParameterError("model", "all", "one model, unless it is a sphere with --light isothermal")
        if list(filter(None, files.values())) != [files["png"]]:
            raise ParameterError("png", png, "the only file, if all models are to be drawn on it")
    f = None if model in (None, "all") else load_target(model, parameters)
    with open_executor(count, scheduler) as executor, progress_bar("rendering", not json) as progress:
        how |= {"executor": executor, "progress": progress}
        if model == "all":
            code = _sheet(files["png"], how, json)
        else:
            picture = picture_of(scene, f, light=light, bounces=bounces, **how)  # type: ignore[arg-type]
            code = _show(picture, files, white, json)
    if code:
        raise typer.Exit(code)


def _show(picture: Any, files: dict[str, Path | None], white: float, json: bool) -> int:
    """Write the files and what there is to say of them; return the exit code."""
    from radiokit.faces.render.furnace import FurnaceImage

    saved = []
    for option, file in files.items():
        if file is not None:
            errors = option.startswith("error")
            saved.append(str(picture.save_error(file) if errors else picture.save(file, white=white)))
    verdict = picture.verdict() if isinstance(picture, FurnaceImage) else None
    if json:
        show_json(picture.to_json() | {"files": saved})
    else:
        _describe(picture, verdict, saved)
    if verdict is not None:
        return EXIT_CODES[verdict.outcome]
    return 0 if picture.converged.all() else EXIT_CODES[Outcome.INCONCLUSIVE]


def _describe(picture: Any, verdict: Any, saved: list[str]) -> None:
    data = picture.to_json()
    kind = "standard error" if data["statistical_pixels"] else "bound"
    write(f"{data['scene']} under {data['light']}: {', '.join(data['materials'])}")
    write(
        f"  {data['width']} x {data['height']} pixels, {data['surface_pixels']} of a surface; radiance from "
        f"{data['minimum']:.6g} to {data['maximum']:.6g}, {data['mean']:.6g} on average"
    )
    write(
        f"  worst error {data['worst_error']:.1e} ({kind}), {data['unconverged_pixels']} pixels not converged"
    )
    write(f"  {data['evaluations']} evaluations, {data['seconds']:.1f} s")
    if verdict is not None:
        write(f"  {verdict}")
    for name in saved:
        write(name)


def _sheet(png: Path | None, how: dict[str, Any], json: bool) -> int:
    """Draw all models in the isothermal furnace; what a model claims to break is no fault."""
    from radiokit.contracts.bsdf import bsdf, list_bsdfs
    from radiokit.faces.render.furnace import furnace_image
    from radiokit.faces.render.pixels import followed
    from radiokit.faces.render.sheet import draw_sheet

    assert png is not None
    progress, names = how.pop("progress"), list_bsdfs()
    how["method"] = "mc-bsdf" if how["method"] == "auto" else how["method"]
    drawn = (furnace_image(bsdf(name), **how) for name in names)
    pictures = list(zip(names, followed(drawn, len(names), progress), strict=True))
    saved = draw_sheet(pictures, png)
    verdicts = {name: picture.verdict() for name, picture in pictures}
    if json:
        show_json(
            {"models": {name: each.to_json() for name, each in verdicts.items()}, "files": [str(saved)]}
        )
    else:
        for name, each in verdicts.items():
            write(f"{name}: {each.outcome}. {each.message}")
        write(str(saved))
    codes = [0]
    for name, each in verdicts.items():
        claims = bsdf(name).claims
        if claims is None or (claims.conserves and claims.reciprocity != "no"):
            codes.append(EXIT_CODES[each.outcome])
    return 1 if 1 in codes else max(codes)
