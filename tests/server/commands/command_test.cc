// SPDX-License-Identifier: Apache-2.0
#include "server/commands/command.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "server/commands/written_file.h"
#include "tests/server/service_fixture.h"

namespace {

using namespace server::commands;

/// Text on standard error of a command that throws.
template <typename Error>
std::string words_of(const Error& error, int expected_code) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_guarded([&]() -> int { throw error; }), expected_code);
  return testing::internal::GetCapturedStderr();
}

TEST(RunGuarded, PassesTheCodeOn) { EXPECT_EQ(run_guarded([] { return 1; }), 1); }

TEST(RunGuarded, PrintsEachFaultOnALine) {
  EXPECT_EQ(words_of(jobs::InvalidRequest(std::vector<jobs::Fault>{{"/a", "unknown"}, {"/b/0", "too small"}}),
                     kBadInput),
            "/a: unknown\n/b/0: too small\n");
}

TEST(RunGuarded, PrintsTextOfUsersAsText) {
  EXPECT_EQ(words_of(jobs::InvalidRequest(std::vector<jobs::Fault>{{"/a\x1b[2K\n", "no \"\r\""}}), kBadInput), "/a\\x1b[2K\\x0a: no \"\\x0d\"\n");
  EXPECT_EQ(words_of(BadInput("a\nrpsup: b\x07"), kBadInput), "rpsup: a\\x0arpsup: b\\x07\n");
}

TEST(RunGuarded, TellsBadInputFromAFailingMachine) {
  EXPECT_EQ(words_of(BadInput("no such file"), kBadInput), "rpsup: no such file\n");
  EXPECT_EQ(words_of(jobs::StorageError("in use", 5), kMachineFailed), "rpsup: in use\n");
  EXPECT_EQ(words_of(CannotWrite("full"), kMachineFailed), "rpsup: full\n");
  EXPECT_EQ(words_of(std::bad_alloc(), kMachineFailed).find("rpsup: there is no memory left"), 0U);
  const std::system_error no_thread(std::make_error_code(std::errc::resource_unavailable_try_again));
  EXPECT_EQ(words_of(no_thread, kMachineFailed),
            "rpsup: the system allows no more threads; ulimit -v and ulimit -u limit them\n");
}

TEST(ReadJson, NamesTheFileAndThePlace) {
  const server_tests::TemporaryFolder folder;
  const std::string path = folder / "a.json";
  std::ofstream(path) << "[1,]";
  try {
    static_cast<void>(read_json(path));
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    EXPECT_EQ(std::string(error.what()).find(path + ": not JSON at byte 4"), 0U) << error.what();
  }
  EXPECT_THROW(static_cast<void>(read_json(folder / "missing.json")), BadInput);
}

TEST(ReadJson, SaysThatAFolderIsNoFile) {
  const server_tests::TemporaryFolder folder;
  const std::string path = folder / "sweeps";
  std::filesystem::create_directory(path);
  try {
    static_cast<void>(read_json(path));
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    EXPECT_EQ(error.what(), "cannot read " + path + ": it is a folder");
  }
}

/// Somebody who may not write everywhere, which root may.
class Nobody {
 public:
  Nobody() : was_(geteuid()) {
    constexpr uid_t kNobody = 65534;
    if (was_ == 0) {
      EXPECT_EQ(seteuid(kNobody), 0);
    }
  }
  ~Nobody() { EXPECT_EQ(seteuid(was_), 0); }
  Nobody(const Nobody&) = delete;
  Nobody& operator=(const Nobody&) = delete;

 private:
  uid_t was_;
};

TEST(CheckOutputFile, RefusesBeforeTheWorkWhatCannotBeWritten) {
  const server_tests::TemporaryFolder folder;
  namespace fs = std::filesystem;
  const fs::path open = folder / "open";
  const fs::path closed = folder / "closed";
  for (const fs::path& each : {open, closed}) fs::create_directory(each);
  std::ofstream(open / "kept.csv") << "kept";
  fs::permissions(folder / "", fs::perms::all);
  fs::permissions(open, fs::perms::all);
  fs::permissions(open / "kept.csv", fs::perms::all & ~(fs::perms::owner_write | fs::perms::group_write |
                                                        fs::perms::others_write));
  fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                              fs::perms::others_exec);
  const Nobody nobody;
  EXPECT_NO_THROW(check_output_file("--results", open / "new.csv"));
  EXPECT_THROW(check_output_file("--results", open), BadInput);
  EXPECT_THROW(check_output_file("--results", open / "none" / "new.csv"), BadInput);
  EXPECT_THROW(check_output_file("--results", closed / "new.csv"), CannotWrite);
  EXPECT_THROW(check_output_file("--results", open / "kept.csv"), CannotWrite);
}

TEST(WriteText, WritesEveryByteOrThrows) {
  const server_tests::TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  write_text(path, std::string("a\r\n\0b", 5));
  std::ifstream file(path, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), std::string("a\r\n\0b", 5));
  // A device without room.
  EXPECT_THROW(write_text("/dev/full", "a"), CannotWrite);
}

TEST(WrittenFile, LeavesTheOldFileUnlessItIsKept) {
  const server_tests::TemporaryFolder folder;
  const std::string path = folder / "a.csv", link = folder / "link.csv";
  write_text(path, "old");
  std::filesystem::create_symlink("a.csv", link);
  {
    WrittenFile file(link);
    EXPECT_TRUE(file.append("new"));
  }
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 2) << "no part is left";
  WrittenFile file(link);
  EXPECT_TRUE(file.append("new"));
  EXPECT_TRUE(file.append("er"));
  file.keep();
  EXPECT_EQ(read_text(path), "newer");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST(WrittenFile, KeepsADevice) {
  WrittenFile file("/dev/null");
  EXPECT_TRUE(file.append("a"));
  file.keep();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  WrittenFile full("/dev/full");
  EXPECT_FALSE(full.append("a"));
  EXPECT_THROW(full.keep(), CannotWrite);
}

}  // namespace
