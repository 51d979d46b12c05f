// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "tools/commands/command.h"
#include "tools/format/columns.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/vibration/displacement_column.h"
#include "tools/vibration/feature_rows.h"

namespace vernier::commands::features_cli {
namespace {

using Json = nlohmann::ordered_json;

struct FeaturesArguments {
  std::string record, output, json, rows, align;
  std::vector<std::string> features, differences, positions;
  std::size_t window = 1500, every = 0;
  std::optional<double> rate_Hz;
  double offset_s = 0, clock_rate = 1, reach_mm = 20;
  bool centred = false;
  std::string corner, cutoff;
  double resolution = 1e-5;
  std::vector<std::string> against;
};

using Ends = std::vector<std::optional<std::size_t>>;

bool wants_displacement(const FeaturesArguments& arguments) {
  return std::count(arguments.features.begin(), arguments.features.end(), vibration::kDisplacementName) != 0;
}

vibration::FeatureChoice choice_of(const FeaturesArguments& arguments) {
  vibration::FeatureChoice choice;
  choice.window = arguments.window;
  choice.centred = arguments.centred;
  if (choice.window < 2) throw text::InputError("--window: two samples at least");
  for (std::size_t i = 0; i < vibration::kFeatureNames.size(); ++i) {
    const bool named =
        std::count(arguments.features.begin(), arguments.features.end(), vibration::kFeatureNames[i]) != 0;
    if (arguments.features.empty() ? i < 11 : named) choice.features.push_back(i);
  }
  const std::size_t named = choice.features.size() + (wants_displacement(arguments) ? 1 : 0);
  if (!arguments.features.empty() && named != arguments.features.size())
    throw text::InputError(fmt::format("--features: one of {} {}", fmt::join(vibration::kFeatureNames, " "),
                                       vibration::kDisplacementName));
  return choice;
}

constexpr const char* kBestAgreement = "fit";

/// How the displacement is cut off; without --corner the power of lines decides, from the noise floor.
vibration::DisplacementChoice displacement_choice_of(const FeaturesArguments& arguments) {
  const bool by_corner = !arguments.corner.empty();
  const std::string& word = by_corner ? arguments.corner : arguments.cutoff;
  const bool asked = by_corner || !arguments.cutoff.empty() || !arguments.against.empty();
  if (asked && !wants_displacement(arguments))
    throw text::InputError(
        fmt::format("--corner, --cutoff and --against require --features {}", vibration::kDisplacementName));
  vibration::DisplacementChoice choice;
  choice.cut = by_corner ? vibration::Cut::kCorner : vibration::Cut::kPower;
  choice.resolution = arguments.resolution;
  if ((word == kBestAgreement) == arguments.against.empty())
    throw text::InputError(
        fmt::format("\"{}\" and --against SIGNAL=COLUMN must be given together", kBestAgreement));
  if (word == kBestAgreement || word.empty() || (!by_corner && word == "noise")) return choice;
  choice.value = text::parse_number(word);
  if (!choice.value || !(*choice.value > 0))
    throw text::InputError(fmt::format("{} {}: the value must be a number above 0, or {}",
                                       by_corner ? "--corner" : "--cutoff", word,
                                       by_corner ? "fit" : "fit or noise"));
  return choice;
}

/// Displacements measured in the rows; an empty cell is no displacement.
std::vector<vibration::KnownDisplacement> known_displacements(const FeaturesArguments& arguments,
                                                              const format::CsvFile& rows) {
  std::vector<vibration::KnownDisplacement> known;
  for (const std::string& pair : arguments.against) {
    const auto equals = pair.find('=');
    if (equals == std::string::npos)
      throw text::InputError(fmt::format("--against: not of the form SIGNAL=COLUMN: {}", pair));
    known.push_back({pair.substr(0, equals), vibration::measured_lengths_um(rows, pair.substr(equals + 1))});
  }
  return known;
}

/// Appends the column of every acceleration; the result is the cut-off by name of signal.
void add_displacements(const FeaturesArguments& arguments, const vibration::VibrationRecord& record,
                       const format::CsvFile& rows, const Ends& ends, vibration::FeatureColumns& columns,
                       Json& json) {
  vibration::DisplacementChoice choice = displacement_choice_of(arguments);
  Json result = {{"cut", choice.cut == vibration::Cut::kCorner ? "corner" : "power"},
                 {"unit", choice.cut == vibration::Cut::kCorner ? "Hz" : "(mm/s^2)^2"}};
  if (!arguments.against.empty()) {
    const vibration::AgreedCut agreed =
        vibration::agreed_cut(record, known_displacements(arguments, rows), ends, choice);
    choice.value = agreed.value;
    result["agreement"] = {{"rms_um", agreed.rms_um}, {"measured_rms_um", agreed.measured_rms_um}};
  }
  for (const vibration::Signal& signal : record.signals) {
    if (!vibration::is_acceleration(signal)) continue;
    const vibration::DisplacementSeries series = vibration::displacement_of(signal, record.rate_Hz, choice);
    columns.header.push_back(fmt::format("{}_{}[um]", signal.name, vibration::kDisplacementName));
    std::size_t empty = 0;
    for (std::size_t row = 0; row < ends.size(); ++row) {
      const bool known = ends[row] && *ends[row] < series.um.size() && std::isfinite(series.um[*ends[row]]);
      columns.cells[row].push_back(known ? text::number_text(series.um[*ends[row]]) : "");
      empty += known ? 0 : 1;
    }
    result["signals"].push_back({{"name", signal.name},
                                 {"value", series.cut},
                                 {"lines_kept", series.kept},
                                 {"samples_held", series.held},
                                 {"rows_without", empty}});
  }
  if (!result.contains("signals"))
    throw text::InputError({arguments.record, 0}, vibration::kDisplacementName,
                           "no signal of the record is an acceleration (unit g, m/s^2 or mm/s^2)");
  json["displacement"] = result;
}

void print_displacements(std::FILE* out, const Json& displacement) {
  for (const Json& signal : displacement["signals"])
    fmt::print(out, "{}: displacement with the cut-off {:.4g} {}; {} rows have no displacement\n",
               signal["name"].get<std::string>(), signal["value"].get<double>(),
               displacement["unit"].get<std::string>(), signal["rows_without"].get<std::size_t>());
  if (displacement.contains("agreement"))
    fmt::print(out,
               "The cut-off gives the best agreement with the measured displacement: rms of the difference "
               "{:.4g} um, rms of the measured displacement {:.4g} um\n",
               displacement["agreement"]["rms_um"].get<double>(),
               displacement["agreement"]["measured_rms_um"].get<double>());
}

/// The clock of the record against the rows' t: given, or found from the motion of an axis.
vibration::ClockFit clock_of(const FeaturesArguments& arguments, const vibration::VibrationRecord& record,
                             const format::CsvFile& rows) {
  vibration::ClockFit clock;
  clock.offset_s = arguments.offset_s;
  clock.rate = arguments.clock_rate;
  if (arguments.align.empty()) return clock;
  const auto equals = arguments.align.find('=');
  if (equals == std::string::npos) throw text::InputError("--align: not of the form SIGNAL=AXIS");
  const std::string signal = arguments.align.substr(0, equals), axis = arguments.align.substr(equals + 1);
  vibration::Series accelerometer;
  for (const vibration::Signal& one : record.signals)
    if (one.name == signal) accelerometer.value = one.value;
  if (accelerometer.value.empty()) throw text::InputError(fmt::format("--align: no signal \"{}\"", signal));
  for (std::size_t i = 0; i < record.samples; ++i)
    accelerometer.t_s.push_back(record.start_s + static_cast<double>(i) / record.rate_Hz);
  return vibration::align_clocks(
      vibration::acceleration_of(vibration::numeric_column(rows, format::columns::kTime),
                                 vibration::numeric_column(rows, axis)),
      accelerometer);
}

Ends ends_by_time(const vibration::VibrationRecord& record, const format::CsvFile& rows,
                  const vibration::ClockFit& clock) {
  Ends ends;
  for (const double t : vibration::numeric_column(rows, format::columns::kTime)) {
    // A time written in decimals is that sample's own, not one just before it.
    constexpr double kSameInstant = 1e-6;
    const double sample =
        ((t - clock.offset_s) / clock.rate - record.start_s) * record.rate_Hz + kSameInstant;
    const bool inside = sample >= 0 && sample < static_cast<double>(record.samples);
    ends.push_back(inside ? std::optional(static_cast<std::size_t>(sample)) : std::nullopt);
  }
  return ends;
}

Eigen::MatrixXd matrix_of(const std::vector<std::vector<double>>& lines) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(lines.size()),
                         static_cast<Eigen::Index>(lines.front().size()));
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < lines[i].size(); ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = lines[i][j];
  return matrix;
}

