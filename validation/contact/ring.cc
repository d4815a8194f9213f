// SPDX-License-Identifier: Apache-2.0
// The ring of elements against the integral that it is a sum for, and that integral against Hertz's law.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/clearance/clearance_joint.h"
#include "charts/chart.h"
#include "validation/contact/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/largest.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kDepths[] = {0.5e-6, 1e-6, 5e-6};  // [m]
constexpr int kNumbers[] = {36, 72, 180, 360, 720};
constexpr int kDirections = 64;  // from one element to the next

/// The study's two rings, which share K.
ClearanceParameters two_levels() {
  ClearanceParameters joint = one_ring();
  joint.n_r = 2;
  return joint;
}

/// The journal's offset in a ring: the geometry of a contact of some depth.
struct Arc {
  ClearanceParameters joint;
  double depth;  ///< [m]

  [[nodiscard]] double e() const { return joint.c_r + depth; }
  [[nodiscard]] double R() const { return e() + joint.r_j(); }
  /// Elements at angle theta from the offset are depth - a theta^2 / 2 deep, but for terms of theta^4.
  [[nodiscard]] double a() const { return e() * joint.r_j() / R(); }
  /// Angle at which the depth is zero.
  [[nodiscard]] double half_angle() const {
    const double r_j = joint.r_j();
    return std::acos((joint.r_b * joint.r_b - r_j * r_j - e() * e()) / (2.0 * e() * r_j));
  }
  /// Stiffness of the elements per angle, the paper's: K 3 sqrt(c_r) / (4 sqrt 2).
  [[nodiscard]] double stiffness_per_angle() const {
    return joint.K * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::numbers::sqrt2);
  }
};

/// Force of infinitely many elements against the offset: the integral over the arc, by Simpson's rule.
double integrate_ring(const Arc& arc) {
  constexpr int kPanels = 4000;
  const double r_j = arc.joint.r_j();
  const double end = arc.half_angle();
  const auto density = [&](double theta) {
    const double x = arc.e() + r_j * std::cos(theta);
    const double rho = std::hypot(x, r_j * std::sin(theta));
    return (rho - arc.joint.r_b) * x / rho;
  };
  double sum = density(0.0) + density(end);
  for (int k = 1; k < kPanels; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * density(end * k / kPanels);
  return arc.stiffness_per_angle() * 2.0 * sum * end / kPanels / 3.0;
}

/// The same integral over Hertz's force, expanded: Delta = delta - a theta^2 / 2 + (a / 24 - a^2 / (8 R))
/// theta^4, times the normal's cosine 1 - (r_j / R)^2 theta^2 / 2.
double expand_ring_ratio(const Arc& arc) {
  const double a = arc.a();
  const double g = std::pow(arc.joint.r_j() / arc.R(), 2);
  return std::sqrt(arc.joint.c_r / a) *
         (1.0 + arc.depth / (20.0 * a) - 3.0 * arc.depth / (20.0 * arc.R()) - 0.2 * g * arc.depth / a);
}

/// Relative error of a sum with the pitch h for the integral of a parabola that is cut off at its zeros: each
/// of the two kinks adds h^2 / 2 times its change of slope times B_2 of its place between two elements (Euler
/// and Maclaurin). The largest that can be.
double error_bound(const Arc& arc, int n_ce) {
  const double h = 2.0 * std::numbers::pi / n_ce;
  return h * h * arc.a() / (8.0 * arc.depth);  // B_2 is 1/6 at most
}

double bernoulli_2(double x) {
  const double place = x - std::floor(x);
  return place * place - place + 1.0 / 6.0;
}

/// The largest that the same gives for the directions looked at.
double estimate_error(const Arc& arc, int n_ce) {
  const double end = arc.half_angle() * n_ce / (2.0 * std::numbers::pi);
  Largest largest;
  for (int k = 0; k < kDirections; ++k) {
    const double direction = static_cast<double>(k) / kDirections;
    largest.take(bernoulli_2(end - direction) + bernoulli_2(end + direction));
  }
  return 3.0 * largest.value() * error_bound(arc, n_ce);
}

/// Force of the engine's ring against the offset.
/// @param direction  of the offset, from the first element, [rad]
double ring_force(const Arc& arc, int n_ce, double direction) {
  ClearanceParameters parameters = arc.joint;
  parameters.form = RadialForm::kElements;
  parameters.n_ce = n_ce;
  ClearanceJoint joint(parameters);
  const Eigen::Vector3d n(std::cos(direction), std::sin(direction), 0.0);
  JournalMotion journal;
  journal.p_bj = arc.e() * n;
  std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()));
  std::vector<double> rates(bristles.size());
  (void)joint.follow(journal, 0.0, bristles.data());
  ContactLoad load;
  (void)joint.calc(journal, bristles.data(), rates.data(), load);
  return 0.0 - load.force.dot(n);
}

