// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/model/rpsup.h"
#include "tests/bench/codes/plain_linkage.h"

namespace bench {

/// At rest in its assembled position.
[[nodiscard]] PlainLinkage make_plain_linkage(const engine::RpsupParameters& parameters);

/// The same of any mechanism whose loops spherical joints close.
/// @param measured  coordinate
[[nodiscard]] PlainLinkage make_plain_linkage(const engine::Mechanism& mechanism,
                                              engine::FrameIndex measured);

/// At rest with every ring of the journal touching.
[[nodiscard]] PlainLinkage make_plain_linkage_in_contact(const engine::RpsupParameters& parameters);

}  // namespace bench
