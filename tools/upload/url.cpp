// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/url.h"

#include <fmt/format.h>

#include <charconv>

#include "tools/text/error.h"

namespace vernier::upload {
namespace {

std::uint32_t parse_number(const std::string& text, const std::string& where) {
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  const char* const first = text.data() + (hex ? 2 : 0);
  const char* const last = text.data() + text.size();
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(first, last, value, hex ? 16 : 10);
  if (error != std::errc{} || end != last || first == last)
    throw text::InputError("board address: " + where + ": '" + text + "' is no number");
  return value;
}

void parse_options(const std::string& text, BoardUrl& url) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('&', at), text.size());
    const std::string option = text.substr(at, end - at);
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos || equals == 0)
      throw text::InputError("board address: '" + option + "' is not name=value");
    url.options[option.substr(0, equals)] = option.substr(equals + 1);
    at = end + 1;
  }
}

}  // namespace

std::uint32_t BoardUrl::number(const std::string& name, std::uint32_t otherwise) const {
  const auto found = options.find(name);
  return found == options.end() ? otherwise : parse_number(found->second, name);
}

BoardUrl parse_url(const std::string& text) {
  BoardUrl url;
  const std::size_t colon = text.find("://");
  url.scheme = colon == std::string::npos ? "tcp" : text.substr(0, colon);
  std::string rest = colon == std::string::npos ? text : text.substr(colon + 3);
  if (url.scheme == "modbus" || url.scheme == "modbus-tcp") url.scheme = "tcp";
  if (url.scheme != "tcp" && url.scheme != "rtu" && url.scheme != "can" && url.scheme != "serial")
    throw text::InputError(
        fmt::format("board address: '{}' is not one of tcp, rtu, serial and can", url.scheme));
  if (const std::size_t question = rest.find('?'); question != std::string::npos) {
    parse_options(rest.substr(question + 1), url);
    rest.resize(question);
  }
  if (url.scheme == "tcp") {
    while (!rest.empty() && rest.back() == '/') rest.pop_back();
    if (const std::size_t port = rest.rfind(':'); port != std::string::npos) {
      const std::uint32_t number = parse_number(rest.substr(port + 1), "port");
      if (number == 0 || number > 65535)
        throw text::InputError("board address: no port " + std::to_string(number));
      url.port = static_cast<int>(number);
      rest.resize(port);
    }
  }
  url.place = rest;
  if (url.place.empty())
    throw text::InputError(fmt::format("board address: '{}' contains no host, device or interface", text));
  return url;
}

}  // namespace vernier::upload
