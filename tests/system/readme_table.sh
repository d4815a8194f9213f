#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The table of parameters in README.md is the one the program answers, and --help prints the same.   readme_table.sh RPSUP README PARAMETER_TABLE.JQ
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
start_service table.db
get "$url/v1/parameters" | jq -r -f "$3" >expected
grep -F '| `' expected >/dev/null || fail "no rows"
awk '/^\| parameter \| default/ { inside = 1 } inside && !/^\|/ { exit } inside { print }' "$2" >shown
diff shown expected || fail "README.md shows another table: run jq as the head of $(basename "$3") says"

# And so is what --help prints.
"$rpsup" simulate --help >help
get "$url/v1/parameters" | jq -r '.properties | (del(.links) | keys[]), (.links.properties | to_entries[] | "links.\(.key).\(.value.properties | keys[])")' >keys
expect_equal "$(grep -c . keys)" 86 "parameters"
while read -r key; do
  grep -qE "^  ${key//./\\.} " help || fail "simulate --help does not name $key"
done <keys
expect_text help '^  clearance_mm +0\.25 mm, in \[0, 1000\): Radial'
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
