// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/seeds.h"

#include <filesystem>
#include <map>

#include "tests/fuzz/binary_seeds.h"
#include "tools/text/files.h"

namespace vernier::fuzz {

using namespace vernier::text;
namespace {

std::string file(const std::string& name) { return read_file(std::string(VERNIER_SOURCE_DIR) + "/" + name); }

std::vector<std::string> files(const std::string& folder, const std::string& extension) {
  std::vector<std::string> list;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(VERNIER_SOURCE_DIR) + "/" + folder))
    if (entry.path().extension() == extension) list.push_back(read_file(entry.path().string()));
  return list;
}

std::string head(const std::string& text, std::size_t lines) {
  std::size_t at = 0;
  while (lines-- > 0 && at != std::string::npos) at = text.find('\n', at + 1);
  return at == std::string::npos ? text : text.substr(0, at + 1);
}

/// What stands between two marks, each time, put in another's place.
std::string replaced(std::string text, const std::string& from, const std::string& to,
                     const std::string& by) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
    const std::size_t begin = at + from.size(), end = text.find(to, begin);
    text.replace(begin, end - begin, by);
  }
  return text;
}

/// The ball bar's file with a few readings: what is long is slow to mutate.
std::string short_b5r() {
  std::string text = file("tests/data/ballbar/ur10e_xy_100mm.b5r"), readings;
  for (int i = 0; i < 40; ++i) readings += (i == 0 ? "" : " ") + std::to_string(0.01 * i);
  text = replaced(text, "<READINGS>", "</READINGS>", readings);
  text = replaced(text, "<START_INDEX>", "<", "5");
  return replaced(text, "<END_INDEX>", "<", "30");
}

const char* const kRows =
    "# rows\nX[mm],C[deg],dirX,feed[mm/min],t[s],T[degC],x[um],y[mm],length[mm],cx[mm],cy[mm],cz[mm],u[um],"
    "load[kg],run,role\n1,2,1,100,0,20,5,0.1,50,0,0,0,2,1,a,fit\n2,3,-1,100,1,,5,0.1,,,,,2,,a,fit\n"
    "# excluded \"door\": 9,9\n3,4,0,100,2,21,,0.1,51,1,2,3,2,3,\"b\",check\n";

