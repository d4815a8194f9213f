// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace jobs::cluster {

/// A file of the shared folder that could not be written or read.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a file that is there as a whole or not at all, whatever fails, and that other machines see only
/// when it is complete: under another name, flushed, renamed, and its folder flushed.
/// @throws FileError
void write_durably(const std::filesystem::path& file, std::string_view bytes);

/// @throws FileError
[[nodiscard]] std::string read_whole(const std::filesystem::path& file);

/// Bytes between a magic word and their SHA-256, so that what is damaged or cut off is known.
[[nodiscard]] std::string seal(std::string_view magic, std::string_view bytes);
/// @throws FileError if these are not sealed bytes of that kind
[[nodiscard]] std::string_view unseal(std::string_view magic, std::string_view sealed);

}  // namespace jobs::cluster
