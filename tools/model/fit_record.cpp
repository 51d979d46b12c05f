// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/fit_record.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <pugixml.hpp>

#include "tools/format/readings.h"
#include "tools/maths/decompositions.h"
#include "tools/model/machine.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::model {
namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string to_base64(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16U;
    if (i + 1 < bytes.size()) group |= static_cast<std::uint32_t>(bytes[i + 1]) << 8U;
    if (i + 2 < bytes.size()) group |= bytes[i + 2];
    for (unsigned k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[(group >> (18U - 6U * k)) & 63U];
  }
  return text;
}

/// Returns an empty vector if the text has an invalid letter.
std::vector<std::uint8_t> from_base64(std::string_view text) {
  std::array<int, 256> value{};
  value.fill(-1);
  for (int i = 0; i < 64; ++i) value[static_cast<unsigned char>(kDigits[i])] = i;
  std::vector<std::uint8_t> bytes;
  std::uint32_t group = 0, bits = 0;
  for (const char c : text) {
    if (c == '=' || std::isspace(static_cast<unsigned char>(c)) != 0) continue;
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0) return {};
    group = (group << 6U) | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>((group >> bits) & 255U));
  }
  return bytes;
}

// Little-endian on every host.
template <class Word>
void put(std::vector<std::uint8_t>& bytes, Word word) {
  for (std::size_t i = 0; i < sizeof(Word); ++i)
    bytes.push_back(static_cast<std::uint8_t>((word >> (8 * i)) & 255U));
}

template <class Word>
Word take(const std::vector<std::uint8_t>& bytes, std::size_t& at) {
  Word word = 0;
  for (std::size_t i = 0; i < sizeof(Word); ++i) word |= static_cast<Word>(bytes[at++]) << (8 * i);
  return word;
}

void put_float(std::vector<std::uint8_t>& bytes, double number) {
  const auto value = static_cast<float>(number);
  std::uint32_t word = 0;
  std::memcpy(&word, &value, sizeof word);
  put(bytes, word);
}

double take_float(const std::vector<std::uint8_t>& bytes, std::size_t& at) {
  const auto word = take<std::uint32_t>(bytes, at);
  float value = 0;
  std::memcpy(&value, &word, sizeof value);
  return static_cast<double>(value);
}

std::string noise_xml(const FitRecord::Noise& noise) {
  std::string text = "    <noise";
  for (const auto& [name, value] : {std::pair{"own", noise.own},
                                    {"pose", noise.pose},
                                    {"run", noise.run},
                                    {"drift", noise.drift},
                                    {"time", noise.time_constant},
                                    {"step", noise.step}})
    text += std::string(" ") + name + "=\"" + text::number_text(value) + "\"";
  if (noise.drifts != 0)
    text += " drifts=\"" + text::joined(format::names_of_kinds(noise.drifts), " ") + "\"";
  return text + " clock=\"" + (noise.in_time ? "s" : "row") + "\" unit=\"" + (noise.of_u ? "u" : "mm") +
         "\"/>\n";
}

