// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/size_text.h"

#include <ios>
#include <sstream>
#include <string>

namespace jobs {

std::string size_text(double bytes) {
  constexpr double kMegabyte = 1e6;
  constexpr double kFewMegabytes = 9.95;  // 9.95 has three digits once it is rounded
  const double megabytes = bytes / kMegabyte;
  std::ostringstream text;
  if (megabytes < kFewMegabytes) {
    text.precision(2);
  } else {
    text << std::fixed;
    text.precision(0);
  }
  text << megabytes << " MB";
  return text.str();
}

}  // namespace jobs
