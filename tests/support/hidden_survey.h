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

/// How the errors of the readings are made (hidden_survey_noise.h). u is what the file states.
enum class NoiseLaw : std::uint8_t {
  kWhite,           // independent, normal, u
  kStudent,         // Student's t of 3 degrees of freedom, standard deviation u
  kQuantised,       // u with the rounding to a display's steps of 2 u in it
  kNoU,             // white, and the file states none
  kTwice,           // white, twice u
  kOutliers,        // 3 % of the rows off by 6 to 14 u
  kSetUps,          // u, and an offset of u that each run has anew, which no BaseShift of the model takes
  kAutoregressive,  // u, of which 0.95 goes from row to row
  kWalk,            // u, and a random walk of rms u along the time in runs
  kWalkNoU,         // the same, and the file states none
  kPoses,           // u, and an error of u that the three readings of a pose share
  kGrowing,         // white; u grows with the distance, and the file says so
  // Disturbances of the instrument, twice u (where nothing is hidden):
  kDrift,  // a random walk
  kStep,   // from a row on
  kJump,   // for a third of the rows
};
inline constexpr std::size_t kNoiseLaws = 15;
inline constexpr std::size_t kLawsOfNoise = 12;  // before the disturbances

struct SurveySpec {
  Family family = Family::kBridge;
  SurveyClass kind = SurveyClass::kSingle;
  NoiseLaw noise = NoiseLaw::kWhite;
  std::string effect;  // id of FORMATS section 4; empty: any that the family can show
  /// rms over the fit observations of what is left of the weighted effect after projection on the complement
  /// of the model's free parameters, over the whole standard deviation of the noise law.
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
  double ratio = 0;                  // reached, in u
  double remaining = 0;              // share of the effect's rms that the free parameters leave
  std::vector<std::string> statics;  // of the term, in the truth's machine file
};

/// An alternative of the truth and what it costs to believe in it: chi^2 of the fit with it minus that with
/// the truth.
struct Alternative {
  Cause cause;
  std::string term;
  double excess = 0;
};

struct HiddenSurvey {
  SurveySpec spec;
  std::string truth, model, csv;  // machine file with and without the effect, measurement file
  std::vector<HiddenEffect> effects;
  std::vector<Alternative> alternatives;  // best first, at most five; for kSingle and kConfusable
  bool can_tell = false;  // the best alternative's excess is 20 times the noise law's variance or more
  std::size_t observations = 0, parameters = 0;
  double u = 0;                   // rms of what the file states or would state of a reading, mm or deg
  std::vector<std::size_t> wild;  // rows with an outlier of the noise
};

/// A survey, the same for the same specification. Throws std::runtime_error where the family cannot show the
/// effect (nothing of it is left beside the model's free parameters after many draws).
HiddenSurvey make_survey(const SurveySpec& spec);

}  // namespace vernier::support
