# SPDX-License-Identifier: Apache-2.0
"""Studies, jobs and measurements of a running program, through the package alone."""

import csv
import io
import json
import os
import tempfile
import unittest
import urllib.request

import rpsup
from support import SHORT, WithProgram

TINY = {"duration_s": 0.05, "run_up_s": 0.02}


class Sweeps(WithProgram):
    def fetch(self, path):
        """What the service says without this package."""
        request = urllib.request.Request(self.client.url + path)
        request.add_header("Authorization", f"Bearer {self.client._program.token}")
        with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(request) as answer:
            return answer.read().decode()

    def test_rows_are_those_of_the_table(self):
        rows = self.sweep.rows()
        table = list(csv.DictReader(io.StringIO(self.fetch(f"{self.sweep.path}/results?format=csv"))))
        self.assertEqual([list(row) for row in rows], [list(row) for row in table])
        self.assertEqual([row["job_id"] for row in rows], [row["job_id"] for row in table])
        for row, text in zip(rows, table):
            self.assertEqual(
                row["peak_slider_acceleration_m_s2"], float(text["peak_slider_acceleration_m_s2"])
            )
        self.assertEqual(
            [(row["clearance_mm"], row["coupler"]) for row in rows],
            [(0, "rigid"), (0, "flexible"), (0.25, "rigid"), (0.25, "flexible")],
        )

    def test_filters_fields_and_order(self):
        rows = self.sweep.rows(
            fields=["clearance_mm", "steps"],
            coupler="rigid",
            clearance_mm_ge=0,
            order_by=["-clearance_mm"],
            limit=2,
        )
        self.assertEqual([row["clearance_mm"] for row in rows], [0.25, 0])
        self.assertEqual(list(rows[0]), ["clearance_mm", "steps"])
        self.assertEqual(len(self.sweep.jobs(coupler="rigid")), 2)

    def test_requests_by_name_as_dict_and_as_text_are_one(self):
        whole = {"parameters": TINY, "sweep": {"clearance_mm": [0.1, 0.2]}, "name": "thrice"}
        sweeps = [
            self.client.submit(whole),
            self.client.submit(json.dumps(whole)),
            self.client.submit(name="thrice", clearance_mm=[0.1, 0.2], **TINY),
            self.client.submit(name="thrice", clearance_mm=range(0, 1), **TINY),
        ]
        requests = [sweep.status()["request"] for sweep in sweeps]
        self.assertEqual(requests[0], requests[1])
        self.assertEqual(requests[0], requests[2])
        self.assertEqual(requests[3]["sweep"], {"clearance_mm": [0]})
        alone = self.client.submit(keep="metrics", clearance_mm=[0.1], **TINY)
        self.assertEqual(alone.status()["request"]["keep"], "metrics")
        ranged = self.client.submit(clearance_mm={"from": 0.1, "to": 0.3, "count": 3}, **TINY)
        self.assertEqual([row["clearance_mm"] for row in ranged.wait().rows()], [0.1, 0.2, 0.3])
        with self.assertRaises(TypeError):
            self.client.submit("[1]")

    def test_all_faults_of_a_request_with_their_places(self):
        with self.assertRaises(rpsup.Error) as caught:
            self.client.submit(clearence_mm=0.1, restitution=1.5)
        error = caught.exception
        self.assertEqual((error.status, error.code), (422, "Unprocessable Content"))
        self.assertEqual(
            {fault.pointer for fault in error.faults}, {"/parameters/clearence_mm", "/parameters/restitution"}
        )
        self.assertIn("did you mean clearance_mm?", str(error))
        self.assertIn("must be a number in [0, 1]", str(error))
        with self.assertRaises(rpsup.Error) as caught:
            self.client.sweep("swp_none").status()
        self.assertEqual(caught.exception.status, 404)

    def test_a_token_that_is_wrong(self):
        with self.assertRaises(rpsup.Error) as caught:
            rpsup.Client(self.client.url, "wrong").newest(rpsup.Sweep)
        self.assertEqual(caught.exception.status, 401)

    def test_extend_retry_move_and_delete(self):
        sweep = self.client.submit(clearance_mm=[0.1], cases=[{"coupler": "rigid"}], **TINY).wait()
        self.assertEqual(sweep.extend(clearance_mm=[0.2])["counts"]["total"], 2)
        self.assertEqual(sweep.wait().extend(cases=[{"coupler": "flexible"}])["counts"]["total"], 4)
        self.assertEqual(sweep.wait().retry()["counts"]["succeeded"], 4)
        with self.assertRaises(rpsup.Error):
            sweep.move("slurm")  # this program has none
        waiting = self.client.submit(crank_velocity_rad_s=[4, 5, 6, 7], duration_s=600)
        self.assertEqual(waiting.move("local")["executor"], "local")
        waiting.cancel()
        sweep.delete()
        with self.assertRaises(rpsup.Error) as caught:
            sweep.status()
        self.assertEqual(caught.exception.status, 404)

    def test_name_notes_and_tags(self):
        sweep = self.client.submit(name="first", clearance_mm=[0.1], **TINY).wait()
        self.assertEqual(sweep.describe(notes="pin B", tags=("dry", "rig 2"))["tags"], ["dry", "rig 2"])
        status = sweep.describe(name="second")
        self.assertEqual((status["name"], status["notes"], status["tags"]), ("second", "pin B", ["dry", "rig 2"]))
        with self.assertRaises(rpsup.Error) as refused:
            sweep.describe(tags=["x" * 51])
        self.assertEqual([fault.pointer for fault in refused.exception.faults], ["/tags/0"])

    def test_estimate_stores_nothing(self):
        before = len(self.client.newest(rpsup.Sweep))
        cost = self.client.estimate(clearance_mm=[0, 0.25, 0.3], coupler=["rigid", "flexible"], **SHORT)
        self.assertEqual((cost["jobs"], cost["stored_jobs"], cost["new_jobs"]), (6, 4, 2))
        self.assertGreater(cost["seconds"], 0)
        self.assertEqual(len(self.client.newest(rpsup.Sweep)), before)

    def test_wait_ends_by_its_timeout_and_after_a_cancel(self):
        sweep = self.client.submit(crank_velocity_rad_s=[5, 6], duration_s=600)
        with self.assertRaisesRegex(TimeoutError, "after 0.3 s"):
            sweep.wait(timeout_s=0.3)
        sweep.cancel()
        self.assertEqual(sweep.wait().status()["state"], "cancelled")

    def test_failed_jobs_end_a_wait_and_say_why(self):
        sweep = self.client.submit(clearance_mm=[0.25], integrator="rk4", step_s=1e-3, **SHORT).wait(
            timeout_s=60
        )
        rows = sweep.rows(fields=["state", "error_reason"])
        self.assertEqual([tuple(row.values()) for row in rows], [("failed", "non_finite")])

    def test_analyses_of_a_sweep(self):
        table = self.sweep.flexibility()
        peaks = {
            (row["clearance_mm"], row["coupler"]): row["peak_slider_acceleration_m_s2"]
            for row in self.sweep.rows()
        }
        for row in table.itertuples():
            expected = peaks[row.clearance_mm, "flexible"] / peaks[row.clearance_mm, "rigid"]
            self.assertAlmostEqual(row.ratio, expected, places=12)
        self.assertEqual(len(table), 2)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        with open(self.sweep.report(os.path.join(folder.name, "report.html")), encoding="utf-8") as page:
            self.assertIn(self.sweep.id, page.read())
        turns = self.sweep.bifurcation("slider_position_m", from_s=0.0)
        self.assertTrue(set(turns.job_id) <= {row["job_id"] for row in self.sweep.rows()})

    def test_sensitivity_surrogate_and_lyapunov(self):
        over = {"clearance_mm": {"from": 0.05, "to": 0.5}, "restitution": {"from": 0.6, "to": 0.95}}
        sweep = self.client.submit(design={"type": "morris", "trajectories": 2, "over": over}, **TINY).wait()
        self.assertEqual(list(sweep.sensitivity("steps").parameter), ["clearance_mm", "restitution"])
        surrogate = sweep.surrogate("steps", x="restitution", y="clearance_mm")
        self.assertEqual((surrogate["x"], surrogate["y"]), ("restitution", "clearance_mm"))
        again = self.client.submit(replicates={"count": 2}, clearance_mm=[0.25], **SHORT).wait()
        self.assertEqual(len(again.lyapunov()), 1)
        self.assertEqual(list(again.results().replicate), [0, 1])


