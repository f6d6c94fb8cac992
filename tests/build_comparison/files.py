"""Compares the output folders of two builds.

All files must be identical, except for these differences:
  - pictures with text (PICTURES_WITH_TEXT): pixels that are paper or ink in both may differ; the size may not;
  - PDF: the letters may differ; pages, boxes, other lines and images may not;
  - report.json, report.html and other JSON: times, memory, wording and the camera's address may differ; keys may have
    moved (BLOCKS, RENAMED), and a missing value equals 0, false, null and an empty text or list;
  - summary.json: the summary may have become the report;
  - PLY: the new build may add properties of the faces (ADDED_TO_FACES);
  - film_profile.toml: comments may differ;
  - residuals.csv: the reason in the last column may differ.
"""
import csv
import dataclasses
import fnmatch
import functools
import html
import io
import itertools
import json
import re
import tomllib

from build_comparison import decode, pdf

# The colours (paper, ink) of pictures with text.
VIEWS = ((250, 250, 249), (60, 64, 70))
PLOT = ((255, 255, 255), (40, 40, 40))
PICTURES_WITH_TEXT = {"stretch.png": VIEWS, "wrinkles.png": VIEWS, "predicted.png": VIEWS, "alignment.png": VIEWS,
                      "error.png": VIEWS, "scan.png": VIEWS, "validate-*.png": VIEWS, "residuals.png": PLOT}
PICTURES_WITHOUT_TEXT = "validate-*-film.png"
ADDED_TO_FACES = {"property uchar flags"}

# Keys of JSON whose values may differ; the keys themselves, types and lengths of lists may not.
MEASURED = {"total_seconds", "stage_seconds", "seconds", "peak_memory_bytes"}
OF_THE_CALL = {"threads", "uri"}  # uri: path of the virtual rig's control socket
WORDING = {"message", "why", "why_not", "text", "title", "caption", "paper", "method", "frame",
           "from_nominal_pose", "marks", "marks_dropped"}
BLOCKS = {"run", "flow", "parameters", "dip", "mesh", "page", "fit", "print", "placement", "scan", "camera", "cells"}
LENS = ("fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "depth_scale")
RENAMED = {("interval", 0): ("low",), ("interval", 1): ("high",)} | {(name,): ("lens", i) for i, name in enumerate(LENS)}
ROW_BY_ROW = {"matrix", "covariance", "covariance_turn_rad_shift_mm"}  # with or without a list for each row
CHOICES = re.compile(r"(MODEL|COLOURS|ARTIFACT_SET)_")
TABLES = {"where", "header", "rows"}  # wording whose numbers may not differ, except in warnings


@dataclasses.dataclass
class Finding:
    """The result for one file."""
    name: str
    how: str = ""  # description of the difference; empty if none, or only in times and memory
    is_allowed: bool = True


def numbers(text):
    return re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)


def first_difference(old, new):
    at = next((i for i, (a, b) in enumerate(zip(old, new)) if a != b), min(len(old), len(new)))
    sizes = f"{len(old)}" if len(old) == len(new) else f"{len(old)} and {len(new)}"
    return f"first differing byte {at} of {sizes}"


def is_code(value):
    return isinstance(value, str) and re.fullmatch(r"[A-Z0-9_]+", value)


def json_differences(old, new, path="", freedom=""):
    """Yields (path, freedom) for each value that differs; freedom is the reason why it may differ, or empty."""
    if kind_of(old) is not kind_of(new):
        yield path, ""
    elif isinstance(old, dict):
        yield from ((f"{path}.{key}", "") for key in old.keys() ^ new.keys())
        for key in old.keys() & new.keys():
            yield from json_differences(old[key], new[key], f"{path}.{key}", freedom or freedom_of(key, old[key]))
    elif isinstance(old, list):
        if len(old) != len(new):
            yield f"{path}[]", ""
        for i, (a, b) in enumerate(zip(old, new)):
            yield from json_differences(a, b, f"{path}[{i}]", freedom)
    elif old != new:
        yield path, freedom if is_free(old, new, freedom) else ""


def kind_of(value):
    return float if type(value) is int else type(value)


def is_free(old, new, freedom):
    """Returns whether the difference between two values is allowed."""
    if freedom == "measured":
        return True
    if not isinstance(old, str):
        return False
    is_warning = re.match(r"[a-z_]+: ", old) and re.match(r"[a-z_]+: ", new)
    return freedom != "table" or is_warning or numbers(old) == numbers(new)


