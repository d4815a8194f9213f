# SPDX-License-Identifier: Apache-2.0
"""Types and units of the columns of tables."""

import contextlib
import io
import os
import subprocess
import sys
import unittest
from unittest import mock

import rpsup
from rpsup import progress
from rpsup.table import Column, Tables, frame
from support import SHORT, WithProgram

FOUR_BAR = os.path.join(os.path.dirname(__file__), "../../web/linkages/four_bar.json")


class Columns(WithProgram):
    def test_types_of_results(self):
        table = self.sweep.results()
        kinds = {name: str(kind) for name, kind in table.dtypes.items()}
        self.assertEqual(kinds["job_id"], "object")
        self.assertEqual((kinds["state"], kinds["coupler"]), ("category", "category"))
        self.assertEqual((kinds["steps"], kinds["impact_count"]), ("int64", "int64"))
        # 0 and 0.25 in JSON: an integer and a number of one column.
        self.assertEqual((kinds["clearance_mm"], kinds["peak_contact_force_n"]), ("float64", "float64"))
        self.assertEqual(list(table.coupler.cat.categories), ["rigid", "flexible"])
        self.assertEqual(list(table.state.cat.categories), ["succeeded"])
        self.assertTrue(table.peak_contact_force_n[table.clearance_mm == 0].isna().all())
        self.assertTrue((table.peak_contact_force_n[table.clearance_mm > 0] > 0).all())

    def test_units_of_results_are_those_of_the_service(self):
        units = self.sweep.results().attrs["units"]
        schemas = self.client.get("/v1/openapi.json")["components"]["schemas"]
        metrics = {
            name: schema["x-unit"] for name, schema in schemas["Metrics"]["anyOf"][0]["properties"].items()
        }
        self.assertEqual(
            units, {**metrics, "clearance_mm": self.client.parameters()["clearance_mm"]["x-unit"]}
        )
        self.assertGreater(len(metrics), 20)

    def test_an_empty_table_has_its_columns(self):
        table, empty = self.sweep.results(), self.sweep.results(state="failed")
        self.assertEqual((len(empty), list(empty.columns)), (0, list(table.columns)))
        self.assertEqual(str(empty.steps.dtype), "int64")

    def test_integers_with_gaps_and_truth_values(self):
        sweep = self.client.submit(
            cases=[{"integrator": "rk4", "step_s": 1e-3}, {}], clearance_mm=0.25, **SHORT
        ).wait()
        table = sweep.results()
        self.assertEqual(list(table.state), ["failed", "succeeded"])
        self.assertEqual(
            str(table.impact_count.dtype), "Int64" if table.impact_count.isna().any() else "int64"
        )
        truths = frame(
            [{"a": True, "b": None}, {"a": False, "b": True}], ["a", "b"], [Column("boolean", None)] * 2
        )
        self.assertEqual([str(kind) for kind in truths.dtypes], ["bool", "boolean"])
        gaps = frame([{"a": 2**53 + 1}, {"a": None}], ["a"], [Column("integer", "1")])
        self.assertEqual(
            (str(gaps.a.dtype), gaps.a[0]), ("Int64", 2**53 + 1)
        )  # a double has no such integer

    def test_described_linkages(self):
        with open(FOUR_BAR, encoding="utf-8") as file:
            job = self.client.submit_job(file.read()).wait()
        with open(FOUR_BAR, encoding="utf-8") as file:
            sweep = self.client.submit(
                {
                    "parameters": rpsup.client._request_of(file.read()),
                    "cases": [{"linkage.bodies.rocker.mass_kg": 0.5}, {}],
                }
            )
        table = sweep.wait().results()
        units = table.attrs["units"]
        self.assertEqual(units["linkage.bodies.rocker.mass_kg"], "kg")
        self.assertEqual(units["peak_crank_drive_n_m"], "N m")
        self.assertEqual(units["peak_rocker_pin_reaction_n"], "N")
        self.assertEqual(str(table.face_impact_count.dtype), "int64")
        run = job.trajectory(points=500, frame=True)
        self.assertEqual(run.attrs["units"]["crank_rad_s2"], "rad/s²")
        self.assertEqual(run.attrs["units"]["crank_drive_n_m"], "N m")
        self.assertEqual(run.attrs["units"]["pose_crank_x_m"], "m")

    def test_units_by_name(self):
        for name, unit in {
            "clearance_mm": "mm",
            "axial_stiffness_n_m": "N/m",
            "crank_torque_n_m": "N m",
            "max_penetration_um": "µm",
            "any_joint_rad_s": "rad/s",
            "restitution": None,
            "amplification": "1",
            "nothing_of_it": None,
        }.items():
            self.assertEqual(self.client.unit(name), unit, name)


