"""A daemon whose worker was taken over: its folders, its people and their jobs, over REST. Everything here is known from
docs/ and the comments of the API; nothing is shared with the daemon's sources."""
from __future__ import annotations

import atexit
import contextlib
import ctypes
import dataclasses
import functools
import hashlib
import json
import os
import pathlib
import re
import secrets
import shutil
import signal
import stat
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
READY = re.compile(r"\bhttp=(\S+:\d+)")
FINISHED = {"SUCCEEDED", "FAILED", "CANCELLED"}
MARKED_TIME_S = 100_000_000  # the worker sets times before this one
MIB = 1 << 20
MEMORY_MIB = 512
# Upper bounds, for a busy machine.
START_S = 60
JOB_S = 240
STOP_S = 20
CALL_S = 30
LARGEST_USE_OF_DISK = 6 << 30
SLURM_COMMANDS = ("sbatch", "squeue", "scancel", "sinfo")
PASSWORD = "a long enough one"


_open_stages: list[Stage] = []


class NotStarted(Exception):
    """Raised if the daemon ends instead of serving; its text is the daemon's output."""


class Refused(Exception):
    """Raised if the daemon answers a request with an error."""


@functools.cache
def compiled() -> pathlib.Path:
    """A folder with the programs of this test; it is deleted at the end."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="hydroprint-attacks-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    folder.chmod(0o755)
    for source, program in (("worker.c", "hydroprint-worker"), ("old_kernel.c", "old_kernel")):
        subprocess.run(["cc", "-O1", "-o", folder / program, HERE / source], check=True)
    return folder


def as_user(user: int) -> list[str]:
    """The beginning of a command that another user runs."""
    return ["setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups"]


def landlock_version() -> int:
    """The version of this kernel's Landlock; 0 without it."""
    return max(0, ctypes.CDLL(None).syscall(444, None, 0, 1))


def io_priority(pid: int) -> int:
    return ctypes.CDLL(None).syscall(252, 1, pid)


def remove_shared_memory(number: int) -> None:
    ctypes.CDLL(None).shmctl(number, 0, None)


def shared_memory(size: int) -> set[int]:
    """Numbers of the System V segments of this size."""
    try:
        lines = pathlib.Path("/proc/sysvipc/shm").read_text().splitlines()[1:]
    except OSError:
        return set()
    return {int(line.split()[1]) for line in lines if int(line.split()[3]) == size}


def wait_until(holds, seconds: float, period_s: float = 0.02) -> bool:
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return bool(holds())
        time.sleep(period_s)
    return True


def close_all() -> None:
    for stage in list(_open_stages):
        stage.close()


@dataclasses.dataclass
class Outcome:
    """What became of an attack, and what was seen meanwhile."""
    job: dict
    artifacts: dict[str, bytes]  # those of the attacker
    other: dict  # the other user's job
    other_artifacts: dict[str, bytes]
    processes: int = 0  # most workers at one time
    rss: int = 0  # most bytes that they held
    seconds: float = 0.0

    @property
    def attempts(self) -> str:
        return self.artifacts.get("attempts.txt", b"").decode(errors="replace")

    @property
    def reason(self) -> str:
        return self.job.get("error", {}).get("reason", "")


