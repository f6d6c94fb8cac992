#!/usr/bin/env python3
"""A real Slurm on loopback, for tests: munged, slurmctld and one slurmd per node, all below one folder.

  slurm.py check                                     what is not installed (exit 3)
  slurm.py start FOLDER [--nodes N] [--cpus N] [--while-pid PID]
                                                     prints conf, munge_socket and pids as JSON when all nodes are idle
  slurm.py kill FOLDER DAEMON [--with-jobs]          SIGKILL; DAEMON: munged, slurmctld, node1, node2, ...
  slurm.py restart FOLDER DAEMON                     SIGKILL, starts it again, waits until it answers
  slurm.py pause|resume FOLDER DAEMON                SIGSTOP, SIGCONT
  slurm.py stop FOLDER                               ends daemons and jobs

A process called the keeper starts the daemons, which write FOLDER/NAME.pid. It starts each daemon without such a file.
All jobs are its descendants, so that it finds and ends them. It ends everything when the process PID ends.
The programs of Slurm find this one by the environment SLURM_CONF=FOLDER/slurm.conf. Paths of sockets are limited, so
FOLDER has at most 90 characters.
"""

import argparse
import ctypes
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

from folder import command, ports_of, write_files
from processes import descendants, runs, send, title

PACKAGES = {'munged': 'munge', 'slurmctld': 'slurmctld', 'slurmd': 'slurmd', 'sbatch': 'slurm-client'}
PATH = os.environ.get('PATH', '') + ':/usr/sbin:/usr/bin:/sbin:/bin'
PR_SET_CHILD_SUBREAPER = 36  # linux/prctl.h
START_S = 30


def missing():
    return [package for program, package in PACKAGES.items() if not shutil.which(program, path=PATH)]


def wait_until(condition, what, limit_s=START_S):
    end = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > end:
            sys.exit(f'slurm.py: after {limit_s} s still not: {what}')
        time.sleep(0.02)


def pid_of(folder, name):
    """The process of a daemon; 0: it was not started."""
    try:
        return int((folder / f'{name}.pid').read_text() or 0)
    except FileNotFoundError:
        return 0


def started(folder, name):
    return pid_of(folder, name) or sys.exit(f'slurm.py: {name} was not started in {folder}')


def steps_of(folder, node):
    """The slurmstepd of each job on this node. Each has a socket NODE_JOB.STEP in the node's folder."""
    jobs = {file.name.split('_')[1].split('.')[0] for file in (folder / 'spool' / node).glob(f'{node}_*.*')}
    for pid in descendants(pid_of(folder, 'keeper')):
        step = re.match(r'slurmstepd: \[(\d+)\.', title(pid))
        if step and step[1] in jobs:
            yield pid


# The keeper.

def start_daemon(folder, name):
    if name == 'munged':
        (folder / 'munge.socket').unlink(missing_ok=True)
    with open(folder / f'{name}.out', 'ab') as out:
        daemon = subprocess.Popen(command(folder, name), stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=folder,
                                  env={'PATH': PATH}, start_new_session=True)
    if name == 'munged':  # the others need it
        wait_until((folder / 'munge.socket').exists, 'munged has a socket')
    (folder / f'{name}.pid').write_text(str(daemon.pid))


def reap():
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass


def end_descendants():
    while left := descendants(os.getpid()):
        for pid in left:
            send(pid, signal.SIGKILL)
        time.sleep(0.01)
        reap()


def keep(folder, while_pid):
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    names = ['munged'] + list(ports_of(folder))
    try:
        while not while_pid or runs(while_pid):
            for name in names:
                if not (folder / f'{name}.pid').exists():
                    start_daemon(folder, name)
            reap()
            time.sleep(0.05)
    finally:
        end_descendants()


# Commands.

def answers(folder, name):
    if name == 'munged':
        return (folder / 'munge.socket').exists()
    with socket.socket() as probe:
        return not probe.connect_ex(('127.0.0.1', ports_of(folder)[name]))


def states(folder):
    env = {'PATH': PATH, 'SLURM_CONF': f'{folder}/slurm.conf'}
    answer = subprocess.run(['sinfo', '-h', '-N', '-o', '%N %t'], env=env, capture_output=True, text=True, check=False)
    return dict(line.split() for line in answer.stdout.splitlines())


def start(folder, options):
    if (folder / 'slurm.conf').exists():
        sys.exit(f'slurm.py: {folder} was used before')
    write_files(folder, options.nodes, options.cpus)
    with open(folder / 'keeper.out', 'wb') as out:
        keeper = subprocess.Popen([sys.executable, __file__, 'keep', folder, '--while-pid', str(options.while_pid)],
                                  stdin=subprocess.DEVNULL, stdout=out, stderr=out, start_new_session=True)
    (folder / 'keeper.pid').write_text(str(keeper.pid))
    names = list(ports_of(folder))
    try:
        wait_until(lambda: all(answers(folder, name) for name in names), f'the daemons answer, see {folder}/*.out')
        idle = ['idle'] * options.nodes
        wait_until(lambda: [*states(folder).values()] == idle, f'all nodes are idle, see {folder}/*.log')
    except SystemExit:
        stop(folder, options)
        raise
    pids = {name: pid_of(folder, name) for name in ['keeper', 'munged'] + names}
    print(json.dumps({'conf': f'{folder}/slurm.conf', 'munge_socket': f'{folder}/munge.socket', 'pids': pids}))


def stop(folder, _):
    keeper = started(folder, 'keeper')
    everything = [keeper] + descendants(keeper) + [pid_of(folder, name) for name in ['munged'] + list(ports_of(folder))]
    send(keeper, signal.SIGTERM)
    wait_until(lambda: not any(runs(pid) for pid in everything), f'{everything} have ended')


def kill(folder, options):
    daemon = started(folder, options.daemon)
    steps = list(steps_of(folder, options.daemon)) if options.with_jobs else []
    jobs = [pid for step in steps for pid in descendants(step)]
    for pid in [daemon] + steps + jobs:
        send(pid, signal.SIGKILL)
    wait_until(lambda: not runs(daemon), f'{options.daemon} has ended')


def restart(folder, options):
    options.with_jobs = False
    kill(folder, options)
    (folder / f'{options.daemon}.pid').unlink()
    wait_until(lambda: pid_of(folder, options.daemon) and answers(folder, options.daemon), f'{options.daemon} answers')


def pause(folder, options):
    send(started(folder, options.daemon), signal.SIGSTOP)


def resume(folder, options):
    send(started(folder, options.daemon), signal.SIGCONT)


def check():
    if packages := missing():
        print('not installed: ' + ' '.join(packages))
        sys.exit(3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('command', choices=['check', 'start', 'stop', 'kill', 'restart', 'pause', 'resume', 'keep'])
    parser.add_argument('folder', nargs='?', type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument('daemon', nargs='?')
    parser.add_argument('--nodes', type=int, default=2)
    parser.add_argument('--cpus', type=int, default=4, help='of each node')
    parser.add_argument('--while-pid', type=int, default=0, help='0: until stop')
    parser.add_argument('--with-jobs', action='store_true', help='as if the node lost power')
    options = parser.parse_args()
    if options.command == 'check':
        check()
    elif options.command == 'keep':
        keep(options.folder, options.while_pid)
    else:
        globals()[options.command](options.folder, options)


if __name__ == '__main__':
    main()
