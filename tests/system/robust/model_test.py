# SPDX-License-Identifier: Apache-2.0
"""Random legal requests of many clients against a model of what the service may answer: model_test.py PROGRAM [OPTION...]

Clients submit sweeps, jobs and studies, read, list, follow, cancel, retry, extend and delete them, all at once. Whoever changes one of them
has it for itself meanwhile, so that each answer can be predicted but for how far the computing is. In the end everything is read once more,
before and after a new start. Prints how often it did what, and which statuses it saw; the seed chooses the requests, not how they interleave.
"""

import argparse
import csv
import io
import itertools
import json
import sys
import threading
import time
import traceback
import zipfile
from pathlib import Path

from faulty_service import FAULTS
from model import ENDED, METRIC, Model, Reader, Thing, must_fail, random_parameters, random_search, random_sweep, random_wear
from service import Service, check, check_integrity, temporary_folder

OPTIONS = ("--threads", "2", "--job-memory-mb", "1")  # with so little memory long jobs fail, at once
MOST_THINGS = 60  # from then on more is deleted
CHANNELS = ("slider_acceleration_m_s2", "slider_position_m", "journal_x_mm", "crank_angle_rad")
SWEEP_ANALYSES = ("sensitivity?metric=" + METRIC, "surrogate", "flexibility", "bifurcation", "lyapunov", "report", "paper")
JOB_ANALYSES = ("spectrum", "poincare", "wear")


