// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace server::report {

/// Name of a parameter or metric without its unit: "peak slider acceleration" of
/// "peak_slider_acceleration_m_s2".
[[nodiscard]] std::string name_of(std::string_view key);

/// "Peak slider acceleration [m/s²]"
[[nodiscard]] std::string title_of(std::string_view key);

/// A number in five significant digits with the unit of its key: "15 rad/s"; other values as they are.
[[nodiscard]] std::string value_text(const nlohmann::json& value, std::string_view key);

/// Key of the time at which a peak was reached: "peak_slider_acceleration_time_s".
[[nodiscard]] std::string time_key_of(std::string_view peak);

}  // namespace server::report
