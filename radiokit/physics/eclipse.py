"""Eclipse: how a body and a light lie to each other, seen from one point: beside, within, before, behind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np
import numpy.typing as npt

from radiokit.measure.circlecone import Place
from radiokit.measure.clip import Cone, cut, has_area, sides, without
from radiokit.measure.exact import RationalVector, cross, inner, rational
from radiokit.physics.ball import Ball
from radiokit.physics.facets import Facets
from radiokit.physics.plate import Plate

__all__ = ["TIE", "Body", "Dome", "Relation", "before", "order", "place", "relation"]

FloatArray = npt.NDArray[np.float64]

TIE = Fraction(1, 2**40)
"""What is nearer than a light by less than this share of the distance is at the light, and hides nothing."""

Order = Literal["nearer", "farther", "mixed"]
Relation = Place | Literal["unsure"]


@dataclass(frozen=True, eq=False)
class Dome:
    """The directions of an environment: those in all half-spaces around ``normals``, all if there is none."""

    normals: tuple[RationalVector, ...] = ()


Body = Ball | Plate | Facets
"""What can hide light, or shine."""


def place(body: Body, light: Body | Dome) -> Place:
    """Return how the directions to a body lie to those to a light, whatever the distances, without rounding.

    >>> from radiokit.physics.ball import Ball
    >>> sun, moon = Ball.seen((0, 0, 400), 1.0, (0, 0, 0)), Ball.seen((0, 0, 1), 0.002, (0, 0, 0))
    >>> place(moon, sun), place(sun, moon)
    ('within', 'around')
    """
    if isinstance(body, Ball) and body.surrounds:
        return "around"
    if isinstance(light, Dome):
        return _in_dome(body, light)
    if isinstance(body, Facets) and isinstance(light, Facets):
        return _facets(body.parts, light)
    if isinstance(body, Facets):
        return _TURNED[_round_in_facets(light, body)]  # type: ignore[arg-type]
    if isinstance(light, Facets):
        return _round_in_facets(body, light)
    return body.cone.to_circle(light.cone)


_TURNED: dict[Place, Place] = {
    "within": "around",
    "around": "within",
    "apart": "apart",
    "across": "across",
}


def _in_dome(body: Body, light: Dome) -> Place:
    found: Place = "within"
    for normal in light.normals:
        if isinstance(body, Facets):
            heights = [inner(p, normal) for p in body.outline]
            side: Place = "within" if min(heights) >= 0 else "apart" if max(heights) <= 0 else "across"
        else:
            side = body.cone.to_half_space(normal)
        if side == "apart":
            return "apart"
        found = side if side == "across" else found
    return found


def _round_in_facets(body: Ball | Plate, light: Facets) -> Place:
    cone, outline = body.cone, light.outline
    if all(cone.holds(p) for p in outline):
        return "around"
    if any(cone.crossed_by(outline[k - 1], p) for k, p in enumerate(outline)):
        return "across"
    return "within" if light.holds(cone.center) else "apart"


def _facets(parts: Sequence[Cone], light: Facets) -> Place:
    lit, hidden = list(light.parts), False
    for part in parts:
        left = [rest for cone in lit for rest in without(cone, sides(part))]
        hidden = hidden or left != lit
        lit = left
    if not hidden:
        return "apart"
    if not lit:
        return "around"
    rest = list(parts)
    for cone in light.parts:
        rest = [outside for part in rest for outside in without(part, sides(cone))]
    return "across" if rest else "within"


def before(body: Facets, light: Facets | Dome) -> list[Cone]:
    """Return the parts of a polygon that are nearer than a light's plane.

    Whether a ray meets q·x below (1 − ``TIE``) k does not depend on its length.
    """
    if isinstance(light, Dome):
        return list(body.parts)
    q, k = light.plane
    limit = k * (1 - TIE)
    parts = (cut(part, [limit - inner(q, p) for p in part]) for part in body.parts)
    return [part for part in parts if len(part) > 2 and has_area(part)]


def order(body: Body, light: Body | Dome) -> Order:
    """Return whether a body is nearer than a light, or farther, wherever a ray meets both.

    Of two sets that a plane parts, the one on the point's side is met first. ``mixed`` means that no plane
    was found.

    >>> import numpy as np
    >>> wall = Facets.seen(np.array([[-1.0, -1, 2], [-1, 1, 2], [1, 1, 2], [1, -1, 2]]), (0, 0, 0))
    >>> lamp = Ball.seen((0, 0, 4), 2.0, (0, 0, 0))
    >>> order(wall, lamp), order(lamp, wall)
    ('nearer', 'farther')
    """
    if isinstance(light, Dome):
        return "nearer"
    if isinstance(body, Ball) and body.surrounds:
        if _holds(body, light):
            return "farther"
        return "nearer" if _clear_of(body, light) else "mixed"
    if isinstance(body, Ball) and isinstance(light, Ball) and _bounds(body) == _bounds(light):
        return "farther"
    if not isinstance(light, Ball):
        q, k = _plane(light)
        low, high = _sides(body, q, k * (1 - TIE))
        if low or high:
            return "farther" if low else "nearer"
    if not isinstance(body, Ball):
        q, k = _plane(body)
        if _sides(light, q, k / (1 - TIE))[1]:
            return "farther"
        if _sides(light, q, k)[0]:
            return "nearer"
    if isinstance(body, Ball) and _holds(body, light):
        return "nearer"
    if isinstance(light, Ball) and _holds(light, body):
        return "farther"
    found = _by_bounds(body, light)
    return _by_nearest(body, light) if found == "mixed" else found


def _by_bounds(body: Body, light: Body) -> Order:
    """Decide by a plane between the spheres around two bodies."""
    (a, first), (b, second) = _bounds(body), _bounds(light)
    way = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    square = inner(way, way)
    if square < (first + second) ** 2 or not square:
        return "mixed"
    share = first / (first + second)
    between = inner(way, a) + share * square  # of the plane's points; the origin's is 0
    return "nearer" if between >= 0 else "farther"


def _by_nearest(body: Body, light: Body) -> Order:
    """Decide between a ball and a flat body by the plane across the shortest way from one to the other."""
    ball, flat = (body, light) if isinstance(body, Ball) else (light, body)
    if not isinstance(ball, Ball) or isinstance(flat, Ball):
        return "mixed"
    center = np.array([float(x) for x in ball.towards])
    nearest = _nearest(flat, center)
    way = center - nearest
    size = float(np.sqrt(way @ way))
    gap = size - float(ball.radius)
    if not gap > 0:
        return "mixed"
    q = rational(way / size)
    k = inner(q, rational(nearest + 0.5 * gap * way / size))
    if not (_sides(ball, q, k)[0] and _sides(flat, q, k)[1]):
        return "mixed"
    return "nearer" if (flat is body) == (k >= 0) else "farther"


def _nearest(flat: Plate | Facets, point: FloatArray) -> FloatArray:
    """Return the point of a flat body's edge that is nearest to another point, but for rounding."""
    if isinstance(flat, Plate):
        center, normal = (np.array([float(x) for x in v]) for v in (flat.center, flat.normal))
        aside = point - center
        aside = aside - (aside @ normal) / (normal @ normal) * normal
        length = float(np.sqrt(aside @ aside))
        return center + (float(flat.size) / length if length > 0 else 0.0) * aside
    start = np.array([[float(x) for x in p] for p in flat.outline])
    side = np.roll(start, -1, axis=0) - start
    share = np.clip(np.sum((point - start) * side, axis=1) / np.sum(side * side, axis=1), 0.0, 1.0)
    places = start + share[:, None] * side
    nearest: FloatArray = places[np.argmin(np.sum((places - point) ** 2, axis=1))]
    return nearest


