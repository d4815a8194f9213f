#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup man: a page without faults that names every command and every option that --help names, with what is said of them.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

expect_code 0 "$rpsup" man
mv out rpsup.1
mandoc -T lint -W error rpsup.1 || fail "the page has faults"
# As plain text in one line: where lines break is the terminal's business.
mandoc -T ascii -O width=1000 rpsup.1 | sed 's/.\x08//g' >page

# texts_of COMMAND...: the options of a --help and the text of each, a line each
texts_of() {
  COLUMNS=1000 "$rpsup" "$@" --help | awk '/^(Options|Positionals):$/ { inside = 1; next } /^[^ ]/ || /^$/ { inside = 0 } inside'
}

commands=$("$rpsup" --help | awk '/^Subcommands:$/ { inside = 1; next } /^$/ { inside = 0 } inside && /^  [a-z]/ { print $1 }')
expect_equal "$(wc -w <<<"$commands" | tr -d ' ')" 27 "commands"
options=0
for command in $commands; do
  grep -qE "^ *rpsup $command( |$)" page || fail "the page has no section of $command"
  [ "$command" != validate ] || continue  # its options are those of rpsup-validate
  section=$(awk -v command="$command" '/^ *rpsup [a-z]/ { inside = $2 == command } /^[A-Z]/ { inside = 0 } inside' page)
  for option in $(texts_of "$command" | grep -oE '^  (-h,)?--[a-z-]+' | grep -v -e --help || true); do
    grep -qE -- "^ *$option( |\$)" <<<"$section" || fail "the page does not have $option of $command"
    options=$((options + 1))
  done
  shown=$(grep -oE '^ +--[a-z-]+' <<<"$section" | sort || true)
  expect_equal "$(wc -w <<<"$shown")" "$(texts_of "$command" | grep -cE '^  --[a-z-]+' || true)" "options of $command"
done
[ "$options" -gt 20 ] || fail "only $options options were compared"
expect_text page 'Environment: RPSUP_TRAJECTORY'
expect_text page 'Default: http://127.0.0.1:8080'
expect_text page 'rod_stroke_mm  *15 mm, in '
expect_text page 'Exit codes: 0 done, 1 a job'
echo "the manual page has $options options"
