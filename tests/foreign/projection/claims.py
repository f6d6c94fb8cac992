"""Claims about a film image: its colours at the places where the film lands, against the definition."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import definition
from definition import Layer, Paint
from landing import Film, Landing, Pairs, across_angle, across_edges, changes_fast, codes_at, left_out
from solids import Solid

LEVELS = 2.0  # largest difference of 99 % of the points
POINTS_SHARE = 0.99
SEAM_LEVELS = 3.0
SEAM_APART_MM = 0.6
SEAM_PAIRS = 20
SEAM_CHANGE = 20.0  # pairs between which the expected colour changes more are left out
KEPT_SHARE = 0.6
KEPT_POINTS = 500
DECAL_POINTS = 100
DECAL_MARGIN_MM = 1.2


@dataclass(frozen=True)
class Claim:
    what: str
    measured: float
    limit: float
    at_least: bool = False  # otherwise, the limit is the largest value at which the claim holds

    @property
    def holds(self) -> bool:
        return bool(self.measured >= self.limit if self.at_least else self.measured <= self.limit)  # False for NaN


@dataclass(frozen=True)
class Print:
    """What was computed for an object: its film image, and where the film lands."""
    solid: Solid
    paint: Paint
    rotation: np.ndarray  # from frame O to frame F
    film: Film
    dpi: float
    landing: Landing
    image: np.ndarray


def of_print(result: Print) -> tuple[list[Claim], dict[str, int]]:
    """The claims, and the number of reached points that were left out for each reason."""
    rows, columns = result.film.size_px(result.dpi)
    size_off = max(abs(result.image.shape[0] - rows), abs(result.image.shape[1] - columns))
    expected = expected_codes(result, result.landing.sites)
    reasons = left_out(result.landing, result.film, result.dpi, result.rotation)
    reasons["decal ends"] = definition.unsure(result.paint, result.solid, result.rotation, result.landing.sites,
                                              DECAL_MARGIN_MM)
    decals = definition.decals_shown(result.paint, result.solid, result.rotation, result.landing.sites)
    reasons["changes fast"] = changes_fast(result.landing, expected, decals)
    kept = ~np.any(list(reasons.values()), axis=0)
    reached = result.landing.reached
    out = [Claim("size of the film image off, pixels", float(size_off), 0),
           Claim("points kept", float(kept.sum()), KEPT_POINTS, at_least=True),
           Claim("share of the reached points kept", float(kept.sum() / max(reached.sum(), 1)), KEPT_SHARE,
                 at_least=True),
           of_colours(result, "", kept, expected)]
    for number, shown in enumerate(decals.T):
        out.append(Claim(f"decal {number + 1}: points kept", float((kept & shown).sum()), DECAL_POINTS, at_least=True))
        out.append(of_colours(result, f"decal {number + 1}: ", kept & shown, expected))
    for layer in result.paint.layers:
        out += of_seams(result, layer, kept)
    return out, {reason: int((flags & reached).sum()) for reason, flags in reasons.items() if reason != "not reached"}


def expected_codes(result: Print, sites: definition.Sites) -> np.ndarray:
    return definition.colours(result.paint, result.solid, result.rotation, sites)


def of_colours(result: Print, where: str, kept: np.ndarray, expected: np.ndarray) -> Claim:
    seen = codes_at(result.image, result.dpi, result.landing.film[kept])
    off = np.abs(seen - expected[kept]).max(axis=1)
    what = f"{where}colour of {POINTS_SHARE:.0%} of the points off, levels of 255"
    return Claim(what, float(np.quantile(off, POINTS_SHARE)) if len(off) else float("nan"), LEVELS)


def of_seams(result: Print, layer: Layer, kept: np.ndarray) -> list[Claim]:
    """Box: where triangles of different axes meet. Cylinder: behind the axis, if the picture repeats."""
    frame = definition.frame_of(layer, result.solid, result.rotation)
    if layer.kind == "box":
        def differ(a: np.ndarray, b: np.ndarray) -> np.ndarray:
            return definition.axis_of(a, frame) != definition.axis_of(b, frame)
        return of_pairs(result, "box seam", across_edges(result.landing, kept, SEAM_APART_MM, differ))
    if layer.kind == "cylindrical" and layer.repeats:
        around_mm = definition.on_picture_mm(layer, frame, result.landing.points)[0][:, 0]
        angle = around_mm / definition.cylinder_radius_mm(frame)
        return of_pairs(result, "cylinder seam", across_angle(result.landing, kept, SEAM_APART_MM, angle))
    return []


def of_pairs(result: Print, name: str, pairs: Pairs) -> list[Claim]:
    seen, expected = [], []
    usable = np.ones(len(pairs.film[0]), bool)
    for sites, places in zip(pairs.sides, pairs.film):
        seen.append(codes_at(result.image, result.dpi, places))
        expected.append(expected_codes(result, sites))
        usable &= ~definition.unsure(result.paint, result.solid, result.rotation, sites, DECAL_MARGIN_MM)
    expected_step = np.abs(expected[0] - expected[1]).max(axis=1)
    usable &= expected_step <= SEAM_CHANGE
    more = (np.abs(seen[0] - seen[1]) - np.abs(expected[0] - expected[1])).max(axis=1)[usable]
    return [Claim(f"{name}: pairs of points", float(len(more)), SEAM_PAIRS, at_least=True),
            Claim(f"{name}: step more than expected, levels of 255", float(more.max()) if len(more) else float("nan"),
                  SEAM_LEVELS)]
