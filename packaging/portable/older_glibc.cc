// SPDX-License-Identifier: Apache-2.0
// Functions that the C library has since 2.35 or 2.36 only, for programs that are to run with 2.34, on RHEL 9 say.
#include <dlfcn.h>
#include <link.h>
#include <sys/random.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace {

/// Loaded object that holds the address of an instruction. libgcc asks the C library for it as an exception passes.
struct Search {
  std::uintptr_t address;
  dl_find_object* found;
};

/// Looks whether an object is the one that is sought, and describes it if so.
/// @returns 1 if it is, which ends dl_iterate_phdr()
int look(dl_phdr_info* object, std::size_t /*size*/, void* data) {
  const auto& search = *static_cast<const Search*>(data);
  std::uintptr_t frames = 0;
  std::uintptr_t begin = UINTPTR_MAX;
  std::uintptr_t end = 0;
  bool is_inside = false;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    const std::uintptr_t from = object->dlpi_addr + segment.p_vaddr;
    const std::uintptr_t to = from + segment.p_memsz;
    if (segment.p_type == PT_GNU_EH_FRAME) frames = from;
    if (segment.p_type != PT_LOAD) continue;
    begin = std::min(begin, from);
    end = std::max(end, to);
    is_inside = is_inside || (search.address >= from && search.address < to);
  }
  if (!is_inside || frames == 0) return 0;
  *search.found = {};
  search.found->dlfo_map_start = reinterpret_cast<void*>(begin);
  search.found->dlfo_map_end = reinterpret_cast<void*>(end);
  search.found->dlfo_eh_frame = reinterpret_cast<void*>(frames);
  return 1;
}

}  // namespace

extern "C" {

// hypot() of 2.35 computes what the older one does, and differs from it where errno is set. The option --wrap=hypot of the linker sends callers here.
double hypot_of_2_2_5(double x, double y);
__asm__(".symver hypot_of_2_2_5, hypot@GLIBC_2.2.5");
double __wrap_hypot(double x, double y);
double __wrap_hypot(double x, double y) { return hypot_of_2_2_5(x, y); }

// For std::random_device.
std::uint32_t arc4random() noexcept {
  std::uint32_t bits = 0;
  if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) std::abort();
  return bits;
}

int _dl_find_object(void* address, dl_find_object* found) noexcept {
  Search search{reinterpret_cast<std::uintptr_t>(address), found};
  return dl_iterate_phdr(look, &search) == 1 ? 0 : -1;
}

}
