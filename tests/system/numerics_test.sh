#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# --numerics portable: the results of a processor without FMA and AVX2, kept apart from those of this one.   numerics_test.sh RPSUP
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

echo '{"duration_s": 0.6, "run_up_s": 0.3, "clearance_mm": 0.25, "coupler": "flexible"}' >job.json
metrics() {
  jq -c '[.metrics, .run.numerics]' "$1"
}
"$rpsup" simulate job.json >native
"$rpsup" simulate job.json --numerics portable --trajectory portable.csv >portable
# Variants that the C library takes for a lesser processor give the same as its portable ones, though this run does not know of them.
GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-SSE4_1,-AVX512F "$rpsup" simulate job.json --trajectory lesser.csv >lesser
expect_equal "$(jq -c .run.numerics native)" '"native"' "numerics that nobody asked for"
expect_equal "$(jq -c .run.numerics portable)" '"portable"' "numerics that were asked for"
expect_equal "$(jq -c .metrics portable)" "$(jq -c .metrics lesser)" "metrics of a lesser processor"
cmp portable.csv lesser.csv || fail "the trajectories of a lesser processor"
if grep -qw fma /proc/cpuinfo; then
  [ "$(jq -c .metrics portable)" != "$(jq -c .metrics native)" ] || fail "portable numerics change nothing on this processor"
fi

# A result of the one is none of the other.
echo '{"parameters": {"duration_s": 0.05, "run_up_s": 0.02}}' >sweep.json
for numerics in native portable portable; do
  expect_code 0 "$rpsup" sweep sweep.json --db store.db --results "$numerics.csv" --numerics "$numerics"
done
expect_equal "$(sqlite3 store.db "SELECT group_concat(numerics) FROM results")" native,portable "results that were computed"
expect_equal "$(RPSUP_NUMERICS=portable "$rpsup" simulate job.json | jq -r .run.numerics)" portable "numerics from the environment"
echo "portable numerics are the same on a lesser processor"
