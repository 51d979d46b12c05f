// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace vernier::report {

/// Returns one self-contained HTML page that draws the JSON result of `compare`. The page itself computes no
/// result. The page needs no network, and has a light and a dark form. Every key of the result is optional.
/// The JSON must be an object with these keys:
///   machine, files[], rms_um, check_rms_um, max_um, check_max_um, noise_um, n_obs, n_excluded, rms_urad,
///   parameters[{name, value, std, unit}], notes[],
///   detail: { columns[{name, unit, kind}], column_data[column][row], runs[], row_run[], row_check[],
///     row_line[],
///     observations: {kind[], row[], kind_index[], residual[] (um or urad)},
///     circular[{plane[2], nominal_radius_mm,
///       runs[{label, direction, angle_deg[], measured_um[], model_um[], check[],
///         centre_mm[2], radius_mm, circular_deviation_um, max_radial_um, max_radial_deg,
///         min_radial_um, min_radial_deg, feed_mm_min}],
///       bidirectional_um, hysteresis_um, hysteresis_deg}],
///     worst[{row, line, run, kind, residual}] },
///   field: {axes[], counts[], point_mm[][3], deviation_um[][3], max_um, rms_um} (arrows over a volume), or
///   field_note: reason why no field is drawn
/// Any of these pages may have header[[key, value]…] with person, subject, date and instrument of the
/// measurement. The entry "company" is at the top of the page. If a kind has more observations than
/// kMostDrawn, only every n-th observation and the worst observations are drawn, and the page states this.
/// Texts are shown unchanged and are never interpreted as HTML. Throws std::invalid_argument if the data in
/// `detail` are inconsistent.
std::string compare_report_html(const nlohmann::ordered_json& result);

/// Returns an HTML page like compare_report_html for a job with several steps, with these keys:
///   title, machine, files[], sections[{title, prose[], numbers[{label, value, unit, hint, strong}],
///     ladder[{label, rms_um, check_rms_um}], tables[{caption, columns[], rows[][]}], parameters[],
///     field: {axes[], counts[], point_mm[][3], deviation_um[][3], max_um} (arrows over a volume),
///     plots[{x: {name, unit, values[]}, y[{name, unit, values[], colour, style}], bars, log, caption}],
///     detail (as above), notes[]}]
std::string improvement_report_html(const nlohmann::ordered_json& result);

/// Returns the HTML page of `diagnose`: verdict in words, stepwise model, candidates, next measurements, and
/// locations where the model fails. The page draws the JSON result of FORMATS section 3 (machine, files[],
/// verdict, explanation, rms_um, check_rms_um, noise_um, candidates[], runner_up, ladder[],
/// next_measurement[] of texts or objects with `sentence`) and, if present, findings[] and structure{}
/// (tools/results/structure_json.h), notes[], detail (as above). The candidates may also contain score,
/// signature, impostors[], why_not.
std::string diagnose_report_html(const nlohmann::ordered_json& result);

/// Returns the HTML page of `improve` with the error after each step. Its keys are ladder[{effect, add,
/// label, rms_um, check_rms_um}], noise_um, and all keys of the page of diagnose; simulation{rms_before_um,
/// rms_after_um, max_before_um, max_after_um, ticks}; pictures[] (tools/results/detail.h:
/// before_after_pictures); steps[{title, prose[], findings[], explanation}].
std::string improve_report_html(const nlohmann::ordered_json& result);

/// Largest number of observations of one kind that a page draws.
inline constexpr std::size_t kMostDrawn = 20000;

}  // namespace vernier::report
