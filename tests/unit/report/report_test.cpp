// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/report.h"

#include <gtest/gtest.h>

#include "tools/report/assets.h"

namespace vernier::report_test {

using namespace vernier::report;
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHostile = "</script><script>alert('x')</script><img src=x onerror=\"y\">";

Json a_result() {
  return {
      {"machine", kHostile},
      {"files", {kHostile}},
      {"rms_um", 1.5},
      {"check_rms_um", nullptr},
      {"notes", {kHostile}},
      {"parameters", {{{"name", kHostile}, {"value", 1.0}, {"std", 0.1}, {"unit", "mm"}}}},
      {"detail",
       {{"columns", {{{"name", kHostile}, {"unit", "mm"}, {"kind", "axis"}}}},
        {"column_data", {{1.0, 2.0, 3.0}}},
        {"runs", {"a"}},
        {"row_run", {0, 0, 0}},
        {"row_check", {0, 1, 0}},
        {"row_line", {2, 3, 4}},
        {"observations",
         {{"kind", {"x"}}, {"row", {0, 1, 2}}, {"kind_index", {0, 0, 0}}, {"residual", {1.0, -1.0, 2.0}}}},
        {"worst", {{{"row", 2}, {"line", 4}, {"run", kHostile}, {"kind", "x"}, {"residual", 2.0}}}}}}};
}

Json a_diagnosis() {
  Json result = a_result();
  result["verdict"] = "missing-effect";
  result["explanation"] = kHostile;
  result["candidates"] = {{{"effect", "backlash"}, {"add", kHostile}, {"why_not", kHostile}}};
  result["ladder"] = {{{"effect", nullptr}, {"rms_um", 5.0}, {"check_rms_um", nullptr}},
                      {{"effect", kHostile}, {"rms_um", 1.0}, {"check_rms_um", 1.1}}};
  result["next_measurement"] = {kHostile};
  result["findings"] = {{{"observation", "x"}, {"sentence", kHostile}, {"share_after", 0.5}}};
  return result;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

// The page without its library, whose text is not ours.
std::string own_part(const std::string& html) {
  const auto at = html.find(report_script());
  EXPECT_NE(at, std::string::npos);
  return html.substr(0, at) + html.substr(at + report_script().size());
}

TEST(Report, HostileTextsStayTexts) {
  for (const std::string& html :
       {compare_report_html(a_result()),
        improvement_report_html({{"title", kHostile},
                                 {"machine", kHostile},
                                 {"files", {kHostile}},
                                 {"sections", {{{"title", kHostile}, {"prose", {kHostile}}}}}}),
        diagnose_report_html(a_diagnosis()), improve_report_html(a_diagnosis())}) {
    const std::string own = own_part(html);
    EXPECT_EQ(count(own, "alert('x')</script>"), 0u);
    EXPECT_EQ(count(own, "<img"), 0u);
    // The data, and the library: two elements, opened and closed once each.
    EXPECT_EQ(count(own, "<script"), 2u);
    EXPECT_EQ(count(own, "</script>"), 2u);
    // Title, heading and list of files hold it as text, with both of its closing tags.
    EXPECT_GE(count(own, "&lt;/script&gt;"), 6u);
  }
}

TEST(Report, LibraryDoesNotCloseItsElement) {
  EXPECT_EQ(report_script().find("</script"), std::string_view::npos);
  EXPECT_EQ(report_style().find("</style"), std::string_view::npos);
  EXPECT_GT(report_script().size(), 100000u);
  EXPECT_GT(report_style().size(), 1000u);
}

TEST(Report, PageFetchesNothing) {
  const std::string own = own_part(compare_report_html(a_result()));
  for (const char* word : {"http://", "https://", "src=\"", "@import", "url("})
    EXPECT_EQ(count(own, word), 0u) << word;
  EXPECT_EQ(count(own, "default-src 'none'"), 1u);
}

TEST(Report, ResultWithoutDetailIsAPageToo) {
  const std::string html = compare_report_html({{"rms_um", 1.0}});
  EXPECT_NE(html.find("<title>Model against measurement</title>"), std::string::npos);
  EXPECT_NE(html.find("\"rms_um\":1.0"), std::string::npos);
}

TEST(Report, ContradictoryDetailIsRefused) {
  Json result = a_result();
  result["detail"]["observations"]["row"][0] = 99;
  EXPECT_THROW(compare_report_html(result), std::invalid_argument);
  EXPECT_THROW(diagnose_report_html(result), std::invalid_argument);
  EXPECT_THROW(improve_report_html(result), std::invalid_argument);
  EXPECT_THROW(diagnose_report_html(Json::array()), std::invalid_argument);
}

TEST(Report, PagesOfDiagnoseAndImproveCarryTheResultAsItIs) {
  for (const auto& [html, type] : {std::pair{diagnose_report_html(a_diagnosis()), "\"type\":\"diagnose\""},
                                   std::pair{improve_report_html(a_diagnosis()), "\"type\":\"improve\""}}) {
    EXPECT_NE(html.find(type), std::string::npos);
    EXPECT_NE(html.find("\"verdict\":\"missing-effect\""), std::string::npos);
    EXPECT_NE(html.find("\"check_rms_um\":1.1"), std::string::npos);
    for (const char* word : {"http://", "https://", "src=\"", "@import", "url("})
      EXPECT_EQ(count(own_part(html), word), 0u) << word;
  }
}

TEST(Report, SameResultGivesTheSameBytes) {
  EXPECT_EQ(compare_report_html(a_result()), compare_report_html(a_result()));
}

TEST(Report, SixThousandRowsStayBelowTwoMegabytes) {
  // The ball-bar record has 6158 rows and about 20 columns; 2 MB opens at once on any machine.
  Json result = a_result();
  Json& detail = result["detail"];
  const std::size_t rows = 6158;
  const std::vector<double> values(rows, 0.123456789);
  const std::vector<int> zeros(rows, 0);
  std::vector<std::size_t> index(rows);
  for (std::size_t i = 0; i < rows; ++i) index[i] = i;
  detail["columns"] = Json::array();
  detail["column_data"] = Json::array();
  for (int column = 0; column < 20; ++column) {
    detail["columns"].push_back({{"name", "c" + std::to_string(column)}});
    detail["column_data"].push_back(values);
  }
  for (const char* key : {"row_run", "row_check", "row_line"}) detail[key] = zeros;
  detail["observations"] = {
      {"kind", {"length"}}, {"row", index}, {"kind_index", zeros}, {"residual", values}};
  EXPECT_LT(compare_report_html(result).size(), 2u << 20);
}

}  // namespace
}  // namespace vernier::report_test
