#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every answer that the tests of the server have met is one that the OpenAPI document allows.   openapi_test.sh RPSUP FOLDER TESTS/OPENAPI
# The whole runs of server_tests leave answers in FOLDER; ctest starts them before this test.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
[ -d "$3/../node_modules" ] || fail "the npm packages of tests/ are missing: script/setup fetches them"

start_service openapi.db
get "$url/v1/openapi.json" >openapi.json
cat "$2"/server_tests.*.ndjson >exchanges.ndjson
rm "$2"/server_tests.*.ndjson  # those of the next run are not to stand below them
node "$3/check_exchanges.mjs" openapi.json exchanges.ndjson
node "$3/query_keys.mjs" "$url"

# Recorded answers that contradict the document are found.
jq -cn 'first(inputs | select(.status == 201) | .status = 202)' exchanges.ndjson >wrong
jq -cn 'first(inputs | select(.method == "GET" and .target == "/healthz" and .status == 200) | .body = "{\"status\": 1}")' exchanges.ndjson >>wrong
jq -cn 'first(inputs | select(.method == "GET" and .target == "/healthz" and .status == 200) | .headers["x-more"] = "1")' exchanges.ndjson >>wrong
expect_equal "$(wc -l <wrong)" 3 "answers to spoil"
cat exchanges.ndjson wrong >spoilt
expect_code 1 node "$3/check_exchanges.mjs" openapi.json spoilt
expect_text out '202 is none of the responses of post /v1/'
expect_text out '/status must be string'
expect_text out 'the header x-more is not in the document'
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
