// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/npy_array.h"

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "jobs/measurements/check_measurement.h"

namespace jobs {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they stand in the file");

[[noreturn]] void refuse_array(const std::string& name, const std::string& why) {
  refuse_body("array " + quoted_text(name) + " " + why);
}

/// Header of a file: the dictionary, and the bytes that follow it.
struct NpyParts {
  std::string_view dictionary, data;
};

NpyParts split_npy(std::string_view file, const std::string& name) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  constexpr std::size_t kSizeOffset = 8;
  if (!file.starts_with(kMagic) || file.size() < kSizeOffset + 4)
    refuse_array(name, "is no file of NumPy's format");
  const auto major = static_cast<unsigned char>(file[kMagic.size()]);
  if (major < 1 || major > 3) refuse_array(name, "is of an unknown version of NumPy's format");
  const std::size_t size_bytes = major == 1 ? 2 : 4;
  std::uint32_t size = 0;
  std::memcpy(&size, file.data() + kSizeOffset, size_bytes);
  file.remove_prefix(kSizeOffset + size_bytes);
  if (size > file.size()) refuse_array(name, "ends too early");
  return {.dictionary = file.substr(0, size), .data = file.substr(size)};
}

/// Text of a value in the dictionary, up to the comma after it; a value in parentheses with what is in them.
/// Empty if the key is missing.
std::string_view value_of(std::string_view dictionary, std::string_view key) {
  const auto found = dictionary.find("'" + std::string(key) + "'");
  if (found == std::string_view::npos) return {};
  std::string_view rest = dictionary.substr(found + key.size() + 2);
  const auto begin = rest.find_first_not_of(" :");
  if (begin == std::string_view::npos) return {};
  rest.remove_prefix(begin);
  const auto end = rest.starts_with('(') ? rest.find(')') : rest.find_first_of(",}");
  if (end == std::string_view::npos) return {};
  return rest.substr(0, rest.starts_with('(') ? end + 1 : end);
}

/// Length of an array of one dimension, "(100,)"; empty for any other shape.
std::optional<std::size_t> find_length(std::string_view shape) {
  if (!shape.starts_with('(')) return std::nullopt;
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(shape.data() + 1, shape.data() + shape.size(), length);
  if (error != std::errc{}) return std::nullopt;
  const std::string_view after(end, static_cast<std::size_t>(shape.data() + shape.size() - end));
  return after == ",)" || after == ", )" ? std::optional(length) : std::nullopt;
}

/// @throws InvalidRequest if the array has another number of dimensions than one
std::size_t read_length(std::string_view dictionary, const std::string& name) {
  const std::string_view shape = value_of(dictionary, "shape");
  const auto length = find_length(shape);
  if (!length) refuse_array(name, "has the shape " + quoted_text(shape) + "; it must have one dimension");
  return *length;
}

template <typename Number>
std::vector<double> numbers_in(std::string_view data) {
  std::vector<double> numbers;
  numbers.reserve(data.size() / sizeof(Number));
  for (std::size_t offset = 0; offset < data.size(); offset += sizeof(Number)) {
    Number number = 0;
    std::memcpy(&number, data.data() + offset, sizeof number);
    numbers.push_back(static_cast<double>(number));
  }
  return numbers;
}

}  // namespace

std::vector<double> read_npy(std::string_view file, const std::string& name) {
  const NpyParts parts = split_npy(file, name);
  const std::string_view type = value_of(parts.dictionary, "descr");
  const bool is_double = type == "'<f8'";
  if (!is_double && type != "'<f4'")
    refuse_array(name, "has the type " + quoted_text(type) + "; float64 and float32 are read, little-endian");
  if (value_of(parts.dictionary, "fortran_order") != "False")
    refuse_array(name, "is in Fortran order; save it in C order");
  const std::size_t length = read_length(parts.dictionary, name);
  const std::size_t item = is_double ? sizeof(double) : sizeof(float);
  if (parts.data.size() % item != 0 || parts.data.size() / item != length)
    refuse_array(name, "has another length than its header says");
  return is_double ? numbers_in<double>(parts.data) : numbers_in<float>(parts.data);
}

}  // namespace jobs
