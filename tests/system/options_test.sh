#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Options from the command line, the environment and a file: each of them works, in this order of precedence.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

echo '{"duration_s": 0.05}' >job.json
rows() { wc -l <"$1" | tr -d ' '; }

RPSUP_TRAJECTORY=from_environment.csv expect_code 0 "$rpsup" simulate job.json
expect_equal "$(rows from_environment.csv)" 52 "lines of the trajectory named in the environment"

printf '[simulate]\ntrajectory=from_file.csv\nchannels=contact_force_n\n' >options.ini
for place in before after environment; do
  rm -f from_file.csv
  case $place in
    before) expect_code 0 "$rpsup" --config options.ini simulate job.json ;;
    after) expect_code 0 "$rpsup" simulate job.json --config options.ini ;;
    environment) RPSUP_CONFIG=options.ini expect_code 0 "$rpsup" simulate job.json ;;
  esac
  expect_equal "$(head -n 1 from_file.csv | tr -d '\r')" t_s,contact_force_n "channels named in the file ($place)"
done

expect_code 0 "$rpsup" --config options.ini simulate job.json --trajectory from_line.csv
expect_equal "$(rows from_line.csv)" 52 "lines of the trajectory named on the command line"

# As Windows' editors save it.
(printf '\xef\xbb\xbf' && cat options.ini) >marked.ini
expect_code 0 "$rpsup" --config marked.ini simulate job.json --trajectory marked.csv
cmp marked.csv from_line.csv

# Names under which SQLite would keep no file.
for name in :memory: file:a.db 'file:a.db?mode=memory' ''; do
  expect_code 2 "$rpsup" serve --db "$name" --port 0
  expect_text err 'db'
  expect_code 2 "$rpsup" sweep sweep.json --db "$name"
  expect_code 2 "$rpsup" export --db "$name" copy.db
done
RPSUP_DB=:memory: expect_code 2 "$rpsup" serve --port 0
expect_text err ':memory: would keep nothing'
[ -z "$(find . -name ':memory:*' -o -name 'file:*')" ] || fail "a refused name has made a file"

printf '[simulate]\ntrajektory=t.csv\n' >wrong.ini
expect_code 2 "$rpsup" --config wrong.ini simulate job.json
expect_text err trajektory
expect_code 2 "$rpsup" --config missing.ini simulate job.json
RPSUP_CONFIG=missing.ini expect_code 2 "$rpsup" simulate job.json
expect_code 2 "$rpsup" --config options.ini validate
expect_text err '^rpsup: validate must be the first word'
RPSUP_PORT=many expect_code 2 "$rpsup" serve --db a.db
expect_text err port
expect_code 2 "$rpsup" serve --db a.db --threads 0
expect_code 2 "$rpsup" serve --db a.db --host 0.0.0.0
expect_text err 'without a token'
expect_code 2 "$rpsup" serve
expect_code 2 "$rpsup" serve --db a.db --executor slurm
expect_text err 'needs --slurm-folder'
expect_code 2 "$rpsup" serve --db a.db --slurm-folder nowhere
expect_text err 'must be an absolute path'
expect_code 2 "$rpsup" check-cluster --slurm-folder "$folder/nowhere"
expect_text err 'there is no such folder'
expect_code 2 "$rpsup" run-task . 0
expect_text err SLURM_ARRAY_TASK_ID
SLURM_ARRAY_TASK_ID=many expect_code 2 "$rpsup" run-task . 0
expect_code 3 "$rpsup" run-task . 0 --index 0
expect_text err g0.list
# Every command reports output that does not arrive.
for words in --help 'serve --help' --version 'completion bash' man; do
  code=0
  # shellcheck disable=SC2086  # the words are arguments
  "$rpsup" $words >/dev/full 2>err || code=$?
  expect_equal "$code" 3 "exit code of $words on a full device"
  expect_text err 'cannot write to standard output'
done
[ ! -e a.db ] || fail "a refused command has made a store"
echo "options work"
