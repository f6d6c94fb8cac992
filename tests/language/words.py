"""Phrases that the project does not use in text for people, and where they occur."""

import re

# Pattern and advice. A pattern ignores case, and a blank in it also matches the line break of a comment.
PHRASES = [
    (r'(?<!there )\b(?:is|are|was|were) no (?!longer\b|more than\b|less than\b|later than\b|different\b)',
     'write "is not a", "cannot", or "there is no"'),
    (r'(?<!there )\b(?:is|are|was|were) (?-i:none)\b', 'name what it is, or write "is not a ..."'),
    (r'\b(?-i:none) for\b', 'write "nullopt if" or "nothing if"'),
    (r'\bwho(?:so|s)?ever\b', 'name the person: user, caller, client'),
    (r'\bbut for\b', 'write "except"'),
    (r'\ball but\b', 'write "all except" or "nearly"'),
    (r'\bstrangers?\b', 'write "unauthenticated caller", "client" or "untrusted input"'),
    (r'\banew\b', 'write "again"'),
    (r'\bso many more\b', 'give the number or its name'),
    (r'\bfrom then on\b', 'write "after that"'),
    (r'\bis none of\b', 'write "is not part of"'),
    (r'\bthe same of\b', 'write a full sentence'),
]

PATTERNS = [(re.compile(pattern.replace(' ', r'[ ]+').replace('(?<!there[ ]+)', '(?<!there )'), re.IGNORECASE), advice) for pattern, advice in PHRASES]
LINE_BREAK = re.compile(r'"?\n\s*(?:///<?|//|\*|#|>)?\s*"?')


def joined(text):
    """The text as one line, and for each of its characters the line number it came from."""
    out, lines, number, position = [], [], 1, 0
    for found in LINE_BREAK.finditer(text):
        piece = text[position:found.start()] + ' '
        out.append(piece)
        lines += [number] * len(piece)
        number += found[0].count('\n')
        position = found.end()
    out.append(text[position:])
    lines += [number] * len(text[position:])
    return ''.join(out), lines


def violations(files):
    """Lines "path:line: "phrase": advice" for {path: text}."""
    found = []
    for path, text in sorted(files.items()):
        line, numbers = joined(text)
        for pattern, advice in PATTERNS:
            found += [(path, numbers[match.start()], match[0].strip(), advice) for match in pattern.finditer(line)]
    return [f'{path}:{number}: "{phrase}": {advice}' for path, number, phrase, advice in sorted(found)]