class Stage:
    """A daemon with folders of its own. `executor`: "local" or "slurm". `landlock`: the version that the daemon and its
    workers see, if it is not the kernel's own. `disk_mib`: size of a disk for the state folder alone. `user`: number of the
    user who runs the daemon, if it is another one."""

    def __init__(self, programs: pathlib.Path, executor: str = "local", landlock: int | None = None,
                 disk_mib: int = 0, user: int | None = None, settings: str = "", store: str = ""):
        self.programs, self.executor, self.landlock, self.disk_mib = programs, executor, landlock, disk_mib
        self.user = user
        self.base = pathlib.Path(tempfile.mkdtemp(prefix="hydroprint-attacks-"))
        self.state, self.shared, self.secret = self.base / "state", self.base / "shared", self.base / "secret"
        self.secret_out = self.base / "secret-work" / "out"  # the same files below a folder that takes the place of work
        self.worker = self.base / "worker" / "hydroprint-worker"
        self.installation = self.shared / "default"
        self.jobs_of_slurm = self.base / "slurm" / "jobs"
        self.log_file = self.base / "daemon.log"
        self.config = self.base / "hydroprintd.toml"
        self.process: subprocess.Popen | None = None
        self.keys: dict[str, str] = {}
        self.secrets: list[str] = []  # that no artifact of the attacker may contain
        _open_stages.append(self)
        try:
            self.make_folders(settings, store)
        except BaseException:
            self.close()
            raise

    def make_folders(self, settings: str, store: str) -> None:
        for folder in (self.worker.parent, self.shared, self.jobs_of_slurm, self.secret, self.secret_out):
            folder.mkdir(parents=True, mode=0o700)
        if self.disk_mib:
            self.state.mkdir(mode=0o700)
        shutil.copy(compiled() / "hydroprint-worker", self.worker)
        token = secrets.token_hex(24)
        self.secrets.append(token)
        for path in (folder / name for folder in (self.secret, self.secret_out) for name in ("key.pem", "film.png")):
            path.write_text(f"-----BEGIN STAND-IN KEY-----\n{token}\n-----END STAND-IN KEY-----\n")
            path.chmod(0o600)
            (path.parent / "report.json").write_text("{}\n")  # so that the folder passes for the results of a job
        for command in SLURM_COMMANDS:
            shutil.copy(HERE / "slurm.sh", self.base / "slurm" / command)  # not links, which may be followed
        slurm = f'[workers.slurm]\nfolder = "{self.shared}"\n' if self.executor == "slurm" else ""
        self.config.write_text(
            f'[store]\n{store}\n[people]\npassword_memory_mib = 1\npassword_passes = 1\n[workers]\n'
            f'program = "{self.worker}"\ncount = 2\nthreads = 1\nmemory_mib = {MEMORY_MIB}\ntime_limit_s = 60\n'
            f'executor = "{self.executor}"\n{settings}\n{slurm}')
        if self.user is not None:
            for path in (self.base, *self.base.rglob("*")):
                os.chown(path, self.user, self.user)

    # The daemon.

    @property
    def pid(self) -> int:
        return self.process.pid

    @property
    def environment(self) -> dict[str, str]:
        return os.environ | {"PATH": f"{self.base}/slurm:{os.environ['PATH']}"}

    def command(self) -> list:
        command = [self.programs / "hydroprintd", "--config", self.config, "--state-dir", self.state,
                   "--grpc", "127.0.0.1:0", "--http", "127.0.0.1:0"]
        if self.landlock is not None:
            command = [compiled() / "old_kernel", self.landlock, *command]
        if self.disk_mib:
            mount = f'mount -t tmpfs -o size={self.disk_mib}m,mode=700 tmpfs "{self.state}" && exec "$@"'
            as_root = [] if os.geteuid() == 0 else ["--map-root-user"]
            command = ["unshare", "--mount", "--propagation", "private", *as_root, "sh", "-c", mount, "sh", *command]
        if self.user is not None:
            command = [*as_user(self.user), *command]
        return [str(part) for part in command]

    def log(self) -> str:
        return self.log_file.read_text(errors="replace") if self.log_file.exists() else ""

    def start(self) -> None:
        with open(self.log_file, "w") as log:
            self.process = subprocess.Popen(self.command(), stdin=subprocess.DEVNULL, stdout=log,
                                            stderr=subprocess.STDOUT, env=self.environment, start_new_session=True)
        wait_until(lambda: READY.search(self.log()) or self.process.poll() is not None, START_S)
        found = READY.search(self.log())
        if not found or self.process.poll() is not None:
            raise NotStarted(self.log()[-3000:])
        self.address = f"http://{found[1]}"

    @property
    def lives(self) -> bool:
        return self.process is not None and self.process.poll() is None

    def is_healthy(self) -> bool:
        try:
            return self.lives and self.request("GET", "/healthz")[0] == 200
        except OSError:
            return False

    def terminate(self) -> float | None:
        """Sends SIGTERM. Returns the seconds until the daemon ended, or nothing if it did not."""
        begin, free = time.monotonic(), shutil.disk_usage(self.base).free
        self.process.terminate()
        wait_until(lambda: self.process.poll() is not None or self.fills_the_disk(free), STOP_S)
        return None if self.lives else time.monotonic() - begin

    def fills_the_disk(self, free_before: int) -> bool:
        return free_before - shutil.disk_usage(self.base).free > LARGEST_USE_OF_DISK

    def close(self) -> None:
        """Ends everything that was started, and removes all files."""
        if self.lives:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.terminate()
                self.process.wait(3)
            self.process.kill()
            self.process.wait()
        wait_until(lambda: not self.end_workers(), 5)
        for path in self.jobs_of_slurm.glob("*/pid"):
            if not (path.parent / "status").exists():
                with contextlib.suppress(OSError, ValueError):
                    os.killpg(int(path.read_text()), signal.SIGKILL)
        subprocess.run(["rm", "-rf", "--one-file-system", str(self.base)], check=False)  # deeper than Python recurses
        if self in _open_stages:
            _open_stages.remove(self)

    def __enter__(self) -> "Stage":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Processes.

    def workers(self) -> dict[int, int]:
        """The processes of the worker program, with the bytes that each holds."""
        found = {}
        for name in os.listdir("/proc"):
            if name.isdigit():
                with contextlib.suppress(OSError, ValueError, IndexError):
                    if os.readlink(f"/proc/{name}/exe") == str(self.worker):
                        pages = int(pathlib.Path(f"/proc/{name}/statm").read_text().split()[1])
                        found[int(name)] = pages * os.sysconf("SC_PAGE_SIZE")
        return found

    def end_workers(self) -> list[int]:
        """Kills the remaining workers. Returns their numbers."""
        left = list(self.workers())
        for pid in left:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        return left

    def bytes_read(self) -> int:
        """Bytes that the daemon has read, from files or elsewhere."""
        with contextlib.suppress(OSError):
            return int(re.search(r"^rchar: (\d+)", pathlib.Path(f"/proc/{self.pid}/io").read_text(), re.M)[1])
        return 0

    def rights(self) -> dict[str, object]:
        """What other processes could change about the daemon."""
        proc = pathlib.Path(f"/proc/{self.pid}")
        return {"nice value": os.getpriority(os.PRIO_PROCESS, self.pid), "io priority": io_priority(self.pid),
                "affinity": os.sched_getaffinity(self.pid), "scheduler": os.sched_getscheduler(self.pid),
                **{name: (proc / name).read_text() for name in ("limits", "oom_score_adj", "coredump_filter")}}

    # Files.

    @property
    def seen_state(self) -> pathlib.Path:
        """The state folder as the daemon sees it."""
        return pathlib.Path(f"/proc/{self.pid}/root{self.state}") if self.disk_mib else self.state

    def lasting_files(self) -> list[pathlib.Path]:
        """Files and folders whose modes, owners and times are the daemon's matter alone."""
        found = [self.state, self.shared, self.installation, self.secret, self.worker.parent, self.worker, self.config,
                 *self.secret.iterdir()]
        for path in self.state.rglob("*"):
            if path.relative_to(self.state).parts[0] not in ("runs", "uploads", "dips"):
                found.append(path)
        return found

    def marks(self) -> dict[pathlib.Path, tuple]:
        """Mode, owners and extended attributes of these files, and whether they have the times of the attack."""
        found = {}
        for path in self.lasting_files():
            with contextlib.suppress(OSError):
                status = path.lstat()
                found[path] = (stat.filemode(status.st_mode), status.st_uid, status.st_gid,
                               sorted(os.listxattr(path, follow_symlinks=False)),
                               min(status.st_mtime, status.st_atime) < MARKED_TIME_S)
        return found

    def secret_files(self) -> dict[str, int]:
        """The files of the secret folder, with their numbers of names."""
        return {str(path): path.stat().st_nlink for folder in (self.secret, self.secret_out) for path in folder.iterdir()}

    def leaks(self, outcome: Outcome) -> list[str]:
        """Places at which the attacker could read what is secret."""
        tokens = [token.encode() for token in self.secrets]
        texts = {f"artifact {name}": content for name, content in outcome.artifacts.items()}
        texts["the job"] = json.dumps(outcome.job).encode()
        folder = self.seen_state / "artifacts" / outcome.job["name"].split("/")[1]
        for path in folder.rglob("*") if folder.is_dir() and not folder.is_symlink() else ():
            if path.is_file() and not path.is_symlink() and path.stat().st_size < 16 * MIB:
                texts[f"stored {path.name}"] = path.read_bytes()
        found = [place for place, text in texts.items() if any(token in text for token in tokens)]
        if folder.is_symlink():
            found.append("the folder of artifacts is a link")
        elif folder.is_dir():
            found += [f"{path.name} is a link" for path in folder.rglob("*") if path.is_symlink()]
        return found

    # People and requests.

    def request(self, method: str, path: str, body: dict | None = None, data: bytes | None = None,
                who: str | None = None, headers: dict | None = None) -> tuple[int, bytes]:
        fields = dict(headers or {})
        if body is not None:
            data, fields["Content-Type"] = json.dumps(body).encode(), "application/json"
        if who:
            fields["Authorization"] = f"Bearer {self.keys[who]}"
        request = urllib.request.Request(self.address + path, data, fields, method=method)
        try:
            with urllib.request.urlopen(request, timeout=CALL_S) as reply:
                return reply.status, reply.read(16 * MIB)
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read()

    def call(self, method: str, path: str, body: dict | None = None, **more) -> dict:
        status, content = self.request(method, path, body, **more)
        if status != 200:
            raise Refused(f"{method} {path}: {status} {content.decode(errors='replace')[:500]}")
        return json.loads(content or b"{}")

    def add_people(self) -> None:
        """An admin, the attacker and another user; each has an API key."""
        self.call("POST", "/v1/users", {"user": {"name": "users/ann", "role": "ADMIN"}, "password": PASSWORD})
        headers = self.sign_in("ann")
        for name in ("mallory", "bob"):
            self.call("POST", "/v1/users", {"user": {"name": f"users/{name}", "role": "MAKER"}, "password": PASSWORD},
                      headers=headers)
            reply = self.call("POST", "/v1/apiKeys", {"displayName": "attacks"}, headers=self.sign_in(name))
            self.keys[name] = reply["key"]

    def sign_in(self, name: str) -> dict:
        body = json.dumps({"user": name, "password": PASSWORD}).encode()
        request = urllib.request.Request(f"{self.address}/v1/session:signIn", body, {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=CALL_S) as reply:
            return {"Cookie": reply.headers["Set-Cookie"].split(";")[0],
                    "X-Hydroprint-Csrf": json.load(reply)["csrfToken"]}

    def upload(self, who: str, content: bytes) -> str:
        digest = hashlib.sha256(content).hexdigest()
        reply = self.call("POST", "/v1/uploads", {"sizeBytes": str(len(content)), "sha256": digest}, who=who)
        if "upload" in reply:
            self.call("PATCH", f"/v1/{reply['upload']['name']}", data=content, who=who,
                      headers={"Upload-Offset": "0", "Content-Type": "application/octet-stream"})
        return f"assets/{digest}"

    def mesh(self, who: str, play: str, settings: dict) -> dict:
        """A mesh file that tells the worker what to play. Each is different, so that no result is used again."""
        lines = [f"# {secrets.token_hex(16)}", f"attack {play}"]
        lines += [f"set {key} {value}" for key, value in ({"daemon": self.pid} | settings).items()]
        lines += ["v 0 0 0", "v 10 0 0", "v 0 10 0", "v 0 0 10", "f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4", ""]
        return {"name": "attack.obj", "asset": self.upload(who, "\n".join(lines).encode())}

    def submit(self, who: str, play: str, **settings: object) -> str:
        return self.call("POST", "/v1/jobs", {"simulate": {"mesh": self.mesh(who, play, settings)}}, who=who)["name"]

    def job(self, name: str, who: str) -> dict:
        return self.call("GET", f"/v1/{name}", who=who)

    def artifacts(self, job: str, who: str) -> dict[str, bytes]:
        """The first bytes of all artifacts of a job."""
        listed = self.call("GET", f"/v1/{job}/artifacts?pageSize=1000", who=who).get("artifacts", [])
        found = {}
        for artifact in listed:
            status, content = self.request("GET", f"/v1/{artifact['name']}:download", who=who)
            found[artifact["name"].split("/artifacts/")[1]] = content if status == 200 else b""
        return found

    def wait_for(self, jobs: dict[str, str], seen: Outcome | None = None, seconds: float = JOB_S) -> dict[str, dict]:
        """Waits until these jobs ({name: who}) have ended, and watches the workers meanwhile. Returns the jobs, ended or
        not; {} if the daemon has died."""
        free, found, next_question = shutil.disk_usage(self.base).free, {}, 0.0
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            workers = self.workers()
            if seen:
                seen.processes = max(seen.processes, len(workers))
                seen.rss = max(seen.rss, sum(workers.values()))
            if self.lives and self.fills_the_disk(free):
                self.process.kill()
                self.process.wait()
            if not self.lives:
                return {}
            if time.monotonic() > next_question:
                try:
                    found = {name: self.job(name, who) for name, who in jobs.items()}
                except OSError:
                    continue  # the daemon has died, or is too busy
                if all(job["state"] in FINISHED for job in found.values()):
                    break
                next_question = time.monotonic() + 0.05
            time.sleep(0.01)
        return found

    def play(self, play: str, **settings: object) -> Outcome | None:
        """Plays an attack while the other user's job runs. Returns nothing if the daemon has died."""
        token = secrets.token_hex(24)
        other = self.submit("bob", "none", ms=400, private=token)
        begin, job = time.monotonic(), self.submit("mallory", play, **settings)
        outcome = Outcome({"name": job}, {}, {"name": other}, {})
        jobs = self.wait_for({job: "mallory", other: "bob"}, outcome)
        outcome.seconds = time.monotonic() - begin
        if not jobs:
            return None
        outcome.job, outcome.other = jobs[job], jobs[other]
        outcome.artifacts, outcome.other_artifacts = self.artifacts(job, "mallory"), self.artifacts(other, "bob")
        outcome.other["right"] = token.encode() in outcome.other_artifacts.get("film.png", b"")
        return outcome
