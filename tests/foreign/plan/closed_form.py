"""Exact solution for a sphere of radius R (mm) that sinks through the middle of a round film of radius Rv (mm), and the
blend weights of two opposite dips of it.

With k^2 = Rv^2 / R^2 - 1, the film at r0(theta) = Rv sqrt(1 - exp(-(2/k) (atan(1/k) - atan(cos(theta)/k)))) lands at the
angle theta from the lowest point (field notes, section 2).
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sphere:
    radius_mm: float
    film_mm: float  # radius of the film

    def film_radius_mm(self, theta_rad: np.ndarray) -> np.ndarray:
        k = np.sqrt((self.film_mm / self.radius_mm) ** 2 - 1)
        passed = np.arctan(1 / k) - np.arctan(np.cos(theta_rad) / k)
        return self.film_mm * np.sqrt(-np.expm1(-2 / k * passed))

    def theta_rad(self, film_radius_mm: np.ndarray) -> np.ndarray:
        """The inverse of film_radius_mm(), for landing angles of up to 175 degrees; beyond and outside the film, 175."""
        k = np.sqrt((self.film_mm / self.radius_mm) ** 2 - 1)
        passed = -k / 2 * np.log1p(-np.minimum(film_radius_mm / self.film_mm, 0.999) ** 2)
        cosine = k * np.tan(np.arctan(1 / k) - passed)
        return np.arccos(np.clip(cosine, np.cos(np.radians(175)), 1))

    def beyond_mm(self, x_mm: np.ndarray, y_mm: np.ndarray, pole: np.ndarray) -> np.ndarray:
        """Signed distance on the sphere from the equator of a pole to the places where film points land, negative on the
        side of the pole. pole: a unit vector in the film's frame; the lowest point is (0, 0, -1)."""
        theta, azimuth = self.theta_rad(np.hypot(x_mm, y_mm)), np.arctan2(y_mm, x_mm)
        across = pole[0] * np.cos(azimuth) + pole[1] * np.sin(azimuth)
        height = np.sin(theta) * across - np.cos(theta) * pole[2]
        return -self.radius_mm * np.arcsin(np.clip(height, -1, 1))

    def stretch(self, theta_rad: np.ndarray) -> np.ndarray:
        """Largest singular value of the map from film to sphere: along the meridian or around it."""
        theta = np.maximum(theta_rad, 1e-4)
        step = 1e-5
        along = 2 * step * self.radius_mm / (self.film_radius_mm(theta + step) - self.film_radius_mm(theta - step))
        around = self.radius_mm * np.sin(theta) / self.film_radius_mm(theta)
        return np.maximum(along, around)

    def mean_stretch(self, up_to_rad: float) -> float:
        """Mean over the cap around the lowest point, by area."""
        theta = (np.arange(20000) + 0.5) / 20000 * up_to_rad
        return float((self.stretch(theta) * np.sin(theta)).sum() / np.sin(theta).sum())


def weight(beyond_mm: np.ndarray, width_mm: float) -> np.ndarray:
    """Weight of a dip at a signed distance from the seam, negative on its own side: eq. (7), divided by the sum over both
    dips."""
    other = np.clip(1 - np.abs(beyond_mm) / width_mm, 0, 1)
    return np.where(beyond_mm <= 0, 1, other) / (1 + other)
