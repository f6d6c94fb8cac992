#!/usr/bin/env python3
"""Checks the codes of warnings, and counts texts that programs take apart or type by hand.

usage: check_codes.py ROOT [--count]

Each code of hydroprint/v1/warning.proto is raised somewhere in C++ and described in docs/troubleshooting.md. The counts
may only fall; a change that lowers one writes the new number here. With --count, only prints the counts.
"""

import pathlib
import re
import sys

# Keys of JSON typed by hand in the worker: {"key", value}, json["key"], in files that make JSON. Reports are messages; what
# is left is the protocol of previews, and the summary and version for programs.
KEY = re.compile(r'\{\s*"[a-z][a-z0-9_]*"\s*,|\["[a-z][a-z0-9_]*"\]')
MAKES_JSON = re.compile(r'nlohmann')
# Expressions of the page over sentences of the daemon or worker.
SENTENCE = re.compile(r'(?:message|instruction|where|phase|words|why)\b[\w.?!()]*\.(?:match|replace|search|split)\(|'
                      r'RegExp\([^)]*mm\b')
MOST = {'keys typed by hand in sim/worker': 27, 'sentences taken apart in web/src': 0,
        'codes of warnings typed as text in C++': 0}


def declared(proto):
    """Returns the names of the codes, without the unspecified one."""
    enum = proto.split('enum Code {')[1].split('\n  }')[0]
    return re.findall(r'^    ([A-Z][A-Z0-9_]*) = [1-9]\d*;', enum, re.MULTILINE)


def texts(root, folder, *endings):
    return {path: path.read_text(encoding='utf-8') for path in sorted((root / folder).rglob('*'))
            if path.suffix in endings and 'node_modules' not in path.parts}


def problems_of_codes(codes, sources, document):
    """Returns the codes that nothing raises or that the document lacks, one line each."""
    code = '\n'.join(re.sub(r'//.*', '', text) for text in sources)
    for name in codes:
        if not re.search(rf'\bWarningCode::{name}\b', code):
            yield f'warning {name} is declared, but nothing raises it'
        if not re.search(rf'\b{name}\b', document):
            yield f'docs/troubleshooting.md does not describe the warning {name}'


def counts(codes, reasons, worker, page, sources):
    """Returns {what is counted: number}, from texts of files. Reasons of errors may be typed as text."""
    names = [name for name in codes if name not in reasons] + [name.lower() for name in codes]
    text = re.compile('"(?:' + '|'.join(names) + ')"')
    return {'keys typed by hand in sim/worker': sum(len(KEY.findall(t)) for t in worker if MAKES_JSON.search(t)),
            'sentences taken apart in web/src': sum(len(SENTENCE.findall(t)) for t in page),
            'codes of warnings typed as text in C++': sum(len(text.findall(t)) for t in sources)}


def main(root, only_count):
    codes = declared((root / 'proto/hydroprint/v1/warning.proto').read_text(encoding='utf-8'))
    sources = [t for folder in ('sim', 'daemon', 'client', 'hardware')
               for t in texts(root, folder, '.h', '.cpp').values()]
    reasons = (root / 'proto/hydroprint/v1/error_reason.proto').read_text(encoding='utf-8')
    found = counts(codes, re.findall(r'^  ([A-Z][A-Z_]*) =', reasons, re.MULTILINE), texts(root, 'sim/worker', '.cpp', '.h').values(),
                   texts(root, 'web/src', '.ts', '.tsx').values(), sources)
    if only_count:
        print('\n'.join(f'{what}: {number}' for what, number in found.items()))
        return 0
    bad = list(problems_of_codes(codes, sources, (root / 'docs/troubleshooting.md').read_text(encoding='utf-8')))
    bad += [f'{what}: {number}; at most {MOST[what]} are allowed' for what, number in found.items() if number > MOST[what]]
    bad += [f'{what}: {number}; lower the limit of {MOST[what]} in check_codes.py'
            for what, number in found.items() if number < MOST[what]]
    print('\n'.join(bad) or f'{len(codes)} codes of warnings are raised and described')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1]), '--count' in sys.argv))
