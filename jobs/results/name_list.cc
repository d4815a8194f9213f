// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/name_list.h"

#include <algorithm>

#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

/// Length of the next name in the text.
std::size_t name_size(std::string_view text, std::span<const std::string> known) {
  std::size_t size = std::min(text.find(','), text.size());
  for (const std::string& name : known) {
    const bool stands_here =
        text.starts_with(name) && (text.size() == name.size() || text[name.size()] == ',');
    if (stands_here) size = std::max(size, name.size());
  }
  return size;
}

}  // namespace

std::vector<std::string> split_names(std::string_view text, std::span<const std::string> known) {
  std::vector<std::string> names;
  for (;;) {
    const std::string_view sign = text.starts_with('-') ? text.substr(0, 1) : "";
    const std::size_t size = sign.size() + name_size(text.substr(sign.size()), known);
    names.emplace_back(text.substr(0, size));
    if (size == text.size()) return names;
    text.remove_prefix(size + 1);
  }
}

std::vector<std::size_t> find_names(const std::vector<std::string>& names, std::span<const std::string> known,
                                    std::string_view listed, const std::string& pointer,
                                    std::vector<Fault>& faults) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto index = static_cast<std::size_t>(std::ranges::find(known, names[i]) - known.begin());
    const std::string where = pointer + "/" + std::to_string(i);
    if (index == known.size()) {
      faults.push_back({where, "\"" + names[i] + "\": " + describe_unknown_key(names[i], views, listed)});
    } else if (std::ranges::find(indices, index) != indices.end()) {
      faults.push_back({where, "\"" + names[i] + "\" is in the list already"});
    } else {
      indices.push_back(index);
    }
  }
  return indices;
}

}  // namespace jobs
