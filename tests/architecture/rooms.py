"""Checks the rules of docs/architecture.md on file names and texts."""

import fnmatch
import posixpath
import re

LARGEST_ROOM = 35
CODE = ('.h', '.cpp')
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
# Rooms that must not include check.h: they keep the axis safe, and their threads must not throw.
WITHOUT_CHECKS = ('hardware/rig', 'hardware/drive')
# Matches the definition of a member at the beginning of a line, and captures its class: "Status JobStore::start(".
MEMBER = re.compile(r'^(?:[^\s#/}][^=;({}]*[\s&*])?(?:\w+::)*?(\w+)::(?:~?\w+|operator\S+)\(', re.MULTILINE)
ROW = re.compile(r'^\| `([^`]+)` \|([^|]*)\|', re.MULTILINE)


def room_of(path):
    """Returns the folder of a file or an included name; generated API code counts as `proto`."""
    folder = posixpath.dirname(path)
    return 'proto' if folder.startswith(('hydroprint/v1', 'google/')) else folder


def section(document, title):
    """Returns the text under a second-level heading; empty if the heading is missing."""
    return (document + f'\n## {title}\n').split(f'\n## {title}\n')[1].split('\n## ')[0]


def allowed_arrows(document):
    """Returns {room: rooms that it may include} from the table in the document."""
    table = {}
    for room, targets in ROW.findall(section(document, 'Allowed arrows')):
        if room in table:
            raise ValueError(f'docs/architecture.md lists {room} twice')
        table[room] = set(re.findall(r'`([^`]+)`', targets))
    return table


def headerless_files(document):
    """Returns the sources (names or patterns) that need no header of the same name, according to the document."""
    return set(re.findall(r'`([^`\s]+\.cpp)`', section(document, 'Sources without a header')))


def arrows(files):
    """Returns {(room, included room): [(file, included name)]} for {path: text}, without includes within a room."""
    found = {}
    for path, text in files.items():
        if path.endswith(CODE):
            for name in INCLUDE.findall(text):
                if room_of(name) != room_of(path):
                    found.setdefault((room_of(path), room_of(name)), []).append((path, name))
    return found


def cycle_in(table):
    """Returns the rooms of one include cycle, or an empty list."""
    state = {}

    def visit(room, path):
        state[room] = 'open'
        for target in sorted(table.get(room, ())):
            if state.get(target) == 'open':
                return path[path.index(target):] + [target]
            if target not in state:
                found = visit(target, path + [target])
                if found:
                    return found
        state[room] = 'done'
        return []

    for room in sorted(table):
        if room not in state:
            found = visit(room, [room])
            if found:
                return found
    return []


def violations(files, document):
    """Returns the violations of the rules, one line each.

    files: {path: text} of production code, paths from the root of the project.
    document: text of docs/architecture.md.
    """
    return (list(_arrow_violations(files, document)) + list(_size_violations(files)) +
            list(_header_violations(files, document)) + list(_member_violations(files)))


def _arrow_violations(files, document):
    table = allowed_arrows(document)
    found = arrows(files)
    for (room, target), places in sorted(found.items()):
        if room not in table:
            yield f'{room} is not in the table of docs/architecture.md'
        elif target.startswith('sim/worker') and not room.startswith('sim/worker'):
            yield f'{places[0][0]} includes {places[0][1]}: nothing outside sim/worker may include it'
        elif target != 'sim/base' and target not in table[room]:
            yield f'{places[0][0]} includes {places[0][1]}: no arrow from {room} to {target} in docs/architecture.md'
    for room, targets in sorted(table.items()):
        for target in sorted(targets):
            if (room, target) not in found:
                yield f'docs/architecture.md allows {room} to include {target}, but no file does'
    for (room, _), places in sorted(found.items()):
        for path, name in places:
            if name == 'sim/base/check.h' and room in WITHOUT_CHECKS:
                yield f'{path} includes {name}, but a failed check throws, and {room} must not throw'
    cycle = cycle_in(table)
    if cycle:
        yield 'docs/architecture.md allows a cycle: ' + ' -> '.join(cycle)


def _size_violations(files):
    sizes = {}
    for path in files:
        sizes[posixpath.dirname(path)] = sizes.get(posixpath.dirname(path), 0) + 1
    for folder, size in sorted(sizes.items()):
        if size > LARGEST_ROOM:
            yield f'{folder} has {size} files; at most {LARGEST_ROOM} are allowed'


def _header_violations(files, document):
    excused = headerless_files(document)
    for path in sorted(files):
        if not path.endswith('.cpp') or path[:-4] + '.h' in files or posixpath.basename(path) == 'main.cpp':
            continue
        if not any(fnmatch.fnmatchcase(path, pattern) for pattern in excused):
            yield f'{path} has no header of the same name'
    for pattern in sorted(excused):
        if not fnmatch.filter(files, pattern):
            yield f'docs/architecture.md excuses {pattern}, which does not exist'


def _member_violations(files):
    for path, text in sorted(files.items()):
        if path.endswith('.cpp'):
            own = text + files.get(path[:-4] + '.h', '')
            for name in sorted(set(MEMBER.findall(text))):
                if not re.search(rf'\b(?:class|struct|namespace)\b[\w: ]*\b{name}\b', own):
                    yield f'{path} defines members of {name}, which its header does not declare'
