#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails if objects compiled for more than baseline x86-64 offer code that the linker may share with the rest of the program: inline
# functions of the standard library or of Eigen, which would then fail on a machine without those instructions. And if they fuse products with sums,
# which gives other bytes than sets that do not.
#   instruction_sets_stay_apart.sh NAMESPACE OBJECT...
set -euo pipefail
namespace=$1
shift

offered=$(nm --demangle --defined-only "$@" | grep -E '^[0-9a-f]+ [TWu] ' || true)
if ! grep -q "$namespace::make_compiled_kernel" <<<"$offered"; then
  echo "$*: make_compiled_kernel is not in them; are these the objects meant?"
  exit 1
fi
if foreign=$(grep -v "$namespace::" <<<"$offered"); then
  echo "$* offer code outside of $namespace:"
  echo "$foreign"
  exit 1
fi
listing=$(objdump --disassemble --no-show-raw-insn "$@")
grep -q vmulpd <<<"$listing" || { echo "$*: no products are in them; are these the objects meant?"; exit 1; }
fused=$(grep -E '\svfn?m(add|sub)' <<<"$listing" || true)
if [ -n "$fused" ]; then
  echo "$* fuse products with sums:"
  head -n 5 <<<"$fused"
  exit 1
fi
echo "$* keep their code in $namespace, and products apart from sums"
