#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The tables of server/METRICS.md are those of the OpenAPI document, and every metric and channel of a job has a definition there.
#   quantity_table.sh RPSUP METRICS.MD QUANTITY_TABLE.JQ LINKAGE.JSON
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
start_service quantities.db
get "$url/v1/openapi.json" >openapi.json
jq -r -f "$3" openapi.json | sed 1d >expected
grep -c '^| `' expected >rows || true
[ "$(<rows)" -gt 80 ] || fail "only $(<rows) rows"
awk '/^## / { inside = 1 } inside' "$2" >shown
diff shown expected || fail "METRICS.md shows other tables: run jq as the head of $(basename "$3") says"

# undefined SCHEMA: the names read that the schema defines neither by name nor by a pattern.
undefined() {
  jq -r --slurpfile document openapi.json "
    (\$document[0].components.schemas | $1) as \$schema
    | .[] | select(in(\$schema.properties // {}) | not)
    | select(. as \$name | [\$schema.patternProperties // {} | keys[] | . as \$pattern | \$name | test(\$pattern)] | any | not)"
}
jq '. + {"duration_s": 0.02}' "$4" >linkage.json
for request in '{"duration_s": 0.02, "coupler": "flexible"}' "$(<linkage.json)"; do
  job=$(curl -s -H 'Prefer: wait=60' -d "$request" "$url/v1/jobs")
  expect_equal "$(jq -r .state <<<"$job")" succeeded "state of the job"
  kind=0
  ! jq -e '.parameters.linkage | type == "object"' <<<"$job" >/dev/null || kind=1
  jq '.metrics | keys' <<<"$job" >metrics
  [ "$(jq length metrics)" -gt 10 ] || fail "a job has few metrics"
  expect_equal "$(undefined ".Metrics.anyOf[$kind]" <metrics)" "" "metrics without a definition"
  get "$url$(jq -r .links.trajectory <<<"$job")?to=0" | jq .channels >channels
  [ "$(jq length channels)" -gt 20 ] || fail "a job has few channels"
  expect_equal "$(undefined .Trajectory.properties.columns <channels)" "" "channels without a definition"
done
expect_equal "$(echo '["peak_nothing"]' | undefined '.Metrics.anyOf[0]')" peak_nothing "a name that is not defined"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
