// SPDX-License-Identifier: Apache-2.0
#include "validation/program/validate.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "validation/chapters.h"
#include "validation/report/report.h"
#include "validation/report/report_line.h"
#include "validation/report/rows.h"
#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "validation/studies/compute.h"
#include "validation/studies/study_chapters.h"
#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"

namespace validation::program {

namespace {

using server::commands::BadInput;
using server::commands::CannotWrite;
using server::commands::check_output_file;
using server::commands::EndSignals;
using server::commands::kDone;
using server::commands::kInterrupted;
using server::commands::kJobFailed;
using server::commands::ProgressView;
using server::commands::write_text;

constexpr const char* kFigureFolder = "figures";
constexpr const char* kRowsFile = "rows.csv";

/// Path of a file or folder that stands beside the report.
std::string beside(const std::string& report, const char* name) {
  return (std::filesystem::path(report).parent_path() / name).string();
}

/// Request for the end by a signal.
struct Interrupted {};

/// Failure of a job of the study: there is no report without its results.
class StudyFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Folder that is removed with this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "rpsup-validate-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw CannotWrite("cannot make a folder in " + std::filesystem::temp_directory_path().string());
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Refuses, before any computation, files that could not be written after it.
void check_options(const ValidateOptions& options) {
  if (options.quick && !(options.report.empty() && options.check.empty()))
    throw BadInput("--quick leaves out part of the report: it goes with neither --report nor --check");
  if (options.report.empty()) return;
  if (options.report == "-") throw BadInput("--report " + options.report + ": must be a file's name");
  check_output_file("--report", options.report);
  check_output_file("--report", beside(options.report, kRowsFile));
  const std::string figures = beside(options.report, kFigureFolder);
  std::error_code error;
  std::filesystem::create_directories(figures, error);
  if (!error) return;
  const std::string folder = "cannot make the folder " + figures;
  throw CannotWrite("--report " + options.report + ": " + folder + ": " + error.message());
}

std::vector<std::string> read_lines(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw BadInput("cannot read " + path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

void print(const Findings& findings) {
  for (const Check& check : findings.checks) std::cout << describe(check) << '\n';
  std::cout << std::flush;
}

std::vector<ComputedChapter> compute_engine_chapters(const ValidateOptions& options) {
  const auto chapters = engine_chapters();
  const Cost most_costly = options.quick ? Cost::kLight : Cost::kHeavy;
  const std::size_t parts = studies::count_parts(chapters, most_costly);
  std::size_t done = 0;
  const auto report_part = [&](const Part& part, const Findings& findings) {
    std::cerr << "part " << ++done << " of " << parts << ": " << part.name << std::endl;
    print(findings);
  };
  return studies::compute_chapters(chapters, most_costly, options.threads, report_part);
}

/// Sweeps of the study, all in one store.
class StudyRun {
 public:
  StudyRun(const std::filesystem::path& store, int threads) : service_(make_options(store, threads)) {
    for (const auto& request : studies::study_requests())
      ids_.push_back(service_.submit_sweep(request).at("id").get<std::string>());
  }

  /// Waits for the sweeps one after the other. @throws Interrupted
  [[nodiscard]] std::vector<jobs::ResultTable> wait(const EndSignals& signals) {
    std::vector<jobs::ResultTable> results;
    for (const std::string& id : ids_) {
      follow(id, signals);
      results.push_back(*service_.find_results(id));
    }
    return results;
  }

  [[nodiscard]] studies::TrajectoryReader trajectory_reader() const {
    return [this](const std::string& job, const std::vector<std::string>& channels, double from) {
      return *service_.find_trajectory(job, {.channels = channels, .from = from, .to = {}});
    };
  }

 private:
  static jobs::ServiceOptions make_options(const std::filesystem::path& store, int threads) {
    jobs::ServiceOptions options;
    options.store = store;
    options.threads = threads;
    options.log = [](const std::string& message) { std::cerr << "rpsup: " << message << '\n'; };
    return options;
  }

  void follow(const std::string& id, const EndSignals& signals) {
    const std::string name = service_.find_sweep(id)->at("name").get<std::string>();
    std::cerr << name << std::endl;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    ProgressView view(std::cerr, terminal ? ProgressView::Form::kBar : ProgressView::Form::kLines);
    while (!service_.wait_for_sweep(id, std::chrono::milliseconds(200))) {
      view.show(*service_.find_sweep(id));
      if (!signals.arrived()) continue;
      view.finish();
      cancel_all();
      throw Interrupted();
    }
    const auto sweep = *service_.find_sweep(id);
    view.show(sweep);
    view.finish();
    if (sweep.at("state") == "succeeded") return;
    throw StudyFailed("a job of \"" + name + "\" failed: " + find_error(id));
  }

  /// Cancels every sweep: jobs that are left would start again with the store.
  void cancel_all() {
    for (const std::string& id : ids_) {
      try {
        service_.cancel_sweep(id);
      } catch (const jobs::WrongState&) {
        // It has ended: nothing is left to cancel.
      }
    }
    service_.stop();
  }

  [[nodiscard]] std::string find_error(const std::string& sweep) const {
    const jobs::ResultTable results = *service_.find_results(sweep);
    for (const auto& row : results.rows) {
      const auto job = *service_.find_job(row.at(0).get<std::string>());
      if (job.at("state") == "succeeded") continue;
      return job.at("id").get<std::string>() + ", " + job.value("error", nlohmann::json()).dump();
    }
    return "";
  }

  jobs::Service service_;
  std::vector<std::string> ids_;
};

std::vector<ComputedChapter> compute_study_chapters(const ValidateOptions& options) {
  const EndSignals signals;  // before the pool's threads, which are to leave them alone
  const TemporaryFolder temporary;
  const std::filesystem::path store(options.store);
  StudyRun run(store.empty() ? temporary.path() / "study.db" : store, options.threads);
  const auto study = studies::make_study(run.wait(signals), run.trajectory_reader());
  auto chapters = studies::study_chapters(study);
  for (const ComputedChapter& chapter : chapters)
    for (const Findings& findings : chapter.findings) print(findings);
  return chapters;
}

std::vector<ComputedChapter> compute_all(const ValidateOptions& options) {
  if (options.quick) return compute_engine_chapters(options);
  // The study first: its store may be refused, if another program has it open.
  std::vector<ComputedChapter> study = compute_study_chapters(options);
  std::vector<ComputedChapter> chapters = compute_engine_chapters(options);
  std::move(study.begin(), study.end(), std::back_inserter(chapters));
  return chapters;
}

/// Lines of the report and of the rows that stand beside it.
struct Fresh {
  std::vector<ReportLine> report;
  std::vector<ReportLine> rows;
};

struct Written {
  std::vector<std::string> report;
  std::vector<std::string> rows;
};

Written read_files(const std::string& report) {
  return {.report = read_lines(report), .rows = read_lines(beside(report, kRowsFile))};
}

/// Replaces a file: the old one stays whole until the new one is.
void replace_file(const std::string& path, const std::string& text) {
  write_text(path + ".tmp", text);
  std::filesystem::rename(path + ".tmp", path);
}

void write_files(const std::string& report, const Fresh& fresh,
                 const std::vector<ComputedChapter>& chapters) {
  replace_file(beside(report, kRowsFile), to_text(fresh.rows));
  replace_file(report, to_text(fresh.report));
  const std::filesystem::path folder(beside(report, kFigureFolder));
  for (const ComputedChapter& chapter : chapters)
    for (const Findings& findings : chapter.findings)
      for (const Figure& figure : findings.figures) write_text((folder / figure.file).string(), figure.svg);
}

/// Prints the differences of a file.
/// @returns whether there is none
bool is_current(const std::string& path, const std::vector<std::string>& differences) {
  for (const std::string& difference : differences) std::cout << path << ", " << difference << '\n';
  if (differences.empty()) std::cout << path << " agrees with this run\n";
  return differences.empty();
}

bool are_current(const std::string& report, const Fresh& fresh, const Written& written) {
  const bool report_is = is_current(report, find_differences(fresh.report, written.report, split_markdown));
  const auto differences = find_differences(fresh.rows, written.rows, split_csv);
  return is_current(beside(report, kRowsFile), differences) && report_is;
}

}  // namespace

int validate(const ValidateOptions& options) {
  check_options(options);
  const Written written = options.check.empty() ? Written{} : read_files(options.check);
  std::vector<ComputedChapter> chapters;
  try {
    chapters = compute_all(options);
  } catch (const Interrupted&) {
    std::cerr << "rpsup: interrupted\n";
    return kInterrupted;
  } catch (const StudyFailed& error) {
    std::cerr << "rpsup: " << error.what() << '\n';
    return kJobFailed;
  }
  const Fresh fresh{.report = write_report(chapters, kFigureFolder), .rows = write_rows(chapters)};
  if (!options.report.empty()) write_files(options.report, fresh, chapters);
  const auto counts = count_checks(chapters);
  std::cout << counts.checks << " comparisons, " << counts.failed << " outside their bounds\n";
  const bool current = options.check.empty() || are_current(options.check, fresh, written);
  return counts.failed == 0 && current ? kDone : kJobFailed;
}

}  // namespace validation::program
