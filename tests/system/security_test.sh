#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup serve with a token, under another name and on all interfaces of a machine: who is let in, and what the log and the disk tell.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

secret=b1946ac92492d2347c6235b4d2611184
printf '%s\n' "$secret" >token
chmod 600 token

# Nothing but the loopback is served without a token, and no token is taken that others may read or guess.
expect_code 2 "$rpsup" serve --db a.db --port 0 --host 0.0.0.0
expect_text err 'without a token'
# With one, others are: this address is no machine's, so that it gets as far as asking for the port.
expect_code 2 "$rpsup" serve --db a.db --port 0 --host 192.0.2.1
expect_code 3 "$rpsup" serve --db tried.db --port 0 --host 192.0.2.1 --token-file token
expect_text err 'cannot listen on http://192.0.2.1'
chmod 644 token
expect_code 2 "$rpsup" serve --db a.db --port 0 --token-file token
expect_text err 'chmod 600'
chmod 600 token
echo short >short
chmod 600 short
expect_code 2 "$rpsup" serve --db a.db --port 0 --token-file short
expect_text err '16 to 512 characters'
RPSUP_TOKEN='two words, not one token' expect_code 2 "$rpsup" serve --db a.db --port 0
expect_text err 'visible ASCII'
expect_code 2 "$rpsup" serve --db a.db --port 0 --token-file missing

# A token that was meant and is missing: on the command line, in the environment, in the configuration file, and an empty file.
# `timeout`, since what waits for a FIFO or serves without a token goes on for ever.
expect_code 2 timeout 20 "$rpsup" serve --db a.db --port 0 --token-file ''
RPSUP_TOKEN_FILE='' expect_code 2 timeout 20 "$rpsup" serve --db a.db --port 0
RPSUP_TOKEN='' expect_code 2 timeout 20 "$rpsup" serve --db a.db --port 0
for value in '' '""'; do
  printf '[serve]\ntoken-file=%s\n' "$value" >none.ini
  expect_code 2 timeout 20 "$rpsup" --config none.ini serve --db a.db --port 0
  expect_text err 'names no file'
done
(umask 077 && : >empty && mkfifo fifo)
for name in empty fifo . /dev/null; do
  expect_code 2 timeout 20 "$rpsup" serve --db a.db --port 0 --token-file "$name"
  expect_code 2 timeout 20 "$rpsup" status --token-file "$name"
done
expect_code 2 timeout 20 "$rpsup" --config fifo status
expect_text err 'is no regular file'
# A file that another user can change is no secret of this one, whatever its mode. Only the administrator can make one.
if [ "$(id -u)" = 0 ]; then
  cp token foreign
  chmod 600 foreign
  chown 65534 foreign
  expect_code 2 timeout 20 "$rpsup" serve --db a.db --port 0 --token-file foreign
  expect_text err 'belongs to another user'
fi
expect_code 2 "$rpsup" serve --db a.db --port 0 --host rpsup.example.org
expect_code 2 "$rpsup" serve --db a.db --port 0 --name https://rpsup.example.org
[ ! -e a.db ] || fail "a refused command has made a store"
! grep -F "$secret" err out || fail "a message holds the token"

start_service store.db --token-file token --name rpsup.example.org --log-level debug
expect_equal "$(stat --format=%a store.db store.db-wal store.db-shm store.db.lock | sort -u)" 600 "modes of the store's files"
expect_code 0 "$rpsup" export --db store.db copy.db
expect_equal "$(stat --format=%a copy.db)" 600 "mode of a copy"

# Every method of every route asks for the token, before the body is read, and so does what is not there.
for method in GET HEAD POST PUT PATCH DELETE OPTIONS TRACE; do
  for path in / /docs /metrics /nothing /v1/sweeps /v1/jobs /v1/store /v1/openapi.json /v1/sweeps/s1/events; do
    expect_equal "$(curl --silent --max-time 20 --request "$method" $([ "$method" != HEAD ] || echo --head) --output /dev/null --write-out '%{http_code}' "$url$path")" 401 \
      "$method $path without the token"
  done
done
curl --silent --include --data '{}' "$url/v1/sweeps" >refused
expect_text refused '^WWW-Authenticate: Bearer realm="rpsup"'
expect_text refused '^Content-Type: application/problem\+json'
expect_equal "$(status_of "$url/healthz")" 200 "health without the token"
expect_equal "$(status_of "$url/readyz")" 200 "readiness without the token"
expect_equal "$(status_of --header "Authorization: Bearer ${secret}0" "$url/v1/sweeps")" 401 "another token"
expect_equal "$(status_of "$url/v1/sweeps?token=$secret")" 401 "the token in the query"
expect_equal "$(status_of --header "Authorization: Bearer $secret" "$url/v1/sweeps")" 200 "the token"
expect_equal "$(status_of --user "anybody:$secret" "$url/")" 200 "the token as a password"
expect_equal "$(status_of --header "Authorization: Bearer $secret" --data '{"sweep": {"clearance_mm": [0]}, "parameters": {"duration_s": 0.05}}' "$url/v1/sweeps")" 201 "a sweep with the token"
RPSUP_URL=$url RPSUP_TOKEN=$secret expect_code 0 "$rpsup" status
RPSUP_URL=$url expect_code 0 "$rpsup" status --token-file token
RPSUP_URL=$url RPSUP_TOKEN_FILE=token expect_code 0 "$rpsup" status

