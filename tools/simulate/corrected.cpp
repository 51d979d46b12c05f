// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/corrected.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>

#include "comp/compensator.h"
#include "tools/compile/compile.h"
#include "tools/format/columns.h"
#include "tools/simulate/counts.h"
#include "tools/simulate/loop.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::simulate {
namespace {

using Index = Eigen::Index;
namespace fs = std::filesystem;

/// Half a day of a board's ticks. An equation needs about a microsecond on this computer.
constexpr double kMostTicks = 4e7;

/// The compiled directories below a folder, opened when a row needs one.
class ImageFolder {
 public:
  explicit ImageFolder(std::string directory) : directory_(std::move(directory)) {
    std::error_code failed;
    const fs::path root(directory_);
    if (!fs::is_directory(root, failed))
      throw text::InputError(fmt::format("\"{}\": this directory does not exist", directory_));
    look_at(root);
    for (fs::recursive_directory_iterator it(root, fs::directory_options::skip_permission_denied, failed),
         end;
         !failed && it != end; it.increment(failed))
      if (it->is_directory(failed)) look_at(it->path());
    if (failed) throw text::InputError("\"" + directory_ + "\": " + failed.message());
  }

  /// Throws InputError if no directory contains it.
  const compile::LoadedImage& image(const std::string& fingerprint, const text::Place& place) {
    const auto found = directories_.find(fingerprint);
    if (found == directories_.end())
      throw text::InputError(place, fingerprint, "no image below " + directory_ + " has this fingerprint");
    std::unique_ptr<compile::LoadedImage>& open = open_[fingerprint];
    if (!open) open = compile::load_image_dir(found->second);
    return *open;
  }

 private:
  void look_at(const fs::path& directory) {
    std::error_code failed;
    if (!fs::is_regular_file(directory / "machine.vimg", failed) ||
        !fs::is_regular_file(directory / "machine.xml", failed))
      return;
    const std::string bytes = text::read_file((directory / "machine.vimg").string());
    ImageHeader header;
    if (bytes.size() < sizeof(header)) return;  // not an image, and no row can refer to it
    std::memcpy(&header, bytes.data(), sizeof(header));
    directories_.emplace(text::fingerprint_text(header.fingerprint), directory.string());
  }

  std::string directory_;
  std::map<std::string, std::string> directories_;
  std::map<std::string, std::unique_ptr<compile::LoadedImage>> open_;
};

/// Returns the inputs of the board for a row of states bound to the image's machine.
CycleInput cycle_input(const model::Machine& machine, const model::States& s, Index row) {
  PlantState told;
  tell_state(machine, s, row, told);
  CycleInput input;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const AxisReading& from = told.axis[i];
    input.axis[i] = {.position = from.position,
                     .velocity = from.velocity,
                     .acceleration = from.acceleration,
                     .since = from.since,
                     .sense = from.sense};
  }
  for (std::size_t i = 0; i < machine.inputs.size(); ++i) input.input[i] = told.input[i];
  input.feed = told.path.feed;
  input.curvature = told.path.curvature;
  input.time = TimeUs(counts(1e6 * s.time[row]));
  input.visit = told.path.visit;
  return input;
}

/// Returns a tick between two rows. Continuous quantities are interpolated linearly. Held
/// quantities are those of the first row.
CycleInput between(const CycleInput& from, const CycleInput& to, double share) {
  CycleInput mid = from;
  const auto mix = [share](auto& value, const auto& target) {
    const auto way = static_cast<double>(target.count - value.count);
    value.count += static_cast<decltype(value.count)>(std::llround(share * way));
  };
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    mix(mid.axis[i].position, to.axis[i].position);
    mix(mid.axis[i].velocity, to.axis[i].velocity);
    mix(mid.axis[i].acceleration, to.axis[i].acceleration);
  }
  for (std::size_t i = 0; i < kMaxInputs; ++i) mix(mid.input[i], to.input[i]);
  mix(mid.feed, to.feed);
  mix(mid.curvature, to.curvature);
  mix(mid.time, to.time);
  return mid;
}

/// The corrections of one image along the rows of a measurement that is bound to the image's machine: mm or
/// deg, by axis of the image.
class ImageRun {
 public:
  ImageRun(const compile::LoadedImage& image, const model::Measurement& rows)
      : image_(image), rows_(rows), compensator_(std::make_unique<Compensator>(image.view.program())) {
    result_.assign(image.machine.axes.size(), model::Column::Zero(static_cast<Index>(rows.rows())));
  }

