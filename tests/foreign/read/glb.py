"""Reads binary glTF files (glTF 2.0 specification) and refuses files that are not valid."""
from __future__ import annotations

import json
import struct
from dataclasses import dataclass

import numpy as np

import nodes
import png
from scene import Material, Scene, Texture, concatenated

COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
INDEX_KINDS = (np.uint8, np.uint16, np.uint32)
EXTENSIONS = {"KHR_materials_unlit"}
WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
NEAREST = 9728
TRIANGLES = 4


class Invalid(ValueError):
    """The file breaks the specification, or uses something that the worker does not promise."""


@dataclass(frozen=True)
class Glb:
    scene: Scene
    extras: tuple[object, ...]  # of the asset and of the shown scene
    image_bytes: int  # of all encoded images


def need(holds: bool, message: str) -> None:
    if not holds:
        raise Invalid(message)


def read(data: bytes) -> Glb:
    try:
        document, binary = chunks(data)
        reader = Reader(document, binary)
        shown = document["scenes"][document.get("scene", 0)]
        extras = tuple(part["extras"] for part in (document["asset"], shown) if "extras" in part)
        return Glb(reader.scene(shown), extras, reader.image_bytes)
    except (KeyError, IndexError, TypeError, AttributeError, ValueError) as error:
        raise Invalid(str(error) if isinstance(error, Invalid) else repr(error)) from error


def chunks(data: bytes) -> tuple[dict, bytes]:
    """The JSON document and the binary chunk."""
    need(len(data) >= 20, "shorter than its header")
    magic, version, length = struct.unpack_from("<4sII", data)
    need(magic == b"glTF" and version == 2, "not a binary glTF 2 file")
    need(length == len(data), f"length {length} in the header of a file of {len(data)} bytes")
    found, at = [], 12
    while at < length:
        need(at + 8 <= length, "a chunk's header is cut off")
        size, kind = struct.unpack_from("<I4s", data, at)
        need(size % 4 == 0, f"a chunk of {size} bytes is not a multiple of 4")
        need(at + 8 + size <= length, "a chunk is longer than the file")
        found.append((kind, data[at + 8:at + 8 + size]))
        at += 8 + size
    need([kind for kind, _ in found] in ([b"JSON"], [b"JSON", b"BIN\0"]), f"chunks {[kind for kind, _ in found]}")
    document = json.loads(found[0][1].decode("utf-8"), parse_constant=not_json)
    need(document["asset"]["version"] == "2.0", "asset.version is not 2.0")
    used, required = (set(document.get(name, [])) for name in ("extensionsUsed", "extensionsRequired"))
    need(used <= EXTENSIONS and required <= used, f"extensions used {sorted(used)}, required {sorted(required)}")
    return document, found[1][1] if len(found) > 1 else b""


def not_json(word: str) -> None:
    raise Invalid(f"{word} is not JSON")