class OldService(unittest.TestCase):
    def test_a_table_that_the_document_does_not_have(self):
        tables = Tables({"paths": {}, "components": {"schemas": {"Parameters": {}}}})
        self.assertEqual(tables.column("/v1/sweeps/{id}/new", "a_mm").kind, "object")


class WithoutPackages(WithProgram):
    """An interpreter without NumPy and pandas, as the option -S of Python makes one."""

    def run_bare(self, script):
        code = (
            f"import sys\nsys.path.insert(0, {os.path.dirname(os.path.dirname(rpsup.__file__))!r})\n{script}"
        )
        environment = {"RPSUP_URL": self.client.url, "RPSUP_TOKEN": self.client._program.token}
        return subprocess.run(
            [sys.executable, "-S", "-B", "-c", code], env=environment, capture_output=True, text=True
        )

    def test_rows_and_trajectories(self):
        done = self.run_bare(
            f"""
import rpsup
sweep = rpsup.Client().sweep({self.sweep.id!r}).wait()
print([row["coupler"] for row in sweep.rows()])
run = sweep.jobs()[0].trajectory(["slider_position_m"], to_s=0.009)
print(sorted(run), type(run["t_s"]).__name__, len(run["t_s"]))
assert "numpy" not in sys.modules and "pandas" not in sys.modules
"""
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("['rigid', 'flexible', 'rigid', 'flexible']", done.stdout)
        self.assertIn("['slider_position_m', 't_s'] list 10\n", done.stdout)

    def test_a_table_says_what_is_missing(self):
        done = self.run_bare(f"import rpsup; rpsup.Client().sweep({self.sweep.id!r}).results()")
        self.assertEqual(done.returncode, 1)
        self.assertIn("ImportError: a DataFrame needs pandas", done.stderr)
        self.assertIn("rows() and trajectory() work without", done.stderr)


class Progress(unittest.TestCase):
    STATUS = {
        "counts": {"total": 8, "succeeded": 3, "failed": 1, "cancelled": 0},
        "progress": 0.5,
        "eta_s": 12.4,
    }

    def test_says_how_far_a_study_is(self):
        self.assertEqual(progress.text_of(self.STATUS, 10), "[#####-----] 4 of 8 jobs, 1 failed, 12 s left")
        self.assertEqual(progress.text_of({"counts": {}, "progress": 0.5}, 4), "[##--] 0 of 0 jobs")
        self.assertEqual(progress.text_of({"state": "running", "metrics": None}), "running")  # a job

    def test_stays_in_one_line_of_a_narrow_terminal(self):
        said = io.StringIO()
        with mock.patch.object(progress.shutil, "get_terminal_size", lambda: os.terminal_size((20, 5))):
            with contextlib.redirect_stderr(said), progress.Bar(True) as bar:
                bar.draw({"counts": {"total": 100, "succeeded": 99}})
                bar.draw({"state": "succeeded"})
        self.assertEqual([len(line) for line in said.getvalue().rstrip("\n").split("\r")], [0, 19, 19])

    def test_draws_on_terminals_only_unless_it_is_asked_to(self):
        for wanted, is_terminal, is_drawn in (
            (None, True, True),
            (None, False, False),
            (True, False, True),
            (False, True, False),
        ):
            said = io.StringIO()
            said.isatty = lambda: is_terminal
            with contextlib.redirect_stderr(said), progress.Bar(wanted) as bar:
                bar.draw(self.STATUS)
                bar.draw(self.STATUS)  # draws the same line once
            self.assertEqual(said.getvalue().count("4 of 8 jobs"), int(is_drawn), (wanted, is_terminal))

    def test_draws_over_itself_in_a_notebook(self):
        shell, display = mock.Mock(), mock.Mock()
        with mock.patch.object(progress.builtins, "get_ipython", shell, create=True), mock.patch.dict(
            sys.modules, {"IPython": mock.Mock(), "IPython.display": mock.Mock(display=display)}
        ), progress.Bar() as bar:
            bar.draw({"counts": {"total": 2, "succeeded": 1}})
            bar.draw({"counts": {"total": 2, "succeeded": 2}})
        self.assertIn("1 of 2 jobs", repr(display.call_args[0][0]))
        self.assertIn("2 of 2 jobs", repr(display.return_value.update.call_args[0][0]))


if __name__ == "__main__":
    unittest.main()
