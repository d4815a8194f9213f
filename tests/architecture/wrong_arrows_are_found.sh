#!/usr/bin/env bash
# Plants one wrong include at a time in a small tree and expects includes_point_down.sh or folders_in_no_circle.sh to fail on it.
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/includes_point_down.sh
circles=$(dirname "${BASH_SOURCE[0]}")/folders_in_no_circle.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# plant FILE INCLUDE: the tree of correct includes with one more
plant() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree/engine/kinematics" "$tree/engine/model" "$tree/jobs" "$tree/server/http"
  echo '#include <vector>' >"$tree/engine/simulate.h"
  echo '#include <vector>' >"$tree/engine/model/mechanism.h"
  echo '#include "engine/model/mechanism.h"' >"$tree/engine/kinematics/frame_motion.h"
  echo '#include "engine/simulate.h"' >"$tree/jobs/store.cc"
  echo '#include "jobs/store.h"' >"$tree/server/routes.cc"
  echo '#include <httplib.h>' >"$tree/server/http/http_guard.cc"
  [ -z "${1:-}" ] || echo "$2" >>"$tree/$1"
}

plant
bash "$check" "$tree" >/dev/null && bash "$circles" "$tree" >/dev/null || { echo "correct includes are refused"; exit 1; }

expect_refused() {
  plant "$1" "$2"
  if bash "$check" "$tree" >/dev/null; then
    echo "not found: $2 in $1"
    exit 1
  fi
}
expect_refused engine/simulate.h '#include "jobs/store.h"'
expect_refused engine/simulate.h '#include <nlohmann/json.hpp>'
expect_refused jobs/store.cc '#include "server/routes.h"'
expect_refused jobs/store.cc '#  include <httplib.h>'
expect_refused server/routes.cc '#include <SQLiteCpp/SQLiteCpp.h>'
expect_refused server/routes.cc '#include <sqlite3.h>'
expect_refused server/routes.cc '#include <httplib.h>'
expect_refused server/routes.cc '#include "../jobs/store.h"'
expect_refused engine/simulate.h '#include "engine/validation/report.h"'
expect_refused jobs/store.cc '#include "engine/validation/report.h"'
expect_refused engine/kinematics/frame_motion.h '#include "engine/dynamics/equations.h"'
expect_refused engine/model/mechanism.h '#include "engine/kinematics/frame_motion.h"'

rm -rf "${tree:?}"/*
mkdir -p "$tree/engine" "$tree/jobs" "$tree/server"
if bash "$circles" "$tree" 2>"$tree/told" || ! grep -q 'no folder includes another' "$tree/told"; then
  echo "an empty tree passes without a word"
  exit 1
fi

expect_circle() {
  plant "$1" "$2"
  if bash "$circles" "$tree" >/dev/null; then
    echo "no circle found: $2 in $1"
    exit 1
  fi
}
expect_circle engine/model/mechanism.h '#include "engine/kinematics/frame_motion.h"'
expect_circle engine/simulate.h '#  include "server/routes.h"'
echo "all planted faults are found"
