#!/usr/bin/env python3
"""Tests that check_rooms.py reports violations of docs/architecture.md in small example trees."""

import unittest

import rooms

DOCUMENT = """# Architecture

## Allowed arrows

| room | may include |
|---|---|
| `sim/mesh` | |
| `sim/flow` | `sim/mesh` |
| `sim/base` | |

## Sources without a header
- `sim/flow/reader.cpp`: one of several readers
"""

KEPT = {
    'sim/base/result.h': '',
    'sim/mesh/surface.h': '#include "sim/base/result.h"\n',
    'sim/flow/trace.h': '#include <vector>\n\n#include "sim/mesh/surface.h"\n',
    'sim/flow/trace.cpp': '#include "sim/flow/trace.h"\n',
    'sim/flow/reader.cpp': '#include "sim/flow/trace.h"\n',
}


def found(changes, document=DOCUMENT):
    return rooms.violations({**KEPT, **changes}, document)


class Rooms(unittest.TestCase):

    def test_a_tree_that_keeps_the_rules_is_accepted(self):
        self.assertEqual([], found({}))

    def test_an_include_without_an_arrow_is_refused(self):
        self.assertEqual(
            ['sim/mesh/weld.h includes sim/flow/trace.h: no arrow from sim/mesh to sim/flow in docs/architecture.md'],
            found({'sim/mesh/weld.h': '#include "sim/flow/trace.h"\n'}))

    def test_a_room_missing_in_the_table_is_refused(self):
        self.assertEqual(['sim/new is not in the table of docs/architecture.md'],
                         found({'sim/new/thing.h': '#include "sim/mesh/surface.h"\n'}))

    def test_an_unused_arrow_is_refused(self):
        document = DOCUMENT.replace('| `sim/mesh` | |', '| `sim/mesh` | `sim/film` |')
        self.assertEqual(['docs/architecture.md allows sim/mesh to include sim/film, but no file does'],
                         found({}, document))

    def test_a_cycle_in_the_table_is_refused(self):
        document = DOCUMENT.replace('| `sim/mesh` | |', '| `sim/mesh` | `sim/flow` |')
        self.assertIn('docs/architecture.md allows a cycle: sim/flow -> sim/mesh -> sim/flow',
                      found({'sim/mesh/weld.h': '#include "sim/flow/trace.h"\n'}, document))

    def test_the_control_loop_has_no_checks_that_throw(self):
        document = DOCUMENT.replace('| `sim/mesh` | |', '| `sim/mesh` | |\n| `hardware/rig` | |')
        self.assertEqual(
            ['hardware/rig/loop.h includes sim/base/check.h, but a failed check throws, and hardware/rig must not throw'],
            found({'hardware/rig/loop.h': '#include "sim/base/check.h"\n'}, document))

    def test_the_worker_is_included_by_nothing_else(self):
        document = DOCUMENT.replace('| `sim/flow` | `sim/mesh` |', '| `sim/flow` | `sim/mesh`, `sim/worker` |')
        self.assertEqual(['sim/flow/trace2.h includes sim/worker/run.h: nothing outside sim/worker may include it'],
                         found({'sim/flow/trace2.h': '#include "sim/worker/run.h"\n'}, document))

    def test_a_folder_of_36_files_is_refused(self):
        files = {f'sim/mesh/part{i}.h': '' for i in range(35)}
        self.assertEqual(['sim/mesh has 36 files; at most 35 are allowed'], found(files))

    def test_a_source_without_its_header_is_refused(self):
        self.assertEqual(['sim/mesh/weld.cpp has no header of the same name'],
                         found({'sim/mesh/weld.cpp': '#include "sim/mesh/surface.h"\n'}))

    def test_members_of_a_class_of_another_header_are_refused(self):
        files = {'sim/mesh/surface.h': 'class Surface {\n  int size() const;\n};\n',
                 'sim/mesh/weld.h': '',
                 'sim/mesh/weld.cpp': '#include "sim/mesh/weld.h"\n\nint Surface::size() const { return 0; }\n'}
        self.assertEqual(['sim/mesh/weld.cpp defines members of Surface, which its header does not declare'],
                         found(files))

    def test_members_of_own_classes_are_accepted(self):
        self.assertEqual([], found({'sim/flow/trace.cpp': 'struct Step {\n  int of() const;\n};\n\n'
                                                          'int Step::of() const { return 0; }\n'}))

    def test_an_exception_for_a_missing_file_is_refused(self):
        files = dict(KEPT)
        del files['sim/flow/reader.cpp']
        self.assertEqual(['docs/architecture.md excuses sim/flow/reader.cpp, which does not exist'],
                         rooms.violations(files, DOCUMENT))


if __name__ == '__main__':
    unittest.main()