/// The ring's force over Hertz's, for directions between two elements.
struct Ratios {
  std::vector<double> of{};
  double mean = 0.0;

  [[nodiscard]] double least() const { return *std::min_element(of.begin(), of.end()); }
  [[nodiscard]] double most() const { return *std::max_element(of.begin(), of.end()); }
  [[nodiscard]] double largest_error(double limit) const {
    Largest error;
    for (const double ratio : of) error.take(ratio / limit - 1.0);
    return error.value();
  }
};
Ratios sample_directions(const Arc& arc, int n_ce) {
  const double hertz = arc.joint.K * std::pow(arc.depth, 1.5);
  Ratios ratios;
  for (int k = 0; k < kDirections; ++k) {
    const double ratio = ring_force(arc, n_ce, 2.0 * std::numbers::pi / n_ce * k / kDirections) / hertz;
    ratios.of.push_back(ratio);
    ratios.mean += ratio / kDirections;
  }
  return ratios;
}

/// Fewest and most elements that touch, over the directions.
std::string elements_in(const Arc& arc, int n_ce) {
  const double elements = 2.0 * arc.half_angle() * n_ce / (2.0 * std::numbers::pi);
  const int least = static_cast<int>(std::floor(elements));
  return std::to_string(least) + " or " + std::to_string(least + 1);
}

/// Slope of the straight line nearest to log(errors) over log(numbers).
double fit_order(const std::vector<double>& numbers, const std::vector<double>& errors) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    x += std::log(numbers[i]) / n;
    y += std::log(errors[i]) / n;
    xx += std::log(numbers[i]) * std::log(numbers[i]) / n;
    xy += std::log(numbers[i]) * std::log(errors[i]) / n;
  }
  return (xy - x * y) / (xx - x * x);
}

/// One depth: rows of the table, a line of the figure, checks.
void add_depth(const Arc& arc, const char* colour, Findings& findings, Table& table, charts::Chart& chart) {
  const std::string at = ", " + number(1e6 * arc.depth) + " um deep";
  const double limit_ratio = integrate_ring(arc) / (arc.joint.K * std::pow(arc.depth, 1.5));
  charts::Series line{
      .label = number(1e6 * arc.depth) + " um", .x = {}, .y = {}, .colour = colour, .markers = true};
  Largest over_bound;
  for (const int n_ce : kNumbers) {
    const Ratios ratios = sample_directions(arc, n_ce);
    const double error = ratios.largest_error(limit_ratio);
    line.x.push_back(n_ce);
    line.y.push_back(error);
    over_bound.take(error / error_bound(arc, n_ce));
    table.rows.push_back({number(1e6 * arc.depth), std::to_string(n_ce), elements_in(arc, n_ce),
                          number(ratios.least(), 5), number(ratios.most(), 5), number(ratios.mean, 5),
                          number(100.0 * error, 3), number(100.0 * estimate_error(arc, n_ce), 3)});
  }
  findings.checks.push_back(
      limit("largest error of rings of 36 to 720 elements, over its bound" + at,
            "sum for an integral with two kinks: h^2 a / (8 delta), h = 2 pi / n_ce, a = e r_j / (e + r_j)",
            over_bound.value(), 1.0, "1", "the bound is that of the leading term, h^2"));
  findings.checks.push_back(
      compare("largest error of 720 elements, over its estimate" + at,
              "h^2 a / (8 delta) times the largest 3 (B_2 + B_2) of the arc's two ends between elements",
              line.y.back() / estimate_error(arc, kNumbers[std::size(kNumbers) - 1]), 1.0, 0.05, "1",
              "third power of h, delta / c_r: each about 2 %"));
  if (arc.depth > 2e-6)
    findings.checks.push_back(compare(
        "order of that error in n_ce, 36 to 720" + at, "-2", fit_order(line.x, line.y), -2.0, 0.1, "1",
        "from one n_ce to the next the arc's ends lie otherwise between elements: a factor of 1 to 2"));
  const Ratios fine = sample_directions(arc, 720);
  findings.checks.push_back(compare("mean force of 720 elements over directions, over Hertz's" + at,
                                    "integral over the ring, by Simpson's rule", fine.mean, limit_ratio,
                                    1.2 * error_bound(arc, 720 * kDirections) * limit_ratio, "1",
                                    "the mean over 64 directions is a sum of 720 * 64 elements: h^2 a / (8 "
                                    "delta), and a fifth of it for higher terms"));
  const double x = arc.depth / arc.a();
  findings.checks.push_back(compare(
      "mean force of 720 elements over directions, over Hertz's" + at,
      "sqrt(c_r / a) (1 + delta / (20 a) - 3 delta / (20 R) - (r_j / R)^2 delta / (5 a)), R = e + r_j",
      fine.mean, expand_ring_ratio(arc), 0.05 * x * x + 1e-5, "1",
      "terms of the order of (delta / a)^2, and 1e-5 for the sum"));
  chart.series.push_back(std::move(line));
}

}  // namespace

