#!/usr/bin/env bash
# Fails if objects compiled for more than baseline x86-64 offer code that the linker may share with the rest of the program: inline
# functions of the standard library or of Eigen, which would then fail on a machine without those instructions.
#   instruction_sets_stay_apart.sh NAMESPACE OBJECT...
set -euo pipefail
namespace=$1
shift

offered=$(nm --demangle --defined-only "$@" | grep -E '^[0-9a-f]+ [TWu] ' || true)
if ! grep -q "$namespace::make_compiled_equations" <<<"$offered"; then
  echo "$*: make_compiled_equations is not in them; are these the objects meant?"
  exit 1
fi
if foreign=$(grep -v "$namespace::" <<<"$offered"); then
  echo "$* offer code outside of $namespace:"
  echo "$foreign"
  exit 1
fi
echo "$* keep their code in $namespace"
