// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <charconv>
#include <random>
#include <string>

namespace server {

/// Names requests: a random part for this run of the program, then a number.
class RequestIds {
 public:
  RequestIds() : prefix_(hex(std::random_device{}())) {}
  [[nodiscard]] std::string next() { return prefix_ + "-" + std::to_string(++count_); }

 private:
  static std::string hex(unsigned value) {
    char digits[16];
    return {digits, std::to_chars(digits, digits + sizeof digits, value, 16).ptr};
  }

  std::string prefix_;
  std::atomic<unsigned long> count_ = 0;
};

}  // namespace server