Ends ends_by_position(const FeaturesArguments& arguments, const vibration::VibrationRecord& record,
                      const format::CsvFile& rows, Json& json) {
  std::vector<std::vector<double>> path, points;
  for (const vibration::Signal& position : record.positions) {
    path.push_back(position.value);
    points.push_back(vibration::numeric_column(rows, position.name));
  }
  Ends ends;
  double worst = 0;
  for (const vibration::PathPlace& place :
       vibration::nearest_places(matrix_of(path), matrix_of(points), arguments.reach_mm)) {
    ends.push_back(place.sample + (place.fraction > 0.5 ? 1 : 0));
    worst = std::max(worst, place.distance);
  }
  json["most_distance_mm"] = worst;
  return ends;
}

/// Windows one after the other, without rows to belong to.
format::CsvFile rows_of_windows(const FeaturesArguments& arguments, const vibration::VibrationRecord& record,
                                Ends& ends) {
  format::CsvFile rows;
  rows.columns = {{format::columns::kTime, "s"}};
  const std::size_t every = arguments.every == 0 ? arguments.window : arguments.every;
  for (std::size_t end = arguments.window - 1; end < record.samples; end += every) {
    ends.push_back(end);
    rows.rows.push_back({text::number_text(record.start_s + static_cast<double>(end) / record.rate_Hz)});
  }
  return rows;
}