def _bounds(body: Body) -> tuple[RationalVector, Fraction]:
    """Return the centre and radius of a sphere around a body."""
    if isinstance(body, Ball):
        return body.towards, body.radius
    if isinstance(body, Plate):
        return body.center, body.size
    n = len(body.outline)
    x, y, z = (sum((p[k] for p in body.outline), Fraction(0)) / n for k in range(3))
    farthest = max(_between((x, y, z), p) for p in body.outline)
    return (x, y, z), Fraction(float(farthest) ** 0.5) * (1 + TIE)


def _plane(body: Plate | Facets) -> tuple[RationalVector, Fraction]:
    """Return q and k > 0 of the plane q·x = k in which a flat body lies."""
    if isinstance(body, Facets):
        return body.plane
    x, y, z = body.normal
    return (-x, -y, -z), -inner(body.normal, body.center)


def _sides(body: Body, q: RationalVector, k: Fraction) -> tuple[bool, bool]:
    """Return whether all of a body has q·x ≥ k, and whether all has q·x ≤ k."""
    if isinstance(body, Facets):
        heights = [inner(q, p) for p in body.outline]
        return min(heights) >= k, max(heights) <= k
    if isinstance(body, Ball):
        above, reach = inner(q, body.towards) - k, body.radius**2 * inner(q, q)
    else:
        aside = cross(q, body.normal)
        above = inner(q, body.center) - k
        reach = body.size**2 * inner(aside, aside) / inner(body.normal, body.normal)
    clear = above * above >= reach
    return clear and above >= 0, clear and above <= 0


def _between(a: RationalVector, b: RationalVector) -> Fraction:
    """Return the square of the distance between two points."""
    way = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    return inner(way, way)


def _holds(ball: Ball, body: Body) -> bool:
    """Return whether all of a body is in a ball; for a disk, whether that is sure."""
    if isinstance(body, Facets):
        return all(_between(ball.towards, p) <= ball.radius**2 for p in body.outline)
    center, radius = _bounds(body)
    return radius <= ball.radius and _between(ball.towards, center) <= (ball.radius - radius) ** 2


def _clear_of(ball: Ball, body: Body) -> bool:
    """Return whether a body is surely outside a ball."""
    center, radius = _bounds(body)
    if _between(ball.towards, center) >= (ball.radius + radius) ** 2:
        return True
    if isinstance(body, Ball):
        return False
    q, k = _plane(body)
    return any(_sides(ball, q, k))


def relation(body: Body, light: Body | Dome) -> Relation:
    """Return how a body lies before a light: ``apart`` if it hides nothing, ``unsure`` if that is not known.

    A polygon that pierces a flat light's plane counts by its nearer part.

    >>> from radiokit.physics.ball import Ball
    >>> sun, star = Ball.seen((0, 0, 400), 1.0, (0, 0, 0)), Ball.seen((0, 0, 900), 0.5, (0, 0, 0))
    >>> place(star, sun), relation(star, sun), relation(sun, star)
    ('within', 'apart', 'around')
    """
    if isinstance(body, Facets) and isinstance(light, Facets):
        return _facets(before(body, light), light)
    found = place(body, light)
    if found == "apart":
        return found
    met = order(body, light)
    return "apart" if met == "farther" else "unsure" if met == "mixed" else found
