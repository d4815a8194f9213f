# SPDX-License-Identifier: Apache-2.0
"""The machine's clock goes back by an hour and forward by a day while jobs run (libfaketime): clock_jump.py PROGRAM"""

import shutil
import sys
import time
from datetime import datetime
from pathlib import Path

from service import Service, check, check_integrity, skip, temporary_folder

LIBRARIES = sorted(Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
SWEEP = {"parameters": {"duration_s": 1.0, "run_up_s": 0.02}, "reuse": False, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 12}}}


def check_times(job, what):
    texts = [job[key] for key in ("created_at", "started_at", "ended_at") if job.get(key)]
    times = [datetime.fromisoformat(text.replace("Z", "+00:00")) for text in texts]
    check(times == sorted(times), f"{what} {job['id']}: {texts}")


def main():
    if shutil.which("faketime") is None or not LIBRARIES:
        skip("faketime is not installed")
    folder = temporary_folder()
    clock = folder / "clock"

    def jump(offset):
        # Replaced at once: half a file would be half an offset.
        (folder / "next").write_text(offset + "\n")
        (folder / "next").rename(clock)

    jump("+0")
    store = folder / "store.db"
    service = Service(sys.argv[1], store, "--threads", "2", environment={
        "LD_PRELOAD": str(LIBRARIES[0]), "FAKETIME_TIMESTAMP_FILE": str(clock), "FAKETIME_NO_CACHE": "1", "FAKETIME_DONT_FAKE_MONOTONIC": "1"})
    waiting = [service.submit(SWEEP)]
    for offset in ("-3600s", "+86400s", "-7200s"):
        before = service.get(f"/v1/sweeps/{waiting[-1]}")["counts"]
        check(before["queued"] + before["running"] > 0, f"the jobs had ended before the clock jumped by {offset}")
        jump(offset)
        time.sleep(0.15)
        waiting.append(service.submit(SWEEP))
    service.ask("POST", f"/v1/sweeps/{waiting.pop()}/cancel")
    check([service.wait_for_end(i) for i in waiting] == ["succeeded"] * 3, "sweeps over the jumps")
    tables = [service.results(i) for i in waiting]
    check(tables[1:] == tables[:-1], "results depend on the clock")
    for sweep in service.get("/v1/sweeps")["items"]:
        check_times(sweep, "sweep")
    jobs = service.get("/v1/jobs?limit=1000")["items"]
    check(len(jobs) == 48 and len({job["id"] for job in jobs}) == 48, "ids")
    computed = 0
    for job in jobs:
        check_times(job, "job")
        run = service.get(f"/v1/jobs/{job['id']}")["run"]
        computed += run is not None
        check(run is None or 0 < run["wall_time_s"] < 60, f"the time that {job['id']} took: {run}")
    check(computed >= 36, f"{computed} jobs say how long they took; all were computed but those of the sweep that was cancelled")
    listed = [item["id"] for item in service.get("/v1/sweeps")["items"]]
    check(len(listed) == 4, "a sweep is missing")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    print("48 jobs over three jumps of the clock: every job once, no time before the one it follows")


main()
