#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The tables of parameters in jobs/parameters/README.md, below "All parameters", are those that the program answers;
# --help prints the same parameters.   readme_table.sh RPSUP README PARAMETER_TABLE.JQ
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
start_service table.db
get "$url/v1/parameters" | jq -r -f "$3" >expected
grep -F '| `' expected >/dev/null || fail "no rows"
sed '1,/^## All parameters$/d' "$2" | sed '1d' >shown
diff shown <(sed '$d' expected) || fail "$2 shows other tables: run jq as the head of $(basename "$3") says"

# And so is what --help prints.
"$rpsup" simulate --help >help
get "$url/v1/parameters" | jq -r '.properties | (del(.links) | keys[]), (.links.properties | to_entries[] | "links.\(.key).\(.value.properties | keys[])")' >keys
expect_equal "$(grep -c . keys)" 89 "parameters"
while read -r key; do
  grep -qE "^  ${key//./\\.} " help || fail "simulate --help does not name $key"
done <keys
expect_text help '^  clearance_mm +0\.25 mm, in \[0, 1000\): Radial'
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
