#!/usr/bin/env python3
"""Tests that check_links.py finds violations in small example documents."""

import unittest

import links

README = '\n'.join(['# Name', '[guide](docs/guide.md#first-steps)'] + ['text'] * 60)
GUIDE = '# Guide\n\n## First steps\n\n```sh\n# not a heading\n[not](a-link)\n```\n\n`[not](either)`\n![p](p.png)\n'
FILES = {'README.md', 'docs/guide.md', 'docs/p.png'}


def found(readme=README, guide=GUIDE):
    return links.violations({'README.md': readme, 'docs/guide.md': guide}, FILES.__contains__)


class Links(unittest.TestCase):

    def test_links_with_a_target_are_accepted(self):
        self.assertEqual([], found())

    def test_a_missing_file_is_reported(self):
        self.assertEqual(['docs/guide.md: gone.md does not exist'], found(guide=GUIDE + '[a](gone.md)'))

    def test_a_missing_picture_is_reported(self):
        self.assertEqual(['docs/guide.md: q.png does not exist'], found(guide=GUIDE + '![q](q.png)'))

    def test_a_missing_heading_is_reported(self):
        self.assertEqual(['README.md: docs/guide.md#first-steps: docs/guide.md does not have this heading'],
                         found(guide='# Guide\n![p](p.png)\n'))

    def test_a_heading_in_code_is_not_a_heading(self):
        self.assertEqual(['README.md: docs/guide.md#not-a-heading: docs/guide.md does not have this heading'],
                         found(readme=README.replace('first-steps', 'not-a-heading')))

    def test_a_link_out_of_the_project_is_refused(self):
        self.assertEqual(['README.md: ../other.md does not exist'], found(readme=README + '\n[a](../other.md)'))

    def test_external_links_are_not_checked(self):
        self.assertEqual([], found(guide=GUIDE + '[a](https://example.org/x#y)'))

    def test_a_readme_that_is_too_long_is_refused(self):
        self.assertEqual(['README.md has 81 lines, but must have 60 to 80'], found(readme=README + '\nmore' * 19))

    def test_anchors_match_those_of_markdown_viewers(self):
        self.assertEqual('hydroprint-worker-simulate-step-1', links.anchor_of('`hydroprint-worker simulate`, step 1'))


if __name__ == '__main__':
    unittest.main()
