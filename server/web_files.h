#pragma once

#include <span>
#include <string_view>

namespace server {

/// One file of web/, as it was when the program was built.
struct WebFile {
  std::string_view path;  ///< "/index.html"
  std::string_view content_type;
  std::string_view content;
};

/// All of them; written by server/embed_files.cmake.
[[nodiscard]] std::span<const WebFile> web_files();

}  // namespace server
