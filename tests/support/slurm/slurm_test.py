#!/usr/bin/env python3
"""Tests of slurm.py, the Slurm on loopback that other tests use. Skipped (exit 77) without the packages of Slurm."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

import processes
import slurm

PROGRAM = pathlib.Path(__file__).with_name('slurm.py')
SCRIPT = '#!/bin/sh\nsleep 600 & echo $$ $! > "$1.begun" && mv "$1.begun" "$1"\nwait\n'


def call(*arguments, **options):
    return subprocess.run([sys.executable, PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False,
                          **options)


class Slurm(unittest.TestCase):

    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.folder = pathlib.Path(self.place.name, 'slurm')
        self.folder.mkdir()

    def start(self, *options):
        self.addCleanup(call, 'stop', self.folder)
        answer = call('start', self.folder, *options)
        self.assertEqual(0, answer.returncode, answer.stderr)
        return json.loads(answer.stdout)

    def ask(self, *command):
        env = {'PATH': os.environ['PATH'], 'SLURM_CONF': str(self.folder / 'slurm.conf')}
        answer = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
        self.assertEqual(0, answer.returncode, answer.stderr)
        return answer.stdout.strip()

    def wait_until(self, condition):
        end = time.monotonic() + 30
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def submit(self, name):
        """Submits a script that runs for long. Its job, its shell and its child, once it runs."""
        script, begun = self.folder / f'{name}.sh', self.folder / f'{name}.begun'
        script.write_text(SCRIPT)
        job = self.ask('sbatch', '--parsable', f'--job-name={name}', '--output=/dev/null', script, begun)
        self.wait_until(begun.exists)
        return job, [int(pid) for pid in begun.read_text().split()]

    def state(self, job):
        return self.ask('squeue', '--noheader', '--states=all', f'--jobs={job}', '--format=%T')

    def test_a_job_outlives_the_controller_and_stop_leaves_nothing(self):
        pids = self.start()['pids']
        self.assertEqual({'keeper', 'munged', 'slurmctld', 'node1', 'node2'}, set(pids))
        job, begun = self.submit('long')
        # A start by the backfill scheduler is not written to the state until something else changes. If slurmctld is
        # killed before, it starts the job a second time.
        self.ask('scontrol', 'update', f'JobId={job}', 'Comment=started')
        saved = self.folder / 'state' / 'job_state'
        self.wait_until(lambda: b'started' in saved.read_bytes())

        self.assertEqual(0, call('kill', self.folder, 'slurmctld').returncode)
        self.assertFalse(processes.runs(pids['slurmctld']))
        self.assertTrue(all(map(processes.runs, begun)))
        self.assertEqual(0, call('restart', self.folder, 'slurmctld').returncode)
        self.assertEqual('RUNNING', self.state(job))

        self.assertEqual(0, call('stop', self.folder).returncode)
        self.assertFalse([pid for pid in begun + list(pids.values()) if processes.runs(pid)])

    def test_a_node_is_killed_with_its_jobs_and_comes_back(self):
        pids = self.start('--nodes', '1', '--cpus', '1')['pids']
        _, begun = self.submit('lost')
        self.assertEqual(0, call('kill', self.folder, 'node1', '--with-jobs').returncode)
        self.wait_until(lambda: not any(map(processes.runs, begun + [pids['node1']])))
        self.assertEqual(0, call('restart', self.folder, 'node1').returncode)

    def test_everything_ends_with_the_process_that_needs_it(self):
        needing = subprocess.Popen(['sleep', '600'])
        pids = self.start('--while-pid', str(needing.pid))['pids']
        _, begun = self.submit('left')
        needing.kill()
        needing.wait()
        self.wait_until(lambda: not any(map(processes.runs, begun + list(pids.values()))))

    def test_a_folder_is_used_once(self):
        (self.folder / 'slurm.conf').touch()
        self.assertEqual(1, call('start', self.folder).returncode)

    def test_only_a_started_daemon_is_killed(self):
        self.assertEqual(1, call('kill', self.folder, 'slurmctld').returncode)
        self.assertEqual(1, call('stop', self.folder).returncode)

    def test_missing_packages_are_named(self):
        with unittest.mock.patch('slurm.PATH', str(self.folder)):
            self.assertEqual(['munge', 'slurmctld', 'slurmd', 'slurm-client'], slurm.missing())


if __name__ == '__main__':
    if packages := slurm.missing():
        print('skipped, not installed: ' + ' '.join(packages))
        sys.exit(77)
    unittest.main()
