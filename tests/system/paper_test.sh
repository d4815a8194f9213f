#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The paper's study: every energy account closed, the paper's statements, the closed form of the ideal linkage, and the peaks that other codes find.
#   paper_test.sh RPSUP PAPER.JSON ACROSS.JSON
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
paper=$2 across=$3

echo "the study of $paper on two threads"
SECONDS=0
expect_code 0 "$rpsup" sweep "$paper" --db paper.db --threads 2 --results two.json
echo "took $SECONDS s"
expect_equal "$(jq 'map(select(.replicate == 0)) | length' two.json)" 24 "cases"
expect_equal "$(jq 'map(select(.state != "succeeded")) | length' two.json)" 0 "jobs that failed"
jq -e 'all(.energy_residual >= 0 and .energy_residual < 1e-6)' two.json >/dev/null || fail "an energy account is open"

echo "the paper's seven statements, on medians of five replicates of every case"
jq 'del(.replicates.only)' "$paper" >five.json
expect_code 0 "$rpsup" sweep five.json --db paper.db --threads 2 --results five.results.json
expect_equal "$(jq length five.results.json)" 120 "jobs of five replicates"
expect_code 0 "$rpsup" paper five.results.json
cat out
expect_equal "$(grep -c '^[1-7] .* holds$' out)" 7 "statements that hold"

# median CLEARANCE VELOCITY COUPLER
median() {
  jq --argjson c "$1" --argjson v "$2" --arg k "$3" \
    '[.[] | select(.clearance_mm == $c and .crank_velocity_rad_s == $v and .coupler == $k) | .peak_slider_acceleration_m_s2] | sort | .[2]' five.results.json
}

# The same without the program's own word: growth from 10 to 15 rad/s within 20 % of what the paper prints, and the orders at 15 rad/s.
while read -r clearance coupler printed; do
  awk -v fast="$(median "$clearance" 15 "$coupler")" -v slow="$(median "$clearance" 10 "$coupler")" -v printed="$printed" \
    'BEGIN { r = fast / slow / printed; exit !(r >= 0.8 && r <= 1.2) }' || fail "growth with $clearance mm, $coupler: not $printed within 20 %"
done <<'TXT'
0.25 rigid 8.5
0.25 flexible 4
0.5 rigid 3.5
0.5 flexible 1.25
TXT
# below NAME NAME  each "CLEARANCE COUPLER"
below() {
  awk -v a="$(median $1 15 $2)" -v b="$(median $3 15 $4)" 'BEGIN { exit !(a < b) }' || fail "at 15 rad/s the peak with $1 mm, $2 is not below that with $3 mm, $4"
}
below 0.25 flexible 0.25 rigid
below 0.5 flexible 0.5 rigid
below 0.5 rigid 0.25 rigid
below 0.5 flexible 0.25 flexible

# expect_near GOT EXPECTED RELATIVE WHAT
expect_near() {
  awk -v got="$1" -v expected="$2" -v relative="$3" \
    'BEGIN { d = got - expected; if (d < 0) d = -d; exit !(got != "" && d <= relative * expected) }' ||
    fail "$4: got '$1', expected $2 within $3"
}
for velocity in 5 10 12 15; do
  expect_near "$(median 0 $velocity flexible)" "$(median 0 $velocity rigid)" 0.05 "flexible over rigid peak of the ideal joint at $velocity rad/s"
done

echo "the second geometry: the closed form of the ideal linkage, differentiated twice, and 4 s of the rigid case on which six other codes agree"
jq '. + {clearance_mm: 0}' "$across" >ideal.json
expect_code 0 "$rpsup" simulate ideal.json
expect_near "$(jq .metrics.peak_slider_acceleration_m_s2 out)" 38.8612939 1e-6 "its ideal peak at 10 rad/s"
jq '. + {duration_s: 4}' "$across" >four.json
expect_code 0 "$rpsup" simulate four.json
expect_near "$(jq .metrics.peak_slider_acceleration_m_s2 out)" 772.6 0.002 "its peak with clearance"
expect_near "$(jq .metrics.peak_slider_acceleration_time_s out)" 3.6434 3e-5 "the time of that peak"

echo "the same on one thread gives the same bytes"
expect_code 0 "$rpsup" sweep "$paper" --db one.db --threads 1 --results one.csv
expect_code 0 "$rpsup" sweep "$paper" --db two.db --threads 2 --results two.csv
cmp <(without_job_id <one.csv) <(without_job_id <two.csv) || fail "one thread and two threads differ"
echo "every statement holds, every energy account is closed"