std::string warnings_xml(const FitRecord& record) {
  std::string text;
  for (const FitRecord::Finding& one : record.findings)
    text += "    <finding code=\"" + text::escape_attribute(one.code) + "\" value=\"" +
            text::number_text(one.value) + "\" text=\"" + text::escape_attribute(one.text) + "\"/>\n";
  const auto& discrepancy = record.discrepancy_mm;
  if (discrepancy[0] > 0 || discrepancy[1] > 0 || discrepancy[2] > 0)
    text += "    <discrepancy x=\"" + text::number_text(discrepancy[0]) + "\" y=\"" +
            text::number_text(discrepancy[1]) + "\" z=\"" + text::number_text(discrepancy[2]) + "\"/>\n";
  for (const FitRecord::Unvaried& one : record.unvaried) {
    text += "    <unvaried coefficient=\"" + text::escape_attribute(one.coefficient) + "\" variable=\"" +
            text::escape_attribute(one.variable) + "\" at=\"" + text::number_text(one.at);
    if (!one.follows.empty())
      text += "\" follows=\"" + text::escape_attribute(one.follows) + "\" slope=\"" +
              text::number_text(one.slope) + "\" about=\"" + text::number_text(one.about);
    text += "\"/>\n";
  }
  for (const FitRecord::Alternative& one : record.alternatives) {
    text += "    <alternative branch=\"" + std::string(one.workpiece ? "workpiece" : "tool") +
            "\" transform=\"" + std::to_string(one.transform) + "\" dof=\"" + kSixDofNames[one.dof] + "\"";
    if (!one.axis.empty())
      text += " axis=\"" + text::escape_attribute(one.axis) + "\" period=\"" + text::number_text(one.period) +
              "\"";
    for (std::size_t i = 0; i < 3; ++i)
      text += std::string(" ") + "abc"[i] + "=\"" + text::number_text(one.size[i]) + "\"";
    text += "/>\n";
  }
  for (const FitRecord::Plane& plane : record.planes) {
    text += "    <plane name=\"" + text::escape_attribute(plane.name) + "\"";
    for (std::size_t i = 0; i < 3; ++i)
      text += std::string(" ") + "xyz"[i] + "=\"" + text::number_text(plane.place_mm[i]) + "\"";
    for (std::size_t i = 0; i < 3; ++i)
      text += std::string(" n") + "xyz"[i] + "=\"" + text::number_text(plane.normal[i]) + "\"";
    text += "/>\n";
  }
  return text;
}

}  // namespace

Eigen::MatrixXd open_factor(const Eigen::MatrixXd& part, const Eigen::MatrixXd& covariance) {
  constexpr double kLeast = 1e-3;  // of the covariance's squares
  const Eigen::VectorXd std = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd shrink = std.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  Eigen::MatrixXd left = shrink.asDiagonal() * part * shrink.asDiagonal();
  Eigen::MatrixXd factor(part.rows(), 0);
  while (factor.cols() < part.rows()) {
    Eigen::Index pivot = 0;
    const double most = left.diagonal().size() > 0 ? left.diagonal().maxCoeff(&pivot) : 0;
    if (!(most > kLeast)) break;
    const Eigen::VectorXd column = left.col(pivot) / std::sqrt(most);
    left.noalias() -= column * column.transpose();
    factor.conservativeResize(Eigen::NoChange, factor.cols() + 1);
    factor.rightCols(1) = std.cwiseProduct(column);
  }
  return factor.cast<float>().cast<double>();
}

Eigen::MatrixXd covariance_factor(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd std = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd shrink = std.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  Eigen::MatrixXd scaled = shrink.asDiagonal() * covariance * shrink.asDiagonal();
  // Rounding may make the smallest of its eigenvalues negative. The diagonal is raised until the
  // matrix factorises.
  for (double lift = 0; lift<1e-3; lift = lift> 0 ? 10 * lift : 1e-14) {
    scaled.diagonal().array() = 1 + lift;
    const Eigen::LLT<Eigen::MatrixXd> llt(scaled);
    if (llt.info() != Eigen::Success) continue;
    const Eigen::MatrixXd lower = std.asDiagonal() * Eigen::MatrixXd(llt.matrixL());
    return lower.cast<float>().cast<double>();
  }
  return Eigen::MatrixXd(std.asDiagonal());
}

