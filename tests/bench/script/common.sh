# SPDX-License-Identifier: Apache-2.0
# For script/bench and the parts of it. Sourced; expects $root.

# Packages that the benchmarks need beside those of script/setup.
bench_packages=(libbenchmark-dev libsimbody-dev libmujoco-dev)

install_packages() {
  script/setup
  local missing=() package
  for package in "${bench_packages[@]}"; do
    [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "script/bench: as root, run: apt-get install ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "bench: installing ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 apt-get --quiet=2)
  "${apt[@]}" update
  "${apt[@]}" install --yes --no-install-recommends "${missing[@]}"
}

# build_benches TREE TARGET...: in TREE/build/bench, with the flags of the release preset
build_benches() {
  local tree=$1
  shift
  echo "bench: building $*"
  # A file that uses Eigen takes up to 1.5 GB to compile: no more at a time than there is memory for.
  local cores by_memory
  cores=$(nproc)
  by_memory=$(($(awk '$1 == "MemAvailable:" {print $2}' /proc/meminfo) / 1500000))
  [ "$by_memory" -ge 1 ] || by_memory=1
  (cd "$tree" && cmake --preset release -B build/bench -DRPSUP_BENCH=ON --log-level=WARNING >/dev/null)
  cmake --build "$tree/build/bench" --target "$@" --parallel $((by_memory < cores ? by_memory : cores)) >"$tree/build/bench/build.log" ||
    { tail -n 40 "$tree/build/bench/build.log" >&2; echo "script/bench: the build failed" >&2; exit 1; }
}

describe_commit() {
  git describe --always --dirty --abbrev=12 2>/dev/null || echo unknown
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
