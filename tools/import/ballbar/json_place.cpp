// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/json_place.h"

#include <algorithm>
#include <vector>

#include "tools/text/error.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::importer {
namespace {

// Walks over a text by the parser's events and remembers where in the document it is.
class Locator {
 public:
  using Json = nlohmann::json;
  explicit Locator(std::string wanted) : wanted_(std::move(wanted)) {}

  bool null() { return value(); }
  bool boolean(bool) { return value(); }
  bool number_integer(Json::number_integer_t) { return value(); }
  bool number_unsigned(Json::number_unsigned_t) { return value(); }
  bool number_float(Json::number_float_t, const Json::string_t&) { return value(); }
  bool string(Json::string_t&) { return value(); }
  bool binary(Json::binary_t&) { return value(); }
  bool start_object(std::size_t) { return open(false); }
  bool start_array(std::size_t) { return open(true); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(Json::string_t& name) {
    levels_.back().key = name;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) { return false; }

 private:
  struct Level {
    bool array = false;
    std::size_t index = 0;
    std::string key;
  };
  // Returns false, which ends the walk, at the wanted value.
  bool value() {
    const bool found = pointer() == wanted_;
    if (!levels_.empty()) ++levels_.back().index;
    return !found;
  }
  bool open(bool array) {
    if (pointer() == wanted_) return false;
    levels_.push_back({array, 0, {}});
    return true;
  }
  bool close() {
    levels_.pop_back();
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }
  std::string pointer() const {
    std::string text;
    for (const auto& level : levels_) text += "/" + (level.array ? std::to_string(level.index) : level.key);
    return text;
  }

  std::string wanted_;
  std::vector<Level> levels_;
};

// An iterator that reports the position of the parser.
struct Counting {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  const char* at = nullptr;
  const char** reached = nullptr;
  reference operator*() const { return *at; }
  Counting& operator++() {
    ++at;
    if (reached != nullptr) *reached = at;
    return *this;
  }
  bool operator==(const Counting& other) const { return at == other.at; }
  bool operator!=(const Counting& other) const { return at != other.at; }
};

}  // namespace

nlohmann::json parse_json(const std::string& path, std::string_view text) {
  if (text::nests_deeper_than(text, text::kMostJsonDepth))
    throw text::InputError({path, 1}, "[", "the JSON of this file nests too deeply");
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::out_of_range& error) {
    // The library reports the number, but not its position.
    const std::string what = error.what();
    const std::size_t open = what.find('\''), close = what.rfind('\'');
    const std::string word = open < close ? what.substr(open + 1, close - open - 1) : "";
    throw text::InputError({path, text::line_of(text, text.find(word))}, word, "this number is too large");
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    std::size_t begin = at;
    while (begin > 0 && std::string_view(" \t\r\n,:[]{}").find(text[begin - 1]) == std::string_view::npos)
      --begin;
    std::string word(
        text.substr(begin, std::min<std::size_t>(24, text.find_first_of(" \t\r\n,:[]{}", at) - begin)));
    throw text::InputError({path, text::line_of(text, at)}, word.empty() ? "end of file" : word, "not JSON");
  }
}

std::size_t json_line(std::string_view text, const std::string& pointer) {
  const char* reached = text.data();
  Locator locator(pointer);
  const bool ran_through = nlohmann::json::sax_parse(Counting{text.data(), &reached},
                                                     Counting{text.data() + text.size(), nullptr}, &locator);
  if (ran_through) return 0;
  // The parser has read one character beyond the value, which may be the line end behind it.
  const auto offset = static_cast<std::size_t>(reached - text.data());
  return text::line_of(text, offset == 0 ? 0 : offset - 1);
}

}  // namespace vernier::importer