class Reader:
    """Reads the parts of a document."""

    def __init__(self, document: dict, binary: bytes):
        self.document, self.binary = document, binary
        self.buffers_fit()
        self.image_bytes = 0
        self.images = [self.image(each) for each in document.get("images", [])]
        self.materials = [self.material(each) for each in document.get("materials", [])]

    def buffers_fit(self) -> None:
        buffers = self.document.get("buffers", [])
        need(len(buffers) <= 1 and all("uri" not in buffer for buffer in buffers), "a buffer outside the file")
        if buffers:
            spare = len(self.binary) - buffers[0]["byteLength"]
            need(0 <= spare <= 3, f"the binary chunk has {spare} bytes more than the buffer")

    def view(self, number: int) -> tuple[dict, bytes]:
        need(number >= 0, "a negative index")
        view = self.document["bufferViews"][number]
        start, length = view.get("byteOffset", 0), view["byteLength"]
        need(view["buffer"] == 0 and start >= 0 and length > 0, f"buffer view {number} is malformed")
        need(start + length <= self.document["buffers"][0]["byteLength"], f"buffer view {number} exceeds the buffer")
        return view, self.binary[start:start + length]

    def accessor(self, number: int, vertices: bool) -> np.ndarray:
        """Rows of an accessor; normalized integers as numbers from 0 to 1. vertices: alignment of vertex attributes."""
        need(number >= 0, "a negative index")
        accessor = self.document["accessors"][number]
        need("sparse" not in accessor and "bufferView" in accessor, f"accessor {number} is sparse")
        view, data = self.view(accessor["bufferView"])
        kind, width = np.dtype(COMPONENTS[accessor["componentType"]]), WIDTHS[accessor["type"]]
        start, count = accessor.get("byteOffset", 0), accessor["count"]
        size = kind.itemsize * width
        stride = view.get("byteStride", size)
        need(count >= 1 and start >= 0 and stride >= size, f"accessor {number} is malformed")
        unit = max(4, kind.itemsize) if vertices else kind.itemsize
        need((start + view.get("byteOffset", 0)) % kind.itemsize == 0 and start % unit == 0 and stride % unit == 0
             and (vertices or "byteStride" not in view), f"accessor {number} is not aligned")
        need(start + (count - 1) * stride + size <= len(data), f"accessor {number} exceeds its buffer view")
        rows = np.ndarray((count, width), kind.newbyteorder("<"), data, start, (stride, kind.itemsize))
        check_extremes(accessor, rows, number)
        if kind != np.float32:
            return rows / np.iinfo(kind).max if accessor.get("normalized") else rows
        need(bool(np.isfinite(rows).all()), f"accessor {number} has numbers that are not finite")
        return rows

    def image(self, image: dict) -> np.ndarray:
        need(image["mimeType"] == "image/png" and "uri" not in image, "an image that is not an embedded PNG")
        data = self.view(image["bufferView"])[1]
        self.image_bytes += len(data)
        return png.decode(data, f"image {image.get('name', '')}")

    def material(self, material: dict) -> Material:
        need("KHR_materials_unlit" in material.get("extensions", {}), "a material is not unlit")
        need("KHR_materials_unlit" in self.document["extensionsUsed"], "KHR_materials_unlit is not declared")
        need(material.get("alphaMode", "OPAQUE") == "OPAQUE", "a material is not opaque")
        surface = material.get("pbrMetallicRoughness", {})
        factor = np.array(surface.get("baseColorFactor", [1, 1, 1, 1]), float)
        need(factor.shape == (4,) and bool(((factor >= 0) & (factor <= 1)).all()), f"baseColorFactor {factor}")
        reference = surface.get("baseColorTexture")
        if reference is None:
            return Material(factor[:3], None)
        return Material(factor[:3], self.texture(reference["index"]), reference.get("texCoord", 0))

    def texture(self, number: int) -> Texture:
        need(number >= 0, "a negative index")
        texture = self.document["textures"][number]
        need(texture["source"] >= 0 and texture.get("sampler", 0) >= 0, "a negative index")
        sampler = self.document["samplers"][texture["sampler"]] if "sampler" in texture else {}
        wraps = tuple(WRAPS[sampler.get(name, 10497)] for name in ("wrapS", "wrapT"))
        return Texture(self.images[texture["source"]], wraps, sampler.get("magFilter") == NEAREST)

    def scene(self, shown: dict) -> Scene:
        """All triangles of the shown scene, in its frame."""
        parts = []
        for matrix, mesh in nodes.placed(self.document, shown):
            parts += [self.primitive(each, matrix) for each in self.document["meshes"][mesh]["primitives"]]
        need(len(parts) > 0, "the scene is empty")
        return concatenated(parts, self.materials)

    def primitive(self, primitive: dict, matrix: np.ndarray) -> Scene:
        need(primitive.get("mode", TRIANGLES) == TRIANGLES, "a primitive is not made of triangles")
        attributes = primitive["attributes"]
        position = self.document["accessors"][attributes["POSITION"]]
        need(position["type"] == "VEC3" and position["componentType"] == 5126, "positions are not three floats")
        need("min" in position and "max" in position, "POSITION needs min and max")
        columns = {name: self.accessor(number, True) for name, number in attributes.items()}
        points = columns["POSITION"].astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        need(all(len(rows) == len(points) for rows in columns.values()), "attributes of different lengths")
        corners = self.corners(primitive, len(points))
        need(primitive["material"] >= 0, "a negative index")
        material = self.materials[primitive["material"]]
        uv = np.full((len(points), 2), np.nan)
        if material.texture is not None:
            uv = columns[f"TEXCOORD_{material.texcoord}"].astype(float)
            need(uv.shape[1] == 2, "texture coordinates are not pairs")
        colour = columns.get("COLOR_0", np.ones((len(points), 3)))[:, :3].astype(float)
        need(bool(((colour >= 0) & (colour <= 1)).all()), "COLOR_0 is not from 0 to 1")
        return Scene(points[corners], uv[corners], colour[corners], np.full(len(corners), primitive["material"]), [])

    def corners(self, primitive: dict, count: int) -> np.ndarray:
        """The indices of each triangle's vertices."""
        if "indices" not in primitive:
            indices = np.arange(count)
        else:
            rows = self.accessor(primitive["indices"], False)
            need(rows.shape[1] == 1 and rows.dtype in INDEX_KINDS, "indices are not whole numbers")
            indices = rows[:, 0].astype(np.int64)
        need(len(indices) % 3 == 0, f"{len(indices)} indices are not triangles")
        need(indices.max() < count, f"index {indices.max()} of {count} vertices")
        return indices.reshape(-1, 3)


def check_extremes(accessor: dict, rows: np.ndarray, number: int) -> None:
    for name, found in (("min", rows.min(axis=0)), ("max", rows.max(axis=0))):
        if name in accessor:
            given = np.array(accessor[name], float).astype(rows.dtype)
            need(given.shape == found.shape and bool((given == found).all()),
                 f"accessor {number}: {name} is {accessor[name]} instead of {found.tolist()}")
