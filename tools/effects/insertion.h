// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <pugixml.hpp>
#include <string>

#include "tools/text/xml_text.h"

namespace vernier::effects {

/// Returns the position of an element's name in the text from which the element was read, in bytes from 0.
std::size_t offset_of(const pugi::xml_node& node);

/// Returns the first element below `parent` that has the name `name`, in capital or small letters.
pugi::xml_node element_named(const pugi::xml_node& parent, const char* name);

/// Inserts `lines` at the end of an element's content. If the closing tag of the element is on a separate
/// line, the lines are inserted before this line. An empty element (<name/>) gets a separate closing tag.
text::TextEdit at_end_of(const std::string& text, const pugi::xml_node& node, const std::string& lines);

}  // namespace vernier::effects
