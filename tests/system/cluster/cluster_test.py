# SPDX-License-Identifier: Apache-2.0
"""The paper's sweep on a Slurm cluster of two nodes, undisturbed and disturbed: always the bytes of the local pool.

cluster_test.py PROGRAM PAPER.JSON [TRIAL...]"""

import getpass
import json
import sqlite3
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "robust"))

from service import Service, check, skip, temporary_folder  # noqa: E402
from slurm_box import SlurmBox, enter_own_network, why_not  # noqa: E402

QUICK = ("--slurm-slots", "4", "--slurm-poll-s", "0.4", "--slurm-grace-s", "1.5", "--slurm-task-s", "1", "--slurm-least-task-s", "0.3")


def trajectories(store):
    """As they are stored, in the order of the sweep's jobs."""
    database = sqlite3.connect(store)
    try:
        return [bytes(row[0]) for row in database.execute("SELECT t.data FROM jobs j JOIN trajectories t ON t.result = j.result ORDER BY j.seq")]
    finally:
        database.close()


def wait_until(holds, what, seconds=60):
    deadline = time.monotonic() + seconds
    while not holds():
        check(time.monotonic() < deadline, what)
        time.sleep(0.05)


def script(file, text):
    file.write_text("#!/bin/sh\n" + text)
    file.chmod(0o755)
    return str(file)


class Lab:
    """A cluster, a service on it for each trial, and what every trial must come to."""

    def __init__(self, program, paper):
        self.program, self.sweep = str(Path(program).resolve()), json.loads(Path(paper).read_text())
        self.folder = temporary_folder()
        self.box = SlurmBox(self.folder / "box")
        self.began = time.monotonic()
        local = Service(self.program, self.folder / "local.db")
        self.rows = local.results(self.submit(local, "local"))
        local.terminate()
        self.trajectories = trajectories(self.folder / "local.db")
        check(len(self.rows) == 41 and len(self.trajectories) == 40, f"{len(self.rows)} rows, {len(self.trajectories)} trajectories")
        self.tell("local pool")

    def tell(self, what):
        print(f"{time.monotonic() - self.began:5.1f} s  {what}", flush=True)

    def submit(self, service, executor, wait=True):
        sweep_id = service.submit({**self.sweep, "executor": executor})
        if wait:
            self.finish(service, sweep_id)
        return sweep_id

    def finish(self, service, sweep_id):
        try:
            state = service.wait_for_end(sweep_id, 120)
            errors = [job["error"] for job in service.get("/v1/jobs?state=failed")["items"]]
            check(state == "succeeded", f"{state}: {errors}")
        except AssertionError:
            print(self.box.run("squeue", "-r", "-t", "all", "-o", "%j %K %T %r %N", check=False), self.box.run("sinfo", "-N", "-l", check=False),
                  service.get("/v1/executors"), service.log.read_text()[-2000:], sep="\n")
            raise

    def start(self, trial, *options):
        shared = self.folder / f"shared-{trial}"
        shared.mkdir(exist_ok=True)
        return Service(self.program, self.folder / f"{trial}.db", "--slurm-folder", str(shared), *QUICK, *options,
                       environment={"SLURM_CONF": str(self.box.config)})

    def compare(self, service, sweep_id, trial):
        check(service.results(sweep_id) == self.rows, f"{trial}: the results are not those of the local pool")
        code, _ = service.terminate()
        check(code == 0, f"{trial}: exit code {code}")
        check(trajectories(self.folder / f"{trial}.db") == self.trajectories, f"{trial}: the trajectories are not those of the local pool")
        self.tell(trial)

    def wait_for_tasks(self, state, count):
        wait_until(lambda: len(self.box.run("squeue", "-h", "-r", "-t", state, "-o", "%i").split()) >= count, f"never {count} tasks {state}")

    def slow_program(self, seconds):
        """A node that takes its time, so that its tasks can be disturbed."""
        return script(self.folder / "slow.sh", f"sleep {seconds}\nexec '{self.program}' \"$@\"\n")


def plain(lab):
    service = lab.start("plain", "--executor", "slurm", "--slurm-program", lab.slow_program(1))
    sweep_id = service.submit(lab.sweep)
    check(service.get(f"/v1/sweeps/{sweep_id}")["executor"] == "slurm", "the executor of a sweep that names none")
    nodes = set()
    while service.get(f"/v1/sweeps/{sweep_id}")["state"] in ("queued", "running"):
        nodes.update(service.get("/v1/executors")["items"][0]["nodes"])
        time.sleep(0.1)
    check(nodes == {"n1", "n2"}, f"tasks ran on {nodes}")
    lab.finish(service, sweep_id)
    job = service.get("/v1/jobs?limit=1")["items"][0]
    check(job["run"]["libm"].startswith("glibc ") and job["run"]["numerics"] == "native", f"provenance: {job['run']}")
    metrics = service.ask("GET", "/metrics")[2].decode()
    for line in ('rpsup_executor_slots{executor="slurm"} 4', 'rpsup_executor_tasks{executor="slurm",state="running"}'):
        check(line in metrics, metrics[-2000:])
    lab.compare(service, sweep_id, "plain")


