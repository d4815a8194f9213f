// SPDX-License-Identifier: Apache-2.0
#include "validation/report/report.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "validation/support/text.h"

namespace validation {

namespace {

constexpr const char* kTitle = "# Why the numbers may be believed";

constexpr const char* kIntroduction =
    R"(The validation compares results of the engine with results that the engine did not compute: closed
forms, published numbers, other codes. Some rows use a second route instead, and say so: energies of the
engine, another integrator, another way to enforce the drives, other tolerances. No row compares a joint with
clearance with a measurement in a laboratory. Each comparison has a bound and a reason for the bound: rounding,
truncation, or the number of known digits.

[rows.csv](rows.csv) holds all rows. A row begins with the names of its chapter and its section:

```sh
grep '^contact,' validation/rows.csv                                 # rows of a chapter
grep '^contact,rebounds_obey_the_closed_form,' validation/rows.csv   # rows of a section
```

The columns `ours` and `reference` hold the engine's value and the value of the `source`. Both are empty
where only the `difference` makes sense, of matrices for instance. The column `holds` says whether the
difference is within its `bound`, and `note` gives the reason for the bound. A row without bound is a number
of a table; the `note` of the table's first row explains the table.

`build/release/rpsup-validate --report FILE` overwrites FILE with this report, and rows and figures beside
it. A test runs `--check FILE`, which computes all again and compares every line. `--quick` computes the light
rows and writes no report. Each section of chapters 1 to 10 is also a test of its own, for example
`engine_tests --gtest_filter='*/rebounds_obey_the_closed_form'`. [FITS.md](FITS.md) tries fits.
)";

constexpr const char* kFaults =
    R"(A proof that cannot fail proves nothing. `script/faults` plants faults in copies of the engine, one at
a time: a changed sign, a factor of 2, a missing term, two exchanged frames. It then runs the engine's light
tests, most of which are sections of the chapters above. `tests/faults/faults.txt` lists the faults.
[found.csv](../tests/faults/found.csv) names a test that failed with each fault, and a test checks
that every fault has one. `script/faults --report tests/faults/found.csv` plants all faults and writes that
file.)";

/// Text of a cell: a bar would end the cell.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? "\\|" : std::string(1, c);
  return safe;
}

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& text : cells) line += " " + cell(text) + " |";
  return line;
}

std::string rule(std::size_t columns) {
  std::string line = "|";
  for (std::size_t k = 0; k < columns; ++k) line += "---|";
  return line;
}

/// Difference over bound; infinite where nothing is allowed or the difference is no number.
double share_of_bound(const Check& check) {
  if (check.difference == 0.0) return 0.0;
  const double share = check.difference / check.bound;
  return std::isnan(share) ? std::numeric_limits<double>::infinity() : share;
}

struct Summary {
  Counts counts;
  const Check* worst = nullptr;  ///< comparison with the largest share of its bound
};

Summary summarise(const ComputedChapter& computed) {
  Summary summary;
  for (const Findings& findings : computed.findings)
    for (const Check& check : findings.checks) {
      ++summary.counts.checks;
      summary.counts.failed += check.holds() ? 0 : 1;
      if (!summary.worst || share_of_bound(check) > share_of_bound(*summary.worst)) summary.worst = &check;
    }
  return summary;
}

std::string describe_counts(const Counts& counts) {
  if (counts.failed == 0) return "all within their bounds";
  return std::to_string(counts.failed) + " **outside their bounds**";
}

Tolerance tolerance_to(double reproducible_to) {
  if (reproducible_to < 1.0) return {.relative = reproducible_to};
  return {.factor = reproducible_to, .floor = 1e-6};
}

class ReportWriter {
 public:
  explicit ReportWriter(const std::string& figure_folder) : figure_folder_(figure_folder) {}

  void add_introduction(const std::vector<ComputedChapter>& chapters) {
    add(kTitle);
    add("");
    add_paragraphs(kIntroduction);
    add("");
    const Counts counts = count_checks(chapters);
    add(std::to_string(counts.checks) + " comparisons, " + describe_counts(counts) + ".");
    add("");
    add_summary(chapters);
    if (counts.failed > 0) add_failures(chapters);
  }

  void add_chapter(const ComputedChapter& computed, std::size_t number) {
    const Chapter& chapter = computed.chapter;
    add_heading(chapter.title, number);
    if (!chapter.text.empty()) {
      add_paragraphs(chapter.text);
      add("");
    }
    for (const Findings& findings : computed.findings) {
      for (const Table& table : findings.tables)
        if (table.place == Place::kInReport) add_table(table);
      for (const Figure& figure : findings.figures)
        if (figure.place == Place::kInReport) add_figure(figure);
    }
    add_links(computed);
  }

