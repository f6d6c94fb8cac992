"""Checks that CONTRIBUTING.md names every test program of the CMake lists, and no other. Usage: check_programs.py ROOT"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
declared = {name for path in (root / "tests").rglob("CMakeLists.txt")
            for name in re.findall(r"^ *hydroprint_test\((\w+)", path.read_text(), re.M)}
table = [line for line in (root / "CONTRIBUTING.md").read_text().splitlines() if line.startswith("| `")]
named = {name for line in table for name in re.findall(r"`(\w+_test|kill_campaign)`", line.split("|")[2])}
for name in sorted(declared - named):
    print(f"CONTRIBUTING.md: the test program {name} is missing in the table")
for name in sorted(named - declared):
    print(f"CONTRIBUTING.md: there is no test program {name}")
sys.exit(declared != named)
