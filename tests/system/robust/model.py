# SPDX-License-Identifier: Apache-2.0
"""What the service may answer: random legal requests, a model of what they have made, and a reader that compares the two."""

import hashlib
import http.client
import itertools
import json
import random
import threading
import time
from collections import Counter, defaultdict
from urllib.parse import quote, urlsplit

from service import check

ENDED = ("succeeded", "failed", "cancelled")
OPEN = ("queued", "running")
METRIC = "peak_slider_acceleration_m_s2"


def must_fail(parameters):
    """Whether the trajectory is larger than a job's memory: 3000 samples of some 70 channels are, 300 are not."""
    return parameters.get("duration_s", 0) * parameters.get("output_rate_hz", 1000) >= 3000


def random_parameters(dice):
    return {"duration_s": 0.03, "run_up_s": 0.01, "output_rate_hz": 1000, "crank_velocity_rad_s": dice.choice((5, 6, 7, 8))}


def random_sweep(dice):
    """A request, and how many jobs it makes."""
    parameters = random_parameters(dice)
    request = {"name": dice.choice(("Φ", "a\"b<c>", "plain")), "parameters": parameters, "reuse": dice.random() < 0.7, "priority": dice.choice((-1, 0, 0, 1))}
    clearances = dice.sample((0, 0.1, 0.2, 0.3, 0.4, 0.5), dice.randint(1, 3))
    kind = dice.choice(("grid", "grid", "range", "cases", "failing", "slow", "latin_hypercube", "sobol", "zip", "one_at_a_time", "morris", "saltelli", "replicates"))
    ranges = {"clearance_mm": {"from": 0.05, "to": 0.5}, "restitution": {"from": 0.6, "to": 0.95}}
    if kind in ("latin_hypercube", "sobol"):
        request["design"] = {"type": kind, "count": 4, "seed": dice.randint(1, 3), "over": ranges}
        return request, 4
    if kind == "zip":
        request["design"] = {"type": kind, "over": {"clearance_mm": [0.1, 0.2, 0.3], "restitution": [0.7, 0.8, 0.9]}}
        return request, 3
    if kind == "one_at_a_time":
        request["design"] = {"type": kind, "centre": {"clearance_mm": 0.25}, "over": {"clearance_mm": [0.1, 0.2], "restitution": [0.7]}}
        return request, 4
    if kind == "morris":
        request["design"] = {"type": kind, "trajectories": 2, "levels": 4, "seed": dice.randint(1, 3), "over": ranges}
        return request, 2 * 3
    if kind == "saltelli":
        request["design"] = {"type": kind, "count": 2, "seed": dice.randint(1, 3), "over": ranges}
        return request, 2 * 4
    request["sweep"] = {"clearance_mm": clearances}
    if kind == "range":
        request["sweep"]["restitution"] = {"from": 0.7, "to": 0.9, "count": 3}
        return request, 3 * len(clearances)
    if kind == "cases":
        request["cases"] = [{}, {"restitution": 0.8}]
        return request, 2 * len(clearances)
    if kind == "failing":
        parameters["output_rate_hz"] = 10000
        del parameters["duration_s"]
        request["sweep"]["duration_s"] = [0.03, 0.3]
        return request, 2 * len(clearances)
    if kind == "slow":
        parameters.update(duration_s=0.8, output_rate_hz=100)
        request["priority"] = -1
    if kind == "replicates":
        request["replicates"] = {"count": 3, "seed": dice.randint(1, 3)}
        return request, 3 * len(clearances)
    return request, len(clearances)


def random_search(dice):
    over = {"from": dice.choice((0.02, 0.05)), "to": 0.4, "first": 3, "tolerance": 0.1}
    return {"name": "search", "parameters": random_parameters(dice), "over": {"clearance_mm": over}, "metric": METRIC, "bound": dice.choice((1, 60, 120, 1e6))}


def random_wear(dice):
    return {"name": "wear", "parameters": {**random_parameters(dice), "clearance_mm": 0.2}, "hours": dice.choice((1, 1e4)), "max_cycles": 2}


def state_of(counts):
    """State of a sweep whose jobs are so."""
    if counts["queued"] or counts["running"]:
        return "running" if counts["running"] or sum(counts[state] for state in ENDED) else "queued"
    return next(state for state in ("cancelled", "failed", "succeeded") if counts[state] or state == "succeeded")


