#!/usr/bin/env python3
"""Tests that check_words.py finds the phrases, and only them."""

import unittest

import words


def found(text):
    return words.violations({'a.h': text})


class Words(unittest.TestCase):

    def test_plain_english_is_accepted(self):
        for text in ['/// nullopt if the line is malformed', 'There is no such job.', 'there are no users yet',
                     'The key is no longer valid.', 'It takes no more than 2 s.', 'int anewline;']:
            self.assertEqual([], found(text), text)

    def test_each_phrase_is_found_with_its_place_and_advice(self):
        for text in ['this is no number', 'for a line that is none', 'none for other jobs', 'whoever calls',
                     'all but the last', 'nothing but for that', 'models of strangers', 'begins anew',
                     'for so many more bytes', 'from then on it waits', 'the same of the other']:
            lines = found('good\n// ' + text)
            self.assertEqual(1, len(lines), text)
            self.assertTrue(lines[0].startswith('a.h:2: "'), lines)
            self.assertIn('write', lines[0].replace('name', 'write'))

    def test_a_phrase_is_found_across_the_lines_of_a_comment_or_a_string(self):
        self.assertEqual(1, len(found('/// this is\n  /// no number')))
        self.assertEqual(1, len(found('"this is "\n   "no number"')))

    def test_capitals_do_not_hide_a_phrase(self):
        self.assertEqual(1, len(found('Whoever calls')))


if __name__ == '__main__':
    unittest.main()
