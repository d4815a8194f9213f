// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <string>

namespace server::commands {

/// Fault of a file that holds a secret, as the end of a sentence; empty if the file is for its owner alone.
/// The owner is this user, or the administrator, who gives a file by group or access list and never to write.
[[nodiscard]] std::string describe_secret_fault(const struct stat& status);

/// The same of a file that is no secret, but decides where secrets go: others can change it.
[[nodiscard]] std::string describe_owner_fault(const struct stat& status);

/// Fault of the name of a token file, for the parser of options; empty if there is none.
[[nodiscard]] std::string describe_file_name_fault(const std::string& name);

/// The token: the only line of a file, else `otherwise`. An empty name is no file left out: a token that was
/// meant and is missing would open the service to all.
/// @param file       name that an option gave; empty: there is none, unless RPSUP_TOKEN_FILE is set and empty
/// @param otherwise  token without a file; null: there is none
/// @returns empty if there is none
/// @throws BadInput for a file that is no regular one, cannot be read or is open to others, and for a text
///     that is no good token
[[nodiscard]] std::string find_token(const std::string& file, const char* otherwise);

/// The token that clients of the service have to carry: of the file, else of the variable RPSUP_TOKEN.
/// Never an option with the token itself, which every user of the machine could read in the list of
/// processes.
[[nodiscard]] std::string find_service_token(const std::string& file);

}  // namespace server::commands
