#!/usr/bin/env python3
"""Runs the Python example of docs/api.md against a real daemon. Usage: run_api_example.py ROOT FOLDER_OF_PROGRAMS"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import programs  # noqa: E402

ADDRESS = 'http://127.0.0.1:8080'  # the address in the example


def main(root, folder_of_programs):
    example = re.search(r'```python\n(.*?)```', (root / 'docs/api.md').read_text(encoding='utf-8'), re.DOTALL)[1]
    if ADDRESS not in example:
        raise SystemExit(f'the example in docs/api.md does not use {ADDRESS}')
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([folder_of_programs / 'hydroprint', 'sample', 'globe', '--out', folder / 's'], check=True)
        daemon, found = programs.start(
            [folder_of_programs / 'hydroprintd', '--grpc', '127.0.0.1:0', '--http', '127.0.0.1:0', '--state-dir',
             folder / 'state'], r'\bhttp=(\S+:\d+)')
        try:
            (folder / 'example.py').write_text(example.replace(ADDRESS, f'http://{found[1]}'), encoding='utf-8')
            subprocess.run([sys.executable, 'example.py'], cwd=folder, check=True, timeout=240)
        finally:
            daemon.terminate()
            daemon.wait()
        if not (folder / 'print.pdf').read_bytes().startswith(b'%PDF'):
            raise SystemExit('print.pdf is not a PDF')
    return 0


if __name__ == '__main__':
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