std::string text_of(const format::CsvFile& rows, const vibration::FeatureColumns& columns) {
  std::vector<std::string> header;
  for (const format::CsvColumn& column : rows.columns)
    header.push_back(column.unit.empty() ? column.name : column.name + "[" + column.unit + "]");
  header.insert(header.end(), columns.header.begin(), columns.header.end());
  std::string text = fmt::format("{}\n", fmt::join(header, ","));
  for (std::size_t row = 0; row < rows.rows.size(); ++row) {
    std::vector<std::string> cells = rows.rows[row];
    for (std::string& cell : cells)
      if (cell.find_first_of(",\"") != std::string::npos) cell = '"' + cell + '"';
    cells.insert(cells.end(), columns.cells[row].begin(), columns.cells[row].end());
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

void run_features(const FeaturesArguments& arguments) {
  const vibration::FeatureChoice choice = choice_of(arguments);
  vibration::VibrationRecord record =
      vibration::read_vibration(format::parse_csv(text::read_file(arguments.record), arguments.record),
                                arguments.rate_Hz, arguments.positions);
  for (const std::string& difference : arguments.differences) vibration::add_difference(record, difference);
  Json json = {{"window", choice.window}, {"rate_Hz", record.rate_Hz}, {"samples", record.samples}};
  Ends ends;
  format::CsvFile rows;
  if (arguments.rows.empty()) {
    rows = rows_of_windows(arguments, record, ends);
  } else {
    rows = format::parse_csv(text::read_file(arguments.rows), arguments.rows);
    if (arguments.positions.empty()) {
      const vibration::ClockFit clock = clock_of(arguments, record, rows);
      ends = ends_by_time(record, rows, clock);
      json["clock"] = {{"offset_s", clock.offset_s},         {"rate", clock.rate},
                       {"offset_std_s", clock.offset_std_s}, {"rate_std", clock.rate_std},
                       {"correlation", clock.correlation},   {"rival", clock.second_best}};
    } else {
      ends = ends_by_position(arguments, record, rows, json);
    }
  }
  vibration::FeatureColumns columns = vibration::feature_columns(record, choice, ends);
  const bool displaced = wants_displacement(arguments);
  if (displaced) {
    add_displacements(arguments, record, rows, ends, columns, json);
  } else {
    displacement_choice_of(arguments);  // refuses options that need a displacement
  }
  json["rows"] = rows.rows.size();
  json["rows_without_window"] = columns.empty_rows;
  json["columns"] = columns.header;
  text::write_file(arguments.output, text_of(rows, columns));
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "{} rows, of which {} have no full window of {} samples at {:.6g} Hz before their time\n",
             rows.rows.size(), columns.empty_rows, choice.window, record.rate_Hz);
  if (displaced) print_displacements(out, json["displacement"]);
  if (!arguments.align.empty())
    fmt::print(out, "clock: t = {:.6g} s + {:.8f} t_record, correlation {:.3f} (next best lag {:.3f})\n",
               json["clock"]["offset_s"].get<double>(), json["clock"]["rate"].get<double>(),
               json["clock"]["correlation"].get<double>(), json["clock"]["rival"].get<double>());
  fmt::print(out, "{}\n", arguments.output);
}

}  // namespace

