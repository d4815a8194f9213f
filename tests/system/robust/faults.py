# SPDX-License-Identifier: Apache-2.0
"""Failing system calls, by libfiu (Debian's fiu-utils), switched on and off while a program runs."""

import shutil
import subprocess
from pathlib import Path

LIBRARIES = [Path("/usr/lib/fiu/fiu_run_preload.so"), Path("/usr/lib/fiu/fiu_posix_preload.so")]


def can_inject():
    return shutil.which("fiu-ctrl") is not None and all(library.exists() for library in LIBRARIES)


class Faults:
    def __init__(self, folder):
        self.control = folder / "fiu"

    def environment(self, *commands):
        """As fiu-run makes it, without a shell in between."""
        return {"LD_PRELOAD": " ".join(map(str, LIBRARIES)), "FIU_CTRL_FIFO": str(self.control), "FIU_ENABLE": "\n".join(commands)}

    def tell(self, service, *commands):
        arguments = [part for command in commands for part in ("-c", command)]
        subprocess.run(["fiu-ctrl", "-f", self.control, *arguments, str(service.process.pid)], check=True, timeout=10)
