"""Rules for the documents: every link has a target, and README.md has 60 to 80 lines."""

import posixpath
import re

README_LINES = range(60, 81)
FENCE = re.compile(r'^(```|~~~).*?^\1', re.MULTILINE | re.DOTALL)
CODE = re.compile(r'`[^`\n]*`')
LINK = re.compile(r'!?\[(?:[^\]\\]|\\.)*\]\(([^)\s]+)\)')
HEADING = re.compile(r'^#+ +(.*?) *#*$', re.MULTILINE)


def anchor_of(heading):
    """Returns the anchor of a heading: lower case, spaces replaced by dashes, without punctuation."""
    text = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading).lower()
    return re.sub(r'[^\w\- ]', '', text).replace(' ', '-')


def anchors(text):
    return {anchor_of(heading) for heading in HEADING.findall(FENCE.sub('', text))}


def links(text):
    """Returns the targets of a document's links and pictures, except those in code."""
    return LINK.findall(CODE.sub('', FENCE.sub('', text)))


def violations(documents, exists):
    """Returns the violations of the rules, one line each.

    documents: {path: text} of all Markdown files, paths from the root of the project.
    exists: returns True if a path, relative to the root, exists.
    """
    found = []
    for path, text in sorted(documents.items()):
        for target in links(text):
            found += _wrong_link(path, target, documents, exists)
    lines = len(documents.get('README.md', '').splitlines())
    if lines not in README_LINES:
        found.append(f'README.md has {lines} lines, but must have 60 to 80')
    return found


def _wrong_link(path, target, documents, exists):
    if re.match(r'[a-z]+:', target):
        return []
    name, _, anchor = target.partition('#')
    place = posixpath.normpath(posixpath.join(posixpath.dirname(path), name)) if name else path
    if place.startswith('..') or not exists(place):
        return [f'{path}: {target} does not exist']
    if anchor and anchor not in anchors(documents.get(place, '')):
        return [f'{path}: {target}: {place} does not have this heading']
    return []
