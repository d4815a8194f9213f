// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace jobs {

/// Entry of a ZIP archive, as its directory describes it.
struct ZipEntry {
  std::string name;
  bool deflated = false;  ///< else stored
  std::uint32_t crc = 0;
  std::size_t packed_size = 0, size = 0;
  std::string_view packed;  ///< part of the archive
};

/// Entries of a ZIP archive (APPNOTE 6.3.9), stored or deflated. Sizes are those of the directory, and are
/// checked against the archive; nothing is unpacked.
/// @param most_bytes  size of all entries together, unpacked
/// @throws InvalidRequest for a text that is no such archive, several disks, ZIP64, encryption, or larger
///     entries. The archive must outlive the entries
[[nodiscard]] std::vector<ZipEntry> read_zip_directory(std::string_view archive, std::size_t most_bytes);

/// Bytes of an entry. Takes no more memory than its size. @throws InvalidRequest if they do not agree with
/// size and checksum
[[nodiscard]] std::string unpack(const ZipEntry& entry);

}  // namespace jobs