class Jobs(WithProgram):
    def test_a_single_job(self):
        job = self.client.submit_job(clearance_mm=0.25, coupler="rigid", **SHORT).wait()
        row = self.sweep.rows(clearance_mm=0.25, coupler="rigid")[0]
        self.assertEqual(job.metrics["peak_slider_acceleration_m_s2"], row["peak_slider_acceleration_m_s2"])
        job.delete()
        with self.assertRaises(rpsup.Error):
            job.status()

    def test_trajectories_are_those_of_the_service(self):
        job = self.sweep.jobs(clearance_mm=0.25)[0]
        channels = ["slider_acceleration_m_s2", "journal_x_mm"]
        run = self.client.trajectory(job, channels, from_s=0.1, to_s=0.2)
        answer = self.client.get(f"{job.path}/trajectory", {"channels": channels, "from": 0.1, "to": 0.2})
        self.assertEqual(list(run), ["t_s", *channels])
        for name, values in answer["columns"].items():
            self.assertEqual(list(run[name]), values)
        self.assertEqual((run["t_s"].dtype, run["t_s"].ndim), ("float64", 1))
        self.assertGreater(len(run["t_s"]), 10)
        thinned = self.client.trajectory(job.id, channels, points=20, frame=True)
        self.assertLessEqual(len(thinned), 20)
        self.assertEqual(thinned.index.name, "t_s")
        self.assertEqual(
            thinned.attrs["units"], {"t_s": "s", "slider_acceleration_m_s2": "m/s²", "journal_x_mm": "mm"}
        )

    def test_analyses_of_a_job(self):
        job = self.client.submit_job(
            clearance_mm=0.25, crank_velocity_rad_s=40, duration_s=0.6, run_up_s=0.1
        ).wait()
        spectrum = job.spectrum("slider_acceleration_m_s2", window="flat_top", from_s=0.1, frame=True)
        self.assertEqual(spectrum.index.name, "frequency_hz")
        self.assertEqual(spectrum.attrs["units"]["frequency_hz"], "Hz")
        section = job.poincare(["journal_x_mm"], phase_rad=1.0, from_s=0.0)
        # The crank turns 40 rad/s * 0.5 s = 20 rad in steady motion, three turns and a part.
        self.assertIn(len(section["journal_x_mm"]), (3, 4))
        wear = job.wear(sectors=12, wear_coefficient_m2_n=1e-14)
        self.assertEqual(len(wear) % 12, 0)
        self.assertEqual(wear.attrs["units"]["depth_um"], "µm")
        self.assertEqual(str(wear.ring.dtype), "int64")


