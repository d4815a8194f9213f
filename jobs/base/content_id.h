// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace jobs {

/// The one text of a parameter set: keys sorted, no blanks, shortest numbers. @param completed all
/// parameters, canonical
[[nodiscard]] std::string canonical_text(const nlohmann::json& completed);

/// Content of a job, the name of its result: SHA-256 of its parameters and of the engine, 64 hexadecimal
/// digits.
[[nodiscard]] std::string content_id(std::string_view canonical_parameters, std::string_view engine_version);

inline constexpr std::size_t kSha256Digits = 64;  ///< hexadecimal ones

/// SHA-256 of a text in hex. @param rest  what follows it, if the text comes in two parts
[[nodiscard]] std::string sha256_hex(std::string_view text, std::string_view rest = {});

}  // namespace jobs
