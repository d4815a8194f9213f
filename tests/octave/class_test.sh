#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The class for Octave and MATLAB: against the program, which has a token, and against a server that fails.
#   class_test.sh RPSUP FOLDER-OF-THE-CLASS
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$tests/../system/helpers.sh"
export CLASS=$2
command -v octave-cli >/dev/null || { echo "skipped: Octave comes with script/setup all"; exit 77; }

export TOKEN=0123456789abcdef0123456789abcdef
RPSUP_TOKEN=$TOKEN start_service store.db
/usr/bin/python3 "$tests/failing_server.py" requests >failing &
server=$!
trap 'kill $server 2>/dev/null; leave' EXIT
until [ -s failing ]; do sleep 0.1; done
FAILING=$(cat failing)
export URL=$url FAILING
mkdir temporary
TMPDIR=$PWD/temporary expect_code 0 octave-cli --norc --quiet "$tests/class_test.m"
expect_text out '^all of the class works$'

# One request, three times with one key; one download, with the names of the interface.
expect_equal "$(grep -c '^POST /v1/sweeps ' requests)" 3 "requests until one was answered"
expect_equal "$(grep '^POST /v1/sweeps ' requests | sort -u | wc -l)" 1 "idempotency keys of one request"
query='format=npz&channels=journal_x_mm,journal_y_mm&from=0.5&to=2'
expect_equal "$(grep trajectories requests)" "GET /v1/sweeps/swp_1/trajectories?$query " "the download"
expect_equal "$(cat study.npz)" "the archive" "what was downloaded"
expect_equal "$(ls temporary)" "" "folders that are left"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
! grep -q "$TOKEN" log || fail "the token is in the log"
echo "the class works"
