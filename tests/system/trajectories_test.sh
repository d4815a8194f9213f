#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Files with all trajectories of a sweep: their numbers are those of each job's trajectory, in h5py, NumPy and Octave; the
# service needs no more memory for many jobs than for few; a full disk, and a process that is killed, leave nothing behind.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
skipped=

start_service all.db
sweep=$(get "$url/v1/sweeps" -d '{"name": "Gelenk, größer", "parameters": {"duration_s": 1, "run_up_s": 0.3}, "sweep":
  {"clearance_mm": [0, 0.25], "crank_velocity_rad_s": [5, 10], "coupler": ["rigid", "flexible"]}}' | jq -r .id)
get -H 'Prefer: wait=20' "$url/v1/sweeps/$sweep" >sweep.json
expect_equal "$(jq .counts.succeeded sweep.json)" 8 "jobs"
for format in h5 mat npz; do
  get -o "all.$format" "$url/v1/sweeps/$sweep/trajectories?format=$format&channels=slider_acceleration_m_s2,pose_1_3_1_x_m&from=0.2&to=0.7"
done
for row in $(seq 0 7); do
  job=$(get "$url/v1/sweeps/$sweep/results" | jq -r ".[$row].job_id")
  get "$url/v1/jobs/$job/trajectory?from=0.2&to=0.7&format=json" >"job_000$((row + 1)).json"
done
get "$url/v1/sweeps/$sweep/results" >rows.json

cat >compare.py <<'PY'
import json, sys
import numpy
wanted = ("t_s", "slider_acceleration_m_s2", "pose_1_3_1_x_m")
rows = json.load(open("rows.json"))
def check(name, results, trajectories):
    for key in ("job_id", "state", "coupler", "clearance_mm", "peak_slider_acceleration_m_s2"):
        assert [row[key] for row in rows] == results(key), (name, key)
    numbers = 0
    for k in range(1, len(rows) + 1):
        job = json.load(open(f"job_000{k}.json"))
        columns = {key: job["columns"][key] for key in wanted if key in job["columns"]}
        read = trajectories(f"job_000{k}")
        assert set(read) == set(columns), (name, k, set(read))
        for key, values in columns.items():
            assert numpy.array_equal(read[key], values), (name, k, key)
            numbers += len(values)
    print(name, numbers, "numbers")
packed = numpy.load("all.npz")
assert packed["sweep_name"][0] == "Gelenk, größer"
check("npz", lambda key: packed["results/" + key].tolist(), lambda job: {
    name.split("/")[2]: packed[name] for name in packed.files if name.startswith(f"trajectories/{job}/") and not name.endswith("job_id")})
try:
    import h5py
except ImportError:
    sys.exit(77)
file = h5py.File("all.h5")
assert file.attrs["sweep_name"].decode() == "Gelenk, größer"
assert file["results/peak_slider_acceleration_m_s2"].attrs["unit"].decode() == "m/s²"
assert file["trajectories/job_0002/pose_1_3_1_x_m"].attrs["unit"].decode() == "m"
assert file["trajectories/job_0002/pose_1_3_1_x_m"].chunks is not None
text = lambda value: value.decode() if isinstance(value, bytes) else value
units = {}
def note_unit(name, data):
    if "unit" in data.attrs:
        units[name.split("/")[-1]] = text(data.attrs["unit"])
file.visititems(note_unit)
assert units["clearance_mm"] == "mm" and units["crank_velocity_rad_s"] == "rad/s", units
json.dump(units, open("units.json", "w"), ensure_ascii=False)
check("h5", lambda key: [text(value) for value in file["results/" + key][()].tolist()],
      lambda job: {key: data[()] for key, data in file["trajectories/" + job].items()})
PY
code=0
/usr/bin/python3 compare.py || code=$?
[ "$code" -ne 77 ] || skipped="$skipped h5py"
[ "$code" -eq 0 ] || [ "$code" -eq 77 ] || fail "the numbers differ"

cat >compare.m <<'M'
mat = load('all.mat');
h5 = load('all.h5');
assert(mat.sweep.name, 'Gelenk, größer');
assert(mat.results.coupler{2}, 'flexible');
assert(mat.units.pose_1_3_1_x_m, 'm');
if exist('units.json', 'file')  % of the HDF5 file
  units = jsondecode(fileread('units.json'));
  assert(sort(fieldnames(units)), sort(fieldnames(mat.units)));
  for key = fieldnames(units)'
    assert(mat.units.(key{1}), units.(key{1}));
  end
