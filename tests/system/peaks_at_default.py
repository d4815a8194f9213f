# SPDX-License-Identifier: Apache-2.0
"""Peaks of random parameter sets at the default tolerance, against two tight references of different methods.

peaks_at_default.py PROGRAM [--sets 200] [--seed 1] [--threads 2]

The sets draw all laws of friction and of the normal force, geometry, speeds and clearances. A set has converged if both
references give the same peak to 1e-4, and once more with a stiffness changed by a millionth: what does not converge has
no right peak. Of converged sets less than 0.5 % may be off by more than 0.1 %, and none by more than 1 %."""

import argparse
import csv
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

PEAK = "peak_slider_acceleration_m_s2"
FRICTIONS = ("lugre", "none", "coulomb", "ambrosio", "dahl", "elasto_plastic")
NORMAL_LAWS = ("lankarani_nikravesh", "hunt_crossley", "herbert_mcwhannell", "lee_wang", "gonthier", "flores", "hu_guo",
               "carvalho_martins", "kelvin_voigt")
COMMON = {"duration_s": 0.4, "run_up_s": 0.2, "output_rate_hz": 100}
TIGHT = {"relative_tolerance": 1e-9, "absolute_tolerance": 1e-9}
# Shares of the peak.
CONVERGED, OFF, NEVER = 1e-4, 1e-3, 1e-2


def draw(dice):
    across = dice.random() < 0.5
    geometry = {"yoke_axis": "across", "gravity_direction": "-y", "guide_offset_z_m": 0.2} if across else {}
    return {**geometry,
            "friction": dice.choice(FRICTIONS), "normal_law": dice.choice(NORMAL_LAWS),
            "contact": "elements" if dice.random() < 0.2 else "continuum",
            "coupler": "flexible" if dice.random() < 0.2 else "rigid",
            "crank_velocity_rad_s": round(dice.uniform(2, 20), 3), "clearance_mm": round(dice.uniform(0.02, 0.5), 4),
            "restitution": round(dice.uniform(0.3, 0.95), 3), "friction_kinetic": round(dice.uniform(0.02, 0.3), 3),
            "friction_static": round(dice.uniform(0.02, 0.3), 3), "guide_offset_y_m": round(dice.uniform(0, 0.03), 4)}


def peaks(program, folder, cases, threads):
    """One a case, in their order; None where there is none."""
    request, store = folder / "request.json", folder / "store.db"
    request.write_text(json.dumps({"parameters": COMMON, "cases": cases}))
    done = subprocess.run([program, "sweep", request, "--db", store, "--threads", str(threads)], capture_output=True, text=True, check=False)
    if done.returncode > 1:
        sys.exit(done.stderr)
    rows = sorted(csv.DictReader(done.stdout.splitlines()), key=lambda row: row["job_id"])
    return [float(row[PEAK]) if row[PEAK] else None for row in rows]


def apart(a, b):
    return abs(a - b) / abs(b)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("--sets", type=int, default=200)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--threads", type=int, default=2)
    options = arguments.parse_args()
    dice = random.Random(options.seed)
    errors, failed = [], 0
    with tempfile.TemporaryDirectory() as name:
        for number in range(options.sets):
            drawn = draw(dice)
            stiffer = {"contact_stiffness_scale": 1.000001}
            by_default, *references = peaks(options.program, Path(name), [
                drawn, {**drawn, **TIGHT, "integrator": "radau5"}, {**drawn, **TIGHT, "integrator": "rodas5"},
                {**drawn, **TIGHT, **stiffer, "integrator": "radau5"}], options.threads)
            if None in (by_default, *references):
                failed += 1
                print(f"{number}: no peak: {by_default} {references} {json.dumps(drawn)}", flush=True)
                continue
            spread = max(apart(other, references[0]) for other in references)
            if spread > CONVERGED:
                print(f"{number}: does not converge, {spread:.1e}", flush=True)
                continue
            error = apart(by_default, references[0])
            errors.append(error)
            print(f"{number}: {error:.1e}{' OFF ' + json.dumps(drawn) if error > OFF else ''}", flush=True)
    off = sum(error > OFF for error in errors)
    print(f"seed {options.seed}: {options.sets} sets, {failed} without a peak, {len(errors)} converged; "
          f"{off} of these off by more than {OFF:.1%}, the most by {max(errors):.4%}")
    sys.exit(0 if off < 0.005 * len(errors) and max(errors) < NEVER and not failed else 1)


if __name__ == "__main__":
    main()