class Studies(WithProgram):
    def test_search(self):
        search = self.client.search(
            over={"clearance_mm": {"from": 0.05, "to": 0.45, "tolerance": 0.2, "first": 2}},
            metric="peak_slider_acceleration_m_s2",
            bound=1e6,
            parameters=SHORT,
        ).wait()
        self.assertEqual([limit["verdict"] for limit in search.limits()], ["never_exceeded"])
        self.assertEqual(list(search.results().verdict), ["never_exceeded"])
        is_monotonic = search.limits()[0]["monotonic"]
        self.assertEqual(
            [len(search.rows(monotonic=value)) for value in (is_monotonic, not is_monotonic)], [1, 0]
        )
        self.assertEqual(str(search.results().monotonic.dtype), "bool")
        self.assertEqual(self.client.newest(rpsup.Search)[0].id, search.id)
        self.assertEqual(self.client.of(rpsup.Search, search.id).status()["state"], "succeeded")

    def test_wear(self):
        study = self.client.wear(
            hours=1000,
            max_cycles=2,
            sectors=8,
            wear_coefficient_m2_n=1e-16,
            parameters={"clearance_mm": 0.25, **SHORT},
        ).wait()
        table = study.results()
        self.assertGreaterEqual(len(table), 1)
        self.assertTrue((table.hours.diff().dropna() > 0).all())

    def test_optimisation(self):
        over = {"clearance_mm": {"from": 0.05, "to": 0.4}, "restitution": {"from": 0.6, "to": 0.9}}
        study = self.client.optimise(
            over=over, objectives=[{"metric": "steps"}], budget=10, starts=1, population=5, parameters=TINY
        ).wait()
        best = min(study.rows(state="feasible"), key=lambda row: row["steps"])
        self.assertEqual(study.best()["metrics"]["steps"], best["steps"])
        self.assertIn(
            best["clearance_mm"], (candidate["values"]["clearance_mm"] for candidate in study.front())
        )

    def test_measurement_and_fit(self):
        shared = {"coupler": "rigid", "clearance_mm": 0, "run_up_s": 0.1}
        job = self.client.submit_job(guide_angle_deg=1, duration_s=0.2, **shared).wait()
        run = job.trajectory(["slider_acceleration_m_s2"])
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "bench.csv")
        with open(path, "w", encoding="utf-8") as file:
            file.write("time_s,acc\n")
            file.writelines(f"{t},{a}\n" for t, a in zip(run["t_s"], run["slider_acceleration_m_s2"]))
        measured = self.client.measure(path, channels={"acc": "slider_acceleration_m_s2"})
        self.assertEqual(measured.status()["name"], "bench.csv")
        data = measured.data(from_s=0.1)
        self.assertEqual(
            data["slider_acceleration_m_s2"].tolist(),
            job.trajectory(["slider_acceleration_m_s2"], from_s=0.1)["slider_acceleration_m_s2"].tolist(),
        )
        fit = self.client.fit(
            over={"guide_angle_deg": {"from": -5, "to": 5}},
            measurements=[measured],
            budget=30,
            intervals="linearised",
            parameters=shared,
        )
        (parameter,) = fit.wait().parameters()
        self.assertAlmostEqual(parameter["value"], 1.0, delta=0.01)  # that of the job that was measured
        self.assertGreater(len(fit.signals()), 10)
        fit.delete()
        measured.delete()
        with self.assertRaises(rpsup.Error):
            measured.status()

    def test_measurements_of_arrays(self):
        import numpy

        measured = self.client.measure(
            {
                "name": "two",
                "channels": [{"name": "slider_acceleration_m_s2"}],
                "runs": [
                    {
                        "time_s": numpy.array([0, 0.001]),
                        "values": {"slider_acceleration_m_s2": numpy.array([0.5, 1])},
                    }
                ],
            }
        )
        self.assertEqual(measured.data()["slider_acceleration_m_s2"].tolist(), [0.5, 1])
        self.assertIn(measured.id, [each.id for each in self.client.newest(rpsup.Measurement)])
        with self.assertRaisesRegex(ValueError, "csv, .npz or .json"):
            self.client.measure("bench.txt")
        with self.assertRaisesRegex(ValueError, "no comma in its name: 'acc, x'"):
            self.client.measure("bench.csv", channels={"acc, x": "slider_acceleration_m_s2"})


if __name__ == "__main__":
    unittest.main()