  void add_faults(std::size_t number) {
    add_heading("Planted faults", number);
    add_paragraphs(kFaults);
  }

  std::vector<ReportLine> take() { return std::move(lines_); }

 private:
  void add(const std::string& text, std::vector<Tolerance> cells = {}) {
    lines_.push_back({text, std::move(cells)});
  }

  void add_heading(const std::string& title, std::size_t number) {
    add("## " + std::to_string(number) + " " + title);
    add("");
  }

  void add_paragraphs(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) add(line);
  }

  void add_head(const std::vector<std::string>& head) {
    add(row(head));
    add(rule(head.size()));
  }

  /// A row for each chapter. Rounding may decide which comparison is the worst.
  void add_summary(const std::vector<ComputedChapter>& chapters) {
    const Tolerance share{.factor = 30.0, .floor = 0.1};
    const Tolerance worst{.other_words = true};
    add_head({"", "chapter", "name", "comparisons", "outside bounds", "worst: difference / bound", "worst"});
    for (std::size_t k = 0; k < chapters.size(); ++k) {
      const Chapter& chapter = chapters[k].chapter;
      const Summary summary = summarise(chapters[k]);
      const Counts& counts = summary.counts;
      std::vector<std::string> cells{std::to_string(k + 1), chapter.title, '`' + chapter.name + '`',
                                     std::to_string(counts.checks), std::to_string(counts.failed)};
      if (summary.worst) {
        cells.push_back(number(share_of_bound(*summary.worst), 2));
        cells.push_back(summary.worst->what);
      }
      cells.resize(7);
      add(row(cells), {{}, {}, {}, {}, {}, share, worst});
    }
    add("");
  }

  void add_failures(const std::vector<ComputedChapter>& chapters) {
    add("Outside their bounds:");
    add("");
    for (const ComputedChapter& computed : chapters)
      for (const Findings& findings : computed.findings)
        for (const Check& check : findings.checks)
          if (!check.holds()) add("- " + describe(check));
    add("");
  }

  void add_table(const Table& table) {
    add(table.caption, {tolerance_of(table)});
    add("");
    add_head(table.head);
    for (std::size_t k = 0; k < table.rows.size(); ++k)
      add(row(table.rows[k]), std::vector<Tolerance>(table.rows[k].size(), tolerance_of_row(table, k)));
    add("");
  }

  void add_figure(const Figure& figure) {
    add("![" + figure.file + "](" + path_of(figure) + ")");
    add("");
    add("*" + figure.caption + "*");
    add("");
  }

  void add_links(const ComputedChapter& computed) {
    std::vector<std::string> links;
    for (const Findings& findings : computed.findings)
      for (const Figure& figure : findings.figures)
        if (figure.place == Place::kBeside)
          links.push_back("- [" + figure.caption + "](" + path_of(figure) + ')');
    if (links.empty()) return;
    add("Figures:");
    add("");
    for (const std::string& link : links) add(link);
    add("");
  }

  [[nodiscard]] std::string path_of(const Figure& figure) const { return figure_folder_ + '/' + figure.file; }

  std::string figure_folder_;
  std::vector<ReportLine> lines_;
};

}  // namespace

Counts count_checks(const std::vector<ComputedChapter>& chapters) {
  Counts counts;
  for (const ComputedChapter& computed : chapters) {
    const Summary summary = summarise(computed);
    counts.checks += summary.counts.checks;
    counts.failed += summary.counts.failed;
  }
  return counts;
}

std::string describe(const Check& check) {
  const std::string verdict = check.holds() ? "ok      " : "FAILED  ";
  const std::string unit = check.unit == "1" ? "" : ' ' + check.unit;
  const std::string difference = number(check.difference, 2) + unit;
  return verdict + check.what + ": difference " + difference + ", bound " + number(check.bound);
}

Tolerance tolerance_of(const Table& table) { return tolerance_to(table.reproducible_to); }

Tolerance tolerance_of_row(const Table& table, std::size_t row) {
  const auto& rows = table.row_reproducible_to;
  return rows.empty() ? tolerance_of(table) : tolerance_to(rows.at(row));
}

std::vector<ReportLine> write_report(const std::vector<ComputedChapter>& chapters,
                                     const std::string& figure_folder) {
  ReportWriter report(figure_folder);
  report.add_introduction(chapters);
  for (std::size_t k = 0; k < chapters.size(); ++k) report.add_chapter(chapters[k], k + 1);
  report.add_faults(chapters.size() + 1);
  return report.take();
}

}  // namespace validation
