// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/urdf_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::format {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kMmPerM = 1000;

class Reader {
 public:
  Reader(const std::string& text, const std::string& file) : text_(text), file_(file) {
    const pugi::xml_parse_result parsed = document_.load_buffer(text.data(), text.size());
    if (!parsed)
      throw text::InputError({file, text::line_of(text, static_cast<std::size_t>(parsed.offset))}, "",
                             parsed.description());
    robot_ = document_.child("robot");
    if (!robot_)
      throw text::InputError({file, 1}, document_.first_child().name(),
                             "this file is not a URDF: its root must be <robot>");
    for (const pugi::xml_node& node : robot_.children())
      if (std::string_view(node.name()).starts_with("xacro:")) fail(node, node.name(), kExpand);
  }

  std::string name() const { return robot_.attribute("name").as_string("robot"); }

  std::vector<UrdfJoint> joints() const {
    std::vector<UrdfJoint> list;
    for (const pugi::xml_node& node : robot_.children("joint")) list.push_back(joint(node));
    return list;
  }

  std::set<std::string> links() const {
    std::set<std::string> names;
    for (const pugi::xml_node& node : robot_.children("link"))
      names.insert(node.attribute("name").as_string());
    return names;
  }

 private:
  static constexpr const char* kExpand = "this is xacro: expand it first (xacro FILE > robot.urdf)";

  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& word, const std::string& why) const {
    throw text::InputError({file_, text::line_of(text_, static_cast<std::size_t>(node.offset_debug()))}, word,
                           why);
  }

  double number(const pugi::xml_node& node, const std::string& word) const {
    const auto value = text::parse_number(word);
    if (!value) fail(node, word, "not a number");
    return *value;
  }

  Vector3d triple(const pugi::xml_node& node, const char* attribute, const Vector3d& absent) const {
    const pugi::xml_attribute given = node.attribute(attribute);
    if (!given) return absent;
    if (std::string_view(given.as_string()).find("${") != std::string_view::npos)
      fail(node, given.as_string(), kExpand);
    const std::vector<std::string> words = text::words_in(given.as_string(), " \t\r\n");
    if (words.size() != 3) fail(node, given.as_string(), std::string(attribute) + " must be three numbers");
    return {number(node, words[0]), number(node, words[1]), number(node, words[2])};
  }

  std::optional<double> limit(const pugi::xml_node& node, const char* attribute) const {
    const pugi::xml_attribute given = node.attribute(attribute);
    if (!given) return std::nullopt;
    return number(node, given.as_string());
  }

  UrdfJoint joint(const pugi::xml_node& node) const {
    UrdfJoint one;
    one.line = text::line_of(text_, static_cast<std::size_t>(node.offset_debug()));
    one.name = node.attribute("name").as_string();
    one.type = node.attribute("type").as_string();
    one.parent = node.child("parent").attribute("link").as_string();
    one.child = node.child("child").attribute("link").as_string();
    if (one.parent.empty() || one.child.empty())
      fail(node, one.name, "this joint lacks its parent or child link");
    one.mimic = static_cast<bool>(node.child("mimic"));
    const pugi::xml_node origin = node.child("origin");
    const Vector3d turn = triple(origin, "rpy", Vector3d::Zero());
    constexpr double kFullTurn = 6.3;  // rad
    if (turn.cwiseAbs().maxCoeff() > kFullTurn)
      fail(origin, origin.attribute("rpy").as_string(),
           "more than a full turn: the angles of a URDF are in rad, and these are probably in deg");
    one.origin.linear() =
        (Eigen::AngleAxisd(turn[2], Vector3d::UnitZ()) * Eigen::AngleAxisd(turn[1], Vector3d::UnitY()) *
         Eigen::AngleAxisd(turn[0], Vector3d::UnitX()))
            .toRotationMatrix();
    one.origin.translation() = kMmPerM * triple(origin, "xyz", Vector3d::Zero());
    one.axis = triple(node.child("axis"), "xyz", Vector3d::UnitX());
    if (one.moves() && !(one.axis.norm() > 0))
      fail(node, one.name, "the axis of this joint has no direction");
    one.axis.normalize();
    one.lower = limit(node.child("limit"), "lower");
    one.upper = limit(node.child("limit"), "upper");
    return one;
  }

  const std::string &text_, &file_;
  pugi::xml_document document_;
  pugi::xml_node robot_;
};

std::string triple(const Vector3d& v) {
  constexpr double kRounding = 5e-16;
  const auto plain = [](double value) { return std::abs(value) < kRounding ? 0.0 : value; };
  return fmt::format("{:.12g} {:.12g} {:.12g}", plain(v[0]), plain(v[1]), plain(v[2]));
}

}  // namespace

UrdfTree::UrdfTree(const std::string& text, const std::string& file) : file_(file) {
  const Reader reader(text, file);
  name_ = reader.name();
  joints_ = reader.joints();
  links_ = reader.links();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const UrdfJoint& one = joints_[i];
    for (const std::string* end : {&one.parent, &one.child})
      if (!links_.contains(*end))
        throw text::InputError({file, one.line}, *end, "the URDF has no link of this name");
    if (!above_.emplace(one.child, i).second)
      throw text::InputError({file, one.line}, one.child,
                             "this link has two parent joints: the URDF is not an arm");
  }
  for (const std::string& link : links_) way_to(link);  // refuses a loop
}

