# SPDX-License-Identifier: Apache-2.0
# The paper's study (40 jobs of 5 s) from POST to the last result stored, on two threads, against MuJoCo's RK4 run of one rigid job.
# Sourced by script/bench.
export no_proxy=127.0.0.1 NO_PROXY=127.0.0.1
scratch=$(mktemp -d)
service=
stop_service() {
  if [ -n "$service" ] && kill -0 "$service" 2>/dev/null; then
    kill -TERM "$service" 2>/dev/null || true
    wait "$service" 2>/dev/null || true
  fi
  service=
}
leave() {
  stop_service
  rm -rf "$scratch"
}
trap leave EXIT
trap 'exit 130' INT TERM

# A service with an empty store; sets `url` once it answers.
start_service() {
  rm -f "$scratch"/store.db*
  : >"$scratch/ready"  # read below, perhaps before the service has opened it
  "$root/build/bench/rpsup" serve --db "$scratch/store.db" --port 0 --threads 2 --log-level warning >"$scratch/ready" &
  service=$!
  local tenths
  for ((tenths = 0; tenths < 100; ++tenths)); do
    url=$(sed -n 's/^rpsup listens on //p' "$scratch/ready")
    if [ -n "$url" ] && curl --silent --fail --output /dev/null "$url/readyz"; then return; fi
    kill -0 "$service" 2>/dev/null || break
    sleep 0.1
  done
  echo "script/bench: the service did not start" >&2
  exit 1
}

# Prints the seconds of wall time from POST to the end of the sweep.
time_study() {
  local from to id
  from=$(date +%s.%N)
  id=$(curl --silent --show-error --fail-with-body --data @script/paper.json "$url/v1/sweeps" | jq -r .id)
  while :; do
    curl --silent --show-error --fail "$url/v1/sweeps/$id" >"$scratch/sweep"
    case "$(jq -r .state "$scratch/sweep")" in queued | running) sleep 0.05 ;; *) break ;; esac
  done
  to=$(date +%s.%N)
  [ "$(jq -r .state "$scratch/sweep")" = succeeded ] || { echo "script/bench: the sweep did not succeed" >&2; exit 1; }
  awk -v from="$from" -v to="$to" 'BEGIN { printf "%.3f\n", to - from }'
}

echo
echo "bench: the paper's sweep"
for round in 1 2 3; do
  mujoco=$("$root/build/bench/bench_codes" mujoco)
  start_service
  study=$(time_study)
  used=$(awk -v tick="$(getconf CLK_TCK)" '{ print ($14 + $15) / tick }' "/proc/$service/stat")
  stop_service
  echo "$study $mujoco $used" >>"$scratch/rounds"
done
awk '
  {
    ratio[NR] = $1 / $2
    printf "study %.2f s of wall time on two threads, MuJoCo RK4 1e-5 s %.2f s of CPU: ratio %.2f (half of its %.2f s of CPU: %.2f)\n",
      $1, $2, ratio[NR], $3, $3 / 2 / $2  # the wall time of a machine with other work says little
  }
  END {
    if (NR != 3) exit 1
    low = ratio[1] < ratio[2] ? ratio[1] : ratio[2]; high = ratio[1] < ratio[2] ? ratio[2] : ratio[1]
    median = ratio[3] < low ? low : ratio[3] > high ? high : ratio[3]
    printf "median ratio %.2f; asked for: at most 3; met: %s\n", median, median <= 3 ? "yes" : "no"
  }' "$scratch/rounds"
trap - EXIT INT TERM
leave
