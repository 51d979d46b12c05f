// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/report.h"

#include <stdexcept>

#include "tools/report/assets.h"
#include "tools/report/payload.h"
#include "tools/report/thinning.h"

namespace vernier::report {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& result, const char* key) {
  const auto found = result.find(key);
  return found != result.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string file_list(const Json& result) {
  std::string list;
  for (const Json& file : result.value("files", Json::array())) {
    if (file.is_string()) list += (list.empty() ? "" : ", ") + file.get<std::string>();
  }
  return list;
}

// The policy forbids any download: a page always opens offline.
constexpr const char* kHead =
    "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data:\">\n";

/// Person, subject, date and instrument of the measurement: the company on top, the rest beside one another.
std::string letterhead(const Json& result) {
  std::string company, entries;
  for (const Json& one : result.value("header", Json::array())) {
    const auto key = one.at(0).get<std::string>(), value = one.at(1).get<std::string>();
    if (key == "company")
      company = "<p class=\"company\">" + escape_html(value) + "</p>";
    else
      entries += "<div><dt>" + escape_html(key) + "</dt><dd>" + escape_html(value) + "</dd></div>";
  }
  if (!entries.empty()) entries = "<dl class=\"letterhead\">" + entries + "</dl>";
  return company + entries;
}

std::string page(const std::string& title, const std::string& subtitle, const Json& data) {
  std::string html = kHead;
  html += "<title>" + escape_html(title) + "</title>\n<style>\n";
  html += report_style();
  html +=
      "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#report\">Skip to the report</a>\n<header><h1>" +
      escape_html(title) + "</h1><p>" + escape_html(subtitle) + "</p>" + letterhead(data.at("result")) +
      "</header>\n<nav aria-label=\"Sections\"><div id=\"nav\"></div></nav>\n" +
      "<main id=\"report\"><noscript>This report draws its plots with a script, which this viewer does not "
      "run.</noscript></main>\n" +
      "<script type=\"application/json\" id=\"report-data\">";
  html += script_json(packed(data));
  html += "</script>\n<script>\n";
  html += report_script();
  html += "</script>\n</body>\n</html>\n";
  return html;
}

/// A page of one result with its `detail` thinned.
std::string result_page(const std::string& title, const char* type, const Json& result) {
  if (!result.is_object()) throw std::invalid_argument("report: the result is no object");
  Json shown = result;
  if (shown.contains("detail") && shown["detail"].is_object())
    shown["detail"] = thinned_detail(shown["detail"], kMostDrawn);
  const std::string machine = text_of(result, "machine");
  return page(title + (machine.empty() ? "" : ": " + machine), file_list(result),
              {{"type", type}, {"result", shown}});
}

}  // namespace

std::string compare_report_html(const Json& result) {
  return result_page("Model against measurement", "compare", result);
}

std::string diagnose_report_html(const Json& result) {
  return result_page("What is missing", "diagnose", result);
}

std::string improve_report_html(const Json& result) {
  return result_page("Improvement of the model, step by step", "improve", result);
}

std::string improvement_report_html(const Json& result) {
  Json shown = result;
  for (Json& section : shown.at("sections")) {
    if (section.contains("detail") && section["detail"].is_object())
      section["detail"] = thinned_detail(section["detail"], kMostDrawn);
  }
  std::string title = text_of(result, "title");
  if (title.empty()) title = "From measurement to compensation";
  const std::string machine = text_of(result, "machine");
  return page(machine.empty() ? title : title + ": " + machine, file_list(result),
              {{"type", "improvement"}, {"result", shown}});
}

}  // namespace vernier::report