def freedom_of(key, value):
    if key in MEASURED | OF_THE_CALL:
        return "measured"
    if key in WORDING:
        return "wording"
    if key == "reason" and not is_code(value):
        return "wording" if value else "new reasons"
    return "table" if key in TABLES else ""


def leaves(value, path=()):
    """Yields (path, value) for each value that must not differ, without the blocks of keys and what a default says."""
    key = path[-1] if path else ""
    if key in MEASURED | OF_THE_CALL | WORDING | {"where"} or not value or value == "full":
        return
    if isinstance(value, dict):
        for name, entry in value.items():
            yield from leaves(entry, path + (name,))
    elif isinstance(value, list):
        for i, entry in enumerate(value):
            yield from leaves(entry, path if key in ROW_BY_ROW else path + (i,))
    else:
        path = tuple(part for part in path if part not in BLOCKS)
        for old, new in RENAMED.items():
            path = path[:-len(old)] + new if path[-len(old):] == old else path
        yield path, CHOICES.sub("", value).lower() if isinstance(value, str) else value


def differences_but_moves(old, new):
    """Returns the paths at which two JSON values differ apart from the places of their keys."""
    gathered = []
    for value in (old, new):
        by_path = {}
        for path, leaf in leaves(value):
            in_table = TABLES & set(path) or path[-1] == "reason"
            by_path.setdefault(path, []).append(numbers(leaf) if in_table and isinstance(leaf, str) else leaf)
        gathered.append(by_path)
    first, second = gathered
    return [".".join(map(str, path)) for path in first.keys() | second.keys() if first.get(path) != second.get(path)]


def compare_summary(old, new):
    if "report" in json.loads(new) and "report" not in json.loads(old):
        return "the report", True
    return compare_json(old, new)


def compare_json(old, new):
    """Returns a description of the difference, and whether it is allowed."""
    old, new = json.loads(old), json.loads(new)
    differences = list(json_differences(old, new))
    paths = [path.lstrip(".") for path, freedom in differences if not freedom]
    if paths:
        paths = sorted(differences_but_moves(old, new))
        if not paths:
            return "moved keys", True
        return f"differs in {', '.join(paths[:5])}{f' and {len(paths) - 5} more' if len(paths) > 5 else ''}", False
    kinds = {"wording" if freedom == "table" else freedom for _, freedom in differences}
    if not kinds:
        return "the same values, written differently", True
    return " and ".join(sorted(kinds - {"measured"})), True


def compare_html(old, new):
    """Compares two HTML pages: tags and the numbers in tables may not differ; other text may."""
    def parts(page):
        cells = re.findall(r'<td class="number">(.*?)</td>', page)
        tags = [re.sub(r' alt="[^"]*"', "", tag) for tag in re.findall(r"<[^>]*>", page)]
        return tags, [numbers(html.unescape(cell)) for cell in cells]

    if parts(old.decode()) != parts(new.decode()):
        return "tags or numbers differ", False
    return "wording", True


def compare_toml(old, new):
    if tomllib.loads(old.decode()) != tomllib.loads(new.decode()):
        return "values differ", False
    return "comments", True


def compare_residuals(old, new):
    """Compares all columns except the last, which describes why a point is ignored."""
    tables = [list(csv.reader(io.StringIO(text.decode()))) for text in (old, new)]
    lines = [i + 1 for i, (a, b) in enumerate(itertools.zip_longest(*tables, fillvalue=[]))
             if a[:-1] != b[:-1] or len(a) != len(b) or bool(a[-1:]) != bool(b[-1:])]
    return (f"line {lines[0]} differs, and {len(lines) - 1} more", False) if lines else ("wording", True)


def is_mixture(pixel, colours):
    """Returns whether a colour is between paper and ink, as at the edges of letters. Each channel is rounded, twice
    where letters overlap."""
    paper, ink = colours
    share = (paper[0] - pixel[0]) / (paper[0] - ink[0])
    return -0.02 < share < 1.02 and all(abs(p + share * (i - p) - v) <= 1.5 for p, i, v in zip(paper, ink, pixel))


def compare_png(old, new, colours=None):
    """Compares two PNG files. `colours`: the colours of paper and ink, if the picture may contain text."""
    *shapes, = decode.read_png(old), decode.read_png(new)
    if shapes[0][:4] != shapes[1][:4]:
        return "size, channels or resolution differ", False
    step, pixels, most, outside = shapes[0][2], 0, 0, 0
    for a, b in zip(shapes[0][4], shapes[1][4]):
        if a == b:
            continue
        for x in range(0, len(a), step):
            left, right = a[x:x + step], b[x:x + step]
            if left == right:
                continue
            pixels += 1
            most = max(most, *(abs(p - q) for p, q in zip(left, right)))
            outside += not (colours and is_mixture(left, colours) and is_mixture(right, colours))
    if not pixels:
        return "the same pixels, compressed differently", False
    if colours and not outside:
        return f"text ({pixels} pixels)", True
    return f"pixels{' outside text' if colours else ''} that differ: {outside}, by {most} at most", False


