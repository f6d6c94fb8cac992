#!/usr/bin/env python3
"""Checks that no text in the project uses phrases that people have to read twice. Usage: check_words.py ROOT"""

import pathlib
import sys

import words

SUFFIXES = {'.h', '.cpp', '.in', '.ts', '.tsx', '.css', '.html', '.proto', '.py', '.md', '.toml', '.example', '.txt',
            '.cmake', '.service', '.rules', ''}
GENERATED = {'LICENSE', 'package-lock.json', 'schema.d.ts'}
SKIPPED = {'node_modules', '__pycache__', 'language'}


def is_checked(path):
    return (path.suffix in SUFFIXES and path.name not in GENERATED
            and not any(part.startswith(('.', 'build')) or part in SKIPPED for part in path.parts[:-1]))


def files_of(root):
    out = {}
    for path in root.rglob('*'):
        name = path.relative_to(root)
        if path.is_symlink() or not path.is_file() or not is_checked(name):
            continue
        try:
            out[name.as_posix()] = path.read_text(encoding='utf-8')
        except UnicodeDecodeError:
            continue  # not text
    return out


def main(root):
    files = files_of(root)
    found = words.violations(files)
    for line in found:
        print(line)
    print(f'{len(files)} files, {len(found)} violations')
    return 1 if found or len(files) < 1000 else 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1])))
