// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/workbench/files/project.h"

namespace vernier::workbench {

/// A machine and rows of a project, as read.
struct LoadedRows {
  std::string text;        // of the machine file
  model::Machine machine;  // with its set-up fitted to the rows, if requested
  bool datum = false;
  model::Measurement measurement;
};

/// Reads machines with their measurements, and stores the last few in memory as long as their files do not
/// change. May be called from several threads.
class RowCache {
 public:
  explicit RowCache(const Project& project) : project_(project) {}
  /// The names are those in the project. `datum`: the machine's set-up is fitted to the rows first (`compare
  /// --datum`). Rows that were measured with a correction on need its image in the project. Throws InputError
  /// with file, line and word.
  std::shared_ptr<const LoadedRows> get(const std::string& machine,
                                        const std::vector<std::string>& measurements, bool datum);

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const LoadedRows> rows;
  };
  std::string key_of(const std::string& machine, const std::vector<std::string>& measurements) const;

  const Project& project_;
  std::mutex guard_;
  std::vector<Entry> kept_;
};

/// Returns everything that the page draws of a machine and rows (Blob): columns, runs, roles, lines, tool
/// points, directions of lengths, observations with residuals in um or urad, circles, numbers.
std::string rows_blob(const LoadedRows& rows);

/// Residuals and figures with some parameters changed; no file is written.
std::string prediction_blob(const LoadedRows& rows, const std::map<std::string, double>& values);

/// Returns the change of the residual of the fitted model if an effect is added and fitted, per observation,
/// um or urad. add: a candidate's `add` string.
std::string explanation_blob(const LoadedRows& rows, const std::string& add);

/// Returns the free parameters: {name, value, unit, nominal, std, from}. std and from (data, convention,
/// prior) are from the fit that wrote the file; null if there was no fit, or if the value was changed after
/// the fit.
nlohmann::ordered_json parameters_json(const LoadedRows& rows);

}  // namespace vernier::workbench
