#!/usr/bin/env bash
# The table of parameters in README.md is the one the program answers.   readme_table.sh RPSUP README PARAMETER_TABLE.JQ
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
start_service table.db
get "$url/v1/parameters" | jq -r -f "$3" >expected
grep -F '| `' expected >/dev/null || fail "no rows"
awk '/^\| parameter \| default/ { inside = 1 } inside && !/^\|/ { exit } inside { print }' "$2" >shown
diff shown expected || fail "README.md shows another table: run jq as the head of $(basename "$3") says"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
