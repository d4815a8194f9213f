# SPDX-License-Identifier: Apache-2.0
"""The program that the package starts: it ends with whatever started it, and says why it did not start."""

import os
import re
import stat
import subprocess
import sys
import tempfile
import time
import unittest

import rpsup
from support import PROGRAM


class Starts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def script(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + text)
        os.chmod(path, stat.S_IRWXU)
        return path

    def test_ends_with_the_block_also_by_an_exception(self):
        with self.assertRaises(KeyError):
            with rpsup.start(program=PROGRAM) as client:
                process = client._program._process
                self.assertIsNone(process.poll())
                raise KeyError
        self.assertEqual(process.returncode, 0)  # of SIGTERM, after everything is stored
        self.assertFalse(os.path.exists(client._program._folder.name))
        client.close()  # once more does nothing

    def test_ends_with_the_interpreter(self):
        code = "import rpsup, sys; client = rpsup.start(program=sys.argv[1]); print(client.url)"
        done = subprocess.run(
            [sys.executable, "-c", code, PROGRAM], capture_output=True, text=True, check=True
        )
        with self.assertRaises(rpsup.Unreachable):
            rpsup.Client(done.stdout.strip(), patience_s=0).newest(rpsup.Sweep)

    def test_ends_with_a_process_that_is_killed(self):
        code = """
import os, rpsup, signal, sys
client = rpsup.start(sys.argv[2], program=sys.argv[1])
print(client.submit(clearance_mm=[0.1], duration_s=600).id, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""
        store = os.path.join(self.folder, "study.db")
        done = subprocess.run([sys.executable, "-c", code, PROGRAM, store], capture_output=True, text=True)
        self.assertEqual(done.returncode, -9)
        for _ in range(300):  # until the program has left the store
            try:
                with rpsup.start(store, program=PROGRAM) as client:
                    client.sweep(done.stdout.strip()).cancel()
                return
            except rpsup.ProgramError as error:
                self.assertIn("exit code 3", str(error))
                time.sleep(0.1)
        self.fail("the program goes on")

    def test_lives_on_when_a_wait_is_interrupted(self):
        code = """
import os, rpsup, signal, sys, threading
with rpsup.start(program=sys.argv[1]) as client:
    sweep = client.submit(clearance_mm=[0.1], duration_s=600)
    threading.Timer(0.5, os.killpg, (0, signal.SIGINT)).start()  # as Ctrl-C does
    try:
        sweep.wait()
    except KeyboardInterrupt:
        print(sweep.cancel()["state"])
"""
        done = subprocess.run(
            [sys.executable, "-c", code, PROGRAM], capture_output=True, text=True, start_new_session=True
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn(done.stdout.strip(), ("running", "cancelled"))

    def test_a_named_store_stays(self):
        store = os.path.join(self.folder, "study.db")
        with rpsup.start(store, program=PROGRAM) as client:
            sweep = client.submit(clearance_mm=[0.1], duration_s=0.05, run_up_s=0.02).wait()
            with self.assertRaisesRegex(rpsup.ProgramError, "exit code 3"):
                rpsup.start(store, program=PROGRAM)  # in use, as the program says
        with rpsup.start(store, threads=1, program=PROGRAM) as client:
            self.assertEqual(client.sweep(sweep.id).status()["state"], "succeeded")
            self.assertEqual(client.get("/v1/executors")["items"][0]["slots"], 1)

    def test_options_of_the_environment_are_not_those_of_the_program(self):
        os.environ["RPSUP_THREADS"] = "13"
        self.addCleanup(os.environ.pop, "RPSUP_THREADS")
        with rpsup.start(program=PROGRAM) as client:
            self.assertNotEqual(client.get("/v1/executors")["items"][0]["slots"], 13)
            self.assertEqual(client.newest(rpsup.Sweep), [])
            with self.assertRaises(rpsup.Error) as caught:
                rpsup.Client(client.url).newest(rpsup.Sweep)
            self.assertEqual(caught.exception.status, 401)  # nobody else on the machine may use it

    def test_a_program_that_is_not_installed(self):
        path, os.environ["PATH"] = os.environ["PATH"], self.folder
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        with self.assertRaisesRegex(
            rpsup.ProgramError, "the program rpsup is not installed: no folder of PATH"
        ):
            rpsup.start()
        with self.assertRaisesRegex(rpsup.ProgramError, "/nowhere/rpsup is not there"):
            rpsup.start(program="/nowhere/rpsup")

    def test_a_program_that_is_another_one(self):
        for text, said in {
            "echo hello; sleep 60": "it said 'hello'",
            "echo no room >&2; exit 3": "code 3:\n  no room",
            "exec sleep 0.1": "code 0",
        }.items():
            with self.subTest(text), self.assertRaisesRegex(rpsup.ProgramError, said):
                rpsup.start(program=self.script("rpsup", text))
        garbage = self.script("rpsup", "")
        with open(garbage, "wb") as file:
            file.write(b"\x7fELF nonsense")
        with self.assertRaisesRegex(rpsup.ProgramError, "ended at its start"):
            rpsup.start(program=garbage)


class Version(unittest.TestCase):
    def test_is_that_of_the_program(self):
        said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        version = re.sub(r"[+.]g[0-9a-f]{12}(\.dirty)?$", "", said.split()[1])  # the package names no commit
        self.assertEqual(rpsup.__version__, version)


if __name__ == "__main__":
    unittest.main()