class Client(Reader):
    """Chooses one operation after another by its dice."""

    def submit(self, kind, request, total=None):
        path, headers = f"/v1/{kind}", {}
        if self.dice.random() < 0.3:
            headers["Idempotency-Key"] = f"{self.dice.random()}"
        waits = self.dice.random() < 0.2
        if waits:
            headers["Prefer"] = "wait=2"
        _, answered, text = self.ask("POST", path, (201,), request, headers)
        answer = json.loads(text)
        check(answered["Location"] == f"{path}/{answer['id']}", f"Location {answered['Location']}")
        thing = Thing(kind, answer, request, total)
        with thing.lock:
            self.model.add(thing)
            if kind in ("searches", "wear-studies"):
                sweep = Thing("sweeps", {"id": answer["sweep_id"]}, request)
                sweep.owner, sweep.lock = thing, thing.lock
                self.model.add(sweep)
            if "Idempotency-Key" in headers and not waits:
                with self.model.lock:
                    self.model.keys.append((headers["Idempotency-Key"], path, request, text))
            found, _ = self.read(thing)
            if answer["state"] in ENDED:  # it was seen ended by the answer
                check(found["state"] == answer["state"], f"{thing.path} was {answer['state']} and is {found['state']}")
        return thing, answer

    def post_sweep(self):
        self.submit("sweeps", *random_sweep(self.dice))

    def post_job(self):
        parameters = {**random_parameters(self.dice), "clearance_mm": self.dice.choice((0, 0.1, 0.2))}
        if self.dice.random() < 0.2:
            parameters.update(duration_s=0.3, output_rate_hz=10000)
        self.submit("jobs", parameters)

    def post_search(self):
        self.submit("searches", random_search(self.dice))

    def post_wear_study(self):
        self.submit("wear-studies", random_wear(self.dice))

    def post_twin(self):
        """The same again: all of it is known, and nothing is computed."""
        thing = self.pick("sweeps", "jobs", ended=("succeeded",))
        if thing is None:
            return
        try:
            if thing.owner or thing.request.get("reuse") is False:
                return
            twin, answer = self.submit(thing.kind, thing.request, thing.total)
            check(answer["state"] == "succeeded", f"{twin.path} is known from {thing.path} and {answer['state']}")
            if thing.kind == "sweeps":
                with twin.lock:
                    if twin.id in self.model.things:
                        # In another order, if it was extended.
                        rows, known = (sorted(json.dumps({**row, "job_id": 0}) for row in self.read_rows(one)) for one in (twin, thing))
                        check(rows == known, f"{twin.path} is not {thing.path}")
        finally:
            thing.lock.release()

    def post_again(self):
        """A key that was used: the first answer, or a refusal of any other request."""
        with self.model.lock:
            if not self.model.keys:
                return
            key, path, request, text = self.dice.choice(self.model.keys)
        if self.dice.random() < 0.3:
            other = {**request, "name": "other"} if path != "/v1/jobs" else {**request, "clearance_mm": 0.45}
            self.ask("POST", path, (422,), other, {"Idempotency-Key": key})
        else:
            check(self.ask("POST", path, (201,), request, {"Idempotency-Key": key})[2] == text, f"{path}: another answer under the key {key}")

    def post_at_once(self):
        """One key twice at the same time: one sweep."""
        request, total = random_sweep(self.dice)
        key = {"Idempotency-Key": f"{self.dice.random()}"}
        answers = self.at_once([("POST", "/v1/sweeps", (201, 409), request, key)] * 2)
        texts = {text for status, _, text in answers if status == 201}
        check(len(texts) == 1, f"one key gave {len(texts)} sweeps")
        self.model.add(Thing("sweeps", json.loads(texts.pop()), request, total))

    def get_one(self):
        self.with_thing(self.read, "sweeps", "jobs", "searches", "wear-studies")

    def wait(self):
        def do(thing):
            started = time.monotonic()
            found, headers = self.read(thing, Prefer="wait=1")
            if headers["Preference-Applied"] and time.monotonic() - started < 0.9:
                check(found["state"] in ENDED, f"{thing.path}: not waited for")
        self.with_thing(do, "sweeps", "jobs", "searches", "wear-studies")

    def results(self):
        self.with_thing(self.read_rows, "sweeps", "searches", "wear-studies")

    def query_results(self):
        """Filters, order, limit, fields and formats against the whole table."""
        def do(thing):
            rows = self.read_rows(thing)
            if any(row.get("clearance_mm") is None for row in rows):
                return
            least = self.dice.choice((0, 0.1, 0.25))
            kept = [row for row in rows if row["clearance_mm"] >= least]
            order = self.dice.choice(("", "-"))
            count = self.dice.randint(1, 5)
            query = f"fields=job_id,state,clearance_mm&clearance_mm_ge={least}&order_by={order}clearance_mm"
            found = self.get(f"{thing.path}/results?{query}")
            check({row["job_id"] for row in found} == {row["job_id"] for row in kept} and len(found) == len(kept), f"{thing.path}: {query}: {found}")
            values = [row["clearance_mm"] for row in found]
            check(values == sorted(values, reverse=order == "-"), f"{thing.path}: {query}: {values}")
            first = self.get(f"{thing.path}/results?{query}&limit={count}")
            check([row["job_id"] for row in first] == [row["job_id"] for row in found][:count], f"{thing.path}: {query}&limit={count}")
            lines = self.ask("GET", f"{thing.path}/results?{query}&format=ndjson", (200,))[2].splitlines()
            check([json.loads(line) for line in lines] == found, f"{thing.path}: ndjson")
            text = self.ask("GET", f"{thing.path}/results?{query}", (200,), None, {"Accept": "text/csv"})[2].decode()
            table = list(csv.DictReader(io.StringIO(text)))
            check([(row["job_id"], float(row["clearance_mm"])) for row in table] == [(row["job_id"], row["clearance_mm"]) for row in found], f"{thing.path}: csv")
            state = self.dice.choice(ENDED)
            found = self.get(f"{thing.path}/results?state={state}&fields=job_id")
            check([row["job_id"] for row in found] == [row["job_id"] for row in rows if row["state"] == state], f"{thing.path}: state={state}")
        self.with_thing(do, "sweeps", ended=ENDED)

    def not_modified(self):
        def do(thing):
            for path, tag in list(thing.tags.items()):
                tags = self.dice.choice((tag, f'"x", W/{tag}', "*"))
                _, headers, text = self.ask("GET", path, (304,), None, {"If-None-Match": tags})
                check(headers["ETag"] == tag and not text, f"{path}: 304 with {headers['ETag']} for {tag}")
                _, headers, text = self.ask("GET", path, (200,), None, {"If-None-Match": '"x"'})
                check(headers["ETag"] == tag and text, f"{path}: {headers['ETag']} for {tag}")
        self.with_thing(do, "sweeps", "jobs", "searches", "wear-studies", ended=ENDED)

    def get_deleted(self):
        with self.model.lock:
            if not self.model.deleted:
                return
            path = self.dice.choice(list(self.model.deleted.values()))
        self.ask("GET", path, (404,))
        method, suffix = self.dice.choice((("POST", "/cancel"), ("DELETE", "")))
        self.ask(method, path + suffix, (404,))
        if "/v1/jobs/" not in path:
            self.ask("GET", path + self.dice.choice(("/results", "/events")), (404,))
            self.ask("POST", path + "/retry", (404,))

    def walk(self):
        """Pages: what was there all the time is seen once, what was deleted before never; a state shows those that are in it."""
        kind = self.dice.choice(("sweeps", "sweeps", "jobs", "searches", "wear-studies"))
        state = self.dice.choice(("", "", *ENDED))
        with self.model.lock:
            gone = set(self.model.deleted)
            before = {t.id: (t, t.version, t.ended) for t in self.model.things.values() if t.kind == kind}
        seen = self.pages(kind, state, self.dice.choice((1, 7, 50)) if kind != "jobs" else 200)
        with self.model.lock:
            now = {i: old for i, old in before.items() if self.model.things.get(i) is old[0] and not old[0].dying}
            self.model.listed |= set(seen) if kind != "jobs" else set()
        check(not gone & set(seen), f"{kind} that are deleted and listed: {gone & set(seen)}")
        for i, (thing, version, ended) in now.items():
            if not state:
                check(i in seen or thing.version != version, f"{i} is missing in the list of {kind}")
            elif ended and thing.version == version:
                check((i in seen) == (ended == state), f"{i} is {ended}, and in the list of {state} {kind}: {i in seen}")

    def trajectory(self):
        def do(thing):
            job = self.dice.choice(list(thing.succeeded)) if thing.kind == "sweeps" and thing.succeeded else thing.id
            if not job.startswith("job_"):
                return
            found = self.get(f"/v1/jobs/{job}")
            path = f"/v1/jobs/{job}/trajectory"
            if found["state"] != "succeeded":
                self.ask("GET", path, (404,))
                return
            self.see_job(found)
            duration, rate = found["parameters"]["duration_s"], found["parameters"]["output_rate_hz"]
            channel = self.dice.choice(CHANNELS)
            part = self.dice.choice((f"channels={channel}", f"channels={channel}&from=0.01&to=0.02", f"channels={channel}&points=8"))
            columns = self.get(f"{path}?{part}")["columns"]
            times, values = columns["t_s"], columns[channel]
            check(len(times) == len(values) and all(a < b for a, b in itertools.pairwise(times)), f"{path}?{part}: times")
            if part == f"channels={channel}":
                check(len(times) == round(duration * rate) + 1, f"{path}: {len(times)} samples in {duration} s")
            elif "from" in part:
                check(0.01 <= times[0] and times[-1] <= 0.02, f"{path}?{part}: {times[0]} to {times[-1]}")
            elif None not in values:
                whole = self.get(f"{path}?channels={channel}")["columns"][channel]
                check(max(values) == max(whole) and min(values) == min(whole), f"{path}?{part}: a peak is lost")
            text = self.ask("GET", f"{path}?{part}&format=csv", (200,))[2].decode()
            table = list(csv.DictReader(io.StringIO(text)))
            check([row[channel] and float(row[channel]) for row in table] == ["" if value is None else value for value in values], f"{path}?{part}: csv")
            _, headers, packed = self.ask("GET", f"{path}?{part}&format=npz", (200,))
            check(f"{channel}.npy" in zipfile.ZipFile(io.BytesIO(packed)).namelist(), f"{path}: npz")
            _, head, nothing = self.ask("HEAD", f"{path}?{part}&format=npz", (200,))
            check(head["ETag"] == headers["ETag"] and not nothing, f"{path}: HEAD")
            self.ask("GET", f"{path}?{part}&format=npz", (304,), None, {"If-None-Match": headers["ETag"]})
        self.with_thing(do, "sweeps", "jobs", ended=ENDED)

    def analysis(self):
        def do(thing):
            if thing.kind == "jobs":
                path, must = f"{thing.path}/{self.dice.choice(JOB_ANALYSES)}", False
            else:
                path = f"{thing.path}/{self.dice.choice(SWEEP_ANALYSES)}"
                design = thing.request.get("design", {}).get("type")
                must = "report" in path or ("sensitivity" in path and design in ("morris", "saltelli") and thing.ended == "succeeded")
            allowed = (200,) if must else (200, 404, 409, 422)
            status, headers, text = self.ask("GET", path, allowed)
            if status == 200 and headers["ETag"]:
                thing.tags[path] = headers["ETag"]
                check(self.ask("GET", path, (200,))[2] == text, f"{path}: another answer")
            if status == 200 and must and "sensitivity" in path:
                rows = json.loads(text)
                check({row["parameter"] for row in rows} == {"clearance_mm", "restitution"}, f"{path}: {rows}")
        self.with_thing(do, "sweeps", "jobs", ended=ENDED)

    def metrics(self):
        text = self.ask("GET", "/metrics", (200,))[2].decode()
        check("rpsup_jobs_queued" in text, "/metrics")
        self.ask("GET", "/healthz", (200,))
        self.ask("GET", "/readyz", (200,))

    def follow(self):
        """A stream that is cut off, and then goes on: each job once, none missing."""
        def do(thing):
            jobs, last, done = [], "", None
            end, most = time.monotonic() + 15, self.dice.choice((1, 3, 1_000_000))
            while done is None and time.monotonic() < end:  # then others come first
                events = self.stream(thing, last, 5, most) or []
                self.check_stream(thing, events)
                most = 1_000_000
                numbered = [n for n, event in enumerate(events) if event[1]]
                if numbered:  # what came after it is told again
                    jobs += [event for event in events[:numbered[-1] + 1] if event[0] == "job"]
                    last = events[numbered[-1]][1]
                done = events[-1] if events and events[-1][0] == "done" else None
            self.check_stream(thing, jobs)
            if done is None:
                return
            counts = done[2]["counts"]
            check(len(jobs) == counts["total"], f"{thing.path}: {len(jobs)} ends of {counts} were told")
            check(self.stream(thing, last) is None or thing.kind != "sweeps", f"{thing.path}: something after the end")
            found, _ = self.read(thing)
            if thing.ended:
                check(found["counts"] == counts, f"{thing.path}: {found['counts']} and {counts}")
                states = {data["job_id"]: data["state"] for _, _, data in jobs}
                if thing.kind == "sweeps":
                    check({row["job_id"]: row["state"] for row in self.read_rows(thing)} == states, f"{thing.path}: the events are not the table")
        # Of a study's own sweep the end is none while the study goes on.
        self.with_thing(lambda thing: None if thing.owner else do(thing), "sweeps", "searches", "wear-studies")

    def resume(self):
        """Of what has ended, from any event on: those that came after it."""
        def do(thing):
            if thing.owner:
                return
            whole = self.stream(thing, "", 20)
            self.check_stream(thing, whole)
            jobs = [event for event in whole if event[0] == "job"]
            places = [n for n, event in enumerate(jobs) if event[1]]
            if places:
                place = self.dice.choice(places)
                rest = self.stream(thing, jobs[place][1], 20)
                check([event for event in rest if event[0] == "job"] == jobs[place + 1:], f"{thing.path} from {jobs[place][1]} on: {rest}")
        self.with_thing(do, "sweeps", "searches", "wear-studies", ended=ENDED)

    def cancel(self):
        def do(thing):
            if thing.owner:
                return
            known = thing.ended
            allowed = {None: (200, 409), "succeeded": (409,), "failed": (409,), "cancelled": (200,)}[known]
            if known is None:
                thing.change()
            status, _, text = self.ask("POST", thing.path + "/cancel", allowed)
            found, _ = self.read(thing)
            check(found["state"] == "cancelled" if status == 200 else found["state"] in ("succeeded", "failed"), f"{thing.path}: {status}, and {found['state']}")
            if status == 200:
                check(json.loads(text)["state"] == "cancelled", f"{thing.path}: {text[:200]}")
        self.with_thing(do, "sweeps", "jobs", "searches", "wear-studies", ended=None if self.dice.random() < 0.2 else (None,))

    def retry(self):
        def do(thing):
            if thing.owner:
                return
            known = thing.ended
            if known != "succeeded" or thing.kind != "sweeps":  # a study looks at its jobs again
                thing.change()
            if thing.kind == "sweeps":
                before = self.read_rows(thing)
            _, _, text = self.ask("POST", thing.path + "/retry", (200,))
            if thing.kind == "sweeps":
                after = {row["job_id"]: row["state"] for row in self.read_rows(thing)}
                check(after.keys() == {row["job_id"] for row in before}, f"{thing.path}: other jobs after a retry")
                check("cancelled" not in after.values(), f"{thing.path}: cancelled after a retry")
                check(known != "succeeded" or json.loads(text)["state"] == "succeeded", f"{thing.path}: {text[:200]}")
            self.read(thing)
        self.with_thing(do, "sweeps", "searches", "wear-studies", ended=("failed", "cancelled", "succeeded"))

    def extend(self):
        def do(thing):
            axes = thing.request.get("sweep", {})
            if thing.owner or "clearance_mm" not in axes or "design" in thing.request:
                return
            value = self.dice.choice((0.15, 0.35, axes["clearance_mm"][0]))
            is_new = value not in axes["clearance_mm"]
            before = self.read_rows(thing)
            if is_new:
                thing.change()
                thing.total += thing.total // len(axes["clearance_mm"])
                thing.request = {**thing.request, "sweep": {**axes, "clearance_mm": [*axes["clearance_mm"], value]}}
            self.ask("POST", thing.path + "/extend", (200,), {"sweep": {"clearance_mm": [value]}})
            found, _ = self.read(thing)
            check(found["request"]["sweep"]["clearance_mm"] == thing.request["sweep"]["clearance_mm"], f"{thing.path}: {found['request']}")
            check({row["job_id"] for row in before} <= {row["job_id"] for row in self.read_rows(thing)}, f"{thing.path}: jobs are gone")
        self.with_thing(do, "sweeps")

    def forget(self, thing):
        with self.model.lock:
            gone = [thing] + [t for t in self.model.things.values() if t.owner is thing]
            for one in gone:
                del self.model.things[one.id]
                self.model.deleted[one.id] = one.path

    def delete(self):
        def do(thing):
            if thing.owner:
                _, _, text = self.ask("DELETE", thing.path, (409,))
                check(thing.owner.id in json.loads(text)["detail"], f"{thing.path}: {text}")
                return
            known = thing.ended
            if known is None:
                thing.change()
            status, _, _ = self.remove(thing, (204,) if known else (204, 409))
            if status == 204:
                self.ask("GET", thing.path, (404,))
                if thing.kind == "sweeps" and thing.rows:
                    self.ask("GET", f"/v1/jobs/{self.dice.choice(list(thing.rows))}", (404,))
            else:
                self.read(thing)
        self.with_thing(do, "sweeps", "jobs", "searches", "wear-studies")

    def remove(self, thing, allowed):
        """Deletes it. From the request on it may be gone, from the answer on it is."""
        self.mark_dying(thing, True)
        answer = self.ask("DELETE", thing.path, allowed)
        if answer[0] == 204:
            self.forget(thing)
        self.mark_dying(thing, False)
        return answer

    def mark_dying(self, thing, dying):
        with self.model.lock:
            for one in [thing] + [t for t in self.model.things.values() if t.owner is thing]:
                one.version += 1
                one.dying = dying

    def delete_job_of_sweep(self):
        def do(thing):
            if thing.rows:
                self.ask("DELETE", f"/v1/jobs/{self.dice.choice(list(thing.rows))}", (409,))
        self.with_thing(do, "sweeps")

    def race(self):
        """Two changes at once: as if one had come after the other."""
        def do(thing):
            if thing.owner:
                return
            thing.change()
            self.mark_dying(thing, True)
            first, second = self.dice.sample(("cancel", "retry", "delete"), 2)
            made = {"cancel": ("POST", thing.path + "/cancel", (200, 404, 409)), "retry": ("POST", thing.path + "/retry", (200, 404)),
                    "delete": ("DELETE", thing.path, (204, 409))}
            statuses = dict(zip((first, second), (status for status, _, _ in self.at_once([made[first], made[second]]))))
            if statuses.get("delete") == 204:
                self.forget(thing)
                self.ask("GET", thing.path, (404,))
                return
            self.mark_dying(thing, False)
            check(404 not in statuses.values(), f"{thing.path}: {statuses}")
            self.read(thing)
            if thing.kind == "sweeps":
                self.read_rows(thing)
        self.with_thing(do, "sweeps", "searches", "wear-studies")

    WEIGHTS = {"post_sweep": 8, "post_job": 4, "post_search": 1, "post_wear_study": 0.4, "post_twin": 3, "post_again": 3, "post_at_once": 1, "get_one": 8,
               "wait": 2, "results": 5, "query_results": 4, "not_modified": 5, "get_deleted": 3, "walk": 4, "trajectory": 5, "analysis": 5, "metrics": 1,
               "follow": 3, "resume": 3, "cancel": 6, "retry": 5, "extend": 3, "delete": 4, "delete_job_of_sweep": 1, "race": 3}

    def step(self):
        weights = dict(self.WEIGHTS)
        if len(self.model.things) > MOST_THINGS:
            weights["delete"] = 30
        self.operation = self.dice.choices(list(weights), list(weights.values()))[0]
        getattr(self, self.operation)()