Findings compute_ring_of_elements() {
  Findings findings;
  Table table{.caption =
                  "Force of the engine's ring of elements over Hertz's K delta^1.5 (two levels, c_r = 0.25 "
                  "mm, r_b = 5 mm) for 64 directions between two "
                  "elements. The error is against the integral over the ring, n_ce to infinity. It falls "
                  "like n_ce^-2, and from one n_ce "
                  "to the next by more or less, as the ends of the arc lie between elements; where no "
                  "element or a single one is in the arc, it is no "
                  "error of a sum any more.",
              .head = {"depth [um]", "n_ce", "elements that touch", "least", "most", "mean",
                       "largest error [%]", "its estimate [%]"},
              .rows = {},
              .keys = 2};
  charts::Chart chart{.title = "Ring of elements: error of the force",
              .x_label = "n_ce",
              .y_label = "largest error over directions",
              .x_scale = charts::Scale::kLog,
              .y_scale = charts::Scale::kLog, .y_min = 1e-4, .y_max = 10.0,
              .series = {}};
  const char* colours[] = {charts::kOrange, charts::kGreen, charts::kBlue};
  for (std::size_t k = 0; k < std::size(kDepths); ++k)
    add_depth({two_levels(), kDepths[k]}, colours[k], findings, table, chart);
  charts::Series slope{
      .label = "n_ce^-2", .x = {36.0, 720.0}, .y = {0.1, 0.1 / 400.0}, .colour = charts::kGrey};
  chart.series.push_back(std::move(slope));

  Table limits{.caption =
                   "What is left with infinitely many elements: the integral over the ring, over Hertz's "
                   "force. The paper's element stiffness "
                   "is derived for a shallow arc of the bore's own curvature, so the ratio tends to sqrt(r_b "
                   "/ r_j) = 1.0260, and falls with the "
                   "depth.",
               .head = {"depth [um]", "integral", "expansion in delta / c_r and c_r / r_j",
                        "half of the arc [degrees]"},
               .rows = {}};
  for (const double depth : {0.01e-6, 0.5e-6, 1e-6, 5e-6, 20e-6}) {
    const Arc arc{one_ring(), depth};
    limits.rows.push_back(
        {number(1e6 * depth), number(integrate_ring(arc) / (arc.joint.K * std::pow(depth, 1.5)), 6),
         number(expand_ring_ratio(arc), 6), number(arc.half_angle() * 180.0 / std::numbers::pi, 3)});
  }
  findings.tables = {std::move(table), std::move(limits)};
  findings.figures.push_back(
      {.file = "ring_of_elements.svg",
       .caption =
           "Error of the ring's force against the integral, largest over 64 directions, c_r = 0.25 mm.",
       .svg = charts::draw({chart}, 1)});
  return findings;
}

}  // namespace validation