def compare_ply(old, new):
    *files, = decode.read_ply(old), decode.read_ply(new)
    added = ADDED_TO_FACES & set(files[1][0]) - set(files[0][0])
    if files[0][0] != [line for line in files[1][0] if line not in added]:
        return "headers differ", False
    names = files[0][1]
    most = dict.fromkeys(names, 0.0)
    vertices = 0
    for a, b in zip(files[0][2], files[1][2]):
        if same_numbers(a, b):
            continue
        vertices += 1
        for name, x, y in zip(names, a, b):
            most[name] = max(most[name], distance(x, y))
    if not vertices and added and all(a[:4] == b[:4] for a, b in zip(files[0][3], files[1][3])):
        return f"added: {', '.join(sorted(added))}", True
    if not vertices:
        return "faces differ", False
    return f"vertices that differ: {vertices}, by at most: {as_text(most)}", False


def compare_exr(old, new):
    *files, = decode.read_exr(old), decode.read_exr(new)
    if files[0][0] != files[1][0]:
        return "headers differ", False
    most = {name: max(map(distance, samples, files[1][1][name])) for name, samples in files[0][1].items()}
    if not any(most.values()):
        return "the same samples, compressed differently", False
    return f"samples differ by at most: {as_text(most)}", False


def as_text(distances):
    return ", ".join(f"{name} {value:.3g}" for name, value in distances.items() if value)


def same_numbers(a, b):
    return all(x == y or x != x and y != y for x, y in zip(a, b))


def distance(x, y):
    """NaN equals NaN, and its difference from any number is infinite."""
    if x != x or y != y:
        return 0.0 if x != x and y != y else float("inf")
    return abs(x - y)


def compare_interface(old, new):
    """Compares lists of flags and commands; none may be missing in the new build."""
    old, new = json.loads(old), json.loads(new)
    gone = [f"{of} {name}" for of, names in old.items() for name in names if name not in new.get(of, [])]
    if gone:
        return f"gone: {', '.join(gone)}", False
    added = [f"{of} {name}" for of, names in new.items() for name in names if name not in old.get(of, [])]
    return f"added: {', '.join(added)}", True


def compare_pdf(old, new):
    return pdf.compare(old, new, compare_png)


def compare_placement(old, new):
    """Compares a PDF; its second page shows views of the object with their names."""
    return pdf.compare(old, new, functools.partial(compare_png, colours=VIEWS))


def compare_exactly(old, new):
    return "bytes", False


COMPARISONS = {"interface.json": compare_interface, "summary.json": compare_summary, "*.json": compare_json,
               "*.html": compare_html, "film_profile.toml": compare_toml, "residuals.csv": compare_residuals,
               PICTURES_WITHOUT_TEXT: compare_png,
               **{name: functools.partial(compare_png, colours=colours)
                  for name, colours in PICTURES_WITH_TEXT.items()},
               "placement.pdf": compare_placement, "*.pdf": compare_pdf, "*.png": compare_png, "*.ply": compare_ply,
               "*.exr": compare_exr, "*": compare_exactly}


def comparison_for(base):
    return next(compare for pattern, compare in COMPARISONS.items() if fnmatch.fnmatch(base, pattern))


def compare_bytes(name, old, new):
    """Returns the Finding for a file that both builds wrote."""
    if old == new:
        return Finding(name)
    base = name.rpartition("/")[2]
    try:
        how, is_allowed = comparison_for(base)(old, new)
    except Exception as error:  # a damaged file can cause any kind of error
        how, is_allowed = f"cannot be decoded ({error})", False
    return Finding(name, how if is_allowed else f"{how}; {first_difference(old, new)}", is_allowed)


def files_in(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def compare_folders(old, new):
    """Yields a Finding for each file in either folder. The folders' own names in JSON are ignored."""
    for name in sorted(files_in(old) | files_in(new)):
        if not (new / name).exists():
            yield Finding(name, "not written by the new build", False)
        elif not (old / name).exists():
            yield Finding(name, "written by the new build alone", False)
        else:
            yield compare_bytes(name, *(content(folder, name) for folder in (old, new)))


def content(folder, name):
    data = (folder / name).read_bytes()
    return data.replace(f"{folder}/".encode(), b"FOLDER/") if name.endswith(".json") else data