std::string fit_record_xml(const FitRecord& record) {
  std::string text = "  <fitted converged=\"" + std::string(record.converged ? "true" : "false") +
                     "\" rms=\"" + text::number_text(record.rms_mm) + "\" reach=\"" +
                     text::number_text(record.reach_mm) + "\" worst=\"" + text::number_text(record.worst) +
                     "\" reading=\"" + text::escape_attribute(record.worst_reading) + "\"";
  if (!record.culprit.empty()) text += " culprit=\"" + text::escape_attribute(record.culprit) + "\"";
  if (record.check_ratio > 0)
    text += " check=\"" + text::number_text(record.check_ratio) + "\" check-count=\"" +
            std::to_string(record.check_count) + "\" check-reading=\"" +
            text::escape_attribute(record.worst_check) + "\"";
  if (record.disturbed > 0)
    text += " disturbed=\"" + text::number_text(record.disturbed) + "\" disturbance=\"" +
            text::escape_attribute(record.disturbance) + "\"";
  text += ">\n    <measured>";
  for (const FitRecord::Range& range : record.measured)
    text += "<" + range.name + " min=\"" + text::number_text(range.min) + "\" max=\"" +
            text::number_text(range.max) + "\"/>";
  text += "</measured>\n" + warnings_xml(record);
  if (record.noise) text += noise_xml(*record.noise);
  text += "    <covariance parameters=\"";
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    text += (i > 0 ? "|" : "") + text::escape_attribute(record.parameters[i]);
  if (!record.origins.empty()) text += "\" from=\"";
  for (std::size_t i = 0; i < record.origins.size(); ++i)
    text += (i > 0 ? "|" : "") + text::escape_attribute(record.origins[i]);
  // Values have full precision, because they are compared. The factor has 4-byte numbers, 1e-7 of
  // its largest part.
  std::vector<std::uint8_t> bytes;
  for (const double value : record.values) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    put(bytes, word);
  }
  for (Eigen::Index row = 0; row < record.factor.rows(); ++row)
    for (Eigen::Index column = 0; column <= row; ++column) put_float(bytes, record.factor(row, column));
  text += "\" numbers=\"" + to_base64(bytes) + "\"/>\n";
  if (record.open_known) {
    bytes.clear();
    for (const double value : record.open.reshaped()) put_float(bytes, value);
    text += "    <open numbers=\"" + to_base64(bytes) + "\"/>\n";
  }
  return text + "  </fitted>\n";
}

bool read_open_numbers(std::string_view text, std::size_t n, FitRecord& record) {
  const std::vector<std::uint8_t> bytes = from_base64(text);
  const bool whole = n > 0 ? bytes.size() % (4 * n) == 0 : bytes.empty();
  if (!whole || (bytes.empty() && !text::trimmed(text).empty())) return false;
  record.open = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n),
                                      static_cast<Eigen::Index>(n > 0 ? bytes.size() / (4 * n) : 0));
  std::size_t at = 0;
  for (double& value : record.open.reshaped()) value = take_float(bytes, at);
  record.open_known = true;
  return record.open.allFinite();
}

bool read_fit_numbers(std::string_view text, std::size_t n, FitRecord& record) {
  const std::vector<std::uint8_t> bytes = from_base64(text);
  if (bytes.size() != 8 * n + 2 * n * (n + 1)) return false;
  const auto size = static_cast<Eigen::Index>(n);
  record.values.resize(size);
  record.factor = Eigen::MatrixXd::Zero(size, size);
  std::size_t at = 0;
  for (double& value : record.values) {
    const auto word = take<std::uint64_t>(bytes, at);
    std::memcpy(&value, &word, sizeof value);
  }
  for (Eigen::Index row = 0; row < size; ++row)
    for (Eigen::Index column = 0; column <= row; ++column) record.factor(row, column) = take_float(bytes, at);
  return record.values.allFinite() && record.factor.allFinite();
}

namespace {

/// The text before the element <fitted> and behind it; nullopt: the text has no such element.
std::optional<std::pair<std::string, std::string>> around_record(const std::string& text) {
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  for (const pugi::xml_node node : document.document_element().children()) {
    if (!text::equal_no_case(node.name(), "fitted")) continue;
    std::size_t begin = text.rfind('<', static_cast<std::size_t>(node.offset_debug()));
    const std::size_t end = text.find('>', text.find("</", begin)) + 1;
    const std::size_t close = text.find("</fitted", begin);
    const std::size_t stop = close == std::string::npos ? end : text.find('>', close) + 1;
    while (begin > 0 && text[begin - 1] == ' ') --begin;
    return std::pair(text.substr(0, begin), text.substr(text[stop] == '\n' ? stop + 1 : stop));
  }
  return std::nullopt;
}

}  // namespace

std::string with_fit_record(const std::string& text, const FitRecord& record) {
  const std::string element = fit_record_xml(record);
  if (const auto around = around_record(text)) return around->first + element + around->second;
  const std::size_t root_end = text.rfind("</");
  return text.substr(0, root_end) + element + text.substr(root_end);
}

std::string without_fit_record(const std::string& text) {
  const auto around = around_record(text);
  return around ? around->first + around->second : text;
}

}  // namespace vernier::model