def run_clients(service, model, seed, count, seconds):
    failures, stop = [], threading.Event()
    end = time.monotonic() + seconds

    def run(number):
        client = Client(service, model, f"{seed}-{number}")
        try:
            while time.monotonic() < end and not stop.is_set():
                client.step()
        except Exception as error:
            stop.set()
            failures.append(f"client {number}, {client.operation}: {error}\n{traceback.format_exc()}")

    threads = [threading.Thread(target=run, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return failures


def check_all(client, model):
    """Everything, while nothing is changed."""
    client.operation = "in the end"
    for kind in ("sweeps", "searches", "wear-studies"):
        listed = client.pages(kind, "", 13)
        known = [t.id for t in model.things.values() if t.kind == kind]
        check(listed == sorted(known, reverse=True), f"{kind}: listed {set(listed) - set(known)} and not {set(known) - set(listed)}")
    jobs = set()
    for thing in model.things.values():
        found, _ = client.read(thing)
        check(found["state"] in ENDED, f"{thing.path} is {found['state']}, and nothing is left to compute")
        if thing.kind != "jobs":
            told = client.check_stream(thing, client.stream(thing, "", 20))
            check(len(told) == found["counts"]["total"], f"{thing.path}: {len(told)} ends of {found['counts']} were told")
        if thing.kind == "sweeps":
            rows = client.read_rows(thing)
            jobs |= {row["job_id"] for row in rows}
            for row in rows:
                wanted = "failed" if must_fail(thing.rows[row["job_id"]]) else "succeeded"
                check(row["state"] in (wanted, "cancelled"), f"{row['job_id']} is {row['state']}")
        elif thing.kind == "jobs":
            jobs.add(thing.id)
    listed = client.pages("jobs", "", 200)
    check(set(listed) == jobs, f"jobs: {len(listed)} are listed, {len(jobs)} are known")
    for path in model.deleted.values():
        client.ask("GET", path, (404,))
    unknown = {i for i in model.listed if i not in model.ever}
    check(not unknown, f"listed and never acknowledged: {unknown}")


def print_done(model):
    print(f"{'operation':<20} {'requests':>8}  statuses")
    for operation, statuses in sorted(model.done.items()):
        print(f"{operation:<20} {sum(statuses.values()):>8}  " + ", ".join(f"{status}: {count}" for status, count in sorted(statuses.items())))
    print(f"{'together':<20} {sum(sum(statuses.values()) for statuses in model.done.values()):>8}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--clients", type=int, default=8)
    parser.add_argument("--fault", choices=FAULTS, help="a fault of the answers, which has to be found")
    options = parser.parse_args()
    store = temporary_folder() / "store.db"
    wrapper = (sys.executable, Path(__file__).with_name("faulty_service.py"), options.fault) if options.fault else ()
    service, model = Service(options.program, store, *OPTIONS, wrapper=wrapper), Model()
    print(f"seed {options.seed}, {options.clients} clients, {options.seconds:.0f} s")
    failures = run_clients(service, model, options.seed, options.clients, options.seconds)
    print_done(model)
    check(not failures, f"seed {options.seed}: " + "\n".join(failures))
    service.wait_until_idle()
    client = Client(service, model, options.seed)
    check_all(client, model)
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    client.service = Service(options.program, store, *OPTIONS, wrapper=wrapper)
    check_all(client, model)  # among others: whatever had an ETag has the same one
    print(f"{len(model.ever)} sweeps, jobs and studies acknowledged, {len(model.deleted)} of them deleted; the same before and after a new start")


main()
