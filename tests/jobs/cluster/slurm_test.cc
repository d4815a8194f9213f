// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/slurm.h"

#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/jobs/cluster/fake_slurm.h"

namespace jobs_tests {
namespace {

using namespace std::chrono_literals;
using jobs::cluster::parse_reports;
using jobs::cluster::Phase;
using jobs::cluster::Slurm;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

jobs::cluster::ArrayOrder some_order() {
  return {.name = "rpsup-bat_1-g0",
          .tasks = 3,
          .time_s = 301.0,
          .memory_factor = 1,
          .folder = "/tmp",
          .script = "/tmp/g0.sh",
          .log = "/tmp/g0-%a.log"};
}

TEST(Slurm, ReadsTheNumberOfAnArrayWithAndWithoutACluster) {
  FakeSlurm fake;
  fake.answer("sbatch", "echo 123");
  EXPECT_EQ(Slurm(fake.site()).submit(some_order()).array_job, "123");
  fake.answer("sbatch", "echo '124;big'");
  EXPECT_EQ(Slurm(fake.site()).submit(some_order()).array_job, "124");
}

struct BadAnswer {
  std::string name, script, told;
};

class BadSubmission : public testing::TestWithParam<BadAnswer> {};

TEST_P(BadSubmission, IsNoNumberButAProblem) {
  FakeSlurm fake;
  fake.answer("sbatch", GetParam().script);
  auto site = fake.site();
  site.submit_deadline = 300ms;
  const auto answer = Slurm(site).submit(some_order());
  EXPECT_FALSE(answer.array_job);
  EXPECT_THAT(answer.problem, HasSubstr(GetParam().told));
}

INSTANTIATE_TEST_SUITE_P(
    Answers, BadSubmission,
    testing::Values(BadAnswer{"Error", "echo 'sbatch: error: invalid partition specified' >&2; exit 1",
                              "invalid partition"},
                    BadAnswer{"ErrorAlthoughANumber", "echo 12; exit 1", "12"},
                    BadAnswer{
                        "TimedOut",
                        "echo 'sbatch: error: Batch job submission failed: Socket timed out' >&2; exit 1",
                        "timed out"},
                    BadAnswer{"Silence", "exit 0", "no number"},
                    BadAnswer{"Garbage", "echo '<html>login</html>'", "<html>login"},
                    BadAnswer{"Hang", "sleep 100", "did not answer in time"},
                    BadAnswer{"Killed", "kill -9 $$", "137"}),
    [](const auto& each) { return each.param.name; });

TEST(Slurm, IsNotBlamedForACommandThatWasEndedWithTheProgram) {
  FakeSlurm fake;
  fake.answer("squeue", "sleep 100");
  std::stop_source stopping;
  stopping.request_stop();
  std::string problem;
  EXPECT_FALSE(Slurm(fake.site(), stopping.get_token()).observe({"rpsup-bat_1-g0"}, problem));
  EXPECT_THAT(problem, HasSubstr("as this program ends"));
}

TEST(Slurm, TellsThatACommandIsMissing) {
  jobs::cluster::Site site;
  site.prefix = {"/nowhere/at/all"};
  EXPECT_THAT(Slurm(site).submit(some_order()).problem, HasSubstr("/nowhere/at/all cannot be started"));
}

class BadObservation : public testing::TestWithParam<BadAnswer> {};

TEST_P(BadObservation, IsNoObservation) {
  FakeSlurm fake;
  fake.answer("squeue", GetParam().script);
  auto site = fake.site();
  site.query_deadline = 300ms;
  std::string problem;
  EXPECT_FALSE(Slurm(site).observe({"rpsup-bat_1-g0"}, problem));
  EXPECT_THAT(problem, HasSubstr(GetParam().told));
}

INSTANTIATE_TEST_SUITE_P(
    Answers, BadObservation,
    testing::Values(BadAnswer{"Error",
                              "echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2; exit 1",
                              "to contact"},
                    BadAnswer{"Garbage", "echo 'motd: welcome'", "cannot be read: motd"},
                    BadAnswer{"Hang", "sleep 100", "in time"},
                    BadAnswer{"CutOff",
                              "printf 'rpsup-bat_1-g0|1|0|RUNNING|1|n1|None\\nrpsup-bat_1-g0|1|1|RUN'",
                              "cannot be read"}),
    [](const auto& each) { return each.param.name; });

TEST(Slurm, AsksForAllArraysAtOnceAndReadsTheirTasks) {
  FakeSlurm fake;
  fake.report(
      "a-g0|41|0|RUNNING|2|n1|None\na-g0|41|1|PENDING|2||Resources, or "
      "so|really\nb-g1|42|7|FAILED|1|n2|NonZeroExitCode\n");
  std::string problem;
  const auto reports = Slurm(fake.site()).observe({"a-g0", "b-g1"}, problem);
  ASSERT_TRUE(reports) << problem;
  EXPECT_THAT(
      fake.calls(),
      HasSubstr("squeue --noheader --array --states=all --name=a-g0,b-g1 --format=%j|%F|%K|%T|%C|%N|%r\n"));
  EXPECT_EQ(reports->at("a-g0").at(0).phase, Phase::kRunning);
  EXPECT_EQ(reports->at("a-g0").at(0).node, "n1");
  EXPECT_EQ(reports->at("a-g0").at(1).reason, "Resources, or so|really");
  EXPECT_EQ(reports->at("b-g1").at(7).phase, Phase::kFailed);
  EXPECT_EQ(reports->at("b-g1").at(7).array_job, "42");
}

TEST(Slurm, KnowsNoTaskThatHasVanished) {
  FakeSlurm fake;
  fake.report("");
  std::string problem;
  const auto reports = Slurm(fake.site()).observe({"a-g0"}, problem);
  ASSERT_TRUE(reports);
  EXPECT_TRUE(reports->empty());
}

TEST(Reports, TakeAWordThatIsNotKnownForALiveTask) {
  const auto reports = parse_reports("a|1|0|HIBERNATING|1||None\n");
  EXPECT_EQ(reports->at("a").at(0).phase, Phase::kUnknownWord);
  EXPECT_TRUE(is_alive(reports->at("a").at(0).phase));
  EXPECT_TRUE(reports->at("a").at(0).needs_human());
}

TEST(Reports, CountTheLiveOneOfTwoLinesForATask) {
  for (const char* const text : {"a|1|0|NODE_FAIL|1|n1|None\na|1|0|RUNNING|1|n2|None\n",
                                 "a|1|0|RUNNING|1|n2|None\na|1|0|NODE_FAIL|1|n1|None\n"}) {
    EXPECT_EQ(parse_reports(text)->at("a").at(0).node, "n2");
  }
}

// An array that is cancelled before any of its tasks begins is one line without an index from then on.
TEST(Reports, LeaveOutAnArrayThatWasCancelledAsAWhole) {
  const auto reports = parse_reports("a|1|N/A|CANCELLED|1||JobHeldUser\nb|2|0|RUNNING|1|n1|None\n");
  ASSERT_TRUE(reports);
  EXPECT_FALSE(reports->contains("a"));
  EXPECT_TRUE(reports->contains("b"));
  EXPECT_FALSE(parse_reports("a|1|N/A|PENDING|1||None\n"));
}

TEST(Slurm, PassesTheSitesOptionsToSbatch) {
  jobs::cluster::Site site;
  site.partition = "short";
  site.account = "lab";
  site.qos = "low";
  site.constraint = "zen4";
  site.options = {"--exclude=n7"};
  site.memory_mb = 500;
  site.threads = 4;
  site.slots = 2;
  auto order = some_order();
  order.memory_factor = 2;
  const auto arguments = Slurm(site).submit_arguments(order);
  EXPECT_THAT(arguments,
              testing::IsSupersetOf({"--partition=short", "--account=lab", "--qos=low", "--constraint=zen4",
                                     "--exclude=n7", "--mem-per-cpu=1000", "--cpus-per-task=4",
                                     "--array=0-2%2", "--time=6", "--job-name=rpsup-bat_1-g0", "--requeue"}));
  EXPECT_EQ(arguments.back(), "/tmp/g0.sh");
  EXPECT_THAT(Slurm({}).submit_arguments(some_order()), Not(Contains(HasSubstr("partition"))));
}

TEST(Slurm, ReadsTheLimitsOfTheCluster) {
  FakeSlurm fake;
  std::string problem;
  const auto limits = Slurm(fake.site()).find_limits(problem);
  ASSERT_TRUE(limits) << problem;
  EXPECT_EQ(limits->max_array_size, 1001);
  EXPECT_EQ(limits->version, "22.05.8");
  fake.answer("scontrol", "exit 1");
  EXPECT_FALSE(Slurm(fake.site()).find_limits(problem));
}

TEST(Slurm, QuotesForARemoteShell) {
  FakeSlurm fake;
  // Gives its words to a shell, as ssh does.
  const auto ssh = fake.site().folder / "ssh";
  std::ofstream(ssh) << "#!/bin/sh\nshift 2\neval \"$*\"\n";
  std::filesystem::permissions(ssh, std::filesystem::perms(0755));
  jobs::cluster::Site site;
  site.prefix = {ssh.string(), "login", "--"};
  EXPECT_EQ(Slurm(site).run({"printf", "%s;%s", "a|b $HOME", "it's"}, 5000ms).out, "a|b $HOME;it's");
}

TEST(Process, HidesSlurmsAndOurVariables) {
  ::setenv("SQUEUE_FORMAT", "%i", 1);
  ::setenv("SLURM_JOB_ID", "1", 1);
  ::setenv("RPSUP_TOKEN", "secret", 1);
  ::setenv("SLURM_CONF", "/somewhere/slurm.conf", 1);
  const std::string seen = jobs::cluster::run_process({"env"}, 5000ms).out;
  for (const char* const name : {"SQUEUE_FORMAT", "SLURM_JOB_ID", "RPSUP_TOKEN", "SLURM_CONF"})
    ::unsetenv(name);
  EXPECT_THAT(seen, HasSubstr("SLURM_CONF=/somewhere/slurm.conf"));
  EXPECT_THAT(seen, Not(HasSubstr("SQUEUE_FORMAT")));
  EXPECT_THAT(seen, Not(HasSubstr("SLURM_JOB_ID")));
  EXPECT_THAT(seen, Not(HasSubstr("secret")));
}

TEST(Process, DoesNotWaitForWhatAProgramLeavesBehind) {
  const auto outcome = jobs::cluster::run_process({"sh", "-c", "sleep 100 & echo started $!"}, 20'000ms);
  EXPECT_TRUE(outcome.succeeded());
  const auto left = std::stoi(outcome.out.substr(8));
  EXPECT_EQ(::kill(left, SIGKILL), 0);
}

TEST(Process, SplitsACommandLine) {
  EXPECT_THAT(jobs::cluster::split_words(" ssh  -o 'A B' \"\" login --"),
              ElementsAre("ssh", "-o", "A B", "", "login", "--"));
}

}  // namespace
}  // namespace jobs_tests