class Thing:
    """A sweep, job or study that was acknowledged and is not deleted. Whoever holds its lock has it for itself."""

    def __init__(self, kind, answer, request, total=None):
        self.kind, self.id, self.request, self.total = kind, answer["id"], request, total
        self.path = f"/v1/{kind}/{self.id}"
        self.owner = None       # study that a sweep belongs to
        self.lock = threading.RLock()
        self.version = 0        # of its state: grows before each request that may change it
        self.dying = False      # its deletion has been asked for, and not answered
        self.ended = None       # state in which it has ended, once somebody has seen that
        self.rows = {}          # job id -> parameters, of all its jobs
        self.succeeded = {}     # job id -> row, of jobs that have been seen to succeed
        self.tags = {}          # path -> ETag, since its last change
        self.change()

    def change(self):
        self.version += 1
        self.ended = None
        self.tags = {}


class Model:
    def __init__(self):
        self.lock = threading.Lock()  # guards all of this
        self.things = {}              # id -> Thing
        self.deleted = {}             # id -> path
        self.ever = set()             # ids that were acknowledged
        self.listed = set()           # ids that a listing has shown
        self.keys = []                # (key, path, request, body of the answer)
        self.bodies = {}              # ETag -> digest of its type and body
        self.tags = {}                # path, type and digest -> ETag
        self.results = {}             # parameters -> metrics
        self.done = defaultdict(Counter)

    def add(self, thing):
        with self.lock:
            check(thing.id not in self.ever, f"{thing.id} is given twice")
            self.things[thing.id] = thing
            self.ever.add(thing.id)

    def see_tag(self, path, headers, body):
        digest = hashlib.sha256(headers.get("Content-Type", "").encode() + b"\n" + body).digest()
        with self.lock:
            check(self.bodies.setdefault(headers["ETag"], digest) == digest, f"{path}: one ETag for two bodies")
            check(self.tags.setdefault((path, digest), headers["ETag"]) == headers["ETag"], f"{path}: two ETags for one body")

    def see_result(self, parameters, metrics):
        """Equal parameters have one result, whether it was computed again or not."""
        key = json.dumps(parameters, sort_keys=True)
        with self.lock:
            first = self.results.setdefault(key, metrics)
        check(first == metrics, f"two results of {key}: {first} and {metrics}")


