#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Visits the dashboard of a service of its own with Chromium; screenshots are left in FOLDER.
#   dashboard_test.sh RPSUP TESTS/WEB/VISIT.mjs FOLDER
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
[ -d "$(dirname "$2")/../node_modules" ] || fail "the npm packages of tests/ are missing: script/setup fetches them"
[ -x /usr/bin/chromium-headless-shell ] || fail "chromium-headless-shell is missing: script/setup installs it"

mkdir -p "$3"
start_service dashboard.db
node --test-reporter=spec "$2" "$url" "$3"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
