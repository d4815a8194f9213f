# SPDX-License-Identifier: Apache-2.0
"""Takes the room on the disk away while jobs run, and gives it back: disk_full.py PROGRAM tmpfs|enospc|quota|size_limit

tmpfs       a file system of 3 MiB of its own, filled by another file; needs the right to mount one
enospc      every write to the store fails as on a full disk; needs Debian's fiu-utils
quota       the same as beyond a user's quota
size_limit  no file may grow beyond what it is (RLIMIT_FSIZE, as systemd's LimitFSIZE)

While it lasts: new sweeps are refused with a 507 problem document, deleting a sweep is done or refused so, reads are
answered as before, no job fails. Afterwards, without a new start: everything is computed, byte for byte as if nothing had been.
"""

import errno
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
        mount = ["sh", "-c", f"mount -t tmpfs -o size=5m none '{inside}' && exec \"$@\"", "sh"]
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


def check_reads(service, sweep_id, table):
    check(service.results(sweep_id) == table, "results while the disk is full")
    job = service.get(f"/v1/sweeps/{sweep_id}/results")[0]["job_id"]
    for path in (f"/v1/jobs/{job}", f"/v1/jobs/{job}/trajectory", "/v1/sweeps", "/healthz"):
        check(service.ask("GET", path)[0] == 200, f"{path} while the disk is full")


def check_deleting(service, sweep_id):
    """Returns whether it is gone."""
    status = service.ask("DELETE", f"/v1/sweeps/{sweep_id}")[0]
    check(status in (204, 507), f"deleting on a full disk: {status}")
    left = service.ask("GET", f"/v1/sweeps/{sweep_id}")[0]
    check(left == (404 if status == 204 else 200), f"deleting was answered with {status}, and the sweep with {left}")
    return status == 204


def main():
    program, way = sys.argv[1:]
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
    gone = check_deleting(service, old)
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
