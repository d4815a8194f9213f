// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/machine.h"

#include <array>
#include <fstream>

#include <unistd.h>

namespace jobs {
namespace {

std::string ask_host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string ask_cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

const std::string& host_name() {
  static const std::string name = ask_host_name();
  return name;
}

const std::string& cpu_name() {
  static const std::string name = ask_cpu_name();
  return name;
}

}  // namespace jobs
