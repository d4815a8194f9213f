// SPDX-License-Identifier: Apache-2.0
#include "server/commands/command_line.h"

int main(int argc, char** argv) { return server::commands::run_command_line(argc, argv); }
