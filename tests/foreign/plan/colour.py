"""Colour differences: sRGB (IEC 61966-2-1) to CIELAB under D65, and CIEDE2000 (CIE 142; Sharma, Wu and Dalal, 2005)."""
from __future__ import annotations

import numpy as np

TO_XYZ = np.array([(0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)])
FULL = 25.0 ** 7


def lab(srgb: np.ndarray) -> np.ndarray:
    """From coded values, 0 to 1 in the last axis."""
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    xyz = linear @ TO_XYZ.T / TO_XYZ.sum(axis=1)
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)


def chroma_weight(chroma: np.ndarray) -> np.ndarray:
    return np.sqrt(chroma ** 7 / (chroma ** 7 + FULL))


def ciede2000(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Between colours in CIELAB, with k_L = k_C = k_H = 1."""
    (l_1, a_1, b_1), (l_2, a_2, b_2) = np.moveaxis(first, -1, 0), np.moveaxis(second, -1, 0)
    grow = 1.5 - 0.5 * chroma_weight((np.hypot(a_1, b_1) + np.hypot(a_2, b_2)) / 2)
    c_1, c_2 = np.hypot(grow * a_1, b_1), np.hypot(grow * a_2, b_2)
    h_1, h_2 = np.arctan2(b_1, grow * a_1) % (2 * np.pi), np.arctan2(b_2, grow * a_2) % (2 * np.pi)
    turn = np.where(c_1 * c_2 == 0, 0, (h_2 - h_1 + np.pi) % (2 * np.pi) - np.pi)
    lightness, chroma = (l_1 + l_2) / 2, (c_1 + c_2) / 2
    hue = np.where(c_1 * c_2 == 0, h_1 + h_2, mean_hue(h_1, h_2))
    t = (1 - 0.17 * np.cos(hue - np.radians(30)) + 0.24 * np.cos(2 * hue) + 0.32 * np.cos(3 * hue + np.radians(6))
         - 0.20 * np.cos(4 * hue - np.radians(63)))
    s_l = 1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2)
    lights, chromas = (l_2 - l_1) / s_l, (c_2 - c_1) / (1 + 0.045 * chroma)
    hues = 2 * np.sqrt(c_1 * c_2) * np.sin(turn / 2) / (1 + 0.015 * chroma * t)
    blue_rad = np.radians(60) * np.exp(-((np.degrees(hue) - 275) / 25) ** 2)
    return np.sqrt(lights ** 2 + chromas ** 2 + hues ** 2 - np.sin(blue_rad) * 2 * chroma_weight(chroma) * chromas * hues)


def mean_hue(h_1: np.ndarray, h_2: np.ndarray) -> np.ndarray:
    """The middle of the shorter arc, 0 to 2 pi; of opposite hues, the middle that does not pass 0."""
    middle = (h_1 + h_2) / 2
    return np.where(np.abs(h_1 - h_2) <= np.pi + 1e-9, middle, np.where(middle < np.pi, middle + np.pi, middle - np.pi))
