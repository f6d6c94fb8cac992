"""The runs for the comparison of two builds. Each writes a folder with the program's files and its summary."""
import dataclasses
import json
import pathlib
import re
import subprocess
import threading
import typing

from build_comparison import inputs

SAMPLES = ("globe", "sphere80", "board", "ubend", "mug", "bowl")
VERBS = ("simulate", "predict", "preview", "fit", "validate", "print-image", "template", "calibrate",
         "calibrate-camera", "fuse")
TIMEOUT_S = 1800


class Failure(Exception):
    """A program failed in a run."""


@dataclasses.dataclass
class Build:
    """One of the two builds, and the folder for the files of its runs."""
    bin_folder: pathlib.Path
    work: pathlib.Path
    threads: int

    def call(self, program, *arguments):
        try:
            return subprocess.run([str(word) for word in (self.bin_folder / program, *arguments)], timeout=TIMEOUT_S,
                                  capture_output=True, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise Failure(f"{program} {arguments[0]}: not done after {TIMEOUT_S} s") from None

    def output(self, program, *arguments):
        """Runs a program, which must succeed. Returns its standard output."""
        result = self.call(program, *arguments)
        if result.returncode != 0:
            message = result.stderr.decode(errors="replace").strip()
            raise Failure(f"{program} {arguments[0]} ended with status {result.returncode}: {message}")
        return result.stdout


@dataclasses.dataclass
class Run:
    name: str
    action: typing.Callable  # (build, files, folder): writes files to the folder, which exists
    is_quick: bool = False


class Files:
    """The files that runs read: the shared inputs, and the output of the old build's runs."""

    def __init__(self, folder, old_run):
        self.folder, self.old_run = folder, old_run

    def __truediv__(self, name):
        return self.folder / name

    def mesh(self, sample):
        return self.old_run(f"sample-{sample}") / f"{sample}.obj"

    def artifact(self, run, name):
        return self.old_run(run) / "artifacts" / name

    def frames(self, name):
        return self.old_run("capture") / name

    def derived(self, name, content):
        """Returns a file and creates it atomically on first use, because several threads may need it."""
        path = self.folder / name
        if not path.exists():
            data = content()
            partial = self.folder / f"{name}.{threading.get_ident()}"
            partial.write_bytes(data if isinstance(data, bytes) else data.encode())
            partial.replace(path)
        return path


def worker(verb, flags):
    """A run of the worker. `flags` returns the flags for the files, without --out, --threads and --json."""
    def action(build, files, folder):
        summary = build.output("hydroprint-worker", verb, "--out", folder / "artifacts", "--threads", build.threads,
                               "--json", *flags(files))
        (folder / "summary.json").write_bytes(summary)
    return action


def sample(kind):
    return lambda build, files, folder: build.output("hydroprint", "sample", kind, "--out", folder)


def capture(build, files, folder):
    try:
        inputs.take_frames(build.bin_folder, files.folder, files.mesh("board"), folder)
    except (RuntimeError, OSError, subprocess.SubprocessError) as error:
        raise Failure(f"no frames of the virtual rig: {error}") from error


PREVIEW_REQUESTS = (
    {"id": 1}, {"id": 2, "pose": {"translation_mm": [6, -9, 0]}, "film": "A3", "depth_mm": 5}, {"id": 3, "film": "5x5"},
    {"id": 4, "dip_speed_mm_per_s": 9, "film": "circle:110"}, {"nothing": 0})


def preview(build, files, folder):
    """Saves the responses to a few requests, each sent after the response to the previous one."""
    command = [build.bin_folder / "hydroprint-worker", "preview", "--mesh", files.mesh("board"), "--threads",
               str(build.threads)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with subprocess.Popen(command, **pipes) as process:
        limit = threading.Timer(TIMEOUT_S, process.kill)
        limit.start()
        try:
            keep_answer(process.stdout, folder / "model")
            for i, request in enumerate(PREVIEW_REQUESTS):
                process.stdin.write(json.dumps(request).encode() + b"\n")
                process.stdin.flush()
                keep_answer(process.stdout, folder / f"answer{i}")
            process.stdin.close()
        except (OSError, ValueError, KeyError) as error:
            raise Failure(f"preview does not answer as described: {error}") from error
        finally:
            limit.cancel()


def keep_answer(stream, path):
    """Reads a response: a line of JSON, and as many bytes as the line states."""
    head = json.loads(stream.readline())
    path.with_suffix(".json").write_text(json.dumps(head))
    path.with_suffix(".bytes").write_bytes(stream.read(head["bytes"]))


def names_in(help_text):
    """Returns the flags and commands in a help text; each is at the start of a line, separate from its description."""
    return re.findall(r"^  (?:-\w,)?(--[a-z][a-z0-9-]*|[a-z][a-z0-9-]*(?=  |$))", help_text, re.MULTILINE)


def interface(build, files, folder):
    """Flags of the worker's verbs and commands of the client."""
    names = {verb: names_in(build.output("hydroprint-worker", verb, "--help").decode()) for verb in VERBS}
    for program in ("hydroprint-worker", "hydroprint"):
        names[program] = names_in(build.output(program, "--help").decode())
    (folder / "interface.json").write_text(json.dumps(names))


def bad_calls(files):
    """Calls of the worker that must be refused, by name; without --out and --json."""
    mesh, film = files.mesh("board"), files.artifact("stokes-board", "film.png")
    simulate, small = ["simulate", "--mesh", mesh], ["--film", "A4", "--model", "stokes"]
    predict = ["predict", "--mesh", mesh, "--film-image", film]
    fit = ["fit", "--mesh", mesh, "--points"]
    return {
        "no verb": [], "unknown verb": ["emboss"], "unknown flag": [*simulate, "--frob"],
        "flag without value": [*simulate, "--dpi"], "number that is none": [*simulate, "--dpi", "many"],
        "no mesh": ["simulate"], "empty mesh": ["simulate", "--mesh", ""],
        "missing mesh": ["simulate", "--mesh", files / "nowhere.obj"],
        "bad mesh": ["simulate", "--mesh", files / "not a mesh.obj"],
        "mesh that is a folder": ["simulate", "--mesh", files.folder],
        "unknown film": [*simulate, "--film", "A9"], "small film": [*simulate, "--film", "5x5"],
        "large film": [*simulate, "--film", "3000x200"],
        "missing polygon": [*simulate, "--film", f"polygon:{files / 'nowhere.json'}"],
        "bad polygon": [*simulate, "--film", f"polygon:{files / 'pose.json'}"],
        "dpi out of range": [*simulate, "--dpi", "0"], "scale out of range": [*simulate, "--scale", "-1"],
        "depth out of range": [*simulate, "--depth-mm", "0"], "depth that is none": [*simulate, "--depth-mm", "deep"],
        "speed out of range": [*simulate, "--dip-speed-mm-per-s", "0"],
        "too many pixels": [*simulate, "--film", "2000x2000", "--dpi", "2400"],
        "threads out of range": [*simulate, "--threads", "0"], "unknown model": [*simulate, "--model", "jelly"],
        "unknown artifacts": [*simulate, "--artifacts", "some"],
        "ink passes out of range": [*simulate, "--ink-passes", "21"],
        "inertia of stokes": [*simulate, "--model", "stokes", "--inertia"],
        "closed progress": [*simulate, "--progress-fd", "77"],
        "missing pose": [*simulate, "--pose", files / "nowhere.json"],
        "bad pose": [*simulate, "--pose", files / "bad pose.json"],
        "bad profile": [*simulate, "--profile", files / "bad film.toml"],
        "missing texture": [*simulate, *small, "--texture", files / "nowhere.png"],
        "bad texture": [*simulate, *small, "--texture", files / "pose.json"],
        "bad ink image": [*simulate, "--ink-image", files / "pose.json"],
        "first contact beside the film": [*simulate, *small, "--pose", files / "far pose.json"],
        "no film image": ["predict", "--mesh", mesh], "bad film image": [*predict[:-1], files / "pose.json"],
        "bad motion": [*predict, "--motion", files / "pose.json"], "bad points": [*fit, files / "motion.csv"],
        "empty points": [*fit, ""], "unknown parameter": [*fit, files / "motion.csv", "--free", "colour"],
        "unknown experiment": ["validate", "--only", "luck"],
        "print without film image": ["print-image"],
        "unknown paper": ["print-image", "--film-image", film, "--paper", "B0"],
        "unknown format": ["print-image", "--film-image", film, "--formats", "bmp"],
        "PNG of CMYK": ["print-image", "--film-image", film, "--colours", "cmyk", "--formats", "png"],
        "margin out of range": ["print-image", "--film-image", film, "--printer-margin-mm", "-1"],
        "small paper": ["template", "--mesh", mesh, "--paper", "100x100"],
        "no frames": ["calibrate", "--mesh", mesh, "--layout", inputs.LAYOUT, "--frames", files / "nowhere"],
        "bad layout": ["calibrate", "--mesh", mesh, "--layout", files / "film.toml", "--frames", files.frames("hung")],
        "bad camera": ["fuse", "--frames", files.frames("sweep"), "--camera", files / "pose.json"],
        "voxels out of range": ["fuse", "--frames", files.frames("sweep"), "--voxel-mm", "0.1"],
        "too few views": ["calibrate-camera", "--frames", files.frames("view0"), files.frames("view1")]}


def refusals(build, files, folder):
    """Saves the exit statuses and errors of bad calls."""
    outcomes = {}
    for name, call in bad_calls(files).items():
        result = build.call("hydroprint-worker", *call, "--out", folder / "out", "--json")
        outcomes[name] = {"exit_status": result.returncode, "error": error_in(result.stdout),
                          "leaves_files": (folder / "out").exists()}
    (folder / "refusals.json").write_text(json.dumps(outcomes))


def error_in(output):
    try:
        return json.loads(output)["error"]
    except (ValueError, KeyError):
        return output.decode(errors="replace")


def simulations():
    """Each sample at the default settings and with the Stokes model; then other options of a dip, at low resolution."""
    for kind in SAMPLES:
        yield Run(f"sample-{kind}", sample(kind), is_quick=kind in ("board", "ubend"))
    for kind in SAMPLES:
        yield Run(f"simulate-{kind}", worker("simulate", lambda files, kind=kind: ["--mesh", files.mesh(kind)]))
        yield Run(f"stokes-{kind}", worker("simulate", lambda files, kind=kind: [
            "--mesh", files.mesh(kind), "--model", "stokes", "--dpi", 100]), is_quick=kind == "board")
    variants = {
        "inertia": lambda files: ["--mesh", files.mesh("board"), "--inertia", "--dpi", 75, "--depth-mm", 12],
        "no-ink": lambda files: ["--mesh", files.mesh("bowl"), "--ink-passes", 0, "--dpi", 75, "--profile",
                                 inputs.PROFILE],
        "more-ink": lambda files: ["--mesh", files.mesh("board"), "--ink-passes", 2, "--dpi", 75, "--profile",
                                   files / "film_with_icc.toml"],
        "ink-image": lambda files: ["--mesh", files.mesh("board"), "--dpi", 75, "--ink-image",
                                    files.artifact("stokes-board", "film.png")],
        "polygon": lambda files: ["--mesh", files.mesh("board"), "--dpi", 75, "--pose", files / "pose.json", "--film",
                                  f"polygon:{files / 'octagon.json'}", "--dip-speed-mm-per-s", 8, "--depth-mm",
                                  25, "--profile", files / "film.toml"],
        "texture": lambda files: ["--mesh", files.mesh("ubend"), "--scale", 0.8, "--dpi", 100, "--film", "circle:105",
                                  "--depth-mm", 15, "--texture", files.mesh("board").with_suffix(".png")],
        "stl-map": lambda files: ["--artifacts", "map", "--film", "letter", "--profile", files / "film.toml", "--mesh",
                                  files.derived("board.stl",
                                                lambda: inputs.binary_stl(files.mesh("board").read_text()))],
        "ply-map": lambda files: ["--artifacts", "map", "--model", "stokes", "--mesh",
                                  files.artifact("predict-stokes", "landed.ply")]}
    for name, flags in variants.items():
        yield Run(f"simulate-{name}", worker("simulate", flags), is_quick=name in ("polygon", "texture", "stl-map"))


def predictions():
    def flags(mesh, *more):
        return lambda files: ["--mesh", files.mesh(mesh), "--film-image", files.artifact(f"stokes-{mesh}", "film.png"),
                              *[word(files) if callable(word) else word for word in more]]
    yield Run("predict-sheet", worker("predict", flags("mug")))
    yield Run("predict-stokes", worker("predict", flags("board", "--model", "stokes")), is_quick=True)
    yield Run("predict-motion", worker("predict", flags(
        "board", "--pose", lambda files: files / "pose.json", "--motion", lambda files: files / "motion.csv",
        "--profile", lambda files: files / "film.toml", "--depth-mm", 25)), is_quick=True)


def pages():
    def flags(*more):
        return lambda files: ["--film-image", files.artifact("stokes-board", "film.png"), *more]
    title = ["--job-name", "mug 7", "--date", "2025-03-14"]
    yield Run("print-default", worker("print-image", flags()), is_quick=True)
    yield Run("print-marks", worker("print-image", flags("--paper", "A3", "--bar-mm", 200, *title)), is_quick=True)
    yield Run("print-mirrored", worker("print-image", flags("--mirror", "--no-marks", "--printer-margin-mm", 5)))
    yield Run("print-cmyk", worker("print-image", flags("--colours", "cmyk", "--ink-limit", 2.5, "--paper", "A3")))
    yield Run("print-icc", worker("print-image", flags("--icc-profile", inputs.CMYK_PROFILE, "--formats", "tiff,pdf",
                                                       "--paper", "300x400", *title)), is_quick=True)
    yield Run("print-sheets", worker("print-image", flags("--paper", "120x160", "--overlap-mm", 15, "--formats",
                                                          "png,pdf,tiff", *title)))
    yield Run("template", worker("template", lambda files: [
        "--mesh", files.mesh("ubend"), "--pose", files / "pose.json", "--paper", "A3", *title]), is_quick=True)


def cameras():
    def pose_flags(files, *more):
        return ["--frames", files.frames("hung"), "--layout", inputs.LAYOUT, "--mesh", files.mesh("board"), "--pose",
                files / "hung.json", "--gripper-mm", inputs.GRIPPER_MM, *more]

    def sweep_flags(files, *more):
        return ["--frames", files.frames("sweep"), *more]

    def lens(files):
        return ["--camera", files.artifact("calibrate-camera", "camera.json")]

    yield Run("capture", capture, is_quick=True)
    yield Run("calibrate-camera", worker("calibrate-camera", lambda files: [
        "--frames", *[files.frames(f"view{view}") for view in range(inputs.VIEWS)]]), is_quick=True)
    yield Run("calibrate", worker("calibrate", lambda files: pose_flags(files, *lens(files))), is_quick=True)
    yield Run("fuse", worker("fuse", lambda files: sweep_flags(files, "--layout", inputs.LAYOUT, *lens(files))))
    yield Run("fuse-alone", worker("fuse", lambda files: sweep_flags(files, "--voxel-mm", 4)))


def fits():
    def flags(files, *more):
        points = files.derived("points.csv", lambda: inputs.measured_points(
            files.artifact("simulate-stl-map", "surface_map.ply").read_bytes()))
        return ["--mesh", files.mesh("board"), "--film", "letter", "--points", points, *more]
    yield Run("fit", worker("fit", lambda files: flags(files, "--ink-image",
                                                       files.artifact("stokes-board", "film.png"))))
    yield Run("fit-swelling", worker("fit", lambda files: flags(files, "--free", "swelling", "--drop-outliers",
                                                                "--profile", files / "film.toml")))


def all_runs():
    """Yields all runs, the longest first."""
    yield Run("validate", worker("validate", lambda files: ["--quick"]))
    yield from fits()
    yield from simulations()
    yield from predictions()
    yield from cameras()
    yield from pages()
    yield Run("validate-bowl", worker("validate", lambda files: ["--quick", "--only", "bowl"]), is_quick=True)
    yield Run("preview", preview, is_quick=True)
    yield Run("interface", interface, is_quick=True)
    yield Run("refusals", refusals, is_quick=True)
