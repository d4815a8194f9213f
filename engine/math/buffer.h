// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// An array of a length that is known at construction. (std::vector's functions would be shared between
/// instruction sets by the linker.)
template <typename T>
class Buffer {
 public:
  /// @param capacity  entries that code which takes several at once may touch
  explicit Buffer(std::size_t size, std::size_t capacity = 0)
      : data_(new T[size < capacity ? capacity : size]()), size_(size) {}
  ~Buffer() { delete[] data_; }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  [[nodiscard]] RPSUP_INLINE T& operator[](std::size_t i) { return data_[i]; }
  [[nodiscard]] RPSUP_INLINE const T& operator[](std::size_t i) const { return data_[i]; }
  [[nodiscard]] RPSUP_INLINE T* data() { return data_; }
  [[nodiscard]] RPSUP_INLINE const T* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] RPSUP_INLINE T* begin() { return data_; }
  [[nodiscard]] RPSUP_INLINE T* end() { return data_ + size_; }
  RPSUP_INLINE void fill(const T& value) {
    for (T& entry : *this) entry = value;
  }

 private:
  T* data_;
  std::size_t size_;
};

/// The same of a length that is known when the program is compiled, its entries not set: where it lives on
/// the stack they may stay in registers.
template <typename T, std::size_t length, std::size_t capacity = length>
class FixedBuffer {
 public:
  RPSUP_INLINE explicit FixedBuffer(std::size_t /*size*/, std::size_t /*capacity*/ = 0) {}

  [[nodiscard]] RPSUP_INLINE T& operator[](std::size_t i) { return data_.entries[i]; }
  [[nodiscard]] RPSUP_INLINE const T& operator[](std::size_t i) const { return data_.entries[i]; }
  [[nodiscard]] RPSUP_INLINE T* data() { return data_.entries; }
  [[nodiscard]] RPSUP_INLINE const T* data() const { return data_.entries; }
  [[nodiscard]] static constexpr std::size_t size() { return length; }
  [[nodiscard]] RPSUP_INLINE T* begin() { return data(); }
  [[nodiscard]] RPSUP_INLINE T* end() { return data() + length; }
  RPSUP_INLINE void fill(const T& value) {
    for (T& entry : *this) entry = value;
  }

 private:
  union Storage {
    RPSUP_INLINE Storage() {}
    T entries[capacity > 0 ? capacity : 1];
  };
  Storage data_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