std::vector<UrdfJoint> UrdfTree::way_to(const std::string& link) const {
  std::vector<UrdfJoint> way;
  for (std::string at = link; above_.contains(at); at = way.back().parent) {
    way.push_back(joints_[above_.at(at)]);
    if (way.size() > joints_.size())
      throw text::InputError({file_, way.back().line}, link,
                             "the joints close a loop: the URDF is not an arm");
  }
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<std::string> UrdfTree::ends() const {
  std::vector<std::string> ends;
  std::ptrdiff_t most = 1;
  for (const std::string& link : links_) {
    if (std::any_of(joints_.begin(), joints_.end(), [&](const UrdfJoint& one) { return one.parent == link; }))
      continue;
    const std::vector<UrdfJoint> way = way_to(link);
    const auto moving =
        std::count_if(way.begin(), way.end(), [](const UrdfJoint& one) { return one.moves(); });
    if (moving > most) ends.clear();
    if (moving < most) continue;
    most = moving;
    ends.push_back(link);
  }
  if (ends.empty()) throw text::InputError({file_, 1}, "robot", "the URDF has no joint that moves");
  return ends;
}

std::string UrdfTree::only_end() const {
  const std::vector<std::string> ends = this->ends();
  if (ends.size() > 1)
    throw text::InputError(fmt::format("{}: the arm has several end links, choose one with --tip: {}", file_,
                                       text::joined(ends, ", ")));
  return ends.front();
}

void UrdfTree::require_link(const std::string& name) const {
  if (!links_.contains(name)) throw text::InputError({file_, 1}, name, "the URDF has no link of this name");
}

Isometry3d first_row_frame(const JointLine& first_axis) {
  constexpr double kThrough_mm = 1e-9, kParallel = 1e-6;
  const Vector3d& z = first_axis.direction;
  const auto across = [&z](const Vector3d& v) -> Vector3d { return v - v.dot(z) * z; };
  const Vector3d nearest = across(first_axis.point);
  Vector3d side = across(Vector3d::UnitX());
  if (side.norm() < kParallel) side = across(Vector3d::UnitY());
  Isometry3d frame = Isometry3d::Identity();
  frame.linear().col(0) = side.normalized();
  frame.linear().col(1) = z.cross(frame.linear().col(0));
  frame.linear().col(2) = z;
  if (nearest.norm() >= kThrough_mm) frame.translation() = nearest;
  return frame;
}

std::string origin_xyz(const Isometry3d& frame_mm) { return triple(frame_mm.translation() / kMmPerM); }

std::string origin_rpy(const Isometry3d& frame_mm) {
  constexpr double kStraightUp = 1e-12;
  const Eigen::Matrix3d r = frame_mm.rotation();
  const double level = std::hypot(r(0, 0), r(1, 0)), pitch = std::atan2(-r(2, 0), level);
  const bool straight_up = level < kStraightUp;
  const double yaw = straight_up ? 0 : std::atan2(r(1, 0), r(0, 0));
  const double roll =
      straight_up ? std::atan2(r(0, 1) * (pitch > 0 ? 1 : -1), r(1, 1)) : std::atan2(r(2, 1), r(2, 2));
  return triple({roll, pitch, yaw});
}

std::string with_origins(const std::string& text, const std::string& file,
                         const std::map<std::string, Isometry3d>& origins_mm) {
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size());
  std::vector<text::TextEdit> edits;
  for (const auto& [name, frame] : origins_mm) {
    const pugi::xml_node joint =
        document.child("robot").find_child_by_attribute("joint", "name", name.c_str());
    const pugi::xml_node origin = joint.child("origin");
    const pugi::xml_node place = origin ? origin : joint;
    const auto at = static_cast<std::size_t>(place.offset_debug());
    if (!joint || text.compare(at, std::char_traits<char>::length(place.name()), place.name()) != 0)
      throw text::InputError({file, 1}, name,
                             "this joint cannot be found again in the text; save the file as UTF-8 without a "
                             "byte order mark, and with encoding=\"UTF-8\" in its first line");
    const std::string xyz = origin_xyz(frame), rpy = origin_rpy(frame);
    if (!origin) {
      const std::size_t end = text.find('>', text::end_of_attributes(text, at));
      edits.push_back({end + 1, 0, fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", xyz, rpy)});
      continue;
    }
    const std::vector<text::AttributeSpan> spans = text::attribute_spans(text, at);
    const auto set = [&](const char* attribute, const std::string& value) {
      const auto span = std::find_if(spans.begin(), spans.end(),
                                     [&](const text::AttributeSpan& one) { return one.name == attribute; });
      if (span != spans.end())
        edits.push_back({span->value_at, span->value_size, value});
      else
        edits.push_back({text::end_of_attributes(text, at), 0, fmt::format(" {}=\"{}\"", attribute, value)});
    };
    set("xyz", xyz);
    set("rpy", rpy);
  }
  return text::apply_edits(text, std::move(edits));
}

}  // namespace vernier::format
