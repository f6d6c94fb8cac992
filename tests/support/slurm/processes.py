"""The processes of this machine, from /proc."""

import os
import pathlib


def processes():
    """Parent and state of each process."""
    found = {}
    for file in pathlib.Path('/proc').glob('[0-9]*/stat'):
        try:
            state, parent = file.read_text().rpartition(')')[2].split()[:2]
            found[int(file.parent.name)] = (int(parent), state)
        except (FileNotFoundError, ProcessLookupError):
            pass
    return found


def runs(pid):
    return processes().get(pid, (0, 'Z'))[1] != 'Z'


def descendants(pid):
    children = {}
    for child, (parent, _) in processes().items():
        children.setdefault(parent, []).append(child)
    found = [pid]
    for one in found:
        found += children.get(one, [])
    return found[1:]


def send(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:  # it has ended
        pass


def title(pid):
    """The command line; empty: it has ended."""
    try:
        return pathlib.Path(f'/proc/{pid}/cmdline').read_text()
    except (FileNotFoundError, ProcessLookupError):
        return ''
