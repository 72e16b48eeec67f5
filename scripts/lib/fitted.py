"""What cable_fit finds, kept for another run."""
import json
import os
import subprocess
import sys
import time


def fitted(programs, recordings, arguments, base, segments):
    """Runs cable_fit, unless the report BASE.json is there; the report, and how long [s] it took."""
    report, seconds = (f'{base}.{kind}' for kind in ('json', 'seconds'))
    if not os.path.exists(seconds):
        began = time.monotonic()
        subprocess.run([os.path.join(programs, 'cable_fit'), *recordings, *arguments, '--segments', str(segments), '--report', report],
                       check=True, stdout=subprocess.DEVNULL)
        with open(seconds, 'w', encoding='utf-8') as file:
            json.dump(time.monotonic() - began, file)
    with open(report, encoding='utf-8') as file, open(seconds, encoding='utf-8') as taken:
        found = json.load(file)
        if found['segments'] != segments:
            sys.exit(f'{report}: of {found["segments"]} segments, asked for are {segments}; allowed: another WORK, or the same number')
        return found, json.load(taken)
