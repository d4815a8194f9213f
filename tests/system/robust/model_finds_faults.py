# SPDX-License-Identifier: Apache-2.0
"""Whether model_test.py can fail: model_finds_faults.py PROGRAM

Runs it with each fault that faulty_service.py knows. All are found, by a comparison with the model; without a fault none is.
"""

import subprocess
import sys
import time
from pathlib import Path

from faulty_service import FAULTS
from service import check

FOLDER = Path(__file__).parent


def main():
    for fault in FAULTS:
        started = time.monotonic()
        run = subprocess.run([sys.executable, FOLDER / "model_test.py", sys.argv[1], "--seconds", "5" if fault == "none" else "30", "--fault", fault],
                             capture_output=True, text=True, timeout=200, check=False)
        said = [line for line in run.stderr.splitlines() if line.startswith("AssertionError: ")]
        print(f"{fault}: after {time.monotonic() - started:.1f} s: {said[-1][:200] if said else 'nothing found'}", flush=True)
        check(run.returncode == 0 if fault == "none" else run.returncode == 1 and said, f"{fault}: exit code {run.returncode}\n{run.stderr[-1000:]}")


main()
