#include "server/commands/command.h"

#include <fstream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "tests/server/service_fixture.h"

namespace {

using namespace server::commands;

/// What a command that throws leaves on standard error.
template <typename Error>
std::string words_of(const Error& error, int expected_code) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_guarded([&]() -> int { throw error; }), expected_code);
  return testing::internal::GetCapturedStderr();
}

TEST(RunGuarded, PassesTheCodeOn) { EXPECT_EQ(run_guarded([] { return 1; }), 1); }

TEST(RunGuarded, PrintsEachFaultOnALine) {
  EXPECT_EQ(words_of(jobs::InvalidRequest(std::vector<jobs::Fault>{{"/a", "unknown"}, {"/b/0", "too small"}}), kBadInput),
            "/a: unknown\n/b/0: too small\n");
}

TEST(RunGuarded, TellsBadInputFromAFailingMachine) {
  EXPECT_EQ(words_of(BadInput("no such file"), kBadInput), "rpsup: no such file\n");
  EXPECT_EQ(words_of(jobs::StorageError("in use", 5, false), kMachineFailed), "rpsup: in use\n");
  EXPECT_EQ(words_of(CannotWrite("full"), kMachineFailed), "rpsup: full\n");
  EXPECT_EQ(words_of(std::bad_alloc(), kMachineFailed).find("rpsup: there is no memory left"), 0U);
  const std::system_error no_thread(std::make_error_code(std::errc::resource_unavailable_try_again));
  EXPECT_EQ(words_of(no_thread, kMachineFailed), "rpsup: the system allows no more threads; ulimit -v and ulimit -u limit them\n");
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

TEST(WriteText, WritesEveryByteOrThrows) {
  const server_tests::TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  write_text(path, std::string("a\r\n\0b", 5));
  std::ifstream file(path, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), std::string("a\r\n\0b", 5));
  // A device without room.
  EXPECT_THROW(write_text("/dev/full", "a"), CannotWrite);
}

}  // namespace