# A configuration file with a token is a secret, and one with the address of the service says where tokens go.
printf 'url=%s\ntoken=%s\n' "$url" "$secret" >client.ini
chmod 644 client.ini
expect_code 2 "$rpsup" --config client.ini status
expect_text err 'client.ini: other users can read or write the file'
RPSUP_CONFIG=client.ini expect_code 2 "$rpsup" status
chmod 600 client.ini
expect_code 0 "$rpsup" --config client.ini status
printf 'url=%s\n' "$url" >address.ini
chmod 646 address.ini
RPSUP_TOKEN=$secret expect_code 2 "$rpsup" --config address.ini status
expect_text err 'address.ini: other users can write the file'
chmod 644 address.ini
RPSUP_TOKEN=$secret expect_code 0 "$rpsup" --config address.ini status

# The arguments of a client that runs do not hold the token, and its user is warned.
sweep=$(RPSUP_URL=$url RPSUP_TOKEN=$secret "$rpsup" submit - <<<'{"parameters": {"duration_s": 500}, "sweep": {"clearance_mm": [0.3]}}')
for form in "--token $secret" "--token=$secret"; do
  : >watched  # what the last one wrote is not of this one
  # shellcheck disable=SC2086  # an option with its value
  "$rpsup" watch "$sweep" --url "$url" $form 2>watched &
  watcher=$!
  until grep -q 'of 1' watched; do sleep 0.1; done
  ! tr '\0' ' ' <"/proc/$watcher/cmdline" | grep -F "$secret" || fail "the arguments of a client hold the token"
  expect_text watched 'give it by --token-file'
  kill -TERM "$watcher"
  wait "$watcher" || true
done
RPSUP_URL=$url RPSUP_TOKEN=$secret expect_code 0 "$rpsup" cancel "$sweep"

# The name that a proxy passes on, over https and without, and no other.
with_token() { status_of --header "Authorization: Bearer $secret" "$@"; }
expect_equal "$(with_token --header 'Host: rpsup.example.org' "$url/v1/sweeps")" 200 "the other name"
expect_equal "$(with_token --header 'Host: rpsup.example.org' --header 'Origin: https://rpsup.example.org' -X POST "$url/v1/jobs")" 400 "its page over https"
expect_equal "$(with_token --header 'Host: rpsup.example.org' --header 'Origin: https://example.org' -X POST "$url/v1/jobs")" 403 "a page of its neighbour"
expect_equal "$(with_token --header 'Host: rpsup.example.org.evil.com' "$url/v1/sweeps")" 403 "a name that begins like it"

# Text of clients stays on its line of the log, without what a terminal would obey; the token is on none.
with_token --header 'Idempotency-Key: a' "$url/%0A2026-01-01T00%3A00%3A00%20info%20made%20up%1B%5B2J%9b" >/dev/null
expect_text log 'GET /\\x0a2026-01-01T00:00:00 info made up\\x1b\[2J\\x9b 404'
! LC_ALL=C grep -n '[^ -~]' log || fail "the log holds other than visible ASCII characters"
! grep -F "$secret" log || fail "the log holds the token"
expect_equal "$(grep -vcE '^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:.+-]+ [a-z]+ ' log)" 0 "lines of the log that do not begin with a time"

# Where a client is stands in the log as the connection has it, not as the client says.
expect_equal "$(status_of --header 'REMOTE_ADDR: 9.9.9.9' "$url/v1/jobs")" 401 "another address in the head"
expect_text log 'refused without the token: GET /v1/jobs of 127\.0\.0\.1$'
! grep -F 9.9.9.9 log || fail "a client can make up where it is"

# No path leads to a file.
for path in /../store.db /..%2fstore.db /%2e%2e/token //etc/passwd /docs/../../etc/passwd /docs/%2e%2e%2ftoken /store.db /token%00.html /index.html/../token; do
  expect_equal "$(with_token --path-as-is "$url$path")" 404 "$path"
done

# The program's list of arguments, which every user may read, does not hold it either.
! tr '\0' ' ' <"/proc/$service/cmdline" | grep -F "$secret" || fail "the arguments hold the token"
# The body of a request that is refused for want of a token is not taken for the next request.
exec 3<>"/dev/tcp/127.0.0.1/${url##*:}"
printf 'POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 60\r\n\r\nGET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Rest: 0123456\r\n\r\n' >&3
timeout 20 cat <&3 >unread || true
exec 3>&-
expect_equal "$(grep -c '^HTTP/1.1' unread)" 1 "answers to a request whose body was not read"
expect_text unread '^HTTP/1.1 401'

stop_service TERM
expect_equal "$code" 0 "exit code of the service"

# The token of the environment.
export RPSUP_TOKEN=$secret
start_service store.db
expect_equal "$(status_of "$url/v1/sweeps")" 401 "without the token of the environment"
expect_equal "$(status_of --header "Authorization: Bearer $secret" "$url/v1/sweeps")" 200 "with it"
stop_service TERM
echo "the token works"
