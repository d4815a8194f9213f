#pragma once

#include <cstddef>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// An array of a length that is known at construction. (std::vector's functions would be shared between instruction sets by the linker.)
template <typename T>
class Buffer {
 public:
  /// @param room  for more than size, which code that takes several at once may touch
  explicit Buffer(std::size_t size, std::size_t room = 0) : data_(new T[size < room ? room : size]()), size_(size) {}
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

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
