"""Command: ``radiokit render``, a small picture with the error of each pixel."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, write
from radiokit.facts.errors import ParameterError

__all__ = ["render"]

INCONCLUSIVE = 3


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
    from radiokit.faces.render.render import render as picture_of
    from radiokit.faces.targets import load_target, parse_parameters
    from radiokit.faces.workers import available_workers, open_executor

    parameters = parse_parameters(context.args)
    if model is None and parameters:
        raise ParameterError("model", model, f"given, since {', '.join(parameters)} is a parameter of one")
    files = [path for path in (png, exr, error_png, error_exr) if path is not None]
    if not files:
        png = Path("render.png")
    count = workers
    if model is not None and ":" in model:  # other processes do not know a function in a file
        if scheduler is not None or workers not in (None, 1):
            raise ParameterError("model", model, "a model's name, to be rendered by other processes")
    elif workers is None and scheduler is None:
        count = available_workers()
    how: dict[str, Any] = {
        "light": light,
        "size": size,
        "method": method,
        "bounces": bounces,
        "rtol": rtol,
        "samples": samples,
        "rng": seed,
    }
    with open_executor(count, scheduler) as executor, progress_bar("rendering", not json) as progress:
        if model == "all":
            code = _sheet(scene, light, parameters, how, executor, progress, png, json)
        else:
            f = None if model is None else load_target(model, parameters)
            picture = picture_of(scene, f, executor=executor, progress=progress, **how)
    if model == "all":
        _leave(code)
        return
    saved = [str(picture.save(png, white=white))] if png is not None else []
    saved += [str(picture.save(exr))] if exr is not None else []
    saved += [str(picture.save_error(path)) for path in (error_png, error_exr) if path is not None]
    verdict = picture.verdict() if hasattr(picture, "verdict") else None
    if json:
        show_json(picture.to_json() | {"files": saved})
    else:
        _describe(picture, verdict, saved)
    unconverged = not picture.converged.all()
    if verdict is not None:
        _leave({"holds": 0, "violated": 1, "inconclusive": INCONCLUSIVE}[str(verdict.outcome)])
    _leave(INCONCLUSIVE if unconverged else 0)


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


def _sheet(
    scene: str,
    light: str | None,
    parameters: dict[str, Any],
    how: dict[str, Any],
    executor: Any,
    progress: Any,
    png: Path | None,
    json: bool,
) -> int:
    """Draw all models in the isothermal furnace; the code is 1 only for what no claim explains."""
    from radiokit.contracts.bsdf import bsdf, list_bsdfs
    from radiokit.faces.render.furnace import furnace_image
    from radiokit.faces.render.pixels import followed
    from radiokit.faces.render.sheet import draw_sheet

    if scene != "sphere" or light != "isothermal":
        raise ParameterError("model", "all", "one model, unless it is a sphere with --light isothermal")
    if parameters:
        raise ParameterError("model", "all", "one model, if it is given parameters")
    if png is None:
        raise ParameterError("png", None, "given: all models are drawn on one PNG")
    own = "mc-bsdf" if how["method"] == "auto" else how["method"]
    options = {name: how[name] for name in ("size", "samples", "rtol", "rng")}
    names = list_bsdfs()
    drawn = (furnace_image(bsdf(name), method=own, executor=executor, **options) for name in names)
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
    for name, each in verdicts.items():
        claims = bsdf(name).claims
        excused = claims is not None and (not claims.conserves or claims.reciprocity == "no")
        if not each.ok and not excused:
            return 1 if str(each.outcome) == "violated" else INCONCLUSIVE
    return 0


def _leave(code: int) -> None:
    if code:
        raise typer.Exit(code)
