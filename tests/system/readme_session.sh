#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the commands that a document shows: every block of shell commands below a line `<!-- run by a test -->`, in
# their order, as one script, against a fresh service. A block of text below a line `<!-- its output -->` must stand
# in the output of that script as it is shown.
#   readme_session.sh RPSUP DOCUMENT [filled]: with a sweep in the store of the service
sources=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
readme=$2

awk '
  /^<!-- run by a test -->$/ { marked = "sh"; next }
  /^<!-- its output -->$/ { marked = "text"; next }
  marked && $0 == "```" marked { inside = marked; marked = ""; blocks[inside]++; next }
  inside && /^```$/ { inside = ""; next }
  inside == "sh" { print >"session.sh" }
  inside == "text" { print >("expected." blocks["text"]) }
  marked && !/^[[:space:]]*$/ { print "a mark without a block in line " NR > "/dev/stderr"; exit 1 }
  END { if (inside || marked || blocks["sh"] == 0) { print "no complete block is marked" > "/dev/stderr"; exit 1 } }
' "$readme"

start_service readme.db
if [ "${3:-}" = filled ]; then
  echo '{"parameters": {"duration_s": 0.05, "run_up_s": 0.02}, "sweep": {"coupler": ["rigid", "flexible"]}}' >first.json
  wait_for_end "$(submit first.json)"
fi
# Documents name the default address, the program where script/build leaves it, and files of the sources.
sed -i -e "s#http://127\.0\.0\.1:8080#$url#g" -e "s#http://localhost:8080#$url#g" \
  -e "s#\(127\.0\.0\.1\|localhost\):8080#${url#http://}#g" -e "s#\(\./\)\?build/release/rpsup#$rpsup#g" \
  -e "s#\b\(script\|web/linkages\|tests/system\)/\([a-z_]*\.json\)#$sources/\1/\2#g" -e "s#/var/lib/rpsup/rpsup\.db#$folder/readme.db#g" session.sh
mkdir session
code=0
(cd session && PATH="$(dirname "$rpsup"):$PATH" bash -euo pipefail ../session.sh) >session.out 2>session.err || code=$?
[ "$code" -eq 0 ] || { cat -n session.sh; cat session.out session.err; fail "the session ended with exit code $code"; }
# A refused request ends curl without an error unless it is told otherwise.
! grep -l 'application/problem+json\|"type":"about:blank"' session.out || { cat session.out; fail "a request was refused"; }
sed -i 's/ *$//' session.out
for expected in expected.*; do
  [ -e "$expected" ] || break
  [[ "$(cat session.out)" != *"$(cat "$expected")"* ]] || continue
  cat session.out "$expected"
  fail "the last lines, shown in $readme, are not in the output of its commands"
done
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
echo "the commands of $readme work"
