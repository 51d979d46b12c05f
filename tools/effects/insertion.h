// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <pugixml.hpp>
#include <string>

#include "tools/text/xml_text.h"

namespace vernier::effects {

/// Where the name of an element stands in the text that it was read from.
std::size_t offset_of(const pugi::xml_node& node);

/// Puts `lines` at the end of an element's content, before the line of its closing tag where that has a
/// line of its own; an empty element is opened. tool.
text::TextEdit at_end_of(const std::string& text, const pugi::xml_node& node, const std::string& lines);

}  // namespace vernier::effects
