#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs three small tests, one of which skips, and expects unlisted_skips.py to fail unless the skip is listed for that preset.
set -euo pipefail
check=$(realpath "$(dirname "${BASH_SOURCE[0]}")")/unlisted_skips.py
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >CTestTestfile.cmake <<'END'
add_test(passes true)
add_test(skips sh -c "echo no cluster here; exit 77")
set_tests_properties(skips PROPERTIES SKIP_RETURN_CODE 77)
add_test(is_off false)
set_tests_properties(is_off PROPERTIES DISABLED TRUE)
END
ctest --output-junit "$folder/junit.xml" >/dev/null

# expect CODE TEXT: the check's exit code and a text that it prints, with the list on standard input
expect() {
  cat >list
  local code=0
  python3 "$check" junit.xml list release ${prefix:+"$prefix"} >said 2>&1 || code=$?
  [ "$code" -eq "$1" ] && grep -qF "$2" said || { cat said; echo "exit code $code instead of $1, or \"$2\" not said"; exit 1; }
}
expect 1 'skips: no cluster here' <<<''
expect 1 'is_off' <<<'any skips for a test'
expect 0 '0 of them without' <<<$'# reasons\nany skips for a test\nrelease is_* for another'
expect 1 'skips: no cluster here' <<<$'asan skips not this preset\nany is_off for a test'
expect 1 'list:1' <<<'any skips'
echo '<testsuite/>' >junit.xml
expect 1 'holds no test' <<<''
prefix=engine.
cat >junit.xml <<'END'
<testsuites><testsuite>
  <testcase name="Runs" classname="Suite" status="run" result="completed"/>
  <testcase name="Skips" classname="Suite" status="run" result="skipped"><skipped message="a.cc:1&#x0A;no room"/></testcase>
</testsuite></testsuites>
END
expect 1 'engine.Suite.Skips: no room' <<<''
expect 0 '1 of 2 tests were skipped, 0 of them' <<<'any engine.Suite.Skips for a test'
echo "unlisted skips are found"
