"""Compares a daemon with 20,000 finished jobs with one without any: submissions, and lists of 50 jobs.

Prints one JSON object per row. Usage: long_store.py FOLDER_OF_PROGRAMS [--quick]
"""
import asyncio
import contextlib
import json
import pathlib
import sqlite3
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import load
import programs

JOBS, EVENTS, ARTIFACTS = 20_000, 3, 8
BATCH = 20
CONFIGURATION = "[queue]\nmax_jobs_per_owner = 0\n"


@contextlib.contextmanager
def daemon(bin_folder, folder):
    (folder / "hydroprintd.toml").write_text(CONFIGURATION)
    child, found = programs.start(
        [pathlib.Path(bin_folder) / "hydroprintd", "--grpc", "127.0.0.1:0", "--http", "127.0.0.1:0",
         "--config", folder / "hydroprintd.toml", "--state-dir", folder / "state"], r"\bgrpc=\S+ http=(\S+:\d+)")
    try:
        yield found[1]
    finally:
        child.terminate()
        child.wait()


def numbers(count):
    return f"(WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i+1 FROM n WHERE i<{count}) SELECT i FROM n)"


def fill(path):
    """Copies the only job of a store, as jobs of the same owner that have just succeeded."""
    changed = {"digest": "printf('%064x', i)", "state": "5", "keep_from_ms": "create_ms", "end_ms": "create_ms"}
    with contextlib.closing(sqlite3.connect(path)) as store, store:
        columns = [row[1] for row in store.execute("PRAGMA table_info(jobs)") if row[1] != "id"]
        store.execute(f"INSERT INTO jobs({','.join(columns)}) SELECT {','.join(changed.get(c, c) for c in columns)} "
                      f"FROM jobs, {numbers(JOBS)} WHERE id=1")
        store.execute("INSERT INTO events(job, time_ms, kind, state, fraction, phase, phase_fraction, eta_ms, message) "
                      f"SELECT id, create_ms, 1, 5, 1, '', 0, 0, '' FROM jobs, {numbers(EVENTS)} WHERE id>1")
        store.execute("INSERT INTO artifacts SELECT id, printf('film-%d.png', i), 1000, printf('%064x', id), 'image/png' "
                      f"FROM jobs, {numbers(ARTIFACTS)} WHERE id>1")
        store.execute("INSERT INTO job_inputs SELECT jobs.id, name, sha256 FROM jobs, job_inputs WHERE job=1 AND jobs.id>1")


async def submit(connection, asset, number):
    spec = {"mesh": {"name": "m.obj", "asset": asset}, "depthMm": 1 + number / 1000}
    return await connection.ask("POST", "/v1/jobs", {"simulate": spec})


async def prepare(address):
    """Pauses the queue and submits a job. Returns the job and the asset of its mesh."""
    asset = await load.upload(address, load.File(1, load.PIECE_BYTES))
    async with load.Connection(address) as connection:
        await connection.ask("POST", "/v1/queue:pause", {"reason": "measured"})
        return await submit(connection, asset, 0), asset


async def submission_s(connection, asset, start):
    """Returns the mean time of a submission; the jobs are cancelled afterwards."""
    began = time.monotonic()
    jobs = [await submit(connection, asset, start + i) for i in range(BATCH)]
    seconds = time.monotonic() - began
    for job in jobs:
        await connection.ask("POST", f"/v1/{job['name']}:cancel", {})
    return seconds / BATCH


async def list_s(connection, query):
    began = time.monotonic()
    for _ in range(BATCH):
        found = await connection.ask("GET", "/v1/jobs?pageSize=50" + query)
        if len(found["jobs"]) != 50:
            raise RuntimeError(f"{query}: {len(found['jobs'])} jobs instead of 50")
    return (time.monotonic() - began) / BATCH


async def measure(addresses, owner, asset, rounds):
    async with load.Connection(addresses[0]) as empty, load.Connection(addresses[1]) as filled:
        times = [(await submission_s(empty, asset, start), await submission_s(filled, asset, start))
                 for start in range(0, rounds * BATCH, BATCH)]
        print(json.dumps({"row": "store-submissions", "share": statistics.median(a / b for a, b in times),
                          "empty_s": statistics.median(a for a, _ in times),
                          "filled_s": statistics.median(b for _, b in times)}), flush=True)
        # Deep in the history of the filled store; the newest jobs of the other one.
        tokens = (rounds * BATCH, JOBS // 2)
        factors = {}
        for name, query in (("all", ""), ("own", f"&owner={owner}"), ("ended", "&states=CANCELLED&states=SUCCEEDED"),
                            ("old", "&pageToken={}"), ("own_old", f"&owner={owner}" + "&pageToken={}")):
            pairs = [(await list_s(empty, query.format(tokens[0])), await list_s(filled, query.format(tokens[1])))
                     for _ in range(rounds)]
            factors[name] = statistics.median(b / a for a, b in pairs)
        print(json.dumps({"row": "store-lists", "times": max(factors.values())} | factors), flush=True)


def main():
    rounds = 5 if "--quick" in sys.argv else 20
    with tempfile.TemporaryDirectory() as name:
        folders = [pathlib.Path(name) / kind for kind in ("empty", "filled")]
        for folder in folders:
            folder.mkdir()
        with daemon(sys.argv[1], folders[1]) as address:
            asyncio.run(prepare(address))
        fill(folders[1] / "state/hydroprint.db")
        with daemon(sys.argv[1], folders[0]) as empty, daemon(sys.argv[1], folders[1]) as filled:
            job, asset = asyncio.run(prepare(empty))
            asyncio.run(measure((empty, filled), job["owner"], asset, rounds))


if __name__ == "__main__":
    main()
