#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The pages read of the service's answers, and ask of it, what its own OpenAPI document says.   javascript_types_test.sh RPSUP ROOT
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
packages=$2/tests/node_modules
[ -d "$packages" ] || fail "the npm packages of tests/ are missing: script/setup fetches them"
[ -d "$2/web/node_modules" ] || fail "the npm packages of web/ are missing: script/setup fetches them"

start_service types.db
get "$url/v1/openapi.json" >openapi.json
stop_service TERM
node "$packages/openapi-typescript/bin/cli.js" openapi.json --output openapi.d.ts >/dev/null

# The pages as they are, and beside them the types of this program.
mkdir -p web tests/web
find "$2/web" -mindepth 1 -maxdepth 1 ! -name node_modules -exec cp -r -t web {} +
cp "$2/tests/web/tsconfig.json" tests/web
ln -s "$2/web/node_modules" web
ln -s "$packages" tests
types() {
  node "$packages/typescript/bin/tsc" --project tests/web --incremental --tsBuildInfoFile "$folder/checked"
}
expect_code 0 types

# Wrong names, planted where pages read answers or make requests, are found.
planted=()
# plant FILE RIGHT WRONG ERROR
plant() {
  grep -qF -- "$2" "web/$1" || fail "web/$1 has no '$2' any more"
  sed -i "s/$2/$3/" "web/$1"
  planted+=("^web/$1\([0-9,]+\): error TS[0-9]+: .*$4")
}
plant pages/sweep.js 'counts, eta_s: eta' 'counts, eta_seconds: eta' "Property 'eta_seconds' does not exist"
plant study/sweep_row.js 'sweep.executor' 'sweep.exekutor' "Property 'exekutor' does not exist"
plant run/standing.js 'ended_at: ended' 'end_at: ended' "Property 'end_at' does not exist"
plant run/facts.js 'run.wall_time_s' 'run.wall_s' "Property 'wall_s' does not exist"
plant study/wear_view.js 'cycle.rate_um_h' 'cycle.rate_um' "Property 'rate_um' does not exist"
plant study/limit_view.js 'limit.limit_beyond' 'limit.beyond' "Property 'beyond' does not exist"
plant study/fit_view.js 'points.lost > 0' 'points.missing > 0' "Property 'missing' does not exist"
plant study/optimisation_answer.js 'best_repeats: repeats' 'repeats: repeats' "Property 'repeats' does not exist"
plant measure/measurement_view.js 'run.sampling.rate_hz' 'run.sampling.rate' "Property 'rate' does not exist"
plant analysis/surrogate.js 'surface.terms' 'surface.term' "Property 'term' does not exist"
plant form/estimate.js 'measured_jobs: measured' 'measured: measured' "Property 'measured' does not exist"
plant form/from_sweep.js 'limit: 1' 'most: 1' "'most' does not exist"
plant core/live.js 'sweep.counts.queued' 'sweep.count.queued' "Property 'count' does not exist"
expect_code 2 types
for error in "${planted[@]}"; do expect_text out "$error"; done
expect_equal "$(grep -c 'error TS' out)" "${#planted[@]}" "errors found"
