#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# mypy finds no fault in the types of the Python package, for its oldest Python, and finds those that are
# planted in a user's script.
#   types_test.sh PACKAGE
set -euo pipefail
package=$1
command -v mypy >/dev/null || { echo "skipped: mypy comes with script/setup all"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
check() {
  MYPYPATH=$package mypy --strict --python-version 3.9 --python-executable /usr/bin/python3 \
    --cache-dir "$folder/cache" "$@"
}
check -p rpsup

cat >"$folder/right.py" <<'END'
import rpsup

with rpsup.start(threads=2) as client:
    sweep: rpsup.Sweep = client.submit(clearance_mm=[0, 0.25]).wait()
    rows: list[dict[str, object]] = list(sweep.rows())
    client.newest(rpsup.Search, 1)[0].limits()
END
check "$folder/right.py"
sed -e 's/threads=2/threads="two"/' -e 's/: rpsup.Sweep/: rpsup.Search/' -e 's/limits()/limit()/' \
  "$folder/right.py" >"$folder/wrong.py"
! check "$folder/wrong.py" >"$folder/said" || { echo "wrong types were not found"; exit 1; }
cat "$folder/said"
[ "$(grep -c ': error: ' "$folder/said")" -eq 3 ]
