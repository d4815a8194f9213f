// SPDX-License-Identifier: Apache-2.0
// Whom the file of a store is for, and which files are refused and left alone.

#include <csignal>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "jobs/store/store.h"
#include "jobs/store/store_lock.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/store_support.h"

namespace jobs_tests {
namespace {

TEST(Store, IsRefusedToASecondOpener) {
  const TemporaryStore temporary;
  {
    const jobs::Store store(temporary.file());
    EXPECT_THROW(jobs::Store second(temporary.file()), jobs::StorageError);
  }
  EXPECT_NO_THROW(jobs::Store third(temporary.file()));
}

/// The words with which a store is refused; empty: it is opened.
std::string refusal_of(const std::filesystem::path& file) {
  try {
    const jobs::Store store(file);
  } catch (const jobs::StorageError& error) {
    return error.what();
  }
  return "";
}

std::string stored_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string refusal_of_copy(const std::filesystem::path& file) {
  try {
    jobs::check_can_be_copied(file);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

// SQLite names the log after the name of the file: under the other name nothing would be seen of the log.
TEST(Store, IsRefusedUnderAnotherName) {
  const TemporaryStore temporary;
  const std::filesystem::path link = temporary.file().string() + ".link";
  {
    jobs::Store store(temporary.file());
    add_sweep(store, "{}");
    std::filesystem::create_hard_link(temporary.file(), link);
    EXPECT_NE(refusal_of(link).find("in use by another process, under another name"), std::string::npos) << refusal_of(link);
    EXPECT_NE(refusal_of_copy(link).find("under another name"), std::string::npos) << refusal_of_copy(link);
    // The process that has opened the store before goes on.
    add_sweep(store, "{}");
    EXPECT_EQ(store.reader.list_sweeps("", "", 10).size(), 2U);
  }
  for (const auto& name : {link, temporary.file()}) {
    EXPECT_NE(refusal_of(name).find("has 2 names"), std::string::npos) << refusal_of(name);
    EXPECT_NE(refusal_of_copy(name).find("has 2 names"), std::string::npos) << refusal_of_copy(name);
  }
  std::filesystem::remove(link);
  EXPECT_EQ(refusal_of_copy(temporary.file()), "");
  jobs::Store again(temporary.file());
  EXPECT_EQ(again.reader.list_sweeps("", "", 10).size(), 2U);
}

// A bind mount shows one file, with one link, in two folders; so does a file that is moved while it is open.
TEST(Store, IsRefusedInAnotherFolder) {
  const TemporaryStore temporary;
  const std::filesystem::path moved = temporary.file().string() + ".moved";
  {
    const jobs::Store store(temporary.file());
    EXPECT_EQ(refusal_of_copy(temporary.file()), "");
    std::filesystem::rename(temporary.file(), moved);
    EXPECT_NE(refusal_of(moved).find("under another name"), std::string::npos) << refusal_of(moved);
    EXPECT_NE(refusal_of_copy(moved).find("under another name"), std::string::npos) << refusal_of_copy(moved);
    std::filesystem::rename(moved, temporary.file());
  }
  EXPECT_EQ(refusal_of(temporary.file()), "");
}

/// Serves a store and is killed with a sweep in its log.
void serve_and_be_killed(const std::filesystem::path& file) {
  const pid_t child = ::fork();
  if (child == 0) {
    jobs::Store store(file);
    add_sweep(store, "{}");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

// The log of a killed process lies beside the name that it used: opened under another name, as a bind mount
// has, the store would lack what stands in the log.
TEST(Store, IsRefusedUnderAnotherNameThanItsLogs) {
  const TemporaryStore temporary;
  const std::filesystem::path file = temporary.file(), moved = file.string() + ".moved";
  serve_and_be_killed(file);
  if (::getxattr(file.c_str(), "user.rpsup.log_of", nullptr, 0) <= 0)
    GTEST_SKIP() << "this file system has no extended attributes";
  std::filesystem::rename(file, moved);
  EXPECT_NE(refusal_of(moved).find("its log lies beside that name"), std::string::npos) << refusal_of(moved);
  EXPECT_NE(refusal_of(moved).find(file.string()), std::string::npos) << refusal_of(moved);
  EXPECT_NE(refusal_of_copy(moved).find("its log lies beside that name"), std::string::npos);
  std::filesystem::rename(moved, file);
  {
    jobs::Store store(file);
    EXPECT_EQ(store.reader.list_sweeps("", "", 10).size(), 1U) << "with its log";
  }
  std::filesystem::rename(file, moved);
  EXPECT_EQ(refusal_of(moved), "") << "closed, it may be moved";
  std::filesystem::rename(moved, file);
  serve_and_be_killed(file);
  std::filesystem::rename(file, moved);
  std::filesystem::rename(file.string() + "-wal", moved.string() + "-wal");
  jobs::Store store(moved);
  EXPECT_EQ(store.reader.list_sweeps("", "", 10).size(), 2U) << "its log has come with it";
}

// Under the feet of the service: what is acknowledged must be there after the next start.
TEST(Store, WritesNothingWhileItsFileIsNotInItsPlace) {
  const TemporaryStore temporary;
  const std::filesystem::path file = temporary.file();
  const std::filesystem::path moved = file.string() + ".moved";
  jobs::Store store(file);
  add_sweep(store, "{}");
  EXPECT_NO_THROW(store.reader.check());
  std::filesystem::rename(file, moved);
  EXPECT_THROW(add_sweep(store, "{}"), jobs::StorageError);
  EXPECT_THROW(static_cast<void>(store.queue.claim()), jobs::StorageError);
  EXPECT_THROW(store.reader.check(), jobs::StorageError);
  { std::ofstream(file) << "another file"; }
  EXPECT_THROW(add_sweep(store, "{}"), jobs::StorageError);
  EXPECT_THROW(store.reader.check(), jobs::StorageError);
  EXPECT_EQ(stored_text(file), "another file");
  std::filesystem::rename(moved, file);
  EXPECT_NO_THROW(store.reader.check());
  add_sweep(store, "{}");
  EXPECT_EQ(store.reader.list_sweeps("", "", 10).size(), 2U);
  std::filesystem::remove(file);
  EXPECT_THROW(add_sweep(store, "{}"), jobs::StorageError);
}

TEST(Store, IsCopiedOnlyIfItIsOne) {
  const TemporaryStore temporary;
  const std::filesystem::path file = temporary.file();
  { std::ofstream(file) << ""; }
  EXPECT_NE(refusal_of_copy(file).find("is no store"), std::string::npos);
  { std::ofstream(file) << "clearance_mm,peak\n0.1,12\n"; }
  EXPECT_NE(refusal_of_copy(file).find("is no store"), std::string::npos);
  std::filesystem::remove(file);
  {
    SQLite::Database other(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    other.exec("CREATE TABLE sweeps (id TEXT)");
  }
  EXPECT_NE(refusal_of_copy(file).find("is no store"), std::string::npos);
  std::filesystem::remove(file);
  { const jobs::Store store(file); }
  EXPECT_EQ(refusal_of_copy(file), "");
}

TEST(Store, IsForItsOwnerOnly) {
  const TemporaryStore temporary;
  const jobs::Store store(temporary.file());
  for (const char* suffix : {"", ".lock", "-wal"}) {
    struct stat status {};
    ASSERT_EQ(::stat((temporary.file().string() + suffix).c_str(), &status), 0) << suffix;
    EXPECT_EQ(status.st_mode & 0777U, 0600U) << suffix;
  }
}

TEST(Store, IsTakenFromOthersWhoCouldReadIt) {
  const TemporaryStore temporary;
  { const jobs::Store store(temporary.file()); }
  ASSERT_EQ(::chmod(temporary.file().c_str(), 0644), 0);
  const std::string log = temporary.file().string() + "-wal";
  { std::ofstream(log) << ""; }
  ASSERT_EQ(::chmod(log.c_str(), 0666), 0);
  const jobs::Store store(temporary.file());
  for (const std::string& file : {temporary.file().string(), log}) {
    struct stat status {};
    ASSERT_EQ(::stat(file.c_str(), &status), 0) << file;
    EXPECT_EQ(status.st_mode & 0777U, 0600U) << file;
  }
}

std::string store_refusal_of(const std::filesystem::path& file) {
  try {
    const jobs::Store store(file);
  } catch (const jobs::StorageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Store, RefusesTheFormOfANewerProgramAndLeavesItAlone) {
  const TemporaryStore temporary;
  { const jobs::Store store(temporary.file()); }
  execute_sql(temporary.file(), "PRAGMA user_version = 1000");
  EXPECT_NE(store_refusal_of(temporary.file()).find("newer program"), std::string::npos);
  EXPECT_EQ(query_sql(temporary.file(), "PRAGMA user_version"), "1000");
}

TEST(Store, RefusesAFormThatNoProgramHasWritten) {
  const TemporaryStore temporary;
  { const jobs::Store store(temporary.file()); }
  for (const char* const form : {"-1", "0"}) {
    execute_sql(temporary.file(), std::string("PRAGMA user_version = ") + form);
    EXPECT_NE(store_refusal_of(temporary.file()).find(std::string("of form ") + form), std::string::npos)
        << store_refusal_of(temporary.file());
    EXPECT_EQ(query_sql(temporary.file(), "PRAGMA user_version"), form);
  }
}

TEST(Store, LeavesNothingBehindWhereItsStartIsRefused) {
  const TemporaryStore temporary;
  const std::filesystem::path file = temporary.file();
  const std::filesystem::path folder = file.parent_path();
  const auto count_files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  };
  // Another program's database gets no lock beside it.
  { std::ofstream(file) << ""; }
  execute_sql(file, "CREATE TABLE notes (text)");
  EXPECT_NE(store_refusal_of(file).find("not a store of this program"), std::string::npos);
  EXPECT_EQ(count_files(), 1);
  std::filesystem::remove(file);
  // A service that was never started, because its port is taken, say.
  FakeEngine engine;
  {
    jobs::ServiceOptions options = options_of(temporary, engine, 1);
    options.start = jobs::Start::kWhenTold;
    const jobs::Service service(options);
    EXPECT_TRUE(std::filesystem::exists(file));
  }
  EXPECT_EQ(count_files(), 0);
  // A store that was there before stays, and so does one that was used.
  { const jobs::Service service(options_of(temporary, engine, 1)); }
  EXPECT_TRUE(std::filesystem::exists(file));
  {
    jobs::ServiceOptions options = options_of(temporary, engine, 1);
    options.start = jobs::Start::kWhenTold;
    const jobs::Service service(options);
  }
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(Store, RefusesTheDatabaseOfAnotherProgramAndLeavesItAlone) {
  const TemporaryStore temporary;
  { std::ofstream(temporary.file()) << ""; }
  execute_sql(temporary.file(), "CREATE TABLE notes (text)");
  const std::string before = stored_text(temporary.file());
  EXPECT_NE(store_refusal_of(temporary.file()).find("not a store of this program"), std::string::npos);
  EXPECT_EQ(stored_text(temporary.file()), before);
}

TEST(Store, RefusesWhatIsNoDatabaseAndLeavesItAlone) {
  const TemporaryStore temporary;
  const std::string text(10'000, 'x');
  { std::ofstream(temporary.file()) << text; }
  EXPECT_NE(store_refusal_of(temporary.file()).find("left as it is"), std::string::npos);
  EXPECT_EQ(stored_text(temporary.file()), text);
}

TEST(Store, RefusesADamagedFileAndLeavesItAlone) {
  const TemporaryStore temporary;
  {
    jobs::Store store(temporary.file());
    add_sweep(store, R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 300}}})");
  }
  std::string damaged = stored_text(temporary.file());
  ASSERT_GT(damaged.size(), 400'000U);
  for (std::size_t i = damaged.size() / 4; i < damaged.size(); ++i) damaged[i] = static_cast<char>(i * 37);
  { std::ofstream(temporary.file(), std::ios::binary) << damaged; }
  EXPECT_NE(store_refusal_of(temporary.file()).find("damaged"), std::string::npos);
  EXPECT_EQ(stored_text(temporary.file()), damaged);
}

TEST(Store, RefusesAFileThatWasCutOff) {
  const TemporaryStore temporary;
  {
    jobs::Store store(temporary.file());
    add_sweep(store, R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 300}}})");
  }
  std::filesystem::resize_file(temporary.file(), std::filesystem::file_size(temporary.file()) / 2);
  EXPECT_NE(store_refusal_of(temporary.file()).find("damaged"), std::string::npos);
}

/// The files of a store that is in use, as a kill would leave them.
void copy_files(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::copy_file(from, to);
  std::filesystem::copy_file(from.string() + "-wal", to.string() + "-wal");
}

TEST(Store, LeavesTheLogOfAStoreThatItRefusesAlone) {
  const TemporaryStore temporary;
  const std::filesystem::path killed = temporary.file().string() + ".killed";
  { const jobs::Store store(temporary.file()); }
  {
    SQLite::Database newer(temporary.file().string(), SQLite::OPEN_READWRITE);
    newer.exec("PRAGMA user_version = 1000");
    copy_files(temporary.file(), killed);
  }
  const std::string log = stored_text(killed.string() + "-wal"), file = stored_text(killed);
  ASSERT_FALSE(log.empty());
  EXPECT_NE(store_refusal_of(killed).find("newer program"), std::string::npos);
  EXPECT_EQ(stored_text(killed.string() + "-wal"), log);
  EXPECT_EQ(stored_text(killed), file);
}

TEST(Store, LeavesTheLogOfAStoreAloneWhoseDamageIsOnlySeenAsItIsWritten) {
  const TemporaryStore temporary;
  const std::filesystem::path killed = temporary.file().string() + ".killed";
  {
    jobs::Store store(temporary.file());
    add_sweep(store, R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 1000}}})");
  }
  // Putting these back into the queue takes pages from the list of free ones, which leads nowhere. No table
  // has it, so none seems damaged.
  execute_sql(temporary.file(), "UPDATE jobs SET state = 'running', started_ms = created_ms");
  constexpr std::streamoff kFreePages = 32;
  {
    std::fstream file(temporary.file(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(kFreePages);
    file << std::string{0, 0x7f, 0, 0, 0, 0, 0, 5};
  }
  {
    SQLite::Database other(temporary.file().string(), SQLite::OPEN_READWRITE);
    other.exec("UPDATE sweeps SET name = 'in the log'");
    copy_files(temporary.file(), killed);
  }
  const std::string log = stored_text(killed.string() + "-wal"), file = stored_text(killed);
  ASSERT_FALSE(log.empty());
  EXPECT_NE(store_refusal_of(killed).find("is damaged"), std::string::npos);
  EXPECT_TRUE(stored_text(killed.string() + "-wal") == log);
  EXPECT_TRUE(stored_text(killed) == file);
}

TEST(Store, RefusesALogWhoseStoreIsGone) {
  const TemporaryStore temporary;
  const std::filesystem::path killed = temporary.file().string() + ".killed";
  {
    jobs::Store store(temporary.file());
    add_sweep(store, R"({"sweep": {"clearance_mm": [0.1, 0.2]}})");
    copy_files(temporary.file(), killed);
  }
  const std::string log = stored_text(killed.string() + "-wal"), file = stored_text(killed);
  ASSERT_FALSE(log.empty());
  std::filesystem::remove(killed);
  EXPECT_NE(store_refusal_of(killed).find("its log"), std::string::npos);
  EXPECT_EQ(stored_text(killed.string() + "-wal"), log);
  EXPECT_FALSE(std::filesystem::exists(killed));
  { std::ofstream(killed) << file; }
  const jobs::Store store(killed);
  EXPECT_EQ(store.reader.list_sweeps("", "", 10).size(), 1U) << "the store was put back";
}

// A probe or the end of a job asks whether there is room, in the midst of a deletion that has got it.
TEST(StoreLock, KeepsLentRoomForWhoGotIt) {
  const TemporaryStore temporary;
  jobs::StoreLock lock(temporary.file());
  const std::filesystem::path file = temporary.file().string() + ".lock";
  ASSERT_TRUE(lock.hold_room());
  const std::uintmax_t held = std::filesystem::file_size(file);
  {
    const jobs::StoreLock::LentRoom lent(lock);
    EXPECT_FALSE(lock.hold_room());
    EXPECT_FALSE(lock.has_room());
    EXPECT_EQ(std::filesystem::file_size(file), 0U);
  }
  EXPECT_TRUE(lock.hold_room());
  EXPECT_EQ(std::filesystem::file_size(file), held);
}

TEST(Store, TurnsADirectoryOrAMissingFolderDown) {
  const TemporaryStore temporary;
  std::filesystem::create_directory(temporary.file());
  EXPECT_THROW(jobs::Store store(temporary.file()), jobs::StorageError);
  EXPECT_THROW(jobs::Store store(temporary.file() / "no" / "such" / "folder.db"), jobs::StorageError);
}

}  // namespace
}  // namespace jobs_tests
