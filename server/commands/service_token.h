// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace server::commands {

/// The token that clients of the service have to carry: the only line of a file, else the variable
/// RPSUP_TOKEN. Never an option with the token itself, which every user of the machine could read in the list
/// of processes.
/// @param file  empty: none
/// @returns empty if there is none
/// @throws BadInput for a file that cannot be read or that others may read, and for what is no good token
[[nodiscard]] std::string find_service_token(const std::string& file);

}  // namespace server::commands
