// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/part_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::tolerance {
namespace {

constexpr std::array<const char*, 4> kKindNames = {"point", "plane", "cylinder", "path"};
constexpr std::array<const char*, 3> kCharacteristicNames = {"position", "size", "form"};

/// The cells of a part's file by column name.
class PartSheet {
 public:
  PartSheet(const std::string& text, const std::string& file) : csv_(format::parse_csv(text, file)) {
    static const std::set<std::string> kKnown = {"feature",  "kind",      "i",     "j",        "k",
                                                 "diameter", "length",    "width", "position", "size",
                                                 "size_low", "size_high", "form",  "datum"};
    const auto is_known = [](const std::string& name) {
      const auto among = [&](const std::array<const char*, 3>& names) {
        return std::find(names.begin(), names.end(), name) != names.end();
      };
      return kKnown.contains(name) || among(format::columns::kPoint) || among(format::columns::kNormal);
    };
    for (const format::CsvColumn& column : csv_.columns) {
      const auto unit = format::find_unit(column.unit);
      const bool number = column.name != "feature" && column.name != "kind" && column.name != "datum";
      if (!is_known(column.name))
        throw text::InputError(
            head(), column.name,
            "a list of features cannot have this column: see `vernier part conformity --help`");
      if (!column.unit.empty() && (!number || !unit || unit->dimension != format::Dimension::kLength))
        throw text::InputError(head(), column.unit, "this column of a part must have a unit of length");
    }
    std::vector<const char*> needed = {"feature", "kind"};
    needed.insert(needed.end(), format::columns::kPoint.begin(), format::columns::kPoint.end());
    for (const char* name : needed)
      if (!find(name)) throw text::InputError(head(), name, "this column is missing");
  }

  std::size_t rows() const { return csv_.rows.size(); }
  text::Place head() const { return {csv_.file, csv_.header_line}; }
  text::Place place(std::size_t row) const { return {csv_.file, csv_.line[row]}; }

  std::string word(std::size_t row, const std::string& name) const {
    const auto column = find(name);
    return column ? csv_.rows[row][*column] : "";
  }

  std::optional<double> number(std::size_t row, const std::string& name) const {
    const std::string text = word(row, name);
    if (text.empty()) return std::nullopt;
    const auto value = text::parse_number(text);
    if (!value) throw text::InputError(place(row), text, name + ": not a number");
    const auto unit = format::find_unit(csv_.columns[*find(name)].unit);
    return *value * (csv_.columns[*find(name)].unit.empty() ? 1 : unit->factor);
  }

  std::optional<Eigen::Vector3d> vector(std::size_t row, const std::array<const char*, 3>& names) const {
    Eigen::Vector3d values;
    std::size_t given = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto one = number(row, names[i]);
      given += one ? 1 : 0;
      values[static_cast<Eigen::Index>(i)] = one.value_or(0);
    }
    if (given == 0) return std::nullopt;
    if (given < 3) throw text::InputError(place(row), names[0], "give all three of these columns, or none");
    return values;
  }

  std::optional<Eigen::Vector3d> direction(std::size_t row, const std::array<const char*, 3>& names) const {
    const auto values = vector(row, names);
    if (!values) return std::nullopt;
    if (!(values->norm() > 1e-9))
      throw text::InputError(place(row), names[0], "the direction has the length 0");
    return values->normalized();
  }

  std::optional<double> positive(std::size_t row, const std::string& name) const {
    const auto value = number(row, name);
    if (value && !(*value > 0))
      throw text::InputError(place(row), word(row, name), name + " must be above 0");
    return value;
  }

 private:
  std::optional<std::size_t> find(const std::string& name) const {
    for (std::size_t i = 0; i < csv_.columns.size(); ++i)
      if (csv_.columns[i].name == name) return i;
    return std::nullopt;
  }

  format::CsvFile csv_;
};

