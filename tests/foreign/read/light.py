"""Colours: sRGB (IEC 61966-2-1) and linear light, and the lookup of textures as glTF defines it."""
from __future__ import annotations

import numpy as np


def linear(levels: np.ndarray) -> np.ndarray:
    """sRGB from 0 to 255 as linear light from 0 to 1."""
    coded = np.asarray(levels, float) / 255
    return np.where(coded <= 0.04045, coded / 12.92, ((np.maximum(coded, 0) + 0.055) / 1.055) ** 2.4)


def levels(light: np.ndarray) -> np.ndarray:
    """Linear light from 0 to 1 as sRGB from 0 to 255."""
    light = np.clip(light, 0, 1)
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def wrapped(texel: np.ndarray, count: int, wrap: str) -> np.ndarray:
    """Numbers of texels beyond the image's edge, as numbers within it."""
    if wrap == "clamp":
        return np.clip(texel, 0, count - 1)
    if wrap == "repeat":
        return texel % count
    there_and_back = texel % (2 * count)
    return np.minimum(there_and_back, 2 * count - 1 - there_and_back)


def sampled(image: np.ndarray, wraps: tuple[str, str], nearest: bool, uv: np.ndarray) -> np.ndarray:
    """Linear light of an image at each (u, v): v runs down from the upper edge, and texels are blended in linear light."""
    height, width = image.shape[:2]
    colour = image[:, :, :3] if image.shape[2] >= 3 else np.repeat(image[:, :, :1], 3, axis=2)
    place = uv * [width, height] - (0 if nearest else 0.5)
    first = np.floor(place).astype(int)
    part = np.zeros_like(place) if nearest else place - first
    out = np.zeros((len(uv), 3))
    for dx, dy in ((0, 0),) if nearest else ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = (part[:, 0] if dx else 1 - part[:, 0]) * (part[:, 1] if dy else 1 - part[:, 1])
        column, row = wrapped(first[:, 0] + dx, width, wraps[0]), wrapped(first[:, 1] + dy, height, wraps[1])
        out += weight[:, None] * linear(colour[row, column])
    return out
