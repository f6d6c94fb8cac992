#!/usr/bin/env python3
"""Checks the codes of warnings and the reasons of errors.

usage: check_codes.py ROOT

Each code of hydroprint/v1/warning.proto and each reason of error_reason.proto is used somewhere in C++ and described in
docs/troubleshooting.md. The compiler refuses others.
"""

import pathlib
import re
import sys

PROTO = 'proto/hydroprint/v1'


def declared(proto, enum):
    """Returns the names of an enum's values, without the unspecified one."""
    body = re.search(rf'^( *)enum {enum} {{\n(.*?)^\1}}', proto, re.MULTILINE | re.DOTALL)[2]
    return re.findall(r'^ *([A-Z][A-Z0-9_]*) = [1-9]\d*;', body, re.MULTILINE)


def sources(root):
    """Returns the C++ files by path, without comments."""
    return {path.relative_to(root).as_posix(): re.sub(r'(?m)(^|\s)//.*', '', path.read_text(encoding='utf-8'))
            for folder in ('sim', 'daemon', 'client', 'hardware', 'proto')
            for path in sorted((root / folder).rglob('*')) if path.suffix in ('.h', '.cpp')}


def problems(names, kind, used, document):
    """Returns the names that nothing uses or that the document lacks, one line each."""
    for name in names:
        if name not in used:
            yield f'{kind} {name} is declared, but nothing uses it'
        if not re.search(rf'\b{name}\b', document):
            yield f'docs/troubleshooting.md does not describe the {kind} {name}'


def main(root):
    code = '\n'.join(sources(root).values())
    document = (root / 'docs/troubleshooting.md').read_text(encoding='utf-8')
    protos = {path.name: path.read_text(encoding='utf-8') for path in (root / PROTO).glob('*.proto')}
    codes = declared(protos['warning.proto'], 'Code')
    reasons = declared(protos['error_reason.proto'], 'ErrorReason')
    bad = [*problems(codes, 'warning', set(re.findall(r'\bWarningCode::([A-Z0-9_]+)', code)), document),
           *problems(reasons, 'reason', set(re.findall(r'\bErrorReason::([A-Z0-9_]+)', code)), document)]
    print('\n'.join(bad) or f'{len(codes)} warnings and {len(reasons)} reasons are used and described')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1])))
