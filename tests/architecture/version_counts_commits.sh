#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks packaging/version.cmake in small repositories: commits since the version was set, archives, shallow clones.
#   version_counts_commits.sh ROOT
set -euo pipefail
root=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
git() { command git -c user.name=test -c user.email=test@localhost -c commit.gpgsign=false "$@"; }

faults=0
# expect FOLDER EXPECTED: version, text and commit of its sources; HASH stands for the commit
expect() {
  local hash found
  hash=$(git -C repository rev-parse --short=12 HEAD)
  found=$(cd "$1" && cmake -P print.cmake 2>"$folder/warnings")
  found=${found#-- }
  [ "${found//$hash/HASH}" = "$2" ] && return
  echo "$1: expected $2, found $found"
  faults=$((faults + 1))
}

mkdir -p repository/packaging
cd repository
git init --quiet --initial-branch=main
cp "$root/packaging/version.cmake" packaging/
cp "$root/.gitattributes" .
cat >print.cmake <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
file(READ CMakeLists.txt text)
string(REGEX MATCH "rpsup VERSION ([0-9.]+)" text "${text}")
set(PROJECT_VERSION ${CMAKE_MATCH_1})
include(packaging/version.cmake)
message(STATUS "${RPSUP_VERSION} ${RPSUP_VERSION_TEXT} ${RPSUP_COMMIT}")
CMAKE
# commit [TEXT]: of CMakeLists.txt
commit() {
  [ $# -eq 0 ] || echo "$1" >CMakeLists.txt
  git add --all
  git commit --quiet --allow-empty --message=change
}
commit 'project(rpsup VERSION 0.1.0 LANGUAGES CXX)'
cd ..
expect repository '0.1.0 0.1.0+gHASH HASH'
(cd repository && commit && commit 'project(rpsup VERSION 0.1.0 LANGUAGES CXX C)')
expect repository '0.1.0+2 0.1.0+2.gHASH HASH'
echo 'project(rpsup VERSION 0.2.0 LANGUAGES CXX C)' >repository/CMakeLists.txt
expect repository '0.2.0 0.2.0+gHASH.dirty HASH-dirty'
(cd repository && commit 'project(rpsup VERSION 0.2.0 LANGUAGES CXX C)' && commit)
expect repository '0.2.0+1 0.2.0+1.gHASH HASH'

git clone --quiet --depth=1 "file://$folder/repository" shallow
expect shallow '0.2.0 0.2.0+gHASH HASH'
grep -q shallow warnings || { echo "a shallow clone is not warned of"; faults=$((faults + 1)); }

mkdir archive
git -C repository archive HEAD | tar -x -C archive
expect archive '0.2.0 0.2.0+gHASH HASH'
# Sources without Git's files, in the repository of something else.
mkdir -p repository/inside
cp -r repository/packaging repository/print.cmake repository/CMakeLists.txt repository/inside/
expect repository/inside '0.2.0 0.2.0 unknown'

[ "$faults" -eq 0 ] || exit 1
echo "the version counts commits"