void register_features(CLI::App& vernier) {
  auto arguments = std::make_shared<FeaturesArguments>();
  CLI::App* command = vernier.add_subcommand(
      "features", "Compute features of an accelerometer record as inputs of measured rows");
  command
      ->add_option("RECORD", arguments->record,
                   "accelerometer record (CSV): t[s] and signals, evenly sampled (table_x[g], ...)")
      ->type_name(kReads)
      ->required();
  command
      ->add_option(
          "-o,--output", arguments->output,
          "output file (CSV): the rows, with a column SIGNAL_FEATURE for each feature of each signal")
      ->type_name(kWrites)
      ->required();
  command
      ->add_option("--rows", arguments->rows,
                   "measurement file to which the command adds the columns; without this option the output "
                   "has one row for each window")
      ->type_name(kReads);
  command->add_option("--window", arguments->window,
                      "number of samples of a window; the last sample is at the time of the row (1500)");
  command->add_option("--every", arguments->every,
                      "without --rows: number of samples from the start of a window to the start of the next "
                      "window (default: the length of a window)");
  command->add_option("--rate", arguments->rate_Hz, "samples per second, for a record without the column t")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--features", arguments->features,
                   "features to compute (default: all, MAV .. BANDPOWER, PEAK); DISPLACEMENT is the double "
                   "integral of an acceleration, at the time of the row")
      ->delimiter(',');
  command->add_option(
      "--corner", arguments->corner,
      "compute DISPLACEMENT with the filter of a board: corner frequency of the filter in Hz, or fit");
  command
      ->add_option("--cutoff", arguments->cutoff,
                   "DISPLACEMENT of the whole record: spectral lines above this |F|^2/N, (mm/s^2)^2; noise "
                   "(from the floor of each signal, the default) or fit")
      ->excludes("--corner");
  command
      ->add_option("--against", arguments->against,
                   "SIGNAL=COLUMN: column of the rows with the measured displacement of the signal; fit "
                   "finds the cut-off with the best agreement")
      ->delimiter(',');
  command
      ->add_option("--resolution", arguments->resolution,
                   "with --corner: resolution of a sample on the board, in the unit of the signal (1e-5)")
      ->check(CLI::PositiveNumber);
  command->add_option("--difference", arguments->differences,
                      "additional signal as a difference of two signals, NAME=A-B (table minus base)");
  command->add_flag("--centre", arguments->centred, "subtract from each signal its mean over the record");
  command->add_option("--align", arguments->align,
                      "SIGNAL=AXIS: estimate offset and rate of the record's clock by comparing the signal "
                      "with the acceleration of the axis in the rows");
  command->add_option("--offset", arguments->offset_s,
                      "time difference of the two clocks, s: the value of column t in the rows at the time "
                      "when the record begins (t = 0); default 0");
  command
      ->add_option("--clock", arguments->clock_rate,
                   "rate between the clocks: seconds of the rows per second of the record (1)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--by-position", arguments->positions,
                   "axes whose positions the record also contains (X,Y): each row gets the window at the "
                   "nearest position")
      ->delimiter(',');
  command
      ->add_option("--reach", arguments->reach_mm,
                   "with --by-position: length of the path, mm, on which the position of the next row is "
                   "searched; the search starts at the position of the row before (20)")
      ->check(CLI::PositiveNumber);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([arguments] { run_features(*arguments); });
}

}  // namespace vernier::commands::features_cli
