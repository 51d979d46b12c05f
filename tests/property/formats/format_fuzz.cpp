// SPDX-License-Identifier: GPL-3.0-or-later
// Malformed machine and measurement files from a seeded generator: each is refused with an InputError that
// names a place, or it is one that still is a file of the format: then what was read, written out and read
// again is the same, and every number in it is one that a second, independent scan finds in the text. Prints
// its seed; arguments: seed, count.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/support/machines.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/model/measurement.h"

namespace {

using vernier::model::Machine;
using vernier::model::Measurement;
using vernier::text::InputError;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) {
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

const char* const kWords[] = {"<",
                              ">",
                              "/>",
                              "\"",
                              "'",
                              "&",
                              "=",
                              "(",
                              ")",
                              "^",
                              "-",
                              "+",
                              "*",
                              "1e",
                              "1e999",
                              "nan",
                              "inf",
                              "0x1",
                              ".",
                              "..",
                              ",",
                              "\n",
                              "\0x",
                              "X",
                              "Y",
                              "alpha",
                              "Hide",
                              "true",
                              "n",
                              "value",
                              "run(",
                              "lag(",
                              "<k value=\"1\"/>",
                              "<station loc=\"1\"/>",
                              "</static>",
                              "]]>",
                              "<!--",
                              "-->",
                              "<![CDATA[",
                              "&lt;",
                              "\xEF\xBB\xBF",
                              "\xFF",
                              "#",
                              "[mm]",
                              "[deg]",
                              "check",
                              "fit",
                              "role",
                              "-0",
                              "1.5",
                              "99999999999999999999"};

/// One to four small damages: a byte changed, taken out or doubled, a word put in, a piece moved, a line
/// lost, the end lost.
std::string damage(std::string text, Random& random) {
  const std::size_t times = below(random, 2) == 0 ? 1 : 1 + below(random, 4);
  for (std::size_t i = 0; i < times && !text.empty(); ++i) {
    const std::size_t at = below(random, text.size());
    switch (below(random, 9)) {
      case 8:
        text[at] = "0123456789.-XYZabnt"[below(random, 19)];
        break;
      case 0:
        text[at] = static_cast<char>(below(random, 256));
        break;
      case 1:
        text.erase(at, 1 + below(random, 6));
        break;
      case 2:
        text.insert(at, text, at, 1 + below(random, 12));
        break;
      case 3:
        text.insert(at, kWords[below(random, std::size(kWords))]);
        break;
      case 4:
        text.insert(at, text.substr(below(random, text.size()), 1 + below(random, 60)));
        break;
      case 5:
        text.resize(at);
        break;
      case 6: {
        const std::size_t end = text.find('\n', at);
        text.erase(at, end == std::string::npos ? end : end - at + 1);
        break;
      }
      default: {
        const std::string word = kWords[below(random, std::size(kWords))];
        text.replace(at, std::min(word.size(), text.size() - at), word);
      }
    }
  }
  return text;
}

[[noreturn]] void fail(const char* what, const std::string& text, std::size_t number) {
  std::fprintf(stderr, "input %zu: %s\n----\n%s\n----\n", number, what, text.c_str());
  std::exit(1);
}

/// A number that was read must stand in the text: no value may come from nowhere.
bool stands_in(const std::string& text, double value) {
  if (value == 0 || value == 1) return true;  // the defaults
  const char* at = text.c_str();
  const char* const end = at + text.size();
  while (at < end) {
    char* after = nullptr;
    if (std::strtod(at, &after) == value && after != at) return true;
    ++at;
  }
  return false;
}

bool same(const Machine& a, const Machine& b) {
  if (a.statics.size() != b.statics.size() || a.tables.size() != b.tables.size()) return false;
  for (std::size_t i = 0; i < a.statics.size(); ++i)
    if (a.statics[i].value != b.statics[i].value || a.statics[i].hidden != b.statics[i].hidden) return false;
  for (std::size_t i = 0; i < a.tool.size(); ++i)
    for (std::size_t k = 0; k < a.tool[i].dof_count(); ++k)
      if (vernier::model::to_text(*a.tool[i].dof[k]) != vernier::model::to_text(*b.tool[i].dof[k]))
        return false;
  return true;
}

bool machine_case(const std::string& text, std::size_t number) {
  try {
    const Machine machine = vernier::model::parse_machine(text, "f.xml");
    const Machine again =
        vernier::model::parse_machine(vernier::model::update_machine_text(text, machine, false), "f.xml");
    if (!same(machine, again)) fail("does not read back the same", text, number);
    for (const vernier::model::Static& item : machine.statics)
      if (!std::isfinite(item.value) || !stands_in(text, item.value))
        fail("a static's value is not in the text", text, number);
    for (const vernier::model::Table& table : machine.tables)
      for (std::size_t i = 0; i + 1 < table.stations.size(); ++i)
        if (!(table.stations[i].loc < table.stations[i + 1].loc))
          fail("a table that does not increase", text, number);
    return true;
  } catch (const InputError& error) {
    if (std::string(error.what()).find("f.xml") == std::string::npos)
      fail("the error names no file", text, number);
    return false;
  }
}

bool measurement_case(const std::string& text, const Machine& machine, std::size_t number) {
  try {
    const Measurement m = vernier::model::parse_measurement(text, "f.csv", machine);
    for (const vernier::model::Observation& o : m.observations)
      if (!std::isfinite(o.value)) fail("a reading that is not finite", text, number);
    std::size_t lines = 0;
    for (std::size_t at = 0; at < text.size(); ++lines) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::size_t first = text.find_first_not_of(" \t\r\xEF\xBB\xBF", at);
      if (first >= end || text[first] == '#') --lines;
      at = end + 1;
    }
    if (m.rows() + m.excluded + 1 != lines) fail("a line was silently skipped", text, number);
    try {
      if (!vernier::model::predict(machine, m).allFinite())
        fail("a prediction that is not finite", text, number);
    } catch (const InputError&) {
    }
    return true;
  } catch (const InputError& error) {
    if (std::string(error.what()).find("f.csv") == std::string::npos)
      fail("the error names no file", text, number);
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned long long seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20260101;
  const std::size_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 100000;
  std::printf("seed %llu, %zu inputs\n", seed, count);
  Random random(seed);
  const std::vector<std::string> machines = {
      vernier::support::bridge_text(3),
      "<machine name=\"m\" gravity=\"0 0 -1\">\n<variables>\n<static>\n<alpha value=\"1e-4\" nominal=\"0\" "
      "unit=\"rad\"/>\n"
      "<TP value=\"-80\" Hide=\"true\"/>\n<BaseShift run=\"s2\" X=\"1\" "
      "rZ=\"2\"/>\n</static>\n<machineaxes>\n"
      "<X rotary=\"false\" min=\"0\" max=\"600\" maxslew=\"5\"/>\n<C rotary=\"true\" "
      "rollover=\"true\"/>\n</machineaxes>\n"
      "<inputs><T unit=\"degC\" reference=\"20\"/></inputs>\n<comptables>\n<table axis=\"C\" "
      "interpolation=\"cubic\" fit=\"X\">\n"
      "<station loc=\"0\" X=\"0.5\"/>\n<station loc=\"90\"/>\n<station loc=\"360\" "
      "X=\"0.5\"/>\n</table></comptables>\n</variables>\n"
      "<transforms branch=\"workpiece\"><DH n=\"1\" theta=\"C+lCx\" alpha=\"90\"/></transforms>\n"
      "<transforms>\n<sixdof n=\"1\" X=\"X*(1+alpha)^2\" Y=\"-sin(C)*TP\" "
      "rZ=\"lag(T,30)*(X&lt;3)\"/>\n</transforms>\n</machine>\n"};
  const std::string rows =
      "# "
      "rows\nX[mm],C[deg],dirX,feed[mm/"
      "min],t[s],T[degC],x[um],y[mm],length[mm],cx[mm],cy[mm],cz[mm],u[um],load[kg],run,role\n"
      "1,2,1,100,0,20,5,0.1,50,0,0,0,2,1,a,fit\n2,3,-1,100,1,,5,0.1,,,,,2,,a,fit\n3,4,0,100,2,21,,0.1,51,1,2,"
      "3,2,3,\"b\",check\n";
  const Machine machine = vernier::model::parse_machine(machines[1], "m.xml");
  for (const std::string& text : machines)
    vernier::model::parse_machine(text, "seed.xml");  // undamaged they are fine
  vernier::model::parse_measurement(rows, "seed.csv", machine);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_machine = i % 2 == 0;
    const std::string text = damage(is_machine ? machines[below(random, 2)] : rows, random);
    accepted += (is_machine ? machine_case(text, i) : measurement_case(text, machine, i)) ? 1U : 0U;
  }
  std::printf("%zu refused with a place, %zu still files of the format and read back the same\n",
              count - accepted, accepted);
  // Both must happen, or the generator has lost its teeth.
  return accepted > count / 100 && accepted < count * 9 / 10 ? 0 : 1;
}
