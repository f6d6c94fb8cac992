#!/usr/bin/env python3
"""Checks all links, anchors and pictures in the documents. Usage: check_links.py ROOT"""

import pathlib
import sys

import links


def left_out(path):
    return any(part.startswith(('.', 'build')) or part == 'node_modules' for part in path.parts[:-1])


def main(root):
    documents = {path.relative_to(root).as_posix(): path.read_text(encoding='utf-8')
                 for path in root.rglob('*.md') if not left_out(path.relative_to(root))}
    found = links.violations(documents, lambda path: (root / path).exists())
    for line in found:
        print(line)
    print(f'{len(documents)} documents, {len(found)} violations')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1])))