void read_size(const PartSheet& sheet, std::size_t row, PartFeature& feature) {
  const auto size = sheet.positive(row, "size"), low = sheet.number(row, "size_low"),
             high = sheet.number(row, "size_high");
  if (size && (low || high))
    throw text::InputError(sheet.place(row), sheet.word(row, "size"),
                           "give either size, or size_low and size_high");
  if (size) feature.size_mm = {-*size, *size};
  if (low.has_value() != high.has_value())
    throw text::InputError(sheet.place(row), low ? "size_high" : "size_low", "a size has two limits");
  if (low && !(*low < *high))
    throw text::InputError(sheet.place(row), sheet.word(row, "size_low"), "size_low must be below size_high");
  if (low) feature.size_mm = {*low, *high};
  if (feature.size_mm && feature.kind != PartFeatureKind::kCylinder)
    throw text::InputError(sheet.place(row), "size", "only a cylinder has a size");
}

PartFeature read_feature(const PartSheet& sheet, std::size_t row) {
  PartFeature feature;
  feature.line = sheet.place(row).line;
  feature.name = sheet.word(row, "feature");
  if (feature.name.empty()) throw text::InputError(sheet.place(row), "feature", "a feature needs a name");
  const std::string kind = sheet.word(row, "kind");
  const auto found = std::find(kKindNames.begin(), kKindNames.begin() + 3, kind);
  if (found == kKindNames.begin() + 3)
    throw text::InputError(sheet.place(row), kind, "a feature is a point, a plane or a cylinder");
  feature.kind = static_cast<PartFeatureKind>(found - kKindNames.begin());
  const auto at = sheet.vector(row, format::columns::kPoint);
  if (!at) throw text::InputError(sheet.place(row), "x", "the position of the feature is missing");
  feature.at = *at;
  const bool point = feature.kind == PartFeatureKind::kPoint;
  feature.direction =
      sheet.direction(row, format::columns::kNormal).value_or(Eigen::Vector3d(0, 0, point ? 0 : 1));
  feature.tool = sheet.direction(row, {"i", "j", "k"});
  feature.diameter_mm = sheet.positive(row, "diameter").value_or(0);
  feature.length_mm = sheet.number(row, "length").value_or(0);
  feature.width_mm = sheet.number(row, "width").value_or(0);
  if (feature.kind == PartFeatureKind::kCylinder && feature.diameter_mm <= 0)
    throw text::InputError(sheet.place(row), "diameter", "a cylinder must have a diameter above 0");
  if (feature.kind == PartFeatureKind::kPlane && !(feature.length_mm > 0 && feature.width_mm > 0))
    throw text::InputError(sheet.place(row), "length", "a plane needs length and width");
  feature.position_mm = sheet.positive(row, "position");
  feature.form_mm = sheet.positive(row, "form");
  if (feature.form_mm && point) throw text::InputError(sheet.place(row), "form", "a point has no form");
  read_size(sheet, row, feature);
  const std::string datum = sheet.word(row, "datum");
  if (!datum.empty() && datum != "yes" && datum != "no")
    throw text::InputError(sheet.place(row), datum, "datum is yes or no");
  feature.datum = datum == "yes";
  return feature;
}

}  // namespace

const char* kind_name(PartFeatureKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

const char* characteristic_name(PartCharacteristic characteristic) {
  return kCharacteristicNames.at(static_cast<std::size_t>(characteristic));
}

PartDrawing parse_part(const std::string& text, const std::string& file) {
  const PartSheet sheet(text, file);
  PartDrawing part{file, {}};
  std::set<std::string> names;
  for (std::size_t row = 0; row < sheet.rows(); ++row) {
    part.features.push_back(read_feature(sheet, row));
    if (!names.insert(part.features.back().name).second)
      throw text::InputError(sheet.place(row), part.features.back().name,
                             "the list has two features of this name");
  }
  return part;
}

PartDrawing placed_at(const PartDrawing& part, const Eigen::Isometry3d& place) {
  const Eigen::Matrix3d turn = place.linear();
  PartDrawing placed = part;
  for (PartFeature& feature : placed.features) {
    feature.at = place * feature.at;
    feature.direction = turn * feature.direction;
    if (feature.tool) feature.tool = turn * *feature.tool;
  }
  return placed;
}

}  // namespace vernier::tolerance
