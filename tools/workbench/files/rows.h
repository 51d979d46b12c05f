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

/// A machine and measurement rows that were read from the files of a project. Each measurement file has its
/// own set-up, as for the commands (effects::complete_survey).
struct LoadedRows {
  std::string text;        // text of the machine file
  model::Machine machine;  // the machine; if requested, with its set-up fitted to the rows
  bool datum = false;
  model::Measurement measurement;
  std::vector<std::string> notes;  // estimates of u for files without u beside files with u
};

/// Reads machines with their measurements. The last few results stay in memory as long as their files do not
/// change. Several threads may call the functions of RowCache.
class RowCache {
 public:
  explicit RowCache(const Project& project) : project_(project) {}
  /// Returns a machine with its measurements; all file names are relative to the project. `datum`: true if
  /// the set-up of the machine is fitted to the rows first (as with `compare --datum`). If rows were measured
  /// with an active correction, the image of this correction must be in the project. If a file is not valid,
  /// throws InputError with file, line and word.
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

/// Returns all data that the page draws for a machine and its rows (format Blob): columns, runs, roles,
/// lines, tool points, directions of lengths, observations with residuals in um or urad, circles, numbers.
std::string rows_blob(const LoadedRows& rows);

/// Returns residuals and statistics with some parameters changed. No file is written.
std::string prediction_blob(const LoadedRows& rows, const std::map<std::string, double>& values);

/// Returns the change of each residual of the fitted model, um or urad, if one effect is added and fitted.
/// `add`: the `add` string of the effect.
std::string explanation_blob(const LoadedRows& rows, const std::string& add);

/// Returns the free parameters as JSON: {name, value, unit, nominal, std, from}. The entries std and from
/// (data, convention, prior) come from the fit that wrote the file. The entries std and from are null if
/// there was no fit, or if the value was changed after the fit.
nlohmann::ordered_json parameters_json(const LoadedRows& rows);

}  // namespace vernier::workbench
