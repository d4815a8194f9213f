#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# No request, however strange, is answered with a 5xx or beside the OpenAPI document, or ends the service.
#   generated_requests_test.sh RPSUP TESTS/OPENAPI COUNT [SEED]; without a seed another one each time
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
[ -d "$2/../node_modules" ] || fail "the npm packages of tests/ are missing: script/setup fetches them"

start_service generated.db --threads 1
node "$2/generated_requests.mjs" "$url" "$3" "${4:-$RANDOM$RANDOM}"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
! grep -E ' (error|critical) ' log || fail "the log has errors"
