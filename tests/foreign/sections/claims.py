"""Claims about runs of the worker: functions of what was measured, without files or programs."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from areas import Sections
from solids import Shape

import closed_form

MIB = 2 ** 20
AREA_SHARE = 0.01
AREA_FLOOR = 0.005  # of the largest section: errors of smaller sections are shares of this
LEVEL_MM = 0.005  # level faces within this distance of a section may count or not
LEVEL_SHARE = 1e-4  # the same as a share of the height, for tiny bodies
STEP_SHARE = 0.1  # largest distance between sections, as a share of the depth
MAP_RMS_MM = 0.01
MAP_RMS_SMALL_MM = 0.045  # of the coarse sphere; given once, it is at 0.038
MAP_UP_TO_DEG = 110.0
COVERAGE = 0.995  # of a body that film reaches fully
COVERAGE_OFF = 0.01
FULL = 0.999
ONE_COLOUR = 0.02  # colours that differ less are the same; 1 is white
NOWHERE = float("nan")  # no claim holds with it


@dataclass(frozen=True)
class Claim:
    what: str
    measured: float
    limit: float
    at_least: bool = False  # otherwise, the limit is the largest value at which the claim holds
    note: str = ""

    @property
    def holds(self) -> bool:
        return bool(self.measured >= self.limit if self.at_least else self.measured <= self.limit)  # False for NaN

    def __str__(self) -> str:
        measured = "missing" if np.isnan(self.measured) else f"{self.measured:.6g}"
        limit = f"(at {'least' if self.at_least else 'most'} {self.limit:g})"
        return f"{self.what}: {measured} {limit}" + (f"; {self.note}" if self.note else "")


def not_so(what: str, wrong: bool, note: str = "") -> Claim:
    """A claim that something is not the case."""
    return Claim(what, float(wrong), 0, note=note)


@dataclass(frozen=True)
class Limits:
    seconds: float  # of processor time
    memory_bytes: float


SOLID = Limits(60, 1.5 * 1024 * MIB)
LATTICE = Limits(120, 2 * 1024 * MIB)


@dataclass(frozen=True)
class Outcome:
    """How a run of the worker ended."""
    status: int  # negative: the number of the signal
    killed: bool  # by the judge, because it had no end
    seconds: float  # of processor time, of the user and the system
    memory_bytes: float
    stages: tuple[str, ...]  # as reported by --progress-fd
    errors: tuple[str, ...]  # lines on stderr that are not warnings

    @property
    def finished(self) -> bool:
        return self.status == 0

    @property
    def refused(self) -> bool:
        return self.status == 3 and not self.killed


def of_end(outcome: Outcome, limits: Limits) -> list[Claim]:
    """Ends by itself within the limits: finished, or refused with a reason before the first solve."""
    what = "no end: stopped by the judge" if outcome.killed else f"exit status {outcome.status}"
    return [
        not_so("neither finished nor refused", not outcome.finished and not outcome.refused, what),
        Claim("processor time, s", outcome.seconds, limits.seconds),
        Claim("memory, MiB", outcome.memory_bytes / MIB, limits.memory_bytes / MIB),
    ] + (of_refusal(outcome) if outcome.refused else [])


def of_refusal(outcome: Outcome) -> list[Claim]:
    reason = outcome.errors[0] if outcome.errors else "no reason"
    return [
        not_so("refusal after the first solve", "velocity" in outcome.stages, f"refused: {reason}"),
        Claim("lines of the refusal more or less than one", float(abs(len(outcome.errors) - 1)), 0),
    ]


def of_sections(report: dict, sections: Sections) -> list[Claim]:
    """`flow.sections` of the report against the union of the shells. `report`: its `flow`."""
    rows = report.get("sections")
    if not rows:
        return [Claim("sections", NOWHERE, 1, at_least=True)]
    depths = np.array([row["depth_mm"] for row in rows], float)
    areas = np.array([row["area_mm2"] for row in rows], float)
    end_mm = float(report["depth_mm"])
    steps = np.diff(np.concatenate([[0.0], np.sort(depths), [end_mm]]))
    off = areas_off(depths, areas, sections)
    worst = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
    note = f"at {depths[worst]:.4g} mm: {areas[worst]:.6g} mm2, expected {sections.area_mm2(depths[worst]):.6g} mm2"
    return [
        Claim("largest step between sections, share of the depth", float(steps.max() / end_mm), STEP_SHARE),
        Claim("sections outside the dip, mm", float(max(-depths.min(), depths.max() - end_mm)), 1e-3 * end_mm),
        Claim("areas of sections off, share", float(off[worst]), AREA_SHARE, note=f"{len(rows)} sections; {note}"),
    ]


def areas_off(depths_mm: np.ndarray, areas_mm2: np.ndarray, sections: Sections) -> np.ndarray:
    """Differences from the union, as shares; 0 between the values on both sides of a level face."""
    expected = np.array([sections.area_mm2(depth) for depth in depths_mm])
    floor = AREA_FLOOR * max(float(expected.max()), 1e-12)
    off = np.abs(areas_mm2 - expected) / np.maximum(expected, floor)
    around = min(LEVEL_MM, LEVEL_SHARE * (sections.top - sections.bottom))
    for i in np.flatnonzero(~(off <= AREA_SHARE)):
        low, high = sections.range_mm2(depths_mm[i], around)
        beyond = max(low - areas_mm2[i], areas_mm2[i] - high, 0.0) if np.isfinite(areas_mm2[i]) else np.inf
        off[i] = min(off[i], beyond / max(expected[i], floor)) if np.isfinite(off[i]) else np.inf
    return off


def of_exact_map(points: np.ndarray, film: np.ndarray, sphere: closed_form.Sphere, most_rms_mm: float) -> list[Claim]:
    """The map of a sphere around the origin that sinks through the middle of a round film."""
    radius = sphere.radius_mm
    theta = np.arccos(np.clip(-points[:, 2] / np.linalg.norm(points, axis=1), -1, 1))
    judged = theta < np.radians(MAP_UP_TO_DEG)
    points, film, theta = points[judged], film[judged], theta[judged]
    reached = np.isfinite(film).all(axis=1)
    off = distance_mm(points[reached], film[reached], theta[reached], sphere)
    rms = float(np.sqrt((off ** 2).mean())) if len(off) else NOWHERE
    _, place = np.unique(np.round(points / radius, 5), axis=0, return_inverse=True)
    missed = np.bincount(place.reshape(-1), reached) == 0
    return [
        Claim("places of the map without film", float(missed.sum()) if len(points) else NOWHERE, 0),
        Claim("distance from the exact map, mm rms", rms, most_rms_mm,
              note=f"{len(off)} points, largest {off.max(initial=0):.3g} mm"),
    ]


def distance_mm(points: np.ndarray, film: np.ndarray, theta: np.ndarray, sphere: closed_form.Sphere) -> np.ndarray:
    """Distance on the sphere between points and the places where their film should have landed."""
    lands = sphere.theta_rad(np.linalg.norm(film, axis=1))
    turn = np.arctan2(film[:, 1], film[:, 0]) - np.arctan2(points[:, 1], points[:, 0])
    turn = (turn + np.pi) % (2 * np.pi) - np.pi
    around = np.where(theta < 1e-6, 0, turn * np.sin(theta))
    return sphere.radius_mm * np.hypot(lands - theta, around)


def of_coverage(report: dict, surface: Shape, film: np.ndarray, outer: np.ndarray, least: float) -> list[Claim]:
    """Coverage counts the outer surface: `outer` says which points of the map are on it. Points count by area."""
    points, triangles = surface
    a, b, c = (points[triangles[:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) * outer[triangles].all(axis=1)
    reached = np.isfinite(film).all(axis=1)[triangles].mean(axis=1)
    share = float((areas * reached).sum() / max(areas.sum(), 1e-12))
    coverage = float(report.get("coverage", NOWHERE))
    return [Claim("share of the outer surface with film in the map", share, least, at_least=True),
            Claim("coverage in the report", coverage, least, at_least=True),
            Claim("coverage in the report off that share", abs(coverage - share), COVERAGE_OFF)]


def of_hollow(report: dict, image: np.ndarray) -> list[Claim]:
    """A body that encloses nothing moves no film, so it must not be reported as covered."""
    coverage = float(report.get("coverage", 1))
    return [not_so("full coverage with a film of one colour, by a body that encloses nothing",
                   coverage >= FULL and is_of_one_colour(image), f"coverage {coverage:.4g}")]


def is_of_one_colour(image: np.ndarray) -> bool:
    """Whether all pixels are mixtures of white and one colour, in linear light (sRGB, IEC 61966-2-1)."""
    code = np.unique(image.reshape(-1, image.shape[2])[:, :3], axis=0) / 255
    ink = 1 - np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    most = ink[np.argmax(ink.sum(axis=1))]
    if not most.any():
        return True
    share = ink @ most / (most @ most)
    return bool(np.abs(ink - share[:, None] * most).max() <= ONE_COLOUR)


def of_flat_plate(outcome: Outcome) -> list[Claim]:
    names_remedy = any("thick" in line.lower() for line in outcome.errors)
    return [not_so("not refused", not outcome.refused, f"exit status {outcome.status}"),
            not_so("refusal does not name thickness as the remedy", not names_remedy)]
