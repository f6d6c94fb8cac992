"""Compares the printed content of two PDF files, except text: pages, their boxes, images with their positions, and lines
that are not letters. Letters are strokes with a width of 0.17 of their height, or text of a font. Needs mutool
(mupdf-tools) and pdfimages (poppler-utils)."""
import pathlib
import re
import subprocess
import tempfile

PNG = b"\x89PNG"
POINTS_PER_MM = 72 / 25.4
LETTER_PENS_MM = [0.17 * height_mm for height_mm in (1.6, 1.2, 1.1, 0.9, 0.8)]


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True).stdout


def page_count(path):
    return int(output_of("mutool", "show", path, "trailer/Root/Pages/Count"))


def boxes(path, page):
    return [output_of("mutool", "show", path, f"pages/{page}/{box}") for box in ("MediaBox", "CropBox", "Rotate")]


def is_letter(line):
    pen = re.match(r"([\d.]+) w ", line)
    return pen and any(abs(float(pen[1]) / POINTS_PER_MM - width_mm) < 1e-3 for width_mm in LETTER_PENS_MM)


def drawing(path, page):
    """Returns the lines of a page's content without letters."""
    text = output_of("mutool", "show", "-b", path, f"pages/{page}/Contents").decode("latin-1")
    text = re.sub(r"\bBT\b.*?\bET\b", "", text, flags=re.DOTALL)
    return [line for line in text.splitlines() if line.strip() and not is_letter(line)]


def images(path, folder):
    """Returns the pixels of all images in order, as PNG, or TIFF for CMYK."""
    folder.mkdir()
    output_of("pdfimages", "-png" if b"DeviceCMYK" not in path.read_bytes() else "-tiff", path, folder / "image")
    return [file.read_bytes() for file in sorted(folder.iterdir())]


def compare_images(old, new, compare_png):
    """Returns the first difference that is not allowed; empty if there is none."""
    if len(old) != len(new):
        return "the number of images differs"
    for i, (a, b) in enumerate(zip(old, new)):
        if a == b:
            continue
        how, is_allowed = compare_png(a, b) if a.startswith(PNG) and b.startswith(PNG) else ("pixels differ", False)
        if not is_allowed:
            return f"image {i + 1}: {how}"
    return ""


def compare(old, new, compare_png):
    """Returns a description of the difference between two files (bytes), and whether it is allowed."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        paths = [folder / "old.pdf", folder / "new.pdf"]
        for path, data in zip(paths, (old, new)):
            path.write_bytes(data)
        counts = [page_count(path) for path in paths]
        if counts[0] != counts[1]:
            return f"{counts[0]} and {counts[1]} pages", False
        for page in range(1, counts[0] + 1):
            if boxes(paths[0], page) != boxes(paths[1], page):
                return f"boxes of page {page} differ", False
            if drawing(paths[0], page) != drawing(paths[1], page):
                return f"lines or places of images on page {page} differ", False
        how = compare_images(*(images(path, folder / path.stem) for path in paths), compare_png)
        return (how, False) if how else ("text", True)
