// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace server {

/// One file of web/ or of an npm package, as it was when the program was built.
struct WebFile {
  /// Meaning of the path: the file that each build has there, or, by its hash, this very content.
  enum class Path { kNamed, kHashed };

  std::string_view path;  ///< "/index.html", "/lib/three.0123456789abcdef.js"
  std::string_view content_type;
  std::string_view gzip;  ///< content, compressed
  std::size_t size;       ///< of the content, [bytes]
  std::string_view etag;       ///< of the content, with its quotes
  std::string_view gzip_etag;  ///< of the compressed content
  Path kind;
};

/// The file of that path; null if there is none. Written by server/routes/embed_files.cmake.
[[nodiscard]] const WebFile* find_web_file(std::string_view path);

}  // namespace server
