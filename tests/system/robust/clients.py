# SPDX-License-Identifier: Apache-2.0
"""Clients that submit and read while something fails, and what must be true of the service afterwards."""

import time

from service import NoAnswer, Service, check, small_sweep

KINDS = 8  # different sweeps


def request_of(number):
    return {**small_sweep(number % KINDS), "reuse": number % 5 != 0}


def undisturbed_tables(program, folder):
    service = Service(program, folder / "undisturbed.db", "--threads", "2")
    twins = [service.submit(request_of(number)) for number in range(KINDS)]
    check(all(service.wait_for_end(twin) == "succeeded" for twin in twins), "the undisturbed sweeps")
    tables = [service.results(twin) for twin in twins]
    service.terminate()
    return tables


def ask_for_a_while(service, dice, acknowledged, seconds):
    """Adds what is acknowledged, id -> number of the request. Returns how often there was no answer, or a refusal."""
    refused = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        number = dice.randrange(1000)
        try:
            status, headers, text = service.ask("POST", "/v1/sweeps", request_of(number))
            if status == 201:
                acknowledged[headers["Location"].rpartition("/")[2]] = number
            else:
                refused += 1
                # A body that could not be received is a bad request.
                check(status in (400, 408, 503, 507) and headers["Content-Type"] == "application/problem+json", f"refused with {status} {text[:200]}")
            if acknowledged:
                status, _, text = service.ask("GET", f"/v1/sweeps/{dice.choice(list(acknowledged))}/results")
                refused += status != 200
                check(status in (200, 503), f"reading: {status} {text[:200]}")
        except NoAnswer:
            refused += 1
        check(service.is_alive(), f"the service died: {service.log.read_text(errors='replace')[-600:]}")
    return refused


def check_acknowledged(service, acknowledged, tables):
    """Everything is there and computed to the same bytes; jobs that failed for want of memory say so, and succeed when they are tried again."""
    service.wait_until_idle()
    retried = 0
    for sweep_id, number in acknowledged.items():
        state = service.wait_for_end(sweep_id)
        if state == "failed":
            reasons = {service.get(f"/v1/jobs/{row['job_id']}")["error"]["reason"] for row in service.get(f"/v1/sweeps/{sweep_id}/results") if row["state"] == "failed"}
            check(reasons == {"memory_limit"}, f"jobs of {sweep_id} failed: {reasons}")
            status, _, text = service.ask("POST", f"/v1/sweeps/{sweep_id}/retry")
            check(status == 200, f"retry: {status} {text[:200]}")
            retried += 1
            state = service.wait_for_end(sweep_id)
        check(state == "succeeded", f"{sweep_id} is {state}")
        check(service.results(sweep_id) == tables[number % KINDS], f"other results in {sweep_id}")
    return retried
