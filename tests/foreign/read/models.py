"""Models for the tests of the judge, and their binary glTF files."""
from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field, replace

import numpy as np

import light
import png
import shapes

COLOURS = np.array([(200, 60, 40), (50, 160, 60), (40, 70, 180), (230, 190, 40)])  # by quadrant: ++, -+, --, +-
KINDS = {np.dtype(np.float32): 5126, np.dtype(np.uint8): 5121, np.dtype(np.uint16): 5123, np.dtype(np.uint32): 5125}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


@dataclass(frozen=True)
class Part:
    """One primitive."""
    points: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray | None = None
    colour: np.ndarray | None = None  # linear floats, or normalized integers
    factor: tuple[float, ...] = (1, 1, 1, 1)
    image: np.ndarray | None = None
    sampler: dict = field(default_factory=dict)


@dataclass
class Document:
    """The JSON document and the binary chunk of a file. Tests falsify either before packed()."""
    json: dict
    binary: bytes

    def packed(self) -> bytes:
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(self.binary)
        return (struct.pack("<4sII", b"glTF", 2, length) + struct.pack("<I4s", len(text), b"JSON") + text
                + struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


def document(parts: list[Part], summary: dict, translation_mm: tuple[float, ...] = (0, 0, 0)) -> Document:
    """One node with a mesh of these parts; the points are in the scene's frame."""
    out = {"asset": {"version": "2.0", "extras": {"summary": summary}}, "scene": 0, "scenes": [{"nodes": [0]}],
           "nodes": [{"mesh": 0, "translation": list(translation_mm)}], "meshes": [{"primitives": []}],
           "extensionsUsed": ["KHR_materials_unlit"], "materials": [], "accessors": [], "bufferViews": []}
    binary = b""

    def view(data: bytes) -> int:
        nonlocal binary
        out["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + b"\0" * (-len(data) % 4)
        return len(out["bufferViews"]) - 1

    def accessor(rows: np.ndarray) -> int:
        padded = rows if rows.shape[1] * rows.itemsize % 4 == 0 or rows.shape[1] == 1 else with_padding(rows)
        described = {"bufferView": view(padded.tobytes()), "componentType": KINDS[rows.dtype], "count": len(rows),
                     "type": TYPES[rows.shape[1]], "min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        if padded is not rows:
            out["bufferViews"][-1]["byteStride"] = padded.shape[1] * rows.itemsize
        out["accessors"].append(described)
        return len(out["accessors"]) - 1

    for part in parts:
        attributes = {"POSITION": accessor((part.points - translation_mm).astype(np.float32))}
        material = {"extensions": {"KHR_materials_unlit": {}},
                    "pbrMetallicRoughness": {"baseColorFactor": list(part.factor)}}
        if part.uv is not None:
            attributes["TEXCOORD_0"] = accessor(part.uv.astype(np.float32))
        if part.colour is not None:
            attributes["COLOR_0"] = accessor(part.colour)
            out["accessors"][-1]["normalized"] = part.colour.dtype != np.float32
        if part.image is not None:
            for name in ("textures", "images", "samplers"):
                out.setdefault(name, [])
            out["images"].append({"mimeType": "image/png", "bufferView": view(png.encode(part.image))})
            out["samplers"].append(part.sampler)
            out["textures"].append({"source": len(out["images"]) - 1, "sampler": len(out["samplers"]) - 1})
            material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": len(out["textures"]) - 1}
        indices = accessor(part.triangles.reshape(-1, 1).astype(np.uint32))
        out["materials"].append(material)
        out["meshes"][0]["primitives"].append(
            {"attributes": attributes, "indices": indices, "material": len(out["materials"]) - 1})
    out["buffers"] = [{"byteLength": len(binary)}]
    return Document(out, binary)


def with_padding(rows: np.ndarray) -> np.ndarray:
    """Rows whose length is a multiple of 4 bytes."""
    columns = -rows.shape[1] * rows.itemsize % 4 // rows.itemsize
    return np.concatenate([rows, np.zeros((len(rows), columns), rows.dtype)], axis=1)


def summary_of(parts: list[Part]) -> dict:
    """What report.json says of the parts."""
    points = np.concatenate([part.points for part in parts])
    count = sum(len(part.triangles) for part in parts)
    return {"format": "OBJ", "vertices": len(points), "triangles": count, "shown_triangles": count,
            "lowest_mm": points.min(axis=0).tolist(), "highest_mm": points.max(axis=0).tolist(), "warnings": []}


def film_image() -> np.ndarray:
    """The film that prints the sphere; its first row is at the largest y."""
    out = np.full((283, 283, 3), 255, np.uint8)
    out[:141, 142:], out[:141, :141], out[142:, :141], out[142:, 142:] = COLOURS
    return out


def quadrants(points: np.ndarray) -> np.ndarray:
    return np.where(points[:, 1] > 0, np.where(points[:, 0] > 0, 0, 1), np.where(points[:, 0] > 0, 3, 2))


def sphere() -> Part:
    """R = 20 mm, each triangle with its own vertices, which all belong to the quadrant of the triangle."""
    points, triangles = shapes.icosphere(20, 4)
    return Part(points[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))


def quadrants_of(part: Part) -> np.ndarray:
    """The quadrant of the triangle of each vertex."""
    return np.repeat(quadrants(part.points.reshape(-1, 3, 3).mean(axis=1)), 3)


def by_vertex(kind: type) -> list[Part]:
    part = sphere()
    colour = light.linear(COLOURS[quadrants_of(part)])
    stored = colour.astype(np.float32) if kind is np.float32 else np.rint(colour * np.iinfo(kind).max).astype(kind)
    return [replace(part, colour=stored)]


def by_material() -> list[Part]:
    part = sphere()
    of_triangles = quadrants_of(part)[::3]
    return [replace(part, triangles=part.triangles[of_triangles == n], factor=(*light.linear(colour), 1))
            for n, colour in enumerate(COLOURS)]


def by_texture() -> list[Part]:
    """x and y as u and v, which runs down: ++ is the lower right quarter of the picture."""
    part = sphere()
    image = np.repeat(np.repeat(COLOURS[[[2, 3], [1, 0]]], 16, axis=0), 16, axis=1)
    return [replace(part, uv=part.points[:, :2] / 40 + 0.5, image=image)]


def by_product() -> list[Part]:
    """The texture is brighter, so that its product with factor and vertex colours has the colours."""
    factor, vertex = np.array([0.95, 0.9, 0.9]), np.array([0.9, 0.8, 0.95], np.float32)
    part = by_texture()[0]
    image = np.rint(light.levels(light.linear(part.image) / (factor * vertex))).astype(np.uint8)
    return [replace(part, image=image, colour=np.tile(vertex, (len(part.points), 1)), factor=(*factor, 1))]
