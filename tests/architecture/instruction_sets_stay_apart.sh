#!/usr/bin/env bash
# Fails if an object compiled for more than baseline x86-64 offers code that the linker may share with the rest of the program: inline
# functions of the standard library or of Eigen, which would then fail on a machine without those instructions.
#   instruction_sets_stay_apart.sh NAMESPACE OBJECT
set -euo pipefail
namespace=$1 object=$2

offered=$(nm --demangle --defined-only "$object" | grep -E '^[0-9a-f]+ [TWu] ' || true)
if ! grep -q "$namespace::make_compiled_equations" <<<"$offered"; then
  echo "$object: make_compiled_equations is not in it; is this the object meant?"
  exit 1
fi
if foreign=$(grep -v "$namespace::" <<<"$offered"); then
  echo "$object offers code outside of $namespace:"
  echo "$foreign"
  exit 1
fi
echo "$object keeps its code in $namespace"
