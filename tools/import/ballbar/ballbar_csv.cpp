// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/ballbar_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "tools/format/columns.h"
#include "tools/import/ballbar/ballbar_motion.h"

namespace vernier::importer {
namespace {

constexpr std::array kMotionColumns = {format::AxisQuantity::kSpeed, format::AxisQuantity::kAcceleration,
                                       format::AxisQuantity::kSense, format::AxisQuantity::kSince};

// Positions to 0.1 nm, so that an angle computed from them is good to 1e-7 deg; a reading keeps its five
// decimals.
std::string number(double value) {
  std::string text = fmt::format("{:.7f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::vector<std::string> axes_of(const std::vector<BallbarFile>& files) {
  std::set<std::string> axes;
  for (const auto& file : files) axes.insert({file.axis_a, file.axis_b});
  return {axes.begin(), axes.end()};
}

// With repaired time bases the path angle is a column too: what repeats can be a table of it.
std::string header(const std::vector<std::string>& axes, bool repaired) {
  std::string text = repaired ? "phi[deg]," : "";
  const auto each = [&](format::AxisQuantity quantity) {
    for (const auto& axis : axes) text += format::axis_heading(quantity, axis, false) + ",";
  };
  each(format::AxisQuantity::kPosition);
  for (const format::AxisQuantity quantity : kMotionColumns) each(quantity);
  namespace columns = format::columns;
  return text + format::headings(std::array{columns::kFeed, columns::kCurvature, columns::kTime}) + "," +
         format::headings(columns::kCentre) + "," + format::heading(columns::kLength) + ",sense," +
         format::headings(std::array{columns::kRun, columns::kRole}) + "\n";
}

// A field that a comma or a line end in a file's name could break.
std::string field(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == ',' || c == '"' || c == '#'; },
      '_');
  return text;
}

// Of a run's record, lost samples included.
double length_s(const BallbarRun& run) {
  const double samples =
      run.clock ? run.clock->sample.back() + 1 : static_cast<double>(run.reading_mm.size());
  return samples / run.sample_rate_hz;
}

class Writer {
 public:
  Writer(const std::vector<BallbarFile>& files, const BallbarCsvOptions& options) : axes_(axes_of(files)) {
    // Circles of one path share their file.
    std::set<std::string> paths;
    for (const auto& file : files) {
      if (paths.insert(file.path).second)
        csv_.text += "# ball bar: " + field(std::filesystem::path(file.path).filename().string()) + "\n";
    }
    for (const auto& file : files) {
      for (const auto& run : file.runs) repaired_ = repaired_ || run.clock.has_value();
    }
    csv_.text += fmt::format(
        "# the start of each run after the first is not logged: {} s after the last sample before it\n",
        number(options.pause_s));
    csv_.text += header(axes_, repaired_);
    for (const auto& file : files) {
      for (const auto& run : file.runs) {
        add_run(file, run, label_of(files, file, run));
        time_s_ += length_s(run) + options.pause_s;
      }
    }
  }
  BallbarCsv take() { return std::move(csv_); }

 private:
  std::string label_of(const std::vector<BallbarFile>& files, const BallbarFile& file,
                       const BallbarRun& run) {
    std::string label = run.label;
    const bool several = std::any_of(files.begin(), files.end(),
                                     [&](const BallbarFile& other) { return other.path != file.path; });
    if (several) label = field(std::filesystem::path(file.path).stem().string()) + " " + label;
    const std::string wanted = label;
    for (int n = 2; !labels_.insert(label).second; ++n) label = wanted + "-" + std::to_string(n);
    return label;
  }

  void add_run(const BallbarFile& file, const BallbarRun& run, const std::string& label) {
    csv_.run_labels.push_back(label);
    for (std::size_t i = 0; i < run.reading_mm.size(); ++i) {
      const bool check = i < run.start || i > run.end;
      const CirclePoint point = circle_point(file, run, i);
      if (repaired_) csv_.text += number(point.angle_deg) + ",";
      add_motion(file, point);
      const double sample = run.clock ? run.clock->sample[i] : static_cast<double>(i);
      const bool measured = !run.clock || run.clock->on_circle[i];
      fmt::format_to(std::back_inserter(csv_.text), "{},{},{},0,0,0,{},{},{},{}\n",
                     number(actual_feed_mm_min(file, run)), fmt::format("{:.9g}", 1 / file.radius_mm),
                     number(time_s_ + sample / run.sample_rate_hz),
                     measured ? number(file.nominal_length_mm + run.reading_mm[i]) : "", run.direction, label,
                     check ? "check" : "fit");
      ++csv_.rows;
      ++(check ? csv_.check_rows : csv_.fit_rows);
    }
  }

  // An axis outside the plane of this file is at rest at the programmed centre.
  void add_motion(const BallbarFile& file, const CirclePoint& point) {
    const auto each = [&](const double(&values)[2]) {
      for (const auto& axis : axes_)
        csv_.text += (axis == file.axis_a   ? number(values[0])
                      : axis == file.axis_b ? number(values[1])
                                            : "0") +
                     ",";
    };
    each(point.position_mm);
    each(point.velocity_mm_s);
    each(point.acceleration_mm_s2);
    each({static_cast<double>(point.direction[0]), static_cast<double>(point.direction[1])});
    each(point.since_mm);
  }

  std::vector<std::string> axes_;
  std::set<std::string> labels_;
  double time_s_ = 0;
  bool repaired_ = false;
  BallbarCsv csv_;
};

}  // namespace

BallbarCsv ballbar_csv(const std::vector<BallbarFile>& files, const BallbarCsvOptions& options) {
  return Writer(files, options).take();
}

}  // namespace vernier::importer
