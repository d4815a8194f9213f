#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every fault of tests/faults/faults.txt can still be planted, and found.csv beside it names a test that finds it.
#   faults_are_found.sh ROOT
set -euo pipefail
cd "$1"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
found=tests/faults/found.csv
script/faults --list

if grep ',none$' "$found"; then
  echo "$found names faults that no test finds"
  exit 1
fi
awk 'BEGIN { RS = ""; FS = "\n" } { for (i = 1; i <= NF; ++i) if ($i !~ /^#/) { print $i; break } }' tests/faults/faults.txt | grep -v '^$' >"$scratch/titles"
sed -n 's/^"\(.*\)",..*$/\1/p' "$found" | sed 's/""/"/g' >"$scratch/found"
diff "$scratch/found" "$scratch/titles" || {
  echo "$found is not that of the present list: script/faults --report $found"
  exit 1
}
echo "$found has all of them"
