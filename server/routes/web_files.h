// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace server {

/// One file of web/ or of an npm package, as it was when the program was built.
struct WebFile {
  std::string_view path;  ///< "/index.html"
  std::string_view content_type;
  std::string_view content;
};

/// The file of that path; null if there is none. Written by server/routes/embed_files.cmake.
[[nodiscard]] const WebFile* find_web_file(std::string_view path);

}  // namespace server