end
assert(mat.results.clearance_mm(:), h5.results.clearance_mm(:));
assert(h5.results.state(1, :), 'succeeded');
for k = 1:8
  name = sprintf('job_%04d', k);
  job = jsondecode(fileread([name '.json'])).columns;
  for key = {'t_s', 'slider_acceleration_m_s2', 'pose_1_3_1_x_m'}
    assert(isfield(mat.(name), key{1}), isfield(job, key{1}));
    if isfield(job, key{1})
      assert(mat.(name).(key{1})(:), h5.trajectories.(name).(key{1})(:));
      assert(mat.(name).(key{1})(:), job.(key{1})(:), -1e-14);  % its JSON is not read to the last bit
    end
  end
end
disp('same numbers');
M
if command -v octave-cli >/dev/null; then
  octave-cli --norc --quiet compare.m >out 2>err || true
  grep -qx 'same numbers' out || { cat out err; fail 'Octave reads other numbers'; }
else
  skipped="$skipped Octave"
fi

# A download that broke off goes on.
head -c 1000 all.h5 >part.h5
get --continue-at - -o part.h5 "$url/v1/sweeps/$sweep/trajectories?channels=slider_acceleration_m_s2,pose_1_3_1_x_m&from=0.2&to=0.7"
cmp part.h5 all.h5

# Memory of the service.
memory_kb() { awk "/^$1/ { print \$2 }" "/proc/$service/status"; }
many=$(get "$url/v1/sweeps" -d '{"parameters": {"duration_s": 0.2, "run_up_s": 0.1, "output_rate_hz": 5000}, "sweep":
  {"clearance_mm": [0], "crank_velocity_rad_s": {"from": 1, "to": 15, "count": 600}}}' | jq -r .id)
until [ "$(get -H 'Prefer: wait=20' "$url/v1/sweeps/$many" | jq -r .state)" = succeeded ]; do :; done
before=$(memory_kb VmRSS)
for format in h5 mat npz; do
  get -o "many.$format" "$url/v1/sweeps/$many/trajectories?format=$format&channels=slider_acceleration_m_s2,slider_velocity_m_s"
done
peak=$(memory_kb VmHWM)
echo "600 jobs, two channels: $(stat --format=%s many.h5) bytes of HDF5; the service's memory was $before kB before and $peak kB at most"
[ "$((peak - before))" -le 65536 ] || fail "the service has taken more than 64 MB"
/usr/bin/python3 - <<'PY' || [ $? -eq 77 ]
import sys
try:
    import h5py
except ImportError:
    sys.exit(77)
assert len(h5py.File("many.h5")["trajectories"]) == 600
PY

# A file that the disk does not take is no file, whatever the library says.
stop_service TERM
for format in h5 mat npz; do
  for kilobytes in 4 16 40 41 42 43 70 150 400; do
    code=0
    (ulimit -f "$kilobytes"; exec "$rpsup" export "short.$format" --db all.db --trajectories "$sweep") >out 2>err || code=$?
    expect_equal "$code" 3 "exit code of an export to $format that ends after $kilobytes kB"
    expect_text err '^rpsup: .*short'
    expect_equal "$(ls short.* 2>/dev/null | wc -l)" 0 "files of an export that failed"
  done
done
expect_code 0 "$rpsup" export whole.h5 --db all.db --trajectories "$sweep" --channels slider_acceleration_m_s2,pose_1_3_1_x_m --from 0.2 --to 0.7
cmp whole.h5 all.h5
expect_code 2 "$rpsup" export whole.h5 --db all.db --trajectories "$sweep"
expect_code 2 "$rpsup" export other.parquet --db all.db --trajectories "$sweep"
expect_text err '[.]h5, [.]mat or [.]npz'
expect_code 2 "$rpsup" export other.h5 --db all.db --trajectories swp_01m8ex00000000000000000000
start_service all.db
expect_code 0 "$rpsup" --url "$url" trajectory "$sweep" --channels slider_acceleration_m_s2,pose_1_3_1_x_m --from 0.2 --to 0.7 --output remote.h5
cmp remote.h5 all.h5
expect_code 2 "$rpsup" --url "$url" trajectory "$sweep" --channels nothing --output none.h5
expect_text err '/channels/0'
expect_equal "$(ls none.h5* 2>/dev/null | wc -l)" 0 "files of a trajectory that was refused"
expect_code 3 "$rpsup" export busy.h5 --db all.db --trajectories "$sweep"

# Killed while it makes a file.
get -o killed.h5 "$url/v1/sweeps/$many/trajectories" 2>/dev/null &
asking=$!
for _ in $(seq 200); do ls all.db.rpsup-export-* >/dev/null 2>&1 && break; sleep 0.01; done
stop_service KILL
wait "$asking" 2>/dev/null || true
start_service all.db
expect_equal "$(ls all.db.rpsup-export-* 2>/dev/null | wc -l)" 0 "files of the process that was killed"
stop_service TERM

[ -z "$skipped" ] || { echo "skipped:$skipped"; exit 77; }
