#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The JavaScript of the pages and of the tests is free of what ESLint finds, and what is planted is found.   javascript_lint.sh ROOT
set -euo pipefail
cd "$1"
[ -d tests/node_modules ] || { echo "the npm packages of tests/ are missing: script/setup fetches them"; exit 1; }

lint() { node tests/node_modules/eslint/bin/eslint.js --config tests/eslint.config.mjs --max-warnings 0 "$@"; }

lint web tests

planted=$(lint --stdin --stdin-filename web/planted.js --format json <<'END' || true
import { h } from "/core/dom.js";
let found = document.title;
export function show(job) {
  if (found == 1) return missing(job);
  for (const job of []) console.log(job);
}
END
)
for rule in eqeqeq no-unused-vars no-shadow no-undef prefer-const consistent-return; do
  grep -q "\"ruleId\":\"$rule\"" <<<"$planted" || { echo "not found: $rule in $planted"; exit 1; }
done
echo "all planted faults are found"
