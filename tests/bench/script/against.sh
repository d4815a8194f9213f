# SPDX-License-Identifier: Apache-2.0
# The parts of the working tree against those of another commit, by turns in one run. Sourced by script/bench; $1 the commit, $2 a filter.
# A part has become slower if both its least and its median time have, by more than $most_ratio: one alone is noise.
commit=$(git rev-parse --verify --quiet "$1^{commit}") || { echo "script/bench: $1 is no commit" >&2; exit 2; }
filter=${2:-.}
rounds=5
most_ratio=1.10
git cat-file -e "$commit:tests/bench/CMakeLists.txt" 2>/dev/null || { echo "script/bench: $1 has no benchmarks" >&2; exit 2; }

scratch=$(mktemp -d)
leave() {
  git worktree remove --force "$scratch/tree" 2>/dev/null || true
  rm -rf "$scratch"
}
trap leave EXIT
trap 'exit 130' INT TERM
build_benches "$root" bench_parts
other=$root/build/bench/against/$commit  # the program is kept: a commit does not change
if [ ! -x "$other" ]; then
  git worktree add --quiet --detach "$scratch/tree" "$commit"
  build_benches "$scratch/tree" bench_parts
  mkdir -p "${other%/*}"
  cp "$scratch/tree/build/bench/bench_parts" "$other"
fi
describe_machine

# measure SIDE PROGRAM: appends "SIDE NAME NANOSECONDS" for each part
measure() {
  "$2" --benchmark_format=json --benchmark_min_time=0.1 --benchmark_filter="$filter" 2>/dev/null >"$scratch/json" ||
    { echo "script/bench: $2 failed" >&2; exit 1; }
  jq -r --arg side "$1" '.benchmarks[] | select(.error_occurred | not) |
    [$side, .name, .cpu_time * {ns: 1, us: 1e3, ms: 1e6, s: 1e9}[.time_unit]] | @tsv' "$scratch/json" >>"$scratch/times"
}
for ((round = 1; round <= rounds; ++round)); do
  echo "bench: round $round of $rounds" >&2
  measure new "$root/build/bench/bench_parts"
  measure old "$other"
done

awk -F '\t' -v most="$most_ratio" -v commit="$1" '
  # Times of one part on one side stay in order.
  {
    key = $1 SUBSEP $2
    for (i = ++count[key]; i > 1 && time[key, i - 1] > $3; --i) time[key, i] = time[key, i - 1]
    time[key, i] = $3
    if (!($2 in seen)) { seen[$2] = 1; name[++names] = $2 }
  }
  function median(key) { return (time[key, int((count[key] + 1) / 2)] + time[key, int(count[key] / 2) + 1]) / 2 }
  END {
    printf "\n| %-36s | %14s | %14s | %11s | %12s |\n", "part", "here [ns]", "there [ns]", "least ratio", "median ratio"
    printf "|--------------------------------------|---------------:|---------------:|------------:|-------------:|\n"
    for (n = 1; n <= names; ++n) {
      new = "new" SUBSEP name[n]; old = "old" SUBSEP name[n]
      if (!(new in count) || !(old in count)) continue
      ++compared
      least = time[new, 1] / time[old, 1]; middle = median(new) / median(old)
      slow = least > most && middle > most
      slower += slow
      printf "| %-36s | %14.4g | %14.4g | %11.3f | %12.3f |%s\n", name[n], time[new, 1], time[old, 1], least, middle, slow ? " SLOWER" : ""
    }
    if (!compared) { print "script/bench: no part that both have" > "/dev/stderr"; exit 2 }
    printf "\nbench: %d parts, %d slower than %s by more than %g times\n", compared, slower, commit, most
    exit (slower > 0)
  }' "$scratch/times"
