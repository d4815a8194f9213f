#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Plants one wrong include at a time in a small tree and expects includes_point_down.sh or folders_in_no_circle.sh to fail on it.
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/includes_point_down.sh
circles=$(dirname "${BASH_SOURCE[0]}")/folders_in_no_circle.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# plant FILE INCLUDE: the tree of correct includes with one more
plant() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{charts,jobs,tests} "$tree"/engine/{kinematics,model} "$tree"/engine/dynamics/kernel/{topology,forward,tangent,newton} "$tree/server/http" "$tree"/validation/{studies,program}
  echo '#include <vector>' >"$tree/engine/simulate.h"
  echo '#include <vector>' >"$tree/engine/model/mechanism.h"
  echo '#include "engine/model/mechanism.h"' >"$tree/engine/kinematics/frame_motion.h"
  echo '#include <vector>' >"$tree/engine/dynamics/dynamics_kernel.h"
  echo '#include <vector>' >"$tree/engine/dynamics/kernel/topology/topology.h"
  echo '#include "engine/dynamics/kernel/topology/topology.h"' >"$tree/engine/dynamics/kernel/forward/forward_dynamics.h"
  echo '#include "engine/dynamics/kernel/forward/forward_dynamics.h"' >"$tree/engine/dynamics/kernel/tangent/linearised_dynamics.h"
  echo '#include "engine/dynamics/kernel/tangent/linearised_dynamics.h"' >"$tree/engine/dynamics/kernel/newton/newton_matrix.h"
  echo '#include "engine/dynamics/kernel/newton/newton_matrix.h"' >"$tree/engine/dynamics/kernel/compiled_kernel.h"
  echo '#include "engine/dynamics/dynamics_kernel.h"' >>"$tree/engine/dynamics/kernel/compiled_kernel.h"
  echo '#include "engine/simulate.h"' >"$tree/tests/simulate_test.cc"
  echo '#include "engine/simulate.h"' >"$tree/jobs/store.cc"
  echo '#include "jobs/store.h"' >"$tree/server/routes.cc"
  echo '#include <httplib.h>' >"$tree/server/http/http_guard.cc"
  echo '#include <vector>' >"$tree/charts/chart.h"
  echo '#include "engine/simulate.h"' >"$tree/validation/findings.h"
  echo '#include "jobs/store.h"' >"$tree/validation/studies/study.cc"
  echo '#include "server/routes.h"' >"$tree/validation/program/main.cc"
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
expect_refused engine/simulate.h '#include "validation/report/report.h"'
expect_refused jobs/store.cc '#include "validation/report/report.h"'
expect_refused server/routes.cc '#include "validation/report/report.h"'
expect_refused charts/chart.h '#include "engine/simulate.h"'
expect_refused validation/findings.h '#include "jobs/store.h"'
expect_refused validation/studies/study.cc '#include "server/routes.h"'
expect_refused engine/kinematics/frame_motion.h '#include "engine/dynamics/dynamics_kernel.h"'
expect_refused engine/model/mechanism.h '#include "engine/kinematics/frame_motion.h"'
expect_refused engine/simulate.h '#include "engine/dynamics/kernel/forward/forward_dynamics.h"'
expect_refused engine/dynamics/dynamics_kernel.h '#include "engine/dynamics/kernel/compiled_kernel.h"'
expect_refused jobs/store.cc '#include "engine/dynamics/kernel/compiled_kernel.h"'
expect_refused server/routes.cc '#include "engine/dynamics/kernel/compiled_kernel.h"'
expect_refused validation/findings.h '#include "engine/dynamics/kernel/newton/newton_matrix.h"'
expect_refused tests/simulate_test.cc '#include "engine/dynamics/kernel/topology/topology.h"'
expect_refused engine/dynamics/kernel/topology/topology.h '#include "engine/dynamics/dynamics_kernel.h"'
expect_refused engine/dynamics/kernel/topology/topology.h '#include "engine/dynamics/kernel/forward/forward_dynamics.h"'
expect_refused engine/dynamics/kernel/forward/forward_dynamics.h '#include "engine/dynamics/kernel/tangent/linearised_dynamics.h"'
expect_refused engine/dynamics/kernel/tangent/linearised_dynamics.h '#include "engine/dynamics/kernel/newton/newton_matrix.h"'
expect_refused engine/dynamics/kernel/newton/newton_matrix.h '#include "engine/dynamics/kernel/compiled_kernel.h"'

rm -rf "${tree:?}"/*
mkdir -p "$tree"/{charts,engine,jobs,server,validation}
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
