#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Leaves out one include at a time in a small tree and expects names_are_included.py to say what is missing.
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/names_are_included.py
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# plant [FILE INCLUDE]: the tree of correct includes, or with one of them left out
plant() {
  mkdir -p "$tree/engine/math" "$tree/jobs"
  cat >"$tree/engine/math/angle.h" <<'END'
namespace engine {
/// An angle [rad].
struct Angle {
  double rad = 0.0;
};
using Angles = Angle[3];
inline constexpr double kTurn = 6.283185307179586;  ///< of a full turn
template <typename T, int N = 3>
[[nodiscard]] T in_turns(const T& angle) {
  return angle / kTurn;
}
enum class Sense { kLeft, kRight };
}  // namespace engine
END
  cat >"$tree/engine/math/shape.h" <<'END'
#include "engine/math/angle.h"
END
  cat >"$tree/jobs/half.cc" <<'END'
#include "engine/math/shape.h"
namespace jobs {
double half() { return engine::kTurn / 2; }
}  // namespace jobs
END
  cat >"$tree/jobs/turn.cc" <<'END'
#include "engine/math/angle.h"
namespace jobs {
// A kTurn in a comment is no use of it, nor is "kTurn" in a text, and a name of its own needs no header.
const char* in_words() { return "kTurn"; }
END
  printf '%s\n}\n' "${1:-double in_turns(double angle) { return angle; }}" >>"$tree/jobs/turn.cc"
}

# leave_out FILE: without its includes
leave_out() { sed -i '/^#include/d' "$tree/$1"; }

plant
python3 "$check" "$tree" >/dev/null || { echo "correct includes are refused"; exit 1; }
leave_out jobs/turn.cc
python3 "$check" "$tree" >/dev/null || { echo "an include is asked for that nothing needs"; exit 1; }

expect_found() {
  local said
  said=$(python3 "$check" "$tree") && { echo "not found: $1"; exit 1; }
  [ "$said" = "$1" ] || { printf 'expected: %s\nsaid: %s\n' "$1" "$said"; exit 1; }
}
for use in 'Angle:engine::Angle a;' 'Angles:void turn(const engine::Angles& a);' 'kTurn:double whole = engine::kTurn;' \
  'in_turns:double turns = engine::in_turns(1.0);' 'Sense:auto side = engine::Sense::kLeft;' \
  'in_turns:} namespace engine { double twice(double y) { return y * in_turns(2.0); }' \
  'Angle:} namespace engine { struct Pair : public Held<const Angle> {};'; do
  plant "${use#*:}"
  python3 "$check" "$tree" >/dev/null || { echo "refused though included: $use"; exit 1; }
  leave_out jobs/turn.cc
  expect_found "jobs/turn.cc uses ${use%%:*} and does not include engine/math/angle.h"
done
plant
leave_out engine/math/shape.h
expect_found "jobs/half.cc uses kTurn and does not include engine/math/angle.h"
echo "all missing includes are found"
