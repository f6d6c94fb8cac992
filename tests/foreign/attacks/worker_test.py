#!/usr/bin/env python3
"""Plays what a worker that was taken over can do, and judges from outside that it harms nobody.

usage: worker_test.py BIN_DIR [NAME...]       --list shows the names; "slurm" and "local" are all of one executor

BIN_DIR has hydroprintd, hydroprint-confine and hydroprint. The daemon runs worker.c in the worker's place, with Debian 12's
Landlock (old_kernel.c), on this machine or on a stand-in for Slurm (slurm.sh). Beside each attack runs the job of another
user. Exit status: 0 all claims hold, 1 one does not, 2 the daemon does not start, 77 this machine cannot confine."""
from __future__ import annotations

import argparse
import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import traceback
import typing

sys.dont_write_bytecode = True  # set before the import below
import stage as stages  # noqa: E402
from stage import MEMORY_MIB, MIB, NotStarted, Outcome, Stage  # noqa: E402

DEBIAN_12_LANDLOCK = 2
SPARSE_BYTES, SPARSE_FILES = 4096 * MIB, 400
MOST_READ_BYTES = 1 << 30  # by a daemon that hashes none of the sparse files
SHARED_BYTES = 32 * MIB + 7 * 4096
MOST_WORKERS = 4  # two jobs, and two that answer --version
# hydroprint-confine --help: the kernel's limit is a quarter and 512 MiB greater than --memory-mib. The other job is small.
MOST_MEMORY_BYTES = (MEMORY_MIB * 5 // 4 + 512 + 32) * MIB
DISK_MIB, DISK_FILE_MIB, DISK_MIN_FREE_MIB = 768, 64, 48
OTHER_USER = 65534
SHORT_JOBS = 15
# What the confinement alone decides is played on one executor.
BOTH, LOCAL, SLURM = ("local", "slurm"), ("local",), ("slurm",)
REFUSED = re.compile(r": (?!done$)")


class Claims:
    """Collects what does not hold."""

    def __init__(self, name: str):
        self.name, self.failures, self.notes = name, [], []

    def holds(self, holds: object, claim: str, *found: object) -> bool:
        if not holds:
            self.failures.append(f"{claim}{': ' if found else ''}{' '.join(str(part) for part in found)[:1500]}")
        return bool(holds)


class Attack(typing.NamedTuple):
    """`settings(stage)`: more settings of the mesh file. `judge(stage, outcome, claims)`: claims beyond those of all attacks.
    `before(stage)`: remembers what the judge compares with."""
    play: str
    settings: typing.Callable[[Stage], dict] = lambda stage: {}
    judge: typing.Callable[[Stage, Outcome, Claims], None] = lambda stage, outcome, claims: None
    before: typing.Callable[[Stage], object] = lambda stage: None
    executors: tuple[str, ...] = BOTH


def at_secret(stage: Stage) -> dict:
    return {"target": stage.secret, "database": stage.state / "hydroprint.db"}


def at_artifacts_of_another(stage: Stage) -> dict:
    return {"target": stage.state / "artifacts" / stage.first_job.split("/")[1]}


def all_folders(stage: Stage) -> dict:
    folders = [stage.state, stage.shared, stage.installation]
    folders += [stage.state / name for name in ("artifacts", "assets", "runs", "uploads")]
    return {f"path{i}": folder for i, folder in enumerate(path for path in folders if path.is_dir())}


def all_files(stage: Stage) -> dict:
    files = [path for path in stage.lasting_files() if path.exists()][:60]
    return {f"path{i}": path for i, path in enumerate(files)}


def failed(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    claims.holds(outcome.job["state"] == "FAILED", "the attacker's job fails", outcome.job["state"])


def failed_unless_refused(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    refused = outcome.attempts and all(REFUSED.search(line) for line in outcome.attempts.splitlines())
    if not refused:
        failed(stage, outcome, claims)


def few_processes(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    claims.holds(outcome.processes <= MOST_WORKERS, f"at most {MOST_WORKERS} workers run at once", outcome.processes)


def little_memory(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    claims.holds(outcome.rss <= MOST_MEMORY_BYTES, f"workers hold at most {MOST_MEMORY_BYTES >> 20} MiB",
                 outcome.rss >> 20, "MiB")
    few_processes(stage, outcome, claims)
    claims.notes.append(f"{outcome.rss >> 20} MiB")


def nothing_seen(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    claims.holds("event seen: done" not in outcome.attempts, "the attacker sees no events of other people's files")


def rights_unchanged(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    for name, value in stage.rights().items():
        claims.holds(value == stage.rights_before[name], f"the daemon's {name} stays",
                     stage.rights_before[name], "->", value)


def remember_rights(stage: Stage) -> None:
    stage.rights_before = stage.rights()


def none_shared(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    left = stages.shared_memory(SHARED_BYTES) - stage.segments_before
    for segment in left:
        stages.remove_shared_memory(segment)
    claims.holds(not left, "shared memory does not outlive the job", sorted(left))


def remember_segments(stage: Stage) -> None:
    stage.segments_before = stages.shared_memory(SHARED_BYTES)


def little_read(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    amount = stage.bytes_read() - stage.read_before
    claims.holds(amount < MOST_READ_BYTES, "the daemon does not read everything", amount >> 20, "MiB read")


def little_read_and_failed(stage: Stage, outcome: Outcome, claims: Claims) -> None:
    failed_unless_refused(stage, outcome, claims)
    little_read(stage, outcome, claims)


def remember_reading(stage: Stage) -> None:
    stage.read_before = stage.bytes_read()


# The rows of issue 49 that are a job's: name, what is played and judged.
ATTACKS = {
    "link-out": Attack("link-out", at_secret, failed_unless_refused),
    "link-out-to-artifacts": Attack("link-out", at_artifacts_of_another, failed_unless_refused),
    "link-work": Attack("link-work", lambda stage: {"target": stage.secret_out.parent}, failed_unless_refused),
    "link-files": Attack("link-files", at_secret),
    "link-report": Attack("link-report", at_secret),
    "hard-links": Attack("hard-links", at_secret),
    "read": Attack("read", at_secret, executors=LOCAL),
    "special": Attack("special"),
    "progress-link": Attack("progress", lambda stage: at_secret(stage) | {"as": "link"}, executors=SLURM),
    "progress-fifo": Attack("progress", lambda stage: {"as": "fifo"}, executors=SLURM),
    "progress-device": Attack("progress", lambda stage: {"as": "device"}, little_read, remember_reading, executors=SLURM),
    "progress-sparse": Attack("progress", lambda stage: {"as": "sparse", "bytes": SPARSE_BYTES}, little_read,
                              remember_reading, executors=SLURM),
    "answer": Attack("answer", lambda stage: {"bytes": SPARSE_BYTES}, little_read, remember_reading),
    "deep": Attack("deep"),
    "swap": Attack("swap", at_secret),
    "owner": Attack("owner"),
    "socketpair": Attack("socketpair"),
    "notify": Attack("notify"),
    "kill": Attack("kill", executors=LOCAL),
    "modes": Attack("modes", all_files),
    "priorities": Attack("priorities", judge=rights_unchanged, before=remember_rights, executors=LOCAL),
    "watch": Attack("watch", lambda stage: all_folders(stage) | {"ms": 800}, nothing_seen, executors=LOCAL),
    "sparse": Attack("sparse", lambda stage: {"count": SPARSE_FILES, "bytes": SPARSE_BYTES},
                     little_read_and_failed, remember_reading),
    "memory": Attack("memory", lambda stage: {"count": 4, "bytes": 600 * MIB, "ms": 1000}, little_memory, executors=LOCAL),
    "forks": Attack("forks", lambda stage: {"count": 400, "program": stage.worker}, few_processes, executors=LOCAL),
    "outlive": Attack("outlive", judge=few_processes),
    "shared": Attack("shared", lambda stage: {"bytes": SHARED_BYTES}, none_shared, remember_segments, LOCAL),
}


def has_reason(job: dict) -> bool:
    error = job.get("error", {})
    return (job.get("state") == "FAILED" and error.get("reason", "") not in ("", "ERROR_REASON_UNSPECIFIED") and
            error.get("message", "") != "")


def judge_attack(stage: Stage, name: str, claims: Claims) -> None:
    attack = ATTACKS[name]
    parent = {} if stage.executor == "local" else {"parent": 0}  # on a cluster, the parent is the attacker's own script
    settings = attack.settings(stage) | parent
    attack.before(stage)
    marks, pid, secret_files = stage.marks(), stage.pid, stage.secret_files()
    outcome = stage.play(attack.play, **settings)
    if not claims.holds(outcome, "the daemon lives", f"status {stage.process.poll()}; its log ends with\n{stage.log()[-600:]}"):
        return
    claims.holds(stage.is_healthy() and stage.pid == pid, "the daemon lives and /healthz answers")
    state = outcome.job["state"]
    claims.holds(state == "SUCCEEDED" or has_reason(outcome.job), "the attacker's job ends, with a reason if it fails", state,
                 outcome.job.get("error", ""))
    claims.holds(outcome.other["state"] == "SUCCEEDED" and outcome.other["right"], "the other user's job succeeds",
                 outcome.other["state"], outcome.other.get("error", ""), sorted(outcome.other_artifacts))
    leaks = stage.leaks(outcome)
    claims.holds(not leaks, "nothing secret is in the attacker's results", leaks)
    claims.holds(stage.secret_files() == secret_files, "the secret folder has the same files", stage.secret_files())
    changed = {path: mark for path, mark in stage.marks().items() if marks.get(path, mark) != mark}
    claims.holds(not changed, "modes, owners, attributes and times of files stay", f"{len(changed)} changed, among them",
                 *(f"\n            {path}: {marks[path]} -> {mark}" for path, mark in list(changed.items())[:4]))
    claims.holds(stage.secrets[1].encode() in stage.artifacts(stage.first_job, "bob").get("film.png", b""),
                 "earlier results of the other user stay")
    claims.holds(stages.wait_until(lambda: not stage.workers(), 5), "no worker outlives its job", stage.workers())
    stage.end_workers()
    attack.judge(stage, outcome, claims)
    claims.notes.append(f"{state} {outcome.reason} {outcome.job.get('error', {}).get('message', '')}"[:100].strip())


def open_stage(programs: pathlib.Path, executor: str, **more) -> Stage:
    """A daemon that serves, with accounts and a finished job of the other user."""
    if "landlock" not in more and stages.landlock_version() > DEBIAN_12_LANDLOCK:
        more["landlock"] = DEBIAN_12_LANDLOCK
    stage = Stage(programs, executor, **more)
    try:
        stage.start()
        stage.add_people()
        stage.secrets.append("of-the-other-user-" + stage.secrets[0][:16])
        stage.first_job = stage.submit("bob", "none", private=stage.secrets[1])
        jobs = stage.wait_for({stage.first_job: "bob"})
        if not jobs or jobs[stage.first_job]["state"] != "SUCCEEDED":
            raise NotStarted(f"a sound job does not succeed: {jobs}\n{stage.log()[-2000:]}")
    except BaseException:
        stage.close()
        raise
    return stage


def obeys_sigterm(stage: Stage, claims: Claims) -> None:
    seconds = stage.terminate()
    if claims.holds(seconds is not None, f"the daemon obeys SIGTERM within {stages.STOP_S} s"):
        claims.holds(stage.process.returncode == 0, "it ends with status 0", stage.process.returncode)


def wait_for_worker(stage: Stage, claims: Claims) -> None:
    """Waits until the worker has ended and the daemon is busy with its results. The worker pauses, so that it is seen."""
    time.sleep(0.1)  # any workers that answered --version have ended
    claims.holds(stages.wait_until(lambda: stage.workers(), 30, 0.01), "the worker starts")
    claims.holds(stages.wait_until(lambda: not stage.workers(), 30, 0.01), "the worker ends")
    time.sleep(0.3)


def judge_stop(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """SIGTERM while the daemon publishes 400 sparse files; after the next start the job ends with its reason."""
    with open_stage(programs, executor) as stage:
        begin = stage.bytes_read()
        job = stage.submit("mallory", "sparse", count=SPARSE_FILES, bytes=SPARSE_BYTES, ms=500)
        wait_for_worker(stage, claims)
        claims.holds(stage.bytes_read() - begin < MOST_READ_BYTES, "nothing large is read before SIGTERM",
                     (stage.bytes_read() - begin) >> 20, "MiB")
        obeys_sigterm(stage, claims)
        if stage.lives:
            return
        stage.start()
        jobs = stage.wait_for({job: "mallory"})
        claims.holds(has_reason(jobs.get(job, {})), "the job ends with a reason", jobs)
        claims.holds(stage.bytes_read() < MOST_READ_BYTES, "nothing large is read after the restart",
                     stage.bytes_read() >> 20, "MiB")
        claims.notes.append(jobs.get(job, {}).get("error", {}).get("reason", ""))
        obeys_sigterm(stage, claims)


def judge_large_file(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """SIGTERM while the daemon publishes one file of the size that is allowed."""
    with open_stage(programs, executor) as stage:
        stage.submit("mallory", "sparse", count=1, bytes=SPARSE_BYTES, ms=500)
        wait_for_worker(stage, claims)
        obeys_sigterm(stage, claims)


def can_mount() -> bool:
    as_root = [] if os.geteuid() == 0 else ["--map-root-user"]
    command = ["unshare", "--mount", *as_root, "sh", "-c", "mount -t tmpfs tmpfs /mnt"]
    return shutil.which("unshare") is not None and subprocess.run(command, capture_output=True).returncode == 0


def judge_disk(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """The attacker fills a small disk of the state folder, while another user's job writes its results there."""
    if not can_mount():
        claims.notes.append("not played: this user cannot mount a small disk")
        return
    more = {"disk_mib": DISK_MIB, "settings": f"file_mib = {DISK_FILE_MIB}", "store": f"min_free_mib = {DISK_MIN_FREE_MIB}"}
    with open_stage(programs, executor, **more) as stage:
        free = lambda: shutil.disk_usage(stage.seen_state).free  # noqa: E731
        before, least, token = free(), free(), "of-the-other-user-too"
        attack = stage.submit("mallory", "disk", bytes=2048 * MIB, file_bytes=DISK_FILE_MIB * MIB, ms=60)
        other = stage.submit("bob", "none", ms=3500, private=token)
        found, end = {}, time.monotonic() + stages.JOB_S
        while stage.lives and time.monotonic() < end:
            least = min(least, free())
            found = {name: stage.job(name, who) for name, who in ((attack, "mallory"), (other, "bob"))}
            if all(job["state"] in stages.FINISHED for job in found.values()):
                break
            time.sleep(0.05)
        if not claims.holds(stage.lives and stage.is_healthy(), "the daemon lives"):
            return
        job, sound = found[attack], found[other]
        claims.holds(sound["state"] == "SUCCEEDED" and token.encode() in stage.artifacts(other, "bob").get("film.png", b""),
                     "the other user's job succeeds", sound["state"], sound.get("error", ""))
        claims.holds(has_reason(job), "the attacker's job ends with a reason", job["state"], job.get("error", ""))
        claims.holds(least > DISK_MIN_FREE_MIB * MIB, f"{DISK_MIN_FREE_MIB} MiB stay free", least >> 20)
        claims.holds(stages.wait_until(lambda: free() > before - 48 * MIB, 10), "the disk is freed after the job",
                     before >> 20, "->", free() >> 20, "MiB free")
        claims.notes.append(f"{least >> 20} of {before >> 20} MiB stayed free, {job.get('error', {}).get('reason')}")
        obeys_sigterm(stage, claims)


def refuses(stage: Stage, words: list[str], claims: Claims, what: str) -> None:
    """The daemon must end by itself, with these words."""
    try:
        stage.start()
    except NotStarted as error:
        text = str(error)
        claims.holds(stage.process.poll() is not None and stage.process.returncode > 0,
                     f"{what}: the daemon ends with a status", stage.process.poll())
        for word in words:
            claims.holds(word.lower() in text.lower(), f"{what}: the message names {word}", text[-600:])
    else:
        claims.holds(False, f"{what}: the daemon does not start", stage.log()[-300:])
        obeys_sigterm(stage, claims)


def admin_check(stage: Stage) -> tuple[int, str]:
    command = [stage.programs / "hydroprint", "admin", "check", "--state-dir", stage.state, "--config", stage.config]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=90,
                          env=stage.environment, stdin=subprocess.DEVNULL, check=False)
    return done.returncode, done.stdout + done.stderr


def foreign_folder(folder: pathlib.Path, _: pathlib.Path) -> None:
    folder.mkdir()
    folder.chmod(0o777)
    os.chown(folder, OTHER_USER, OTHER_USER)


def foreign_private_folder(folder: pathlib.Path, _: pathlib.Path) -> None:
    folder.mkdir(mode=0o700)
    os.chown(folder, OTHER_USER, OTHER_USER)


def open_folder(folder: pathlib.Path, _: pathlib.Path) -> None:
    folder.mkdir()
    folder.chmod(0o777)


def linked_folder(folder: pathlib.Path, other: pathlib.Path) -> None:
    other.mkdir(mode=0o700)
    folder.symlink_to(other)


def own_folder(folder: pathlib.Path, _: pathlib.Path) -> None:
    folder.mkdir(mode=0o700)


def plain_file(folder: pathlib.Path, _: pathlib.Path) -> None:
    folder.write_text("")


def judge_installation(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """Installation folders that another user can exchange, in a shared folder like /tmp."""
    cases = {"folder of another user, 0777": foreign_folder, "folder of another user, 0700": foreign_private_folder,
             "folder with mode 0777": open_folder, "link": linked_folder, "file": plain_file}
    with Stage(programs, "slurm") as stage:
        stage.state.mkdir(mode=0o700)
        stage.shared.chmod(0o1777)
        own_folder(stage.installation, stage.base)
        status, text = admin_check(stage)
        claims.holds(status == 0, "own folder, 0700: hydroprint admin check has no FAULT", status, text)
        stage.start()
        obeys_sigterm(stage, claims)
    for what, make in cases.items():
        if os.geteuid() != 0 and make in (foreign_folder, foreign_private_folder):
            claims.notes.append(f"{what}: only root can play it")
            continue
        with Stage(programs, "slurm") as stage:
            stage.state.mkdir(mode=0o700)
            stage.shared.chmod(0o1777)
            other = stage.base / "other"
            make(stage.installation, other)
            before = stage.installation.lstat()
            status, text = admin_check(stage)
            faults = [line for line in text.splitlines() if "FAULT" in line and str(stage.installation) in line]
            claims.holds(faults and status == 4, f"{what}: hydroprint admin check has a FAULT that names it", status, text)
            refuses(stage, [str(stage.installation)], claims, what)
            after = stage.installation.lstat()
            claims.holds((before.st_mode, before.st_uid, before.st_ino) == (after.st_mode, after.st_uid, after.st_ino),
                         f"{what}: it stays as it was")
            holds = other if other.exists() else stage.installation
            claims.holds(not holds.is_dir() or not list(holds.iterdir()), f"{what}: nothing is written into it")


def judge_landlock(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """A kernel without Landlock is refused unless the configuration allows it."""
    with Stage(programs, executor, landlock=0) as stage:
        refuses(stage, ["landlock", "workers.allow_without_landlock"], claims, "without Landlock")
    with open_stage(programs, executor, landlock=0, settings="allow_without_landlock = true") as stage:
        claims.holds("landlock" in stage.log().lower(), "allowed without Landlock: the log says so", stage.log()[-600:])
        obeys_sigterm(stage, claims)


def judge_preview(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """The worker of previews has other descriptors, and no job."""
    with open_stage(programs, executor) as stage:
        for play in ("owner", "socketpair", "notify"):
            other = stage.submit("bob", "none", ms=600)
            mesh = stage.mesh("mallory", play, {"private": "nothing"})
            with contextlib.suppress(OSError):
                status, _ = stage.request("POST", "/v1/models:read", {"inspect": {"mesh": mesh}}, who="mallory")
                claims.holds(400 <= status < 600, f"{play}: the call ends with an error", status)
            jobs = stage.wait_for({other: "bob"})
            if not claims.holds(jobs and stage.is_healthy(), f"{play}: the daemon lives", stage.process.poll()):
                return
            claims.holds(jobs[other]["state"] == "SUCCEEDED", f"{play}: the other user's job succeeds", jobs[other])
        obeys_sigterm(stage, claims)


def judge_old_landlock(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """The first version of Landlock suffices, and keeps files of other folders from the worker."""
    with open_stage(programs, executor, landlock=1) as stage:
        for name in ("read", "hard-links"):
            judge_attack(stage, name, claims)
        obeys_sigterm(stage, claims)


def judge_unprivileged(programs: pathlib.Path, executor: str, claims: Claims) -> None:
    """The daemon of a user without rights, as it should be run: many short jobs, and some attacks."""
    command = [*stages.as_user(OTHER_USER), "test", "-x", str(programs / "hydroprintd")]
    if os.geteuid() != 0 or subprocess.run(command, check=False).returncode != 0:
        claims.notes.append("not played: only root can, if other users can read BIN_DIR; the other attacks are as this user")
        return
    with open_stage(programs, executor, user=OTHER_USER) as stage:
        for _ in range(SHORT_JOBS):
            jobs = stage.wait_for({stage.submit(who, "none", ms=30): who for who in ("bob", "mallory")})
            if not claims.holds(jobs and all(job["state"] == "SUCCEEDED" for job in jobs.values()), "sound jobs succeed",
                                [(job["state"], job.get("error", "")) for job in jobs.values()]):
                break
        for name in ("link-out", "special", "owner", "modes"):
            judge_attack(stage, name, claims)
        obeys_sigterm(stage, claims)


# Those that need a daemon of their own.
SCENARIOS = {
    "local/stop": judge_stop, "local/large-file": judge_large_file, "local/disk": judge_disk, "local/preview": judge_preview,
    "local/unprivileged": judge_unprivileged, "local/no-landlock": judge_landlock, "local/landlock-1": judge_old_landlock,
    "slurm/stop": judge_stop, "slurm/installation": judge_installation,
}


def all_names() -> list[str]:
    return ([f"{executor}/{name}" for executor in ("local", "slurm") for name, attack in ATTACKS.items()
             if executor in attack.executors] + list(SCENARIOS))


def selected(wanted: list[str]) -> list[str]:
    names = all_names()
    for word in wanted:
        if not any(word in (name, *name.split("/")) for name in names):
            sys.exit(f"worker_test.py: there is no attack {word}; --list shows all")
    return [name for name in names if not wanted or any(word in (name, *name.split("/")) for word in wanted)]


class Runner(threading.Thread):
    """Plays the attacks of one executor on one daemon, which is replaced if an attack has ended or changed it."""

    def __init__(self, programs: pathlib.Path, names: list[str]):
        super().__init__(daemon=True)
        self.programs, self.names = programs, names
        self.stage: Stage | None = None
        self.failures, self.error = 0, ""

    def run(self) -> None:
        try:
            for name in self.names:
                self.play(name)
            self.finish_stage()
        except NotStarted as error:
            self.error = f"the daemon does not start:\n{error}"
        except Exception:  # in a thread, it would otherwise be lost
            self.error = traceback.format_exc()

    def report(self, claims: Claims, seconds: float) -> None:
        lines = [f"{'FAILED' if claims.failures else 'ok':6}  {claims.name:27} {seconds:5.1f} s  {'; '.join(claims.notes)}",
                 *(f"        {failure}" for failure in claims.failures)]
        print("\n".join(line.rstrip() for line in lines), flush=True)
        self.failures += bool(claims.failures)

    def replace_stage(self, stage: Stage | None) -> None:
        if self.stage:
            self.stage.close()
        self.stage = stage

    def finish_stage(self) -> None:
        """Ends the current daemon, which must obey."""
        if self.stage and self.stage.lives:
            claims, begin = Claims(f"{self.stage.executor}/SIGTERM"), time.monotonic()
            obeys_sigterm(self.stage, claims)
            claims.holds(stages.wait_until(lambda: not self.stage.workers(), 5), "no worker outlives the daemon")
            self.report(claims, time.monotonic() - begin)
        self.replace_stage(None)

    def play(self, name: str) -> None:
        executor, attack = name.split("/")
        claims, begin = Claims(name), time.monotonic()
        try:
            if name in SCENARIOS:
                self.finish_stage()
                SCENARIOS[name](self.programs, executor, claims)
            else:
                if self.stage and not self.stage.is_healthy():
                    self.finish_stage()
                if not self.stage:
                    self.replace_stage(open_stage(self.programs, executor))
                judge_attack(self.stage, attack, claims)
        except NotStarted as error:
            if name not in SCENARIOS:
                raise
            claims.holds(False, "the daemon starts", error)
        except (stages.Refused, OSError, subprocess.TimeoutExpired) as error:
            claims.holds(False, "the daemon answers", repr(error))
        self.report(claims, time.monotonic() - begin)
        if claims.failures:  # its files or rights may be changed
            self.replace_stage(None)


def main() -> int:
    if "--list" in sys.argv:
        print("\n".join(all_names()))
        return 0
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", metavar="BIN_DIR", type=pathlib.Path)
    parser.add_argument("names", metavar="NAME", nargs="*")
    options = parser.parse_args()
    names, programs = selected(options.names), options.programs.resolve()
    if stages.landlock_version() == 0:
        print("this kernel has no Landlock, so workers cannot be confined")
        return 77
    stages.compiled()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that everything is cleaned up
    runners = [Runner(programs, [name for name in names if name.startswith(executor)]) for executor in BOTH]
    try:
        for runner in runners:  # at the same time, because they mostly wait
            runner.start()
        for runner in runners:
            runner.join()
    finally:
        stages.close_all()
    failures = sum(runner.failures for runner in runners)
    print(f"{len(names)} attacks, {failures} failed")
    for runner in runners:
        print(runner.error, end="", file=sys.stderr)
    return 2 if any(runner.error for runner in runners) else 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
