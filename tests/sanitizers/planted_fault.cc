// SPDX-License-Identifier: Apache-2.0
// Leaks memory, or overflows an integer: planted_fault leak|overflow.

#include <limits>
#include <string_view>

namespace {

// Volatile, so that the compiler does not take the fault away.
int* volatile leaked = nullptr;
volatile int largest = std::numeric_limits<int>::max();

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  if (std::string_view(argv[1]) == "leak") {
    leaked = new int[16];
    leaked = nullptr;
    return 0;
  }
  return largest + 1 == 0 ? 1 : 0;
}
