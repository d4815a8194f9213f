#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Identity of results changes with everything that decides their bytes, and with nothing else.   engine_identity_test.sh ROOT
set -euo pipefail
root=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# identity OPTION...: the engine's identity of a build that is configured so. The first one has found compiler and libraries for the others.
identity() {
  rm -rf "$folder/build"
  [ ! -d "$folder/first" ] || cp -r "$folder/first" "$folder/build"
  cmake -S "$root" -B "$folder/build" -G Ninja --log-level=ERROR -DCMAKE_BUILD_TYPE=Release "$@" >/dev/null
  sed -n 's/.*kEngineVersion = "\(.*\)";/\1/p' "$folder/build/generated/jobs/base/program_info.cc" | grep .
}

plain=$(identity -DCMAKE_CXX_FLAGS_RELEASE=-O3)
mv "$folder/build" "$folder/first"
# expect same|other OPTION...
expect() {
  local wanted=$1 found
  shift
  found=$(identity -DCMAKE_CXX_FLAGS_RELEASE=-O3 "$@")
  if [ "$wanted" = same ] && [ "$found" != "$plain" ] || [ "$wanted" = other ] && [ "$found" = "$plain" ]; then
    echo "$*: $found beside $plain, wanted is the $wanted"
    exit 1
  fi
}
expect same -DRPSUP_WERROR=OFF -DRPSUP_INSTRUCTION_SETS=baseline -DCMAKE_UNITY_BUILD=ON
expect other -DCMAKE_CXX_FLAGS=-ffast-math
expect other -DCMAKE_CXX_FLAGS_RELEASE=-O1
expect other -DRPSUP_SANITIZE=address
echo "the engine's identity is $plain, and other with other options"
