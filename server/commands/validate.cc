#include "server/commands/validate.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <utility>

#include "engine/validation/chapters.h"
#include "engine/validation/report.h"
#include "jobs/service.h"
#include "jobs/validation/compute.h"
#include "jobs/validation/study_chapters.h"
#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"

namespace server::commands {

namespace {

using engine::validation::ComputedChapter;
using engine::validation::Cost;
using engine::validation::Findings;
using engine::validation::Part;
using engine::validation::ReportLine;

constexpr const char* kFigureFolder = "validation/figures";

/// Ctrl-C, or the end of the service's life.
struct Interrupted {};

/// A folder that is gone when this is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "rpsup-validate-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw CannotWrite("cannot make a folder in " + std::filesystem::temp_directory_path().string());
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

void check_options(const ValidateOptions& options) {
  if (options.quick && !(options.report.empty() && options.check.empty()))
    throw BadInput("--quick leaves out part of the report: it goes with neither --report nor --check");
  if (options.report.empty()) return;
  const auto folder = std::filesystem::absolute(options.report).parent_path();
  if (!std::filesystem::is_directory(folder)) throw BadInput("--report " + options.report + ": there is no folder " + folder.string());
}

std::vector<std::string> read_lines(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw BadInput("cannot read " + path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

void print(const Findings& findings) {
  for (const engine::validation::Check& check : findings.checks) std::cout << describe(check) << '\n';
  std::cout << std::flush;
}

std::vector<ComputedChapter> compute_engine_chapters(const ValidateOptions& options, const EndSignals& signals) {
  auto chapters = jobs::validation::compute_chapters(engine::validation::engine_chapters(), options.quick ? Cost::kLight : Cost::kHeavy,
                                                     options.threads, [&](const Part&, const Findings& findings) {
                                                       print(findings);
                                                       return !signals.arrived();
                                                     });
  if (chapters.empty()) throw Interrupted();
  return chapters;
}

void follow(jobs::Service& service, const std::string& id, const EndSignals& signals) {
  ProgressView view(std::cerr, isatty(STDERR_FILENO) != 0 ? ProgressView::Form::kBar : ProgressView::Form::kLines);
  while (!service.wait_for_sweep(id, std::chrono::milliseconds(200))) {
    view.show(*service.find_sweep(id));
    if (signals.arrived()) throw Interrupted();
  }
  view.show(*service.find_sweep(id));
  view.finish();
}

std::vector<ComputedChapter> compute_study_chapters(const ValidateOptions& options, const std::filesystem::path& store, const EndSignals& signals) {
  jobs::ServiceOptions service_options;
  service_options.store = store;
  service_options.threads = options.threads;
  service_options.log = [](const std::string& message) { std::cerr << "rpsup: " << message << '\n'; };
  jobs::Service service(service_options);
  std::vector<std::string> ids;
  for (const auto& request : jobs::validation::study_requests()) ids.push_back(service.submit_sweep(request).at("id").get<std::string>());
  std::vector<jobs::ResultTable> results;
  for (const std::string& id : ids) {
    std::cerr << service.find_sweep(id)->at("name").get<std::string>() << '\n';
    follow(service, id, signals);
    results.push_back(*service.find_results(id));
  }
  const auto study = jobs::validation::make_study(
      std::move(results), [&service](const std::string& job, const std::vector<std::string>& channels, double from) {
        return *service.find_trajectory(job, {.channels = channels, .from = from, .to = {}});
      });
  auto chapters = jobs::validation::study_chapters(study);
  for (const ComputedChapter& chapter : chapters)
    for (const Findings& findings : chapter.findings) print(findings);
  return chapters;
}

std::vector<ComputedChapter> compute_all(const ValidateOptions& options) {
  const EndSignals signals;
  std::vector<ComputedChapter> chapters = compute_engine_chapters(options, signals);
  if (options.quick) return chapters;
  const TemporaryFolder temporary;
  const std::filesystem::path store = options.store.empty() ? temporary.path() / "study.db" : std::filesystem::path(options.store);
  for (ComputedChapter& chapter : compute_study_chapters(options, store, signals)) chapters.push_back(std::move(chapter));
  return chapters;
}

void write_files(const std::string& report, const std::vector<ReportLine>& lines, const std::vector<ComputedChapter>& chapters) {
  const auto before = std::filesystem::exists(report) ? read_lines(report) : std::vector<std::string>{};
  write_text(report, engine::validation::to_text(lines, engine::validation::take_faults(before).faults));
  const auto folder = std::filesystem::absolute(report).parent_path() / kFigureFolder;
  std::filesystem::create_directories(folder);
  for (const ComputedChapter& chapter : chapters)
    for (const Findings& findings : chapter.findings)
      for (const engine::validation::Figure& figure : findings.figures) write_text((folder / figure.file).string(), figure.svg);
}

bool says_the_same(const std::string& path, const std::vector<std::string>& written, const std::vector<ReportLine>& fresh) {
  const auto differences = engine::validation::find_differences(fresh, engine::validation::take_faults(written).lines);
  for (const std::string& difference : differences) std::cout << path << ", " << difference << '\n';
  if (differences.empty()) std::cout << path << " says what this run has found\n";
  return differences.empty();
}

}  // namespace

int validate(const ValidateOptions& options) {
  check_options(options);
  const auto written = options.check.empty() ? std::vector<std::string>{} : read_lines(options.check);
  std::vector<ComputedChapter> chapters;
  try {
    chapters = compute_all(options);
  } catch (const Interrupted&) {
    std::cerr << "rpsup: interrupted\n";
    return kInterrupted;
  }
  const auto lines = engine::validation::write_report(chapters, kFigureFolder);
  if (!options.report.empty()) write_files(options.report, lines, chapters);
  const auto counts = engine::validation::count_checks(chapters);
  std::cout << counts.checks << " comparisons, " << counts.failed << " outside their bounds\n";
  const bool current = options.check.empty() || says_the_same(options.check, written, lines);
  return counts.failed == 0 && current ? kDone : kJobFailed;
}

}  // namespace server::commands