std::map<std::string, std::vector<std::string>> text_seeds() {
  std::map<std::string, std::vector<std::string>> seeds;
  seeds["expression"] = {"k*(X+T)",
                         "-sin(C)*TP^2+lag(T,30)*(X<3)",
                         "run(\"a\")*1.5e-3",
                         "k*dir{q}*({hats 5})",
                         "atan2(Y,X)/min(1,max(2,abs(-3)))",
                         "(((1)))",
                         "exp(-since{q}/L)=sqrt(log(sign(2)))"};
  seeds["machine"] = files("tables/machines", ".xml");
  seeds["machine"].push_back(file("tests/data/real/nist_probe/machine.xml"));
  seeds["lint"] = {file("tables/machines/xy_ball_bar.xml"), file("tables/machines/gantry.xml"), kRows,
                   head(file("tests/data/real/nist_probe/meas.csv"), 12)};
  seeds["csv"] = seeds["measurement"] = {kRows, head(file("tests/data/real/nist_probe/meas.csv"), 12)};
  seeds["sheet"] = files("tests/data/sheets", ".xlsx");
  seeds["sheet"].insert(seeds["sheet"].end(), {kRows, "Pos;Anzeige\n1,5;2\n2,5;\"x\"\n",
                                               "\xEF\xBB\xBF"
                                               "a\tb\n1\t2\n",
                                               std::string("\xFF\xFE"
                                                           "a\0,\0b\0\n\0"
                                                           "1\0,\0"
                                                           "2\0\n\0",
                                                           18),
                                               "X[mm] x[um]\n 1   2\n"});
  seeds["column_map"] = {
      "separator = semicolon\ndecimal = comma\nskip = 1\ncolumn 1 = X[mm]\ncolumn Tx = x[m]\nset u[um] = 15\n"
      "header = yes\n====\ntitle\nX;Tx\n1,5;0,001\n2;0,002\n",
      "comment = %\nseparator = space\ncolumn 1 = qw\ncolumn 2 = qx\ncolumn 3 = qy\ncolumn 4 = qz\n====\n1 0 "
      "0 0\n",
      "column 1 = mx[mm]\ncolumn 2 = my[mm]\ncolumn 3 = mz[mm]\nset px[mm] = 0\nset py[mm] = 0\nset pz[mm] = "
      "0\n"
      "set nx = 0\nset ny = 0\nset nz = 1\n====\n1,2,3\n4,5,6\n"};
  seeds["spreadsheet"] = {
      "separator = semicolon\ndecimal = comma\ncolumn Pos = X[mm]\ndeviation Anzeige = X[um]\nset run = "
      "a\nskip = 1\n"
      "====\nMessung;\nPos;Anzeige\n100;1,5\n200;2,5\n",
      "unit = mm\nleave Note\n====\nTarget X\tX ist\tRichtung\tNote\n1\t1.5\thin\tabc\n2\t2.5\tback\t\n"};
  seeds["b5r"] = {short_b5r()};
  seeds["trace"] = {file("tests/data/ballbar/ballbar_trace_fragment.json"),
                    "{\"ErrorUnits\":\"millimetres\",\"Runs\":[{\"Direction\":1,\"Readings\":[1e999,0.1]}]}"};
  seeds["part_program"] = {"G21 G90\nN10 G0 X10 Y10 Z-5\nG1 X50 F1000 (in)\nG2 X60 Y20 I5 J5\nG91\nX5\nM2\n",
                           "%\nO1\nG17 G20\nG1X1.Y2.Z-.5;c\nG3 X0 Y0 R2\n%\n",
                           "X[mm],Y[mm],Z[mm]\n1,2,-3\n4,5,-6\n"};
  seeds["tables"] = {
      "X[mm],lXx[mm],rXz[deg]\n0,0.02,0\n10,0.03,0.001\n",
      "// note\nX EXX EYX EZX EAX EBX ECX\n0.0 0.02 0.01 0.07 0.00 0.0042 0.003\n10.0\t0.00 -0.1 0.01 "
      "0.00 0.0011 0.002 // end\n#\nY EYY\n0 1\n5 2\n",
      "0 0.001 0.002\n10 9.99 10.01\n# c\n20 20.1 20.2\n"};
  seeds["check_history"] = {
      "{\"format\":\"vernier-checks\",\"version\":1,\"machine\":\"m\",\"checks\":[{\"label\":\"a\","
      "\"readings\":3,"
      "\"beyond_set_up\":1.5,\"parameters\":1,\"suspects\":[{\"name\":\"k\",\"unit\":\"mm\",\"of_"
      "instrument\":false}],"
      "\"gram\":[[1.0]],\"moment\":[[2.0]],\"rest\":0.5,\"freedom\":2.0}]}",
      "{\"format\":\"vernier-checks\",\"version\":2,\"machine\":\"m\",\"checks\":[]}"};
  seeds["effects"] = {head(file("tools/effects/catalogue.txt"), 30)};
  seeds["measured_part"] = {head(file("tests/data/spart/overcut_reference.csv"), 6),
                            "x[mm],y[mm],z[mm],defect[um],u[um]\n10,20,5,3,1\n"};
  seeds["dh_table"] = {"theta[deg],d[mm],a[mm],alpha[deg]\n0,100,0,90\n0,0,-600,0\n",
                       "type,theta[deg],d[mm],a[mm],alpha[deg]\nP,0,1,2,90\n", "X:0:600", "X=0..600",
                       "C:rotary"};
  seeds["path"] = {"t[s],X[mm],Y[mm],T[degC],run\n0,0,0,20,a\n0.01,1,0,20,a\n0.02,2,1,20,b\n"};
  seeds["exclude"] = {std::string("3-4,6\n") + kRows, std::string("3\n") + kRows};
  seeds["url"] = {"tcp://127.0.0.1:1502", "rtu:///dev/ttyS1?baud=19200&unit=3",
                  "can://can0?send=0x123&receive=124", "serial:///dev/ttyUSB0?baud=115200", "host:99"};
  seeds["board_file"] = files("tests/data/board", ".toml");
  for (std::string& text : seeds["board_file"]) text = replaced(text, "public_key", "\n", " = \"\"");
  seeds["calibration"] = {"# code um\n0 -1.5\n1000,0.1\n2000 1.2\n", "code,measured\n0,1\n10,2\n",
                          "vernier public key 1\n" + std::string(64, 'a') + "\n"};
  return seeds;
}

}  // namespace

std::vector<std::string> seeds_of(const std::string& target) {
  static const auto kTexts = text_seeds();
  const auto found = kTexts.find(target);
  return found != kTexts.end() ? found->second : binary_seeds_of(target);
}

}  // namespace vernier::fuzz