  std::vector<model::Column> corrections() {
    const bool remembers = image_.view.program().equation.lag_count > 0;
    if (remembers && !rows_.has_recorded(format::columns::kTime))
      throw text::InputError({rows_.files.front(), 0}, format::columns::kTime,
                             "the image that ran has terms with lag, which require this column");
    if (remembers) model::require_time_order(rows_);
    std::vector<std::size_t> last(rows_.states.names(rows_.states.clock).size(), rows_.rows());
    // Clock by clock, because a lag restarts with each.
    for (std::size_t clock = 0; clock < last.size(); ++clock) {
      compensator_->reset();
      for (std::size_t row = 0; row < rows_.rows(); ++row) {
        if (rows_.states.of(rows_.states.clock, row) != clock) continue;
        if (remembers && last[clock] < rows_.rows()) walk(last[clock], row);
        last[clock] = row;
        note(row, compensator_->step(input_of(row)));
      }
    }
    return std::move(result_);
  }

 private:
  /// Executes the ticks between two rows, so that lags have their correct state.
  void walk(std::size_t before, std::size_t after) {
    const model::Column& t = rows_.states.time;
    const double ticks =
        (t[static_cast<Index>(after)] - t[static_cast<Index>(before)]) * 1e6 / image_.view.header().tick_us;
    if ((ticks_ += ticks) > kMostTicks)
      throw text::InputError({rows_.files.front(), rows_.line[after]}, format::columns::kTime,
                             "the image that ran has terms with lag, and there are more than forty million "
                             "ticks before this row");
    const auto count = std::llround(ticks);
    const CycleInput from = input_of(before), to = input_of(after);
    for (long long k = 1; k < count; ++k)
      compensator_->step(between(from, to, static_cast<double>(k) / static_cast<double>(count)));
  }

  CycleInput input_of(std::size_t row) const {
    return cycle_input(image_.machine, rows_.states, static_cast<Index>(row));
  }

  void note(std::size_t row, const CycleOutput& output) {
    for (std::size_t i = 0; i < result_.size(); ++i)
      result_[i][static_cast<Index>(row)] =
          output.wanted[i].counts / (image_.machine.axes[i].rotary ? kCountsPerDeg : kCountsPerMm);
  }

  const compile::LoadedImage& image_;
  const model::Measurement& rows_;
  std::unique_ptr<Compensator> compensator_;
  std::vector<model::Column> result_;
  double ticks_ = 0;
};

/// Applies the correction of one image to the rows of a file in which it was active.
void apply(const compile::LoadedImage& image, const std::string& fingerprint, const model::Machine& machine,
           const std::string& text, model::Measurement& m) {
  // Bound to the image's machine: its inputs may be columns that this machine does not declare.
  const model::Measurement own =
      model::parse_measurement(text, m.files.front(), image.machine, [](auto&&...) {});
  std::map<std::size_t, Index> row_on_line;
  for (std::size_t row = 0; row < own.rows(); ++row) row_on_line[own.line[row]] = static_cast<Index>(row);
  const std::vector<model::Column> corrections = ImageRun(image, own).corrections();
  for (std::size_t row = 0; row < m.rows(); ++row) {
    if (m.corrected[row] != fingerprint) continue;
    const text::Place place{m.files.front(), m.line[row]};
    const auto found = row_on_line.find(m.line[row]);
    if (found == row_on_line.end())
      throw text::InputError(place, fingerprint, "an input of this image is empty in this row");
    for (std::size_t i = 0; i < corrections.size(); ++i) {
      const auto axis = machine.find_axis(image.machine.axes[i].name);
      if (!axis)
        throw text::InputError(place, image.machine.axes[i].name,
                               "the machine file lacks this axis of the image");
      m.correction[*axis][static_cast<Index>(row)] = corrections[i][found->second];
    }
  }
}

}  // namespace

model::ImageCorrection corrections_of_images(const std::string& directory) {
  if (directory.empty()) return {};
  return [folder = std::make_shared<ImageFolder>(directory)](
             model::Measurement& m, const model::Machine& machine, const std::string& text) {
    std::map<std::string, std::size_t> first_row;
    for (std::size_t row = 0; row < m.rows(); ++row)
      if (!m.corrected[row].empty()) first_row.emplace(m.corrected[row], row);
    for (const auto& [fingerprint, row] : first_row)
      apply(folder->image(fingerprint, {m.files.front(), m.line[row]}), fingerprint, machine, text, m);
  };
}

}  // namespace vernier::simulate
