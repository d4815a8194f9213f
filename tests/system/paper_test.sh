#!/usr/bin/env bash
# The paper's study at default settings: 18 jobs, every one with a closed energy account, and the peaks that other codes find.
#   paper_test.sh RPSUP PAPER.JSON
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
paper=$2

echo "the grid of $paper on two threads"
SECONDS=0
expect_code 0 "$rpsup" sweep "$paper" --db paper.db --threads 2 --results two.csv
echo "took $SECONDS s"

# value CLEARANCE VELOCITY COUPLER COLUMN
value() {
  awk -F, -v clearance="$1" -v velocity="$2" -v coupler="$3" -v wanted="$4" '
    { sub(/\r$/, "") }
    NR == 1 { for (i = 1; i <= NF; ++i) place[$i] = i; next }
    $place["clearance_mm"] == clearance && $place["crank_velocity_rad_s"] == velocity && $place["coupler"] == coupler { print $place[wanted] }
  ' two.csv
}

# expect_near GOT EXPECTED RELATIVE WHAT
expect_near() {
  awk -v got="$1" -v expected="$2" -v relative="$3" \
    'BEGIN { d = got - expected; if (d < 0) d = -d; exit !(got != "" && d <= relative * expected) }' ||
    fail "$4: got '$1', expected $2 within $3"
}

jobs=0
for clearance in 0 0.25 0.5; do
  for velocity in 5 10 12; do
    for coupler in rigid flexible; do
      what="$clearance mm, $velocity rad/s, $coupler"
      jobs=$((jobs + 1))
      expect_equal "$(value $clearance $velocity $coupler state)" succeeded "state of $what"
      residual=$(value $clearance $velocity $coupler energy_residual)
      awk -v r="$residual" 'BEGIN { exit !(r != "" && r >= 0 && r < 1e-5) }' || fail "energy residual of $what: '$residual'"
    done
    # The paper's first claim: without clearance a flexible coupler moves as a rigid one.
    [ "$clearance" != 0 ] || expect_near "$(value 0 $velocity flexible amplification)" 1 1e-4 "flexible over ideal peak at $velocity rad/s"
  done
done
expect_equal "$(($(wc -l <two.csv) - 1))" "$jobs" "rows of the table"

# The closed form of the ideal linkage, differentiated twice; and 4 s of the rigid case on which six other codes agree.
expect_near "$(value 0 10 rigid peak_slider_acceleration_m_s2)" 38.8612939 1e-6 "ideal peak at 10 rad/s"
echo '{"duration_s": 4}' >four.json
expect_code 0 "$rpsup" simulate four.json
expect_near "$(jq .metrics.peak_slider_acceleration_m_s2 out)" 772.6 0.002 "peak of the rigid case"
expect_near "$(jq .metrics.peak_slider_acceleration_time_s out)" 3.6434 3e-5 "its time"

echo "the same on one thread gives the same bytes"
expect_code 0 "$rpsup" sweep "$paper" --db other.db --threads 1 --results one.csv
cmp <(without_job_id <one.csv) <(without_job_id <two.csv) || fail "one thread and two threads differ"
echo "18 jobs, every energy account closed"
