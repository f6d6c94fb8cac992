"""Claims about one dip of a sphere's plan, computed again for a pose turned about the sphere's centre.

A centred sphere has the same film map at every turn. So the film at (r0(theta), phi) lands at the angle theta from the
lowest point of the turned sphere, and the direction of the dip's pole gives the latitude of that place on the object.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import closed_form
from claims import Claim, Limits, film_grid_mm, of_sphere_film, worst

MOST_THETA_RAD = np.radians(110)
MOST_TURN_DEG = 20.0  # the equator stays at contact angles of at most 110 degrees, so all of it can be judged
RAYS = 720
STEP_MM = 0.05


@dataclass(frozen=True)
class Images:
    """What `simulate --plan` writes, rows x columns x channels."""
    film: np.ndarray
    complete: np.ndarray
    mask: np.ndarray


def of_turned_dip(images: Images, dpi: float, sphere: closed_form.Sphere, pole: np.ndarray, width_mm: float,
                  limits: Limits, seam_mm: float) -> list[Claim]:
    """pole: direction of the middle of the dip's own hemisphere, in the film's frame."""
    off_mm = seam_off_mm(images.mask, dpi, sphere, pole)
    return [
        Claim("share of the azimuths without a seam", float(np.isnan(off_mm).mean()), 0),
        Claim("seam off the object's equator, mm", worst(np.abs(off_mm[np.isfinite(off_mm)])), seam_mm),
        *of_sphere_film(images.film, dpi, sphere, width_mm, limits, pole),
        Claim("share of pixels of film.png that are not complete.png seen through mask.png", not_seen_through(images), 0.001),
    ]


def seam_off_mm(mask: np.ndarray, dpi: float, sphere: closed_form.Sphere, pole: np.ndarray) -> np.ndarray:
    """For each of the rays from the film's middle: the distance on the sphere, positive beyond the dip's own side, from the
    equator to the place where the weight is one half; NaN where there is none below 110 degrees."""
    radii_mm = np.arange(1, sphere.film_radius_mm(MOST_THETA_RAD), STEP_MM)
    azimuth = np.arange(RAYS) / RAYS * 2 * np.pi
    x_mm, y_mm = radii_mm * np.cos(azimuth)[:, None], radii_mm * np.sin(azimuth)[:, None]
    weight = sampled(mask[:, :, 0] / 255, dpi, x_mm, y_mm)
    beyond_mm = sphere.beyond_mm(x_mm, y_mm, pole)
    return np.array([half_mm(w, d) for w, d in zip(weight, beyond_mm)])


def half_mm(weight: np.ndarray, beyond_mm: np.ndarray) -> float:
    """Where the weight falls to one half. A level of 8 bits is 0.08 mm there, so a straight line is fitted to the weights
    of 1 mm to both sides, twice, to centre them. The weights on both sides of a seam sum to one, so this has no bias."""
    falls = np.flatnonzero((weight[:-1] >= 0.5) & (weight[1:] < 0.5))
    if not falls.size:
        return float("nan")
    place = float(np.median(beyond_mm[falls]))
    for _ in range(2):
        near = np.abs(beyond_mm - place) < 1
        if near.sum() < 3:
            return float("nan")
        slope, at_zero = np.polyfit(beyond_mm[near], weight[near], 1)
        place = (0.5 - at_zero) / slope if slope < 0 else float("nan")
    return place


def sampled(image: np.ndarray, dpi: float, x_mm: np.ndarray, y_mm: np.ndarray) -> np.ndarray:
    """Bilinear between the middles of pixels."""
    columns_mm, rows_mm = film_grid_mm(image.shape, dpi)
    pitch_mm = 25.4 / dpi
    column, row = (x_mm - columns_mm[0]) / pitch_mm, (rows_mm[0] - y_mm) / pitch_mm
    left = np.clip(np.floor(column).astype(int), 0, image.shape[1] - 2)
    top = np.clip(np.floor(row).astype(int), 0, image.shape[0] - 2)
    right, low = column - left, row - top
    upper = image[top, left] * (1 - right) + image[top, left + 1] * right
    lower = image[top + 1, left] * (1 - right) + image[top + 1, left + 1] * right
    return upper * (1 - low) + lower * low


def not_seen_through(images: Images) -> float:
    """Share of the pixels of the film more than 2 levels (three roundings) from w c + (1 - w) white."""
    ink = images.mask[:, :, :1] / 255 * (255 - images.complete[:, :, :3].astype(float))
    return float((np.abs(255 - ink - images.film[:, :, :3]).max(axis=2) > 2).mean())


def of_same_film(film: np.ndarray, planned: np.ndarray) -> list[Claim]:
    """The film of a dip at its planned pose is that of the plan."""
    if film.shape != planned.shape:
        return [Claim("share of pixels more than 1 level off the plan's film", float("nan"), 0.001)]
    off = np.abs(film.astype(int) - planned).max(axis=2)
    return [Claim("share of pixels more than 1 level off the plan's film", float((off > 1).mean()), 0.001)]


def of_warnings(warnings: list[dict], turned_deg: float) -> list[Claim]:
    """A pose that is more than 5 degrees off is named. Between 5 and 6 degrees either is right: a part of the turn may be
    about the vertical."""
    plan_codes = [warning["code"] for warning in warnings if warning["code"].startswith("PLAN_")]
    pose_off = plan_codes.count("PLAN_POSE_OFF")
    if turned_deg == 0:
        return [Claim("warnings about the plan at the planned pose", float(len(plan_codes)), 0)]
    if turned_deg > 6:
        return [Claim("warnings PLAN_POSE_OFF missing", float(pose_off != 1), 0)]
    return [Claim("warnings PLAN_POSE_OFF without need", float(pose_off), 0)] if turned_deg < 5 else []
