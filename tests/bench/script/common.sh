# SPDX-License-Identifier: Apache-2.0
# For script/bench and the parts of it. Sourced; expects $root.
source "$root/script/common.sh"

# Packages that the benchmarks need beside those of script/setup build.
bench_packages=(libbenchmark-dev libsimbody-dev libmujoco-dev)

# build_benches TREE TARGET...: in TREE/build/bench, with the flags of the release preset
build_benches() {
  local tree=$1
  shift
  echo "bench: building $*"
  (cd "$tree" && cmake --preset release -B build/bench -DRPSUP_BENCH=ON --log-level=WARNING >/dev/null)
  cmake --build "$tree/build/bench" --target "$@" --parallel "$(parallel_jobs)" >"$tree/build/bench/build.log" ||
    { tail -n 40 "$tree/build/bench/build.log" >&2; echo "script/bench: the build failed" >&2; exit 1; }
}

# The page of results, which a record before this one may have changed, is no part of what is measured.
describe_commit() {
  local dirty=
  git diff --quiet HEAD -- . ':!tests/bench/README.md' 2>/dev/null || dirty=-dirty
  echo "$(git rev-parse --short=12 HEAD 2>/dev/null || echo unknown)$dirty"
}

describe_machine() {
  echo "bench: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg)," \
    "$(c++ --version | head -n 1), commit $(describe_commit)"
}

# record OUTPUT WHAT [ARGUMENT...]: puts the tables of the file OUTPUT between the marks of WHAT in
# tests/bench/README.md, with command, commit and date
record() {
  local output=$1 readme=$root/tests/bench/README.md
  shift
  grep -qxF "<!-- script/bench $1 -->" "$readme" || { echo "script/bench: $readme has no place for $1" >&2; exit 2; }
  {
    sed "/^<!-- script\/bench $1 -->\$/q" "$readme"
    echo
    echo "\`script/bench $*\`, $(date --utc +%F), commit $(describe_commit), load $(cut -d' ' -f1 /proc/loadavg)"
    cat "$output"
    echo
    sed "1,/^<!-- script\/bench $1 -->\$/d" "$readme" | sed -n '/^<!-- end -->$/,$p'
  } >"$output.readme"
  cp "$output.readme" "$readme"
}

# run_bench PROGRAM ARGUMENT...
run_bench() {
  echo
  echo "bench: $*"
  "$root/build/bench/$1" "${@:2}"
}
