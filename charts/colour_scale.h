// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace charts {

/// Colour of a part of a continuous scale, "#rrggbb": dark blue at 0, yellow at 1 (viridis). Lightness grows
/// along it, so that prints without colours can be read too.
/// @param part  in [0, 1]; beyond it the colour of the nearer end
[[nodiscard]] std::string colour_at(double part);

/// Colour of text on that colour.
[[nodiscard]] const char* text_colour_on(double part);

}  // namespace charts
