#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The account of what the paper leaves open: its table is that of its rows, and the program finds rows of it again.
#   unknowns_test.sh RPSUP UNKNOWNS.JSON UNKNOWNS.CSV UNKNOWNS.MD
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
request=$2 rows=$3 text=$4

echo "the shares of $text are those of $rows"
settings=$(awk -F, 'NR > 1 && $4 != ""' "$rows" | wc -l)
[ "$settings" -ge 2000 ] || fail "$rows has ratios of $settings settings only"
# share NUMBER: in per cent, as the table has it
share() { sed -n "s/^$1 .* in \([0-9.e+]*\) %\$/\1/p" "$text" | head -n 1; }
awk -F, 'NR > 1 {
    split("8.5 4 3.5 1.25", paper, " ")
    for (i = 1; i <= 4; ++i) if ($(3 + i) != "") { n[i + 1]++; r = $(3 + i) / paper[i]; if (r >= 0.8 && r <= 1.2) held[i + 1]++ }
    if ($8 != "" && $9 != "") { n[6]++; if ($8 < 0.999 && $9 < 0.999) held[6]++ }
    if ($10 != "" && $11 != "") { n[7]++; if ($10 < 0.999 && $11 < 0.999) held[7]++ }
  }
  END { for (i = 2; i <= 7; ++i) print i, (n[i] > 0 ? 100 * held[i] / n[i] : "none") }' "$rows" >shares
expect_equal "$(wc -l <shares)" 6 "statements with a share"
while read -r number expected; do
  found=$(share "$number")
  [ -n "$found" ] && [ "$expected" != none ] || fail "statement $number: no share in $text or no rows of it"
  awk -v f="$found" -v e="$expected" 'BEGIN { d = f - e; if (d < 0) d = -d; exit !(f != "" && d <= 0.15) }' ||
    fail "statement $number: $text has $found %, its rows $expected %"
done <shares

echo "the report has the same shares"
report=$(dirname "$text")/VALIDATION.md
paste -sd ' ' "$report" | sed -n 's/.*statements 2 to 7 in \([0-9., and]*\) %.*/\1/p' | tr -s ', and' '\n' >reported
paste -d ' ' <(awk '{ print $2 }' shares) reported |
  awk '{ d = $1 - $2; if (d < 0) d = -d; if ($2 != "" && d <= 0.15) n++ } END { exit !(n == 6 && NR == 6) }' ||
  fail "$report has other shares: $(paste -sd ' ' reported)"

echo "the first settings again"
# find_growths TOLERANCE FILE: two growths of each setting
find_growths() {
  jq --argjson tolerance "$1" '.design.count = 6 | .parameters += {relative_tolerance: $tolerance, absolute_tolerance: $tolerance}' "$request" >few.json
  expect_code 0 "$rpsup" sweep few.json --db few.db --results few.results.json
  jq -r '[.[].peak_slider_acceleration_m_s2] as $p | range(6) as $i | [$p[24 + $i] / $p[12 + $i], $p[48 + $i] / $p[36 + $i]] | @csv' few.results.json >"$2"
}
find_growths "$(jq .parameters.relative_tolerance "$request")" again
find_growths 1e-6 tight
# Growths of chaotic settings depend on the tolerance, and on the processor. The others, seven of twelve or more, are those of the rows; one
# chaotic one may be among them by chance.
read -r settled same < <(paste -d, again tight <(awk -F, '$1 == "continuum" && $2 == 1 && $3 <= 6 { print $4 "," $6 }' "$rows") | awk -F, '
  function is_near(a, b) { return a / b > 0.99 && a / b < 1.01 }
  { for (i = 1; i <= 2; ++i) if (is_near($i, $(i + 2))) { ++settled; same += is_near($i, $(i + 4)) } }
  END { print settled + 0, same + 0 }')
[ "$settled" -ge 7 ] && [ "$same" -ge $((settled - 1)) ] ||
  fail "of twelve growths $settled do not depend on the tolerance, and $same of these are those of $rows"
echo "$settings settings, $same of $settled growths that do not depend on the tolerance found again"
