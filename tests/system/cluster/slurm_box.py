# SPDX-License-Identifier: Apache-2.0
"""A throw-away Slurm cluster of plain processes in one folder: no systemd, no cgroups, no database, nothing under /etc. Loopback only.

Tried with Slurm 22.05 (Debian 12); the settings for newer ones are from Slurm's own documentation of cgroup.conf.
"""

import atexit
import getpass
import os
import re
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

INSIDE = "SLURM_BOX_INSIDE"
DAEMONS = ("munged", "slurmctld", "slurmd")
CLIENTS = ("sbatch", "squeue", "scancel", "scontrol", "sinfo")
ADDRESS = "127.0.0.1"

CONFIG = """\
ClusterName=box
SlurmctldHost=localhost({address})
SlurmctldPort={port}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
# cred_expire is also how long a task that is started again has to wait; less than 5 s counts as the default of 120 s.
AuthInfo=socket={box}/run/munge.socket,cred_expire=5
PluginDir={plugins}
StateSaveLocation={box}/state
SlurmdSpoolDir={box}/spool.%n
SlurmctldPidFile={box}/run/slurmctld.pid
SlurmdPidFile={box}/run/slurmd.%n.pid
SlurmctldLogFile={box}/log/slurmctld.log
SlurmdLogFile={box}/log/slurmd.%n.log
MailProg=/bin/true
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0,bf_interval=1
MaxArraySize=1001
MaxJobCount=50000
MinJobAge=300
SlurmdTimeout=10
SlurmctldTimeout=10
KillWait=2
JobRequeue=1
ReturnToService=2
# Several nodes on one machine, which may claim more processors than it has.
SlurmdParameters=config_overrides
NodeName=n[1-{nodes}] NodeHostname=localhost NodeAddr={address} Port=[{first}-{last}] CPUs={cpus} RealMemory=1024 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def find_program(name):
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def why_not():
    """Why there can be no cluster on this machine; empty if there can."""
    missing = [name for name in (*DAEMONS, *CLIENTS) if not find_program(name)]
    if missing:
        return f"Slurm is not installed ({', '.join(missing)} missing); script/setup all installs it"
    if not plugins():
        return "Slurm's plugins are not installed; script/setup all installs them"
    try:
        loopback = socket.gethostbyname(socket.gethostname()).startswith("127.")
    except OSError:
        loopback = False
    name = socket.gethostname()
    return "" if loopback else f"the name of this machine, {name}, does not stand for 127.x, so that Slurm would listen on the network"


def plugins():
    return next((str(path) for path in Path("/usr/lib").glob("*/slurm-wlm")), None)


def enter_own_network():
    """Starts this program again in a network of its own, where no port is taken and nobody else can come; goes on here if that is not allowed."""
    if os.environ.get(INSIDE):
        return
    # Root needs no user namespace, and slurmd would fail in one.
    unshare = ["unshare", "--net"] if os.geteuid() == 0 else ["unshare", "--map-current-user", "--keep-caps", "--net"]
    # Slurm resolves addresses only if there is one besides 127.x.
    ready = "ip link set lo up && ip addr add 192.0.2.77/32 dev lo"
    if not shutil.which("ip") or subprocess.run([*unshare, "sh", "-c", ready], capture_output=True).returncode != 0:
        return
    os.execvpe("unshare", [*unshare, "sh", "-c", ready + ' && exec "$@"', "sh", sys.executable, *sys.argv], {**os.environ, INSIDE: "1"})


def free_ports(count):
    """The first of so many free ports in a row."""
    for _ in range(100):
        first = 20000 + secrets.randbelow(10000)
        try:
            for port in range(first, first + count):
                with socket.socket() as probe:
                    probe.bind((ADDRESS, port))
            return first
        except OSError:
            continue
    raise AssertionError("no free ports")


class SlurmBox:
    def __init__(self, folder, nodes=2, cpus=2):
        self.box = Path(folder)
        self.nodes = [f"n{k + 1}" for k in range(nodes)]
        self.config = self.box / "slurm.conf"
        self.environment = {**os.environ, "SLURM_CONF": str(self.config)}
        for part in ("run", "log", "state", *(f"spool.{node}" for node in self.nodes)):
            (self.box / part).mkdir(parents=True)
        self.box.chmod(0o755)
        port = free_ports(nodes + 1)
        self.config.write_text(CONFIG.format(address=ADDRESS, port=port, first=port + 1, last=port + nodes, nodes=nodes, cpus=cpus, box=self.box,
                                             user=getpass.getuser(), plugins=plugins()))
        # slurmd starts a plugin for cgroups in any case: since 23.11 one that does nothing; of the older ones v1 starts without them, too.
        version = tuple(int(n) for n in re.findall(r"\d+", self.run("slurmd", "-V"))[:2])
        (self.box / "cgroup.conf").write_text("CgroupPlugin=disabled\n" if version >= (23, 11) else "CgroupPlugin=cgroup/v1\n")
        key = self.box / "munge.key"
        key.write_bytes(secrets.token_bytes(1024))
        key.chmod(0o400)
        atexit.register(self.stop)
        self.start_munge()
        self.start_controller("-i")
        for node in self.nodes:
            self.start_node(node)
        self.wait_until_idle()

    def run(self, name, *arguments, check=True):
        done = subprocess.run([find_program(name), *arguments], env=self.environment, capture_output=True, text=True, timeout=60, start_new_session=True)
        if check and done.returncode != 0:
            raise AssertionError(f"{name} {' '.join(arguments)}: {done.stdout}{done.stderr}")
        return done.stdout

    def start_munge(self):
        run = self.box / "run"
        # Although a folder above is writable for others, as the one for temporary files.
        self.run("munged", "--force", f"--key-file={self.box}/munge.key", f"--socket={run}/munge.socket", f"--pid-file={run}/munged.pid",
                 f"--log-file={self.box}/log/munged.log", f"--seed-file={run}/munged.seed", "--num-threads=2")

    def start_controller(self, *options):
        self.run("slurmctld", "-f", str(self.config), *options)

    def lose_controller_state(self):
        """The controller as after a crash that took its disk: it knows no job.

        Numbers begin elsewhere, or new tasks would have those of tasks that still run."""
        self.kill(self.box / "run/slurmctld.pid")
        with open(self.config, "a", encoding="ascii") as config:
            config.write(f"FirstJobId={100000 + secrets.randbelow(30000)}\n")
        self.start_controller("-c")

    def start_node(self, node):
        stepd = find_program("slurmstepd") or find_program("slurmstepd-wlm")
        self.run("slurmd", "-N", node, "-f", str(self.config), "-d", stepd)

    def processes_of(self, node):
        """The tasks that a node runs, and what watches them."""
        pids = []
        for process in Path("/proc").iterdir():
            if not process.name.isdigit():
                continue
            try:
                variables = (process / "environ").read_bytes().split(b"\0")
                if f"SLURMD_NODENAME={node}".encode() not in variables or f"SLURM_CONF={self.config}".encode() not in variables:
                    continue
                parent = int((process / "stat").read_text().rpartition(")")[2].split()[1])
                if b"slurmstepd" in Path(f"/proc/{parent}/cmdline").read_bytes():
                    pids.append(parent)
                pids.append(int(process.name))
            except (OSError, ValueError):
                continue  # it has ended
        return pids

    def cut_power(self, node):
        """The node's daemon and all it has started, at once."""
        pid_file = self.box / f"run/slurmd.{node}.pid"
        for pid in dict.fromkeys([int(pid_file.read_text()), *self.processes_of(node)]):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        pid_file.unlink()
        # State of the node in an unattended cluster after SlurmdTimeout and more.
        self.run("scontrol", "update", f"nodename={node}", "state=down", "reason=power")

    def give_power(self, node):
        self.start_node(node)
        self.run("scontrol", "update", f"nodename={node}", "state=resume", check=False)

    def wait_until_idle(self, seconds=30):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            states = self.run("sinfo", "-h", "-N", "-o", "%T", check=False).split()
            if states == ["idle"] * len(self.nodes):
                return
            time.sleep(0.05)
        logs = "".join(f"--- {log.name}\n" + log.read_text(errors="replace")[-800:] for log in sorted((self.box / "log").iterdir()))
        raise AssertionError(f"the nodes are {states} after {seconds} s\n{logs}")

    def kill(self, pid_file, how=signal.SIGKILL):
        try:
            pid = int(pid_file.read_text())
            os.kill(pid, how)
            for _ in range(100):
                os.kill(pid, 0)
                time.sleep(0.05)
            os.kill(pid, signal.SIGKILL)
        except (OSError, ValueError):
            pass
        pid_file.unlink(missing_ok=True)

    def stop(self):
        self.run("scancel", "--user", getpass.getuser(), check=False)
        for name in (*(f"slurmd.{node}" for node in self.nodes), "slurmctld", "munged"):
            self.kill(self.box / f"run/{name}.pid", signal.SIGTERM)
