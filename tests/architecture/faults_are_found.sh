#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every fault of tests/faults/faults.txt can still be planted, and the validation report names a test that finds it.
#   faults_are_found.sh ROOT
set -euo pipefail
cd "$1"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
script/faults --list

awk 'BEGIN { RS = ""; FS = "\n" } { for (i = 1; i <= NF; ++i) if ($i !~ /^#/) { print $i; break } }' tests/faults/faults.txt | grep -v '^$' >"$scratch/titles"
sed -n '/^<!-- faults -->$/,/^<!-- end of faults -->$/s/^| \(.*\) | `.*` | \(.*\) |$/\1\t\2/p' validation/VALIDATION.md >"$scratch/reported"
if grep -F '**nothing**' "$scratch/reported"; then
  echo "the report names faults that nothing finds"
  exit 1
fi
diff <(cut -f1 "$scratch/reported") "$scratch/titles" || { echo "the report is not that of the present list: script/faults --report validation/VALIDATION.md"; exit 1; }
echo "the report has all of them"
