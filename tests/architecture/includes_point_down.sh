#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails for an include that points up a layer: server -> jobs -> engine, validation beside them, and some libraries have one layer that may use
# them.   includes_point_down.sh ROOT
set -euo pipefail
cd "$1"

faults=0

# Every include of a source, as FILE:LINE:TEXT.
includes=$(grep -rnE --include='*.h' --include='*.cc' --exclude-dir=node_modules '^[[:space:]]*#[[:space:]]*include' \
  charts engine jobs server tests validation | sort)

# forbid FOLDER PATTERN [EXCEPT]: no source of the folder includes what matches, save the files named
forbid() {
  local found
  if ! [[ $'\n'$includes == *$'\n'"$1/"* ]]; then
    echo "$1 holds no source at all: is this the right folder?" >&2
    exit 1
  fi
  found=$(grep -E "^$1/[^:]*:[0-9]+:[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($2)" <<<"$includes" || true)
  [ -z "$found" ] || [ -z "${3:-}" ] || found=$(grep -vE "$3" <<<"$found" || true)
  if [ -n "$found" ]; then
    echo "$1 must not include $2:"
    sed 's/^/  /' <<<"$found"
    faults=$((faults + 1))
  fi
}

sqlite='sqlite3|SQLiteCpp'
http='httplib'
forbid engine "(\.\./)*(charts|validation|jobs|server|web|tests)/|$sqlite|$http|nlohmann|spdlog|CLI|zstd|openssl|prometheus"
forbid jobs "(\.\./)*(charts|validation|server|web|tests)/|$http|spdlog|CLI|prometheus"
forbid server "(\.\./)*(validation|web|tests)/|$sqlite|zstd"
forbid server "$http" '^server/http/http(lib|_[a-z]+)?\.(h|cc):'
# Positions and rates come before forces.
forbid engine/kinematics 'engine/dynamics/'
forbid engine/model 'engine/(kinematics|dynamics)/'
# The kernel of the dynamics stands behind engine/dynamics/dynamics_kernel.h. Its chapters build on each other: topology, forward, tangent, newton.
kernel='engine/dynamics/kernel/'
forbid engine "$kernel" "^$kernel"
for folder in jobs server validation tests; do forbid "$folder" "$kernel"; done
forbid ${kernel}topology 'engine/dynamics/([a-z_]+\.h|kernel/([a-z_]+\.h|forward|tangent|newton))'
forbid ${kernel}forward "$kernel([a-z_]+\.h|tangent|newton)"
forbid ${kernel}tangent "$kernel([a-z_]+\.h|newton)"
forbid ${kernel}newton "$kernel[a-z_]+\.h"
forbid charts "(engine|validation|jobs|server|web|tests)/"
forbid validation "(jobs|server|web|tests)/" '^validation/(studies|program)/'
forbid validation/studies "(server|web|tests)/"
# A path that climbs out of its folder hides which layer it reaches.
forbid engine '\.\./'
forbid jobs '\.\./'
forbid server '\.\./'

[ "$faults" -eq 0 ] && echo "every include points down"
