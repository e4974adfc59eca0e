"""The command line: ``radiokit validate``, ``check``, ``albedo``, ``cases``, and what other files add."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.bench.command import bench
from radiokit.faces.console import fail, progress_bar, show_json, show_report, show_table, write
from radiokit.faces.derive import derive
from radiokit.faces.grading.classroom.command import grade_class
from radiokit.faces.grading.command import grade
from radiokit.faces.grading.handout.command import assignment
from radiokit.faces.lecture import lecture
from radiokit.faces.models import models
from radiokit.faces.render.command import render
from radiokit.faces.stability.command import stability
from radiokit.faces.validation import case_cells, validate
from radiokit.facts.errors import RadiokitError

__all__ = ["app", "main"]

USAGE = 2
INCONCLUSIVE = 3

app = typer.Typer(
    help="Radiometry for teaching, and an analytic validator of BSDFs and renderers.",
    epilog="Exit codes: 0 all holds, 1 a violation, 2 bad usage or input, 3 inconclusive.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

_OPEN = {"allow_extra_args": True, "ignore_unknown_options": True}

Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Target = Annotated[str, typer.Argument(help="A model's name, or file.py:function.", metavar="TARGET")]
Theta = Annotated[float, typer.Option(help="Polar angle of wo, in degrees.")]
Phi = Annotated[float, typer.Option(help="Azimuth of wo, in degrees.")]


def _exit(code: int) -> None:
    if code:
        raise typer.Exit(code)


def _load(target: str, context: typer.Context) -> Any:
    from radiokit.faces.targets import load_target, parse_parameters

    return load_target(target, parse_parameters(context.args))


def _direction(theta: float, phi: float, *, below: bool = False) -> Any:
    import numpy as np

    from radiokit.facts.directions import spherical_to_cartesian
    from radiokit.facts.errors import ParameterError

    if not (0 <= theta < 90 or (below and 90 < theta <= 180)):
        allowed = "in [0, 90) or (90, 180] degrees" if below else "in [0, 90) degrees"
        raise ParameterError("theta", theta, allowed)
    return spherical_to_cartesian(np.deg2rad(theta), np.deg2rad(phi))


app.command()(validate)


@app.command(context_settings=_OPEN)
def check(
    context: typer.Context,
    target: Target,
    json: Json = False,
    law: Annotated[list[str] | None, typer.Option(help="Only this law; may be repeated.")] = None,
    tolerance: Annotated[float, typer.Option(help="How far beyond a limit a value may lie.")] = 1e-9,
    seconds: Annotated[float, typer.Option(help="Time aimed at for a slow function.")] = 60.0,
    evaluations: Annotated[
        int | None, typer.Option(help="Evaluations aimed at, in place of a time: the same on any machine.")
    ] = None,
    isolated: Annotated[bool, typer.Option("--isolated", help="Run file.py:function in a sandbox.")] = False,
) -> None:
    """Check a BSDF for reciprocity, energy conservation and more; its parameters go as --NAME VALUE."""
    from radiokit.checks.judge import LAWS
    from radiokit.checks.judge import check as judge

    with ExitStack() as stack:
        if isolated:
            from radiokit.faces.grading.isolation.limits import Limits
            from radiokit.faces.grading.isolation.remote import open_isolated
            from radiokit.faces.targets import parse_parameters

            given = parse_parameters(context.args)
            model = stack.enter_context(open_isolated(target, given, Limits(seconds=seconds)))
        else:
            model = _load(target, context)
        progress = stack.enter_context(progress_bar("checking", not json))
        report = judge(
            model,
            laws=law or LAWS,
            tolerance=tolerance,
            seconds=seconds,
            evaluations=evaluations,
            progress=progress,
        )
    if json:
        show_json(report.to_json())
    else:
        show_report(report)
    _exit(report.exit_code)


@app.command(context_settings=_OPEN)
def albedo(
    context: typer.Context,
    target: Target,
    theta: Theta = 0.0,
    phi: Phi = 0.0,
    method: Annotated[str, typer.Option(help="quadrature, mc or qmc.")] = "quadrature",
    rtol: Annotated[
        float | None, typer.Option(help="Relative error asked for; 1e-6 of the quadrature.")
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="Time limit for Monte Carlo.")] = None,
    samples: Annotated[
        int | None, typer.Option(help="Samples for Monte Carlo, at most with --rtol or --seconds.")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed for Monte Carlo.")] = None,
    json: Json = False,
) -> None:
    """Print the directional albedo of a BSDF, with its error and its cost."""
    from radiokit.contracts.albedo import albedo as integrate

    f = _load(target, context)
    wo = _direction(theta, phi, below=f.transmissive)
    aim = 1e-6 if rtol is None and method == "quadrature" else rtol
    found = integrate(
        f,
        wo,
        method=method,  # type: ignore[arg-type]
        rtol=aim,
        seconds=seconds,
        samples=samples,
        rng=seed,
    )
    if json:
        show_json({"target": target, "theta_deg": theta, "phi_deg": phi, **found.to_json()})
    else:
        write(f"albedo of {f!r} at θ = {theta:g}°: {found}")
        write(f"  {found.method}, {found.evaluations} evaluations, {1e3 * found.seconds:.1f} ms")
        if found.note:
            write(f"  {found.note}")
    _exit(0 if found.converged else INCONCLUSIVE)


@app.command()
def cases(
    name: Annotated[str | None, typer.Argument(help="One case; without it, all are listed.")] = None,
    run: Annotated[bool, typer.Option("--run", help="Answer by every method that applies.")] = False,
    seed: Annotated[int, typer.Option(help="Seed of the Monte Carlo methods.")] = 0,
    json: Json = False,
) -> None:
    """List the closed-form cases, or show one: its setup, its exact value, and where it comes from."""
    from radiokit.faces.validate import CaseRow
    from radiokit.worlds.cases.catalogue import case, list_cases

    chosen = [case(name)] if name else [case(each) for each in list_cases()]
    rows = [
        CaseRow(each.name, method, each.exact, each.verdict(method, seed, level=1e-6))
        for each in chosen
        for method in (each.methods if run else ())
    ]
    if json:
        answers = [row.to_json() for row in rows]
        show_json({"cases": [each.to_json() for each in chosen], "answers": answers})
    elif name:
        _show_case(chosen[0])
    else:
        table = [(each.name, each.title, f"{each.exact:.12g}", ", ".join(each.methods)) for each in chosen]
        show_table("closed-form cases", ("case", "title", "exact", "methods"), table)
    if rows and not json:
        columns = (
            "case",
            "method",
            "value",
            "exact",
            "true error",
            "claimed",
            "evaluations",
            "ms",
            "outcome",
        )
        show_table("answers", columns, [case_cells(row) for row in rows])
    outcomes = {str(row.verdict.outcome) for row in rows}
    _exit(1 if "violated" in outcomes else INCONCLUSIVE if "inconclusive" in outcomes else 0)


def _show_case(each: Any) -> None:
    write(f"{each.name}: {each.title}")
    write(f"  setup: {each.setup}")
    write(f"  exact: {each.exact!r} {each.unit}")
    write(f"  derivation: {each.derivation}")
    write(f"  source: {each.source.cite()}")
    write(f"  methods: {', '.join(each.methods)}")


app.command()(assignment)
app.command()(bench)
app.command()(derive)
app.command()(grade)
app.command("grade-class")(grade_class)
app.command()(lecture)
app.command()(models)
app.command(context_settings=_OPEN)(render)
app.command()(stability)


@app.command(context_settings=_OPEN)
def lobe(
    context: typer.Context,
    target: Target,
    png: Annotated[Path, typer.Option(help="File to write.")] = Path("lobe.png"),
    theta: Theta = 45.0,
    phi: Phi = 0.0,
    scale: Annotated[str, typer.Option(help="linear or log.")] = "linear",
    json: Json = False,
) -> None:
    """Draw the lobe of a BSDF in three dimensions (needs the viz extra)."""
    import numpy as np

    from radiokit.faces.plots.lobe import save_lobe

    f = _load(target, context)
    _direction(theta, phi)
    saved = save_lobe(f, theta=np.deg2rad(theta), phi=np.deg2rad(phi), png=png, scale=scale)  # type: ignore[arg-type]
    if json:
        show_json({"target": target, "theta_deg": theta, "phi_deg": phi, "png": str(saved)})
    else:
        write(str(saved))


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; a user's mistake gives one line on standard error and exit code 2."""
    words = sys.argv[1:] if arguments is None else arguments
    try:
        code = app(words, prog_name="radiokit", standalone_mode=False)
    except typer.TyperException as error:
        fail(error.format_message() if hasattr(error, "format_message") else str(error))
        code = USAGE
    except RadiokitError as error:
        if "--json" in words:
            show_json(error.to_json())
        fail(str(error))
        code = USAGE
    except (typer.Abort, KeyboardInterrupt):
        code = 130
    except BrokenPipeError:  # the reader of our output has gone
        sys.stderr.close()
        code = 0
    sys.exit(code if isinstance(code, int) else 0)


if __name__ == "__main__":
    main()
