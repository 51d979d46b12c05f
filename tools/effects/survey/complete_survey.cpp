// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/survey/complete_survey.h"

#include <utility>

#include "tools/effects/probe_offset.h"
#include "tools/effects/roles.h"
#include "tools/model/file_set_ups.h"
#include "tools/model/machine_reader.h"

namespace vernier::effects {

CompletedSurvey complete_survey(const std::string& text, const std::string& file,
                                const std::vector<std::string>& measurements,
                                const model::ImageCorrection& images, const PrepareMachine& prepare) {
  CompletedSurvey survey;
  survey.text = text;
  const auto read = [&] {
    survey.machine = model::parse_machine(survey.text, file);
    if (prepare) survey.machine = prepare(std::move(survey.machine));
    survey.rows = model::read_measurement(measurements, survey.machine, images);
  };
  read();
  for (const auto complete :
       {with_probe_offset, model::with_set_ups_of_files, model::with_camera_mountings}) {
    model::CompletedText own = complete(survey.text, survey.machine, survey.rows);
    if (own.notes.empty()) continue;
    survey.text = std::move(own.text);
    survey.notes.insert(survey.notes.end(), own.notes.begin(), own.notes.end());
    read();
  }
  const std::vector<std::string> directions = notes_of_missing_directions(survey.machine, survey.rows);
  survey.notes.insert(survey.notes.end(), directions.begin(), directions.end());
  return survey;
}

}  // namespace vernier::effects
