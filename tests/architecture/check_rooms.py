#!/usr/bin/env python3
"""Checks the project's includes, folder sizes and headers against docs/architecture.md.

usage: check_rooms.py ROOT
"""

import pathlib
import sys

import rooms

FOLDERS = ('client', 'daemon', 'hardware', 'proto', 'sim')
WRITTEN_BY_HAND = ('.h', '.cpp', '.proto', '.py')


def main(root):
    files = {}
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob('*')):
            if path.suffix in WRITTEN_BY_HAND:
                files[path.relative_to(root).as_posix()] = path.read_text(encoding='utf-8')
    found = rooms.violations(files, (root / 'docs/architecture.md').read_text(encoding='utf-8'))
    print('\n'.join(found) or f'{len(files)} files keep the rules of docs/architecture.md')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1])))