class Reader:
    """Asks, and compares what it reads with the model."""

    def __init__(self, service, model, seed):
        self.service, self.model, self.dice = service, model, random.Random(seed)
        self.operation = ""

    def ask(self, method, path, allowed, body=None, headers=None):
        status, answered, text = self.service.ask(method, path, body, headers, 60)
        with self.model.lock:
            self.model.done[self.operation][status] += 1
        check(status in allowed, f"{method} {path} {json.dumps(body)}: {status} instead of {allowed}: {text[:300]}")
        check(answered["X-Request-Id"], f"{method} {path}: no X-Request-Id")
        if status >= 400:
            check(answered["Content-Type"] == "application/problem+json" and json.loads(text)["status"] == status, f"{path}: {text[:300]}")
        if answered["ETag"] and status == 200 and method == "GET":
            self.model.see_tag(path, answered, text)
        return status, answered, text

    def get(self, path, **headers):
        return json.loads(self.ask("GET", path, (200,), None, headers)[2])

    def pick(self, *kinds, ended=None):
        """A thing of these kinds that nobody else has just now, with its lock held; else none."""
        with self.model.lock:
            things = [t for t in self.model.things.values() if t.kind in kinds and (ended is None or (t.ended in ended))]
        self.dice.shuffle(things)
        for thing in things[:5]:
            if thing.lock.acquire(blocking=False):
                if thing.id in self.model.things:
                    return thing
                thing.lock.release()
        return None

    def with_thing(self, do, *kinds, ended=None):
        thing = self.pick(*kinds, ended=ended)
        if thing is not None:
            try:
                do(thing)
            finally:
                thing.lock.release()

    def at_once(self, requests):
        answers = [None] * len(requests)

        def ask(i):
            try:
                answers[i] = self.ask(*requests[i])
            except Exception as error:
                answers[i] = error

        threads = [threading.Thread(target=ask, args=(i,)) for i in range(len(requests))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for answer in answers:
            if isinstance(answer, Exception):
                raise answer
        return answers

    def see(self, thing, found, headers):
        """The resource itself, read while it is locked."""
        state = found["state"]
        check(found["id"] == thing.id, f"{thing.path}: {found['id']}")
        if thing.kind == "jobs":
            if state == "succeeded":
                self.see_job(found)
            self.see_state(thing, state, state in ENDED)
        else:
            counts = found["counts"]
            check(sum(counts[s] for s in ENDED + OPEN) == counts["total"], f"{thing.path}: {counts}")
            done = sum(counts[s] for s in ENDED)
            if thing.kind == "sweeps":
                check(thing.owner or counts["total"] == thing.total, f"{thing.path}: {counts} of {thing.total}")
                check(state == state_of(counts), f"{thing.path} is {state}: {counts}")
                check(abs(found["progress"] - done / counts["total"]) < 1e-9, f"{thing.path}: {found['progress']} of {counts}")
                self.see_state(thing, state, done == counts["total"] and not thing.owner)
            else:
                check(state != "succeeded" or done == counts["total"], f"{thing.path} is {state}: {counts}")
                self.see_state(thing, state, state != "running")
                self.see_study(thing, found)
        ended = state in ENDED if thing.kind != "sweeps" else state not in OPEN
        check(bool(headers["ETag"]) == ended, f"{thing.path} is {state}, and its ETag {headers['ETag']}")
        if headers["ETag"]:
            thing.tags[thing.path] = headers["ETag"]

    def see_state(self, thing, state, ended):
        check(thing.ended in (None, state), f"{thing.path} was {thing.ended} and is {state}")
        if ended:
            thing.ended = state

    def see_job(self, job):
        check(not must_fail(job["parameters"]), f"{job['id']} is too large and has succeeded")
        check(job["metrics"][METRIC] is not None and job["error"] is None, f"{job['id']}: {job['metrics']} {job['error']}")
        self.model.see_result(job["parameters"], job["metrics"])

    def see_study(self, thing, found):
        if thing.kind == "searches":
            check(all(limit["evaluations"] <= found["most_evaluations"] for limit in found["limits"]), f"{thing.path}: more evaluations than promised")
            for limit in found["limits"]:
                values = {point["value"]: point["quantile"] for point in limit["points"]}
                bound, tolerance = thing.request["bound"], thing.request["over"]["clearance_mm"]["tolerance"]
                if limit["verdict"] == "found":
                    check(values[limit["limit"]] <= bound < values[limit["limit_beyond"]], f"{thing.path}: {limit}")
                    check(abs(limit["limit_beyond"] - limit["limit"]) <= tolerance * (1 + 1e-9), f"{thing.path}: {limit}")
                if limit["verdict"] == "never_exceeded":
                    check(all(value <= bound for value in values.values()), f"{thing.path}: {limit}")
                check(found["state"] != "succeeded" or limit["verdict"] != "open", f"{thing.path} has ended and is open")
        else:
            hours = [cycle["hours"] for cycle in found["cycles"]]
            check(hours == sorted(hours) and len(hours) <= thing.request["max_cycles"], f"{thing.path}: hours {hours}")

    def see_rows(self, thing, rows):
        """All rows of a sweep, read while it is locked."""
        check(thing.owner or len(rows) == thing.total, f"{thing.path}: {len(rows)} rows of {thing.total}")
        ids = [row["job_id"] for row in rows]
        check(len(set(ids)) == len(ids), f"{thing.path}: a job twice")
        check(thing.rows.keys() <= set(ids), f"{thing.path}: jobs are gone")
        swept = {**thing.request.get("sweep", {}), **thing.request.get("design", {}).get("over", {}), **thing.request.get("over", {})}
        for case in thing.request.get("cases", []):
            swept.update(case)
        for row in rows:
            parameters = {**thing.request["parameters"], **{name: row[name] for name in swept if row.get(name) is not None}}
            thing.rows[row["job_id"]] = parameters
            if row["state"] == "succeeded":
                check(not must_fail(parameters), f"{row['job_id']} is too large and has succeeded")
                kept = {name: value for name, value in row.items() if not name.startswith("replicates_")}
                check(thing.succeeded.setdefault(row["job_id"], kept) == kept, f"{row['job_id']} has another result")
                if row.get("replicate") in (None, 0) and "wear_depth_um" not in row:
                    self.model.see_result({**parameters, "table": 1}, {k: v for k, v in kept.items() if k not in ("job_id", "state", "replicate") and k not in swept})
            else:
                check(row["job_id"] not in thing.succeeded, f"{row['job_id']} had succeeded and is {row['state']}")
                check(row["state"] != "failed" or must_fail(parameters), f"{row['job_id']} has failed")

    def read(self, thing, **headers):
        _, answered, text = self.ask("GET", thing.path, (200,), None, headers)
        found = json.loads(text)
        self.see(thing, found, answered)
        return found, answered

    def read_rows(self, thing):
        before = thing.ended
        _, headers, text = self.ask("GET", thing.path + "/results", (200,))
        rows = json.loads(text)
        check(bool(headers["ETag"]) or before is None, f"{thing.path}/results has no ETag")
        if thing.kind == "sweeps":
            self.see_rows(thing, rows)
            if before:
                states = Counter(row["state"] for row in rows)
                check(state_of(Counter(states)) == before, f"{thing.path} is {before}: {states}")
        if headers["ETag"] and before:
            thing.tags[thing.path + "/results"] = headers["ETag"]
        return rows

    def pages(self, kind, state, limit):
        seen, cursor = [], ""
        while True:
            page = self.get(f"/v1/{kind}?limit={limit}&fields=id,state&state={state}&cursor={quote(cursor)}")
            check(len(page["items"]) <= limit and (len(page["items"]) == limit or not page["next_cursor"]), f"a page of {len(page['items'])}")
            check(all(set(item) == {"id", "state"} and state in ("", item["state"]) for item in page["items"]), f"{kind} in {state}: {page['items'][:3]}")
            seen += [item["id"] for item in page["items"]]
            cursor = page["next_cursor"]
            if not cursor:
                break
        check(all(a > b for a, b in itertools.pairwise(seen)), f"{kind}: not from the newest to the oldest, each once")
        return seen

    def stream(self, thing, last="", seconds=2.0, most=1_000_000):
        """Events as (name, id, data) until the end, or for so long, or so many; none if nothing is left."""
        address = urlsplit(self.service.url)
        connection = http.client.HTTPConnection(address.hostname, address.port, timeout=20)
        events, deadline = [], time.monotonic() + seconds
        try:
            connection.request("GET", thing.path + "/events", headers={"Last-Event-ID": last} if last else {})
            sock = connection.sock  # the answer goes on with it alone
            answer = connection.getresponse()
            with self.model.lock:
                self.model.done[self.operation][answer.status] += 1
            if answer.status == 204:
                return None
            check(answer.status == 200, f"{thing.path}/events: {answer.status}")
            fields = {}
            while time.monotonic() < deadline and len(events) < most:
                sock.settimeout(max(0.01, deadline - time.monotonic()))
                line = answer.readline().decode().rstrip("\n")
                if line and not line.startswith(":"):
                    name, _, value = line.partition(": ")
                    fields[name] = value
                elif fields:
                    events.append((fields["event"], fields.get("id"), json.loads(fields["data"])))
                    if fields["event"] == "done":
                        break
                    fields = {}
                elif not line and answer.isclosed():
                    break
        except TimeoutError:
            pass
        finally:
            connection.close()
        return events

    def check_stream(self, thing, events):
        numbers = [int(i.partition("-")[0]) for name, i, _ in events if name == "job" and i]
        check(all(a < b for a, b in itertools.pairwise(numbers)), f"{thing.path}: event ids {numbers}")
        jobs = [data["job_id"] for name, _, data in events if name == "job"]
        check(len(set(jobs)) == len(jobs), f"{thing.path}: a job has ended twice")
        ended = -1
        for name, _, data in events:
            if name == "job":
                check(data["state"] in ENDED and (data["error_reason"] is None) == (data["state"] != "failed"), f"{thing.path}: {data}")
            else:
                counts = data["counts"]
                check(sum(counts[s] for s in ENDED + OPEN) == counts["total"], f"{thing.path}: {counts}")
                now = sum(counts[s] for s in ENDED)
                check(now >= ended, f"{thing.path}: fewer jobs have ended than before: {counts}")
                ended = now
        return jobs
