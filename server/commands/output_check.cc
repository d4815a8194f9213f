// SPDX-License-Identifier: Apache-2.0
#include "server/commands/output_check.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "server/commands/command.h"

namespace server::commands {

namespace {

constexpr std::array<std::string_view, 4> kOutputs{"--trajectory", "--plot", "--results", "--output"};
constexpr std::array<std::string_view, 5> kInputs{"file", "files", "--db", "--token-file", "--config"};

/// File that an option names, or that a descriptor of the process is.
struct NamedFile {
  std::string name;                       ///< as the user gave it, with its option
  std::filesystem::path path{};           ///< without symbolic links; empty: of a descriptor
  std::optional<struct stat> status{};    ///< empty: there is no such file yet
};

/// Path at the end of symbolic links, also of one that leads to no file.
std::filesystem::path resolved(std::filesystem::path path) {
  std::error_code error;
  constexpr int kMostLinks = 40;  // the kernel's limit
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
}

NamedFile named(const std::string& option, const std::string& path) {
  NamedFile file{.name = option + " " + path, .path = resolved(path)};
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) file.status = status;
  return file;
}

/// Adds a descriptor that is a regular file: a terminal or a pipe may be both input and output.
void add_descriptor(int descriptor, const char* name, std::vector<NamedFile>& to) {
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
    to.push_back({.name = name, .status = status});
}

bool is_same(const NamedFile& a, const NamedFile& b) {
  if (a.status && b.status)
    return !S_ISCHR(a.status->st_mode) && a.status->st_dev == b.status->st_dev &&
           a.status->st_ino == b.status->st_ino;
  return !a.status && !b.status && !a.path.empty() && a.path == b.path;
}

/// A store has files beside it, which SQLite and the lock use.
void add_store(const std::string& option, const std::string& store, std::vector<NamedFile>& to) {
  const std::string real = resolved(store).string();
  to.push_back(named(option, store));
  for (const char* suffix : {"-wal", "-shm", "-journal", ".lock"}) to.push_back(named(option, real + suffix));
}

template <std::size_t kCount>
bool is_one_of(const std::array<std::string_view, kCount>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

void add_files(const CLI::App& app, std::vector<NamedFile>& inputs, std::vector<NamedFile>& outputs) {
  const bool writes_its_file = app.get_name() == "export";
  for (const CLI::Option* const option : app.get_options()) {
    const std::string name = option->get_name();
    const bool is_output = is_one_of(kOutputs, name) || (writes_its_file && name == "file");
    if (!is_output && !is_one_of(kInputs, name)) continue;
    for (const std::string& path : option->results()) {
      if (path.empty()) continue;
      if (path == "-") {
        if (!is_output) add_descriptor(STDIN_FILENO, "standard input", inputs);
      } else if (name == "--db") {
        add_store(name, path, inputs);
      } else {
        (is_output ? outputs : inputs).push_back(named(name, path));
      }
    }
  }
}

/// Of two outputs in one file the second would replace the first.
void check_outputs_differ(const std::vector<NamedFile>& outputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    for (auto other = outputs.begin(); other != output; ++other) {
      if (is_same(*output, *other)) throw BadInput(output->name + ": is the same file as " + other->name);
    }
  }
}

}  // namespace

void check_outputs(const CLI::App& program, const CLI::App& command) {
  std::vector<NamedFile> inputs;
  std::vector<NamedFile> outputs;
  add_files(program, inputs, outputs);
  add_files(command, inputs, outputs);
  check_outputs_differ(outputs);
  add_descriptor(STDOUT_FILENO, "standard output", outputs);
  add_descriptor(STDERR_FILENO, "standard error", outputs);
  for (const NamedFile& output : outputs) {
    for (const NamedFile& input : inputs) {
      if (is_same(output, input))
        throw BadInput(output.name + ": is the same file as " + input.name + ", which would be lost");
    }
  }
}

}  // namespace server::commands
