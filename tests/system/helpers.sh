# SPDX-License-Identifier: Apache-2.0
# For the tests that drive the program itself. Sourced; expects the path of the program in $1.
set -euo pipefail
export LC_ALL=C
export no_proxy=127.0.0.1 NO_PROXY=127.0.0.1
# Options of the caller's environment are not part of a test.
for variable in $(compgen -e RPSUP_ || true); do unset "$variable"; done

rpsup=$(realpath "$1")
folder=$(mktemp -d)
service=
export XDG_CONFIG_HOME=$folder/config  # the file with options of whoever runs it is not part of a test either

# Ends what this test has started, and says where it stood if it fails.
leave() {
  local code=$?
  if [ -n "$service" ] && kill -0 "$service" 2>/dev/null; then
    kill -KILL "$service"
    wait "$service" 2>/dev/null || true
  fi
  if [ "$code" -ne 0 ] && [ -f "$folder/log" ]; then
    echo "--- the end of the service's log:"
    tail -n 20 "$folder/log"
  fi
  rm -rf "$folder"
}
trap leave EXIT
trap 'echo "failed in line $LINENO: $BASH_COMMAND"' ERR
cd "$folder"

fail() {
  echo "failed: $*"
  exit 1
}

# expect_equal GOT EXPECTED WHAT
expect_equal() {
  [ "$1" = "$2" ] || fail "$3: got '$1', expected '$2'"
}

# expect_text FILE PATTERN: a line of the file matches
expect_text() {
  grep -qE -- "$2" "$1" || { cat "$1"; fail "no line of $1 matches '$2'"; }
}

# expect_code CODE COMMAND...: runs it with its output in the files out and err
expect_code() {
  local expected=$1 code=0
  shift
  "$@" >out 2>err || code=$?
  [ "$code" -eq "$expected" ] || { cat out err; fail "exit code $code instead of $expected: $*"; }
}

# start_service STORE [OPTION...]: sets `service` and `url`
start_service() {
  local store=$1 tenths
  shift
  : >ready
  "$rpsup" serve --db "$store" --port 0 "$@" >ready 2>>log &
  service=$!
  for ((tenths = 0; tenths < 300; ++tenths)); do
    url=$(sed -n 's/^rpsup listens on //p' ready)
    [ -z "$url" ] || return 0
    kill -0 "$service" 2>/dev/null || fail "the service ended while it started"
    sleep 0.1
  done
  fail "the service was not ready within 30 s"
}

# stop_service SIGNAL: sends it and sets `code`
stop_service() {
  kill "-$1" "$service"
  code=0
  wait "$service" 2>/dev/null || code=$?
  service=
}

get() {
  curl --silent --show-error --fail-with-body --max-time 20 "$@"
}

# has_terminals: script(1) is there, and can make a terminal; a system in another's root may have none
has_terminals() {
  if [ -z "${terminals:-}" ]; then
    terminals=no
    if command -v script >/dev/null && script --quiet --return --command true /dev/null </dev/null >/dev/null 2>&1; then terminals=yes; fi
    [ "$terminals" = yes ] || echo "left out: no terminal can be made, so nothing is shown on one"
  fi
  [ "$terminals" = yes ]
}

# status_of CURL-ARGUMENTS...: the status alone
status_of() {
  curl --silent --max-time 20 --output /dev/null --write-out '%{http_code}' "$@"
}

# submit FILE: the id of the new sweep
submit() {
  get --data "@$1" "$url/v1/sweeps" | jq -r .id
}

# wait_for_end ID: sets `state`
wait_for_end() {
  local tenths
  for ((tenths = 0; tenths < 1200; ++tenths)); do
    state=$(get "$url/v1/sweeps/$1" | jq -r .state)
    case "$state" in queued | running) sleep 0.1 ;; *) return 0 ;; esac
  done
  fail "the sweep has not ended after 120 s"
}

# results ID: the table as CSV without job_id, which is another one in every store
results() {
  get --header 'Accept: text/csv' "$url/v1/sweeps/$1/results" | without_job_id
}

without_job_id() {
  cut -d, -f2-
}
