// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <new>
#include <string_view>

#include <unistd.h>

#include "server/commands/command.h"
#include "server/commands/command_line.h"

namespace {

std::terminate_handler end_abnormally = nullptr;

/// Exceptions of initialisers, of shared libraries and of the program, reach no handler in main.
void explain_want_of_memory() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view kMessage =
        "rpsup: there is no memory left; ulimit -v limits the address space\n";
    static_cast<void>(!::write(STDERR_FILENO, kMessage.data(), kMessage.size()));
    ::_exit(server::commands::kMachineFailed);
  } catch (...) {
    end_abnormally();
  }
  end_abnormally();
}

void watch_initialisers(int, char**, char**) { end_abnormally = std::set_terminate(explain_want_of_memory); }

/// Functions of this section run before the initialisers of shared libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_initialisers)(int, char**,
                                                                                char**) = watch_initialisers;

}  // namespace

int main(int argc, char** argv) { return server::commands::run_command_line(argc, argv); }
