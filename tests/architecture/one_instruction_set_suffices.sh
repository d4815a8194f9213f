#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails if the program needs more of the equations compiled for one instruction set than what makes them: a program that is built
# for this machine alone (script/build --own) has only one set, and would not link.
#   one_instruction_set_suffices.sh OBJECT...      the engine's objects without those of the equations
set -euo pipefail

# symbols KIND OBJECT...: those in the namespaces of the equations
symbols() {
  nm --demangle "$@" | sed -nE 's/^[0-9a-f ]*[TWUu] (.*engine::(baseline|avx2|avx512)::.*)$/\1/p' | sort -u
}

needed=$(comm -23 <(symbols --undefined-only "$@") <(symbols --defined-only "$@"))
makers=$(grep -c '::make_compiled_kernel(' <<<"$needed" || true)
if [ "$makers" -eq 0 ]; then
  echo "$*: make_compiled_kernel is not asked for; are these the objects meant?"
  exit 1
fi
if others=$(grep -v '::make_compiled_kernel(' <<<"$needed"); then
  echo "the engine needs more of the equations of an instruction set than what makes them:"
  echo "$others"
  exit 1
fi
echo "the engine asks for the equations of $makers instruction sets, and for nothing else of theirs"
