// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/expression.h"

#include "tests/fuzz/target.h"

namespace vernier::fuzz {

using namespace vernier::model;
namespace {

template <class Parse>
void there_and_back(const std::string& text, Parse parse) {
  ExprPtr expr;
  try {
    expr = parse(text);
  } catch (const ExpressionError& error) {
    expect(error.offset <= text.size(), "an error beyond the text");
    return;
  }
  // What has as many nodes and brackets as are allowed may need more as it is written.
  const std::string written = to_text(*expr);
  try {
    expect(to_text(*parse(written)) == written, "does not read back the same");
  } catch (const ExpressionError&) {
    expect(text.size() > 100, "what it writes cannot be read");
  }
}

void take(Bytes bytes) {
  const std::string text = text_of(bytes);
  there_and_back(text, parse_expression);
  there_and_back(text, parse_template);
}

const Registered kTarget("expression", take);

}  // namespace
}  // namespace vernier::fuzz