def aborting_tasks(lab):
    # The first run of two tasks ends by a signal, as of a program that finds its memory damaged.
    marks = lab.folder / "marks"
    marks.mkdir()
    program = script(lab.folder / "aborting.sh",
                     f"if [ $SLURM_ARRAY_TASK_ID -lt 2 ] && mkdir {marks}/$SLURM_ARRAY_TASK_ID 2>/dev/null; then kill -ABRT $$; fi\n"
                     f"exec '{lab.program}' \"$@\"\n")
    service = lab.start("aborting", "--slurm-program", program)
    sweep_id = lab.submit(service, "slurm")
    check(len(list(marks.iterdir())) == 2, "two tasks were to abort")
    lab.compare(service, sweep_id, "aborting")


def poisonous_job(lab):
    # Every task that has the first job of the batch dies: that job fails alone, with the end of its log.
    program = script(lab.folder / "poisonous.sh",
                     "line=$((SLURM_ARRAY_TASK_ID + 1))\n"
                     "sed -n ${line}p \"$2/g$3.list\" | grep -q '^0[-, ]' && { echo 'it broke here' >&2; exit 9; }\n"
                     f"exec '{lab.program}' \"$@\"\n")
    service = lab.start("poisonous", "--slurm-program", program)
    sweep_id = service.submit({"parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.1, 0.2, 0.3]},
                               "executor": "slurm"})
    check(service.wait_for_end(sweep_id, 60) == "failed", "a poisonous job was computed")
    jobs = service.get("/v1/jobs?limit=10")["items"]
    failed = [job["error"] for job in jobs if job["state"] == "failed"]
    check(len(failed) == 1 and failed[0]["reason"] == "task_failed" and "it broke here" in failed[0]["detail"], f"what failed: {failed}")
    check(sum(job["state"] == "succeeded" for job in jobs) == 3, f"{jobs}")
    service.terminate()
    lab.tell("poisonous job")


def killed_service(lab):
    # Once Slurm has the first array and before the service hears of it, the service is killed.
    mark = lab.folder / "killed"
    prefix = script(lab.folder / "killing.sh",
                    f"\"$@\"\ncode=$?\nif [ $1 = sbatch ] && mkdir {mark} 2>/dev/null; then kill -KILL $PPID; fi\nexit $code\n")
    service = lab.start("killed", "--slurm-prefix", prefix)
    sweep_id = lab.submit(service, "slurm", wait=False)
    service.process.wait(timeout=20)
    check(mark.exists(), "the service ended by itself")
    service = lab.start("killed")
    lab.finish(service, sweep_id)
    lab.compare(service, sweep_id, "killed")


def foreign_cancellation(lab):
    service = lab.start("cancelled", "--slurm-program", lab.slow_program(1))
    sweep_id = lab.submit(service, "slurm", wait=False)
    lab.wait_for_tasks("running", 2)
    lab.box.run("scancel", "--user", getpass.getuser())
    lab.finish(service, sweep_id)
    lab.compare(service, sweep_id, "cancelled")


def power_cut(lab):
    service = lab.start("power", "--slurm-program", lab.slow_program(1))
    sweep_id = lab.submit(service, "slurm", wait=False)
    wait_until(lambda: lab.box.processes_of("n2"), "no task runs on the node")
    lab.box.cut_power("n2")
    time.sleep(2)
    lab.box.give_power("n2")
    lab.finish(service, sweep_id)
    lab.compare(service, sweep_id, "power")


def lost_controller(lab):
    service = lab.start("controller", "--slurm-program", lab.slow_program(1))
    sweep_id = lab.submit(service, "slurm", wait=False)
    lab.wait_for_tasks("running", 2)
    lab.box.lose_controller_state()
    lab.finish(service, sweep_id)
    lab.compare(service, sweep_id, "controller")


def moved(lab):
    """Cancelling, retrying and moving a sweep; in the end the local pool computes what the cluster was to."""
    service = lab.start("moved", "--slurm-option=--hold")
    sweep_id = lab.submit(service, "slurm", wait=False)
    lab.wait_for_tasks("pending", 2)
    wait_until(lambda: "JobHeldUser" in str(service.get("/v1/executors")["items"][1]["problems"]), "held tasks are not shown")
    status, _, text = service.ask("POST", f"/v1/sweeps/{sweep_id}/cancel")
    check(status == 200 and json.loads(text)["state"] == "cancelled", f"cancel: {status} {text}")
    wait_until(lambda: not lab.box.run("squeue", "-h", "-t", "pending", "-o", "%i"), "tasks of a cancelled sweep wait on")
    check(service.ask("POST", f"/v1/sweeps/{sweep_id}/retry")[0] == 200, "retry")
    lab.wait_for_tasks("pending", 2)
    status, _, text = service.ask("POST", f"/v1/sweeps/{sweep_id}/move", {"executor": "local"})
    check(status == 200 and json.loads(text)["executor"] == "local", f"move: {status} {text}")
    lab.finish(service, sweep_id)
    lab.compare(service, sweep_id, "moved")


def main():
    if reason := why_not():
        skip(reason)
    enter_own_network()
    lab = Lab(sys.argv[1], sys.argv[2])
    chosen = sys.argv[3:] or [trial.__name__ for trial in TRIALS]
    for trial in TRIALS:
        if trial.__name__ in chosen:
            trial(lab)
    lab.tell("in all")


TRIALS = (plain, aborting_tasks, poisonous_job, killed_service, foreign_cancellation, power_cut, moved, lost_controller)
main()
