#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails where folders include each other in a circle: each can be read without those that use it.   folders_in_no_circle.sh ROOT
set -euo pipefail
cd "$1"

# "A B" for every folder A of ours that includes a header of another one, B. Generated headers belong to the folder in their path.
arrows() {
  grep -roE --include='*.h' --include='*.cc' '^[[:space:]]*#[[:space:]]*include[[:space:]]*"(charts|engine|jobs|server|validation)/[^"]+"' charts engine jobs server validation |
    sed -E 's|^(.*)/[^/:]+:[^"]*"(.*)/[^/"]+"$|\1 \2|' | awk '$1 != $2' | sort -u
}

found=$(arrows || true)
if [ -z "$found" ]; then
  echo "no folder includes another: is this the right folder?" >&2
  exit 1
fi
if ! told=$(tsort <<<"$found" 2>&1 >/dev/null); then
  echo "folders include each other in a circle:"
  sed -n 's/^tsort: \([^ ]*\)$/  \1/p' <<<"$told"
  exit 1
fi
echo "$(wc -l <<<"$found") arrows between folders, no circle"
