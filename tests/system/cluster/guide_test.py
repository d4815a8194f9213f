# SPDX-License-Identifier: Apache-2.0
"""Runs the commands that CLUSTER.md shows below a line `<!-- run by a test -->`, against a real cluster: guide_test.py PROGRAM CLUSTER.MD"""

import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "robust"))

from service import ENVIRONMENT, check, skip, temporary_folder  # noqa: E402
from slurm_box import SlurmBox, enter_own_network, why_not  # noqa: E402


def main():
    if reason := why_not():
        skip(reason)
    enter_own_network()
    program, guide = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).read_text(encoding="utf-8")
    blocks = re.findall(r"<!-- run by a test -->\n```sh\n(.*?)```\n", guide, re.DOTALL)
    check(len(blocks) == guide.count("<!-- run by a test -->") == 3, f"{len(blocks)} blocks")
    folder = temporary_folder()
    box = SlurmBox(folder / "box")
    home = folder / "home"
    home.mkdir()
    commands = "\n".join(blocks).replace("build/release/rpsup", str(program)).replace("/scratch/rpsup", str(folder / "scratch"))
    # A cluster that is not a test's has no reason to be looked at so often.
    quick = {"RPSUP_SLURM_POLL_S": "0.4", "RPSUP_SLURM_GRACE_S": "2"}
    environment = {**{k: v for k, v in ENVIRONMENT.items() if k != "XDG_CONFIG_HOME"}, "HOME": str(home), "SLURM_CONF": str(box.config), **quick}
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=home, env=environment, capture_output=True, text=True, timeout=200)
    check(done.returncode == 0, f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    check("to the bit" in done.stdout and "the cluster can be used" in done.stdout, done.stdout)
    rows = (home / "peaks.csv").read_text().splitlines()
    check(len(rows) == 5 and all(",succeeded," in row for row in rows[1:]), f"the results: {rows}")
    check('"name": "slurm"' in done.stdout, done.stdout)

    # Answers to wrong options.
    wrong = subprocess.run([program, "check-cluster", "--slurm-folder", str(folder / "scratch"), "--slurm-partition", "none"], env=environment,
                           capture_output=True, text=True, timeout=60)
    check(wrong.returncode == 3 and "FAULT" in wrong.stdout and "partition" in wrong.stdout, f"{wrong.returncode}: {wrong.stdout}{wrong.stderr}")
    missing = subprocess.run([program, "check-cluster", "--slurm-folder", str(folder / "scratch"), "--slurm-prologue", "exit 5"], env=environment,
                             capture_output=True, text=True, timeout=60)
    check(missing.returncode == 3 and "ended as FAILED" in missing.stdout, f"{missing.returncode}: {missing.stdout}{missing.stderr}")
    left = [entry.name for entry in (folder / "scratch").iterdir() if entry.name.startswith("check-")]
    check(not left, f"what a check has left: {left}")
    print("the commands of the guide work")


main()
