#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The dashboard for Grafana: each of its queries is one that the service answers with flat rows that have its columns.
#   grafana_test.sh RPSUP DASHBOARD
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
dashboard=$2
start_service store.db
echo '{"name": "shown", "parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.3]}, "replicates": {"count": 2}}' >sweep.json
id=$(submit sweep.json)
wait_for_end "$id"

# Every query of Infinity, of panels and variables, on a line.
jq -c '[.panels[].targets[] | select(.datasource.type == "yesoreyeram-infinity-datasource")] + [.templating.list[].query.infinityQuery? // empty] | .[]' \
  "$dashboard" >queries
queries=0
while read -r query; do
  queries=$((queries + 1))
  path=$(jq -r .url <<<"$query")
  [[ $path == '${url}'/* ]] || fail "a query is not of the service of the dashboard: $path"
  path=${path//'${url}'/$url}
  path=${path//'${sweep}'/$id}
  get "$path" >answer.json || fail "no answer: $path"
  jq --argjson query "$query" '
    (if $query.root_selector == "" then . else .[$query.root_selector] end) | if type == "array" then . else [.] end' answer.json >rows.json
  expect_equal "$(jq 'length > 0' rows.json)" true "rows of $path"
  # A column is a path of keys; its values are numbers or null where the dashboard calls it one, and texts elsewhere.
  jq -r --argjson query "$query" '
    .[] as $row | $query.columns[] | . as $column | ($column.selector | split(".")) as $keys
    | if ($row | getpath($keys[:-1]) | has($keys[-1]) | not) then "no \($column.selector)"
      else ($row | getpath($keys)) as $value
      | if $value == null or ($value | type) == (if $column.type == "number" then "number" else "string" end) then empty
        else "\($column.selector) is \($value)" end end' rows.json >faults
  [ ! -s faults ] || { cat faults; fail "columns of $path"; }
done <queries
[ "$queries" -ge 6 ] || fail "only $queries queries in the dashboard"

# The table itself has neither objects nor lists in its cells.
get "$url/v1/sweeps/$id/results" | jq -e 'all(.[]; all(.[]; type != "object" and type != "array"))' >/dev/null || fail "results are not flat"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
echo "$queries queries of the dashboard are answered"
