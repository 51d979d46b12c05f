// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vernier::support {

/// Machines that a hidden-effect survey can be taken on; most are files of tables/machines.
enum class Family : std::uint8_t {
  kBridge,
  kColumn,         // moving table: X and Y on the workpiece side
  kGantry,         // 6 m x 3 m x 1 m
  kHorizontalArm,  // the arm's extension bends the column
  kFiveAxis,       // B head, C table
  kFibre,          // three linear and four rotary axes, 17 m
  kRobot,          // six joints
  kBallBar,        // circles in XY, the length read
  kSingleAxis,     // ISO 230-2 cycles, one reading per row
  // Machines drawn anew for each seed (likeness_machines.h): none of the reference ones.
  kSixJoint,
  kAltAz,
  kEquatorial,
  kBed,
  kTurntable,
  kGearTrain,
  kTorsoArm,
};
inline constexpr std::size_t kFamilyCount = 9;    // of the reference machines
inline constexpr std::size_t kLikenessCount = 7;  // behind them
const char* family_name(Family family);
/// Throws std::invalid_argument.
Family family_named(const std::string& name);

/// What is hidden in a survey.
enum class SurveyClass : std::uint8_t {
  kSingle,      // one effect of FORMATS section 4
  kTwo,         // two of them, axes and places independent
  kOutside,     // something that no catalogue and no search of three factors holds
  kNoise,       // nothing
  kConfusable,  // one effect that the survey's design cannot tell from another
};

struct SurveySpec {
  Family family = Family::kBridge;
  SurveyClass kind = SurveyClass::kSingle;
  std::string effect;  // id of FORMATS section 4; empty: any that the family can show
  /// rms over the fit observations of what is left of the weighted effect after projection on the complement
  /// of the model's free parameters.
  double ratio = 2;
  double u_mm = 0;  // standard uncertainty of a reading; 0: the family's own
  std::size_t rows = 400, runs = 4;
  int feeds = 3;  // 1 or 3
  std::uint64_t seed = 1;
};

/// What a diagnosis may call the cause. Empty axis or input: any.
struct Cause {
  std::string effect, axis, input;
  bool operator==(const Cause&) const = default;
};

/// The truth about one hidden effect.
struct HiddenEffect {
  Cause cause;
  std::vector<std::string> inputs;  // all that the term uses
  std::string branch, dof, term;    // of the first place of the term
  int transform = 0;
  std::vector<Cause> accept;         // the cause, its other names, and twins (one and the same column)
  double ratio = 0;                  // reached
  double remaining = 0;              // share of the effect's rms that the free parameters leave
  std::vector<std::string> statics;  // of the term, in the truth's machine file
};

/// A rival of the truth and what it costs to believe in it: chi^2 of the fit with it minus that with the
/// truth.
struct Rival {
  Cause cause;
  std::string term;
  double excess = 0;
};

struct HiddenSurvey {
  SurveySpec spec;
  std::string truth, model, csv;  // machine file with and without the effect, measurement file
  std::vector<HiddenEffect> effects;
  std::vector<Rival> rivals;  // best first, at most five; for kSingle and kConfusable
  bool can_tell = false;      // the best rival's excess is 20 or more
  std::size_t observations = 0, parameters = 0;
};

/// A survey, the same for the same specification. Throws std::runtime_error where the family cannot show the
/// effect (nothing of it is left beside the model's free parameters after many draws).
HiddenSurvey make_survey(const SurveySpec& spec);

}  // namespace vernier::support
