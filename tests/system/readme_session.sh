#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs what README.md (or another) shows: every block of shell commands below a line `<!-- run by a test -->`, in their order, as one
# script, against a fresh service.   readme_session.sh RPSUP README [filled]: with a sweep in its store
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
readme=$2

awk '
  /^<!-- run by a test -->$/ { marked = 1; next }
  marked && /^```sh$/ { inside = 1; marked = 0; blocks++; next }
  inside && /^```$/ { inside = 0; next }
  inside { print }
  marked && !/^[[:space:]]*$/ { print "a mark without a block of shell commands in line " NR > "/dev/stderr"; exit 1 }
  END { if (inside || blocks == 0) { print "no complete block is marked" > "/dev/stderr"; exit 1 } }
' "$readme" >session.sh

start_service readme.db
if [ "${3:-}" = filled ]; then
  echo '{"parameters": {"duration_s": 0.05, "run_up_s": 0.02}, "sweep": {"coupler": ["rigid", "flexible"]}}' >first.json
  wait_for_end "$(submit first.json)"
fi
# The README speaks of the default address and of the program where script/build leaves it.
sed -i -e "s#http://127\.0\.0\.1:8080#$url#g" -e "s#http://localhost:8080#$url#g" \
  -e "s#\(127\.0\.0\.1\|localhost\):8080#${url#http://}#g" -e "s#\(\./\)\?build/release/rpsup#$rpsup#g" \
  -e "s#/var/lib/rpsup/rpsup\.db#$folder/readme.db#g" session.sh
mkdir session
code=0
(cd session && PATH="$(dirname "$rpsup"):$PATH" bash -euo pipefail ../session.sh) >session.out 2>session.err || code=$?
[ "$code" -eq 0 ] || { cat -n session.sh; cat session.out session.err; fail "the session ended with exit code $code"; }
# A refused request ends curl without an error unless it is told otherwise.
! grep -l 'application/problem+json\|"type":"about:blank"' session.out || { cat session.out; fail "a request was refused"; }
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
echo "the commands of $readme work"
