#!/usr/bin/env python3
"""Counts what programs take apart or type by hand, and what does not keep rules 4 and 5 of docs/architecture.md.

usage: check_counts.py ROOT [--count]

The counts may only fall; a change that lowers one writes the new number here. With --count, only prints the counts.
"""

import collections
import pathlib
import re
import sys

from check_codes import PROTO, declared, sources

# Keys of JSON typed by hand in the worker: {"key", value}, json["key"], in files that make JSON. Reports are messages; what
# is left is the protocol of previews, and the summary and version for programs.
KEY = re.compile(r'\{\s*"[a-z][a-z0-9_]*"\s*,|\["[a-z][a-z0-9_]*"\]')
# Expressions of the page over sentences of the daemon or worker.
SENTENCE = re.compile(r'(?:message|instruction|where|phase|words|why|what)\b[\w.?!()]*\.(?:match|replace|search|split)\(|'
                      r'RegExp\([^)]*mm\b')
# Names of flags in texts. Programs that read command lines may use them; libraries serve several surfaces.
FLAG = re.compile(r'"[^"\n]*--[a-z][a-z-]+[^"\n]*"')
READS_COMMAND_LINE = ('sim/worker/', 'hardware/capture/options.cpp', 'hardware/simulator/drive/main.cpp',
                      'hardware/simulator/drive/camera_control.cpp', 'hardware/simulator/drive/scene.cpp',
                      'hardware/simulator/openni_driver/', 'proto/flags/', 'proto/model_summary_text.cpp')
CLOCK = re.compile(r'_clock::now|\bclock_gettime\(|\bgettimeofday\(|\btime\(nullptr\)|::socket\(')
LIBRARY = re.compile(r'\b(?:pcl|CGAL|OIIO|openni|google::protobuf)::\w|\bFT_Face\b|\bhb_\w+_t\b|\bmodbus_t\b')
NAMESPACE = re.compile(r'^namespace (hydroprint[\w:]*) \{', re.MULTILINE)
# Names that other lists than the reasons have too: causes of faults, states, codes.
OTHER_LISTS = ('hardware/rig/state_names.cpp', 'daemon/dip/state_machine.cpp', 'daemon/store/job.cpp',
               'daemon/workers/slurm/queue.cpp', 'sim/base/result.cpp')
MOST = {'keys typed by hand in sim/worker': 24, 'sentences taken apart in web/src': 0,
        'codes and reasons typed as text in C++': 0, 'flags named by libraries': 0, 'clocks and sockets in sim': 2,
        'types of libraries in headers of sim and hardware': 22, 'second namespaces of rooms': 7}


def seconds_of_rooms(code):
    """Returns the number of namespaces that a room has beside its most frequent one."""
    rooms = collections.defaultdict(set)
    for path, text in code.items():
        rooms[path.rsplit('/', 1)[0]].update(set(NAMESPACE.findall(text)) - {'hydroprint::v1'})  # messages of the API
    return sum(max(0, len(names) - 1) for names in rooms.values())


def counts(code, page, codes, reasons):
    """Returns {what is counted: number}."""
    def total(pattern, is_counted):
        return sum(len(pattern.findall(text)) for path, text in code.items() if is_counted(path))

    typed = re.compile('"(?:' + '|'.join([*codes, *reasons]) + ')"')
    below_surface = lambda path: path.startswith(('sim/', 'hardware/', 'proto/')) and not path.startswith(READS_COMMAND_LINE)
    return {'keys typed by hand in sim/worker':
                total(KEY, lambda path: path.startswith('sim/worker/') and 'nlohmann' in code[path]),
            'sentences taken apart in web/src': sum(len(SENTENCE.findall(text)) for text in page),
            'codes and reasons typed as text in C++': total(typed, lambda path: path not in OTHER_LISTS),
            'flags named by libraries': total(FLAG, below_surface),
            'clocks and sockets in sim': total(CLOCK, lambda path: path.startswith('sim/')),
            'types of libraries in headers of sim and hardware':
                total(LIBRARY, lambda path: path.startswith(('sim/', 'hardware/')) and path.endswith('.h')),
            'second namespaces of rooms': seconds_of_rooms(code)}


def main(root, only_count):
    read = lambda name: (root / PROTO / name).read_text(encoding='utf-8')
    page = [path.read_text(encoding='utf-8') for path in sorted((root / 'web/src').rglob('*'))
            if path.suffix in ('.ts', '.tsx')]
    found = counts(sources(root), page, declared(read('warning.proto'), 'Code'),
                   declared(read('error_reason.proto'), 'ErrorReason'))
    if only_count:
        print('\n'.join(f'{what}: {number}' for what, number in found.items()))
        return 0
    bad = [f'{what}: {number}; at most {MOST[what]} are allowed' if number > MOST[what]
           else f'{what}: {number}; lower the limit of {MOST[what]} in check_counts.py'
           for what, number in found.items() if number != MOST[what]]
    print('\n'.join(bad) or 'no count has grown')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1]), '--count' in sys.argv))
