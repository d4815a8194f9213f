# SPDX-License-Identifier: Apache-2.0
"""Takes the room on the disk away while jobs run, and gives it back: disk_full.py PROGRAM tmpfs|enospc|quota|size_limit|start

tmpfs       a file system of 8 MiB of its own, filled by another file; needs the right to mount one
enospc      every write to the store fails as on a full disk; needs Debian's fiu-utils
quota       the same as beyond a user's quota
size_limit  no file may grow beyond what it is (RLIMIT_FSIZE, as systemd's LimitFSIZE)

While it lasts: new sweeps are refused with a 507 problem document, deleting a sweep is done, or refused so where every write
fails, reads are answered as before, no job fails. Afterwards, without a new start: everything is computed, byte for byte as
if nothing had been.

start       a file system of its own that is full when the service starts, after an orderly end and after a kill: a new store
            is refused, one that is there is read and made smaller, readiness says why, and once there is room all is computed;
            a store that holds no room, as a copy, is read, and made smaller once there is a little room
"""

import atexit
import errno
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

from faults import Faults, can_inject
from service import Service, check, check_integrity, copy_store, skip, small_sweep, temporary_folder


class Tmpfs:
    """The service in a mount namespace of its own."""

    def start(self, program, folder):
        inside = folder / "small"
        inside.mkdir()
        namespace = ["unshare", "--mount", "--"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--mount", "--"]
        mount = ["sh", "-c", f"mount -t tmpfs -o size=8m none '{inside}' && exec \"$@\"", "sh"]
        if subprocess.run([*namespace, *mount, "true"], capture_output=True, check=False).returncode != 0:
            skip("this user may not mount a file system")
        self.service = Service(program, folder / "small/store.db", "--threads", "2", "--disk-reserve-mb", "0", wrapper=[*namespace, *mount], log=folder / "log")
        # An open folder keeps the file system when the namespace has gone.
        self.folder = os.open(f"/proc/{self.service.process.pid}/root{inside}", os.O_RDONLY | os.O_DIRECTORY)
        self.copies = folder
        self.ballast = Path(f"/proc/self/fd/{self.folder}/ballast")
        return self.service

    def fill(self):
        with open(self.ballast, "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass

    def free(self):
        self.ballast.unlink()

    def check_store(self):
        check_integrity(copy_store(Path(f"/proc/self/fd/{self.folder}/store.db"), self.copies))


class FailingWrites:
    def __init__(self, system_error):
        self.system_error = system_error

    def start(self, program, folder):
        if not can_inject():
            skip("fiu-utils is not installed")
        self.store = folder / "store.db"
        self.faults = Faults(folder)
        self.service = Service(program, self.store, "--threads", "2", environment=self.faults.environment())
        return self.service

    def fill(self):
        self.faults.tell(self.service, f"enable name=posix/io/rw/pwrite,failinfo={self.system_error}")

    def free(self):
        self.faults.tell(self.service, "disable name=posix/io/rw/pwrite")

    def check_store(self):
        check_integrity(self.store)


class SizeLimit:
    def start(self, program, folder):
        self.store = folder / "store.db"
        self.service = Service(program, self.store, "--threads", "2")
        return self.service

    def fill(self):
        self.set_limit(os.path.getsize(f"{self.store}-wal"))

    def free(self):
        self.set_limit(resource.RLIM_INFINITY)

    def set_limit(self, size):
        _, hard = resource.prlimit(self.service.process.pid, resource.RLIMIT_FSIZE)
        resource.prlimit(self.service.process.pid, resource.RLIMIT_FSIZE, (size, hard))

    def check_store(self):
        check_integrity(self.store)


DISKS = {"tmpfs": Tmpfs, "enospc": lambda: FailingWrites(errno.ENOSPC), "quota": lambda: FailingWrites(errno.EDQUOT), "size_limit": SizeLimit}


def busy_sweep(seed):
    return {"parameters": {"duration_s": 0.4, "run_up_s": 0.02}, "reuse": False,
            "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 12}}, "replicates": {"count": 1, "seed": seed}}


def long_search():
    return {"parameters": {"duration_s": 4, "run_up_s": 0.02}, "reuse": False, "metric": "peak_slider_acceleration_m_s2", "bound": 1,
            "over": {"clearance_mm": {"from": 0.1, "to": 0.5, "first": 20}}}


def check_reads(service, sweep_id, table):
    check(service.results(sweep_id) == table, "results while the disk is full")
    job = service.get(f"/v1/sweeps/{sweep_id}/results")[0]["job_id"]
    for path in (f"/v1/jobs/{job}", f"/v1/jobs/{job}/trajectory", "/v1/sweeps", "/healthz"):
        check(service.ask("GET", path)[0] == 200, f"{path} while the disk is full")


def check_deleting(service, sweep_id, allowed):
    """Returns whether it is gone."""
    status = service.ask("DELETE", f"/v1/sweeps/{sweep_id}")[0]
    check(status in allowed, f"deleting on a full disk: {status}")
    left = service.ask("GET", f"/v1/sweeps/{sweep_id}")[0]
    check(left == (404 if status == 204 else 200), f"deleting was answered with {status}, and the sweep with {left}")
    return status == 204


class FullDisk:
    """A small file system, mounted in this process's own namespace, which services are started on."""

    def __init__(self, folder):
        self.folder = folder / "small"
        self.folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=40m", "none", self.folder], check=True)
        atexit.register(subprocess.run, ["umount", "--lazy", self.folder], check=False)
        self.ballast = self.folder / "ballast"

    def fill(self):
        with open(self.ballast, "ab", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass

    def free(self):
        self.ballast.unlink()


def check_full(service, folder, open_for="reading, cancelling and deleting only"):
    state = service.get("/readyz")
    check(state["status"] == "full" and "disk" in state["reason"], f"readiness: {state}")
    check(f"open for {open_for}" in (folder / "log").read_text(), "the log does not tell")


def check_store_without_room(service, sweeps, table):
    """What there is to read is read, and what would be written is refused until there is room for it."""
    check(service.ask("POST", "/v1/sweeps", small_sweep(9))[0] == 507, "a sweep on a full disk")
    check_reads(service, sweeps[0], table)
    for sweep in sweeps:
        check_deleting(service, sweep, (507,))
    check(service.terminate()[0] == 0, "the end of a service that could not write")


def check_start(program):
    """As root of a namespace of its own."""
    folder = temporary_folder()
    disk = FullDisk(folder)
    store = disk.folder / "store.db"

    def start(name=store):
        (folder / "log").unlink(missing_ok=True)
        return Service(program, name, "--threads", "2", "--disk-reserve-mb", "0", log=folder / "log")

    service = start()
    done = [service.submit({**small_sweep(k), "reuse": False}) for k in range(3)]
    check([service.wait_for_end(i) for i in done] == ["succeeded"] * 3, "the first sweeps")
    single = json.loads(service.ask("POST", "/v1/jobs", {"duration_s": 0.05})[2])["id"]
    # Its deletion takes several times the room that is held for it.
    large = service.submit({"parameters": {"duration_s": 0.02}, "reuse": False, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 500}}})
    service.wait_until_idle()
    table = service.results(done[0])
    for end in ("orderly", "killed"):
        busy = service.submit({**busy_sweep(1), "name": end})
        search = json.loads(service.ask("POST", "/v1/searches", long_search())[2])["id"]
        if end == "orderly":
            check(service.terminate()[0] == 0, "the end")
        else:
            service.kill()
        disk.fill()
        refused = subprocess.run([program, "serve", "--db", disk.folder / "new.db", "--port", "0"], capture_output=True, text=True, timeout=20, check=False)
        check(refused.returncode == 3 and "disk is full" in refused.stderr, f"a new store on a full disk: {refused}")
        check(not (disk.folder / "new.db").exists(), "a refused store is left over")
        service = start()
        check_full(service, folder)
        check(service.ask("POST", "/v1/sweeps", small_sweep(9))[0] == 507, "a sweep on a full disk")
        check_reads(service, done[0], table)
        gone = done.pop()
        check(check_deleting(service, gone, (204,)), "deleting")
        if end == "orderly":
            check(service.ask("DELETE", f"/v1/jobs/{single}")[0] == 204, "deleting a single job")
            before = store.stat().st_size
            check(check_deleting(service, large, (204,)), "deleting a large sweep")
            check(store.stat().st_size < before - 1_000_000, f"the store has not become smaller: {before}, {store.stat().st_size}")
        cancelled = service.ask("POST", f"/v1/searches/{search}/cancel")[0]
        check(cancelled == 200, f"cancelling a study: {cancelled}")
        check(service.get(f"/v1/sweeps/{busy}")["counts"]["failed"] == 0, "a job has failed")
        disk.free()
        check(service.get("/readyz") == {"status": "ready"}, "readiness with room")
        after = service.submit({**small_sweep(9), "name": end, "reuse": False})
        check([service.wait_for_end(i) for i in (busy, after)] == ["succeeded"] * 2, "the sweeps after the full disk")
    # A copy, and a store of a process that was killed; neither holds room.
    service.kill()
    copy = copy_store(store, disk.folder)
    store.with_name("store.db.lock").unlink()
    disk.fill()
    # The process that was killed left the index of its log.
    for without_room, open_for in ((copy, "reading only"), (store, "reading, cancelling and deleting only")):
        service = start(without_room)
        check_full(service, folder, open_for)
        if without_room == copy:
            exported = subprocess.run([program, "export", "--db", copy, folder / "export.db"], capture_output=True, text=True, timeout=20, check=False)
            check(exported.returncode == 3 and "locked" in exported.stderr and not (folder / "export.db").exists(), f"a copy by another process: {exported}")
        check_store_without_room(service, done, table)
    service = start(copy)
    disk.free()
    check(service.get("/readyz") == {"status": "ready"}, "readiness of the copy with room")
    check(check_deleting(service, done[0], (204,)), "deleting of the copy with room")
    after = service.submit({**small_sweep(10), "reuse": False})
    check(service.wait_for_end(after) == "succeeded", "a sweep of the copy with room")
    check(service.ask("GET", "/v1/store")[2][:16] == b"SQLite format 3\0", "a copy of the copy")
    check(service.terminate()[0] == 0, "the end")
    for name in (copy, store):
        check_integrity(name)
    print("start: opened, read and made smaller on a full disk; without held room read; a new store refused")


def main():
    program, way = sys.argv[1:]
    if way == "start":
        if os.environ.get("RPSUP_IN_NAMESPACE"):
            check_start(program)
            return
        namespace = ["unshare", "--mount", "--"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--mount", "--"]
        if subprocess.run([*namespace, "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, check=False).returncode != 0:
            skip("this user may not mount a file system")
        os.environ["RPSUP_IN_NAMESPACE"] = "1"
        os.execvp(namespace[0], [*namespace, sys.executable, *sys.argv])
    folder = temporary_folder()
    disk = DISKS[way]()
    service = disk.start(program, folder)
    undisturbed = Service(program, folder / "undisturbed.db", "--threads", "2")
    twin = undisturbed.submit(busy_sweep(1))
    check(undisturbed.wait_for_end(twin) == "succeeded", "the undisturbed sweep")

    done = service.submit(small_sweep(1))
    check(service.wait_for_end(done) == "succeeded", "the first sweep")
    table = service.results(done)
    old = service.submit(small_sweep(4))
    check(service.wait_for_end(old) == "succeeded", "the sweep that is to be deleted")
    busy = service.submit(busy_sweep(1))
    disk.fill()
    accepted, status = 0, 201
    while status == 201 and accepted < 1000:
        status, headers, text = service.ask("POST", "/v1/sweeps", small_sweep(2))
        accepted += status == 201
    check(status == 507, f"a sweep on a full disk: {status} {text}")
    check(headers["Content-Type"] == "application/problem+json", "the form of the refusal")
    time.sleep(1.2)  # jobs end meanwhile and cannot be stored
    check_reads(service, done, table)
    gone = check_deleting(service, old, (204, 507) if way in ("enospc", "quota") else (204,))
    row = service.get(f"/v1/sweeps/{busy}")
    check(row["counts"]["failed"] == 0, "a job has failed")
    check(row["state"] in ("queued", "running"), "the disk was not full while jobs ran")
    disk.free()

    after = service.submit(small_sweep(3))
    check([service.wait_for_end(i) for i in (busy, after)] == ["succeeded", "succeeded"], "the sweeps after the full disk")
    check(service.results(busy) == undisturbed.results(twin), "other results than without a full disk")
    listed = service.get("/v1/sweeps?limit=10000")["items"]
    check(len(listed) == 4 + accepted - gone, "a refused sweep was stored")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    disk.check_store()
    print(f"{way}: refused with {status}, reads answered, nothing lost")


main()
