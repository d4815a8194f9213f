// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <sqlite3.h>

namespace jobs_tests {

/// Stands between SQLite and the disk, and knows what a loss of power would leave: what was synced is there,
/// and of what was written since then any part, in any order, torn between sectors. While it exists it is
/// SQLite's default; one at a time.
class LosingDisk {
 public:
  /// @param on_sync  called before each sync takes effect
  explicit LosingDisk(std::function<void()> on_sync);
  ~LosingDisk();
  LosingDisk(const LosingDisk&) = delete;
  LosingDisk& operator=(const LosingDisk&) = delete;

  /// Writes what would be left of a store to another place, without its index, which is made anew.
  void leave(const std::filesystem::path& store, const std::filesystem::path& to,
             std::mt19937_64& dice) const;

  // Operations of SQLite on files.
  void opened(const std::string& path);
  void written(const std::string& path, std::size_t offset, std::string bytes);
  void cut(const std::string& path, std::size_t size);
  void synced(const std::string& path);
  void deleted(const std::string& path);

 private:
  struct Change {
    std::size_t offset = 0;
    std::string bytes;   ///< written there
    bool cuts = false;   ///< or the file ends there
  };
  struct File {
    std::string safe;              ///< as it was when it was last synced
    std::vector<Change> changes;   ///< since then
  };

  static void apply(const Change& change, std::string& content);
  [[nodiscard]] std::string remains_of(const std::string& path, std::mt19937_64& dice) const;

  std::function<void()> on_sync_;
  std::map<std::string, File> files_;
};

}  // namespace jobs_tests
