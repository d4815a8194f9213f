#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup completion: what the shells offer. zsh and fish are skipped, with a word, where they are not installed.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
skipped=

expect_code 2 "$rpsup" completion tcsh
expect_text err 'bash'
touch run.json other.txt

# bash: the function is called as bash would call it.
"$rpsup" completion bash >rpsup.bash
offer() {
  bash --norc -euo pipefail -c 'source rpsup.bash; COMP_LINE="$*"; COMP_POINT=${#COMP_LINE}; COMPREPLY=(); _rpsup; printf "%s " "${COMPREPLY[@]}"' _ "$@"
}
expect_equal "$(offer rpsup si)" 'simulate ' "commands"
expect_equal "$(offer rpsup --v)" '--version ' "options of the program"
expect_equal "$(offer rpsup simulate --tr)" '--trajectory ' "options of a command"
expect_equal "$(offer rpsup --config x.ini serve --po)" '--port ' "options of a command after one of the program"
expect_equal "$(offer rpsup serve --log-level w)" 'warning ' "words of an option"
expect_equal "$(offer rpsup simulate --trajectory run)" 'run.json ' "files for an option"
expect_equal "$(offer rpsup submit ru)" 'run.json ' "files for an argument"
expect_equal "$(offer rpsup completion z)" 'zsh ' "words of an argument"
expect_equal "$(offer rpsup serve --port '')" ' ' "nothing for a number"
expect_equal "$(offer rpsup --url http://127.0.0.1:1 stat)" 'status ' "commands after an option with a URL"

# Ids of what runs, of the kinds that the command takes; nothing, and nothing said, without a service.
PATH=$(dirname "$rpsup"):$PATH
start_service store.db
echo '{"parameters": {"duration_s": 0.05, "run_up_s": 0.02}, "sweep": {"clearance_mm": [0.1]}}' >sweep.json
sweep=$(submit sweep.json)
wait_for_end "$sweep"
job=$(get "$url/v1/sweeps/$sweep/results" | jq -r '.[0].job_id')
expect_equal "$(RPSUP_URL=$url offer rpsup status '')" "$sweep $job " "ids for status"
expect_equal "$(offer rpsup --url "$url" results '')" "$sweep " "ids for results"
expect_equal "$(offer rpsup trajectory --url="$url" job_)" "$job " "ids for trajectory"
expect_equal "$(offer rpsup cancel --url "$url" "$job" swp_)" "$sweep " "ids for the second argument"
expect_equal "$(offer rpsup --url "$url" extend "$sweep" ru)" 'run.json ' "files after the id"
expect_equal "$(RPSUP_URL=http://127.0.0.1:1 offer rpsup status '' 2>&1)" ' ' "nothing without a service"

if command -v fish >/dev/null; then
  "$rpsup" completion fish >rpsup.fish
  # From version 4 on fish offers words that hold what was typed, too.
  offer_fish() { HOME=$folder fish --no-config --command "source rpsup.fish; complete --do-complete '$1'" | cut -f1 | grep -e "^${1##* }" | tr '\n' ' '; }
  expect_equal "$(offer_fish 'rpsup simu')" 'simulate ' "commands in fish"
  expect_equal "$(offer_fish 'rpsup serve --log-level w')" 'warning ' "words in fish"
  expect_equal "$(offer_fish 'rpsup serve --por')" '--port ' "options in fish"
  expect_equal "$(offer_fish 'rpsup submit run')" 'run.json ' "files in fish"
  expect_equal "$(RPSUP_URL=$url offer_fish 'rpsup results sw')" "$sweep " "ids in fish"
else
  skipped="$skipped fish"
fi

if command -v zsh >/dev/null; then
  "$rpsup" completion zsh >_rpsup
  zsh -n _rpsup || fail "zsh does not read it"
  # Stands in for the parts of the completion system that look at a terminal, and says what they were given.
  cat >ask.zsh <<'ZSH'
compdef() { }
_arguments() { if [[ $1 == -C ]]; then state=$wanted; line=($command); else print -rl -- "$@"; fi }
_describe() { print -rl -- "${(@P)4}" }
source ./_rpsup
_rpsup
ZSH
  wanted=command command= zsh -f ask.zsh >commands.txt
  expect_text commands.txt '^simulate:Compute one job'
  wanted=argument command=serve zsh -f ask.zsh >options.txt
  expect_text options.txt '^--log-level\[.*\]:TEXT:\(debug info warning error\)$'
  expect_text options.txt '^--db\[.*\]:FILE:_files$'
  wanted=argument command=results zsh -f ask.zsh >options.txt
  expect_text options.txt '^:id:\{compadd -- .*rpsup status --ids results 2>/dev/null.*\}$'
  # And the completion system itself takes it.
  zsh -f -c 'autoload -Uz compinit && compinit -D -u && source ./_rpsup && [[ $_comps[rpsup] == _rpsup ]]' || fail "zsh does not take it"
else
  skipped="$skipped zsh"
fi

[ -z "$skipped" ] || { echo "skipped, because not installed:$skipped"; exit 77; }
echo "completion works"
