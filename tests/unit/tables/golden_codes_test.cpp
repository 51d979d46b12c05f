// SPDX-License-Identifier: GPL-3.0-or-later
// Every code that is stored or sent, with its number. A new one at the end of a list changes no version; a
// number that changes does.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "comp/probing/latch.h"
#include "comp/probing/touch_filter.h"
#include "comp/shares.h"
#include "firmware/core/cycle/exchange.h"
#include "firmware/core/link/uploader.h"
#include "tables/link_format.h"
#include "tests/unit/tables/golden_listing.h"

namespace vernier::golden {
namespace {

#define VERNIER_CODE(type, name) codes += number(type::name) + " " #type " " #name "\n"

template <class Code>
std::string number(Code code) {
  return std::to_string(static_cast<long>(code));
}

TEST(GoldenCodes, OfAnImage) {
  std::string codes = "= codes of machine images, format " + std::to_string(kImageFormatVersion) + "\n";
  VERNIER_CODE(SectionType, kName);
  VERNIER_CODE(SectionType, kAxes);
  VERNIER_CODE(SectionType, kInputs);
  VERNIER_CODE(SectionType, kConstants);
  VERNIER_CODE(SectionType, kChannels);
  VERNIER_CODE(SectionType, kInstructions);
  VERNIER_CODE(SectionType, kTerms);
  VERNIER_CODE(SectionType, kTables);
  VERNIER_CODE(SectionType, kRecords);
  VERNIER_CODE(SectionType, kWraps);
  VERNIER_CODE(SectionType, kOutputs);
  VERNIER_CODE(SectionType, kShareConstants);
  VERNIER_CODE(SectionType, kShareSources);
  VERNIER_CODE(SectionType, kShareInstructions);
  VERNIER_CODE(SectionType, kShareTerms);
  VERNIER_CODE(SectionType, kShares);
  VERNIER_CODE(SectionType, kShareNames);
  VERNIER_CODE(AxisFlag, kRotary);
  VERNIER_CODE(AxisFlag, kRollover);
  VERNIER_CODE(ChannelKind, kPosition);
  VERNIER_CODE(ChannelKind, kVelocity);
  VERNIER_CODE(ChannelKind, kAcceleration);
  VERNIER_CODE(ChannelKind, kSense);
  VERNIER_CODE(ChannelKind, kSince);
  VERNIER_CODE(ChannelKind, kInput);
  VERNIER_CODE(ChannelKind, kFeed);
  VERNIER_CODE(ChannelKind, kCurvature);
  VERNIER_CODE(ChannelKind, kTime);
  VERNIER_CODE(ChannelKind, kVisit);
  VERNIER_CODE(OpCode, kLinear);
  VERNIER_CODE(OpCode, kMultiply);
  VERNIER_CODE(OpCode, kDot);
  VERNIER_CODE(OpCode, kAbs);
  VERNIER_CODE(OpCode, kMin);
  VERNIER_CODE(OpCode, kMax);
  VERNIER_CODE(OpCode, kSign);
  VERNIER_CODE(OpCode, kEqual);
  VERNIER_CODE(OpCode, kLess);
  VERNIER_CODE(OpCode, kWrap);
  VERNIER_CODE(OpCode, kLookUp);
  VERNIER_CODE(OpCode, kSineCosine);
  VERNIER_CODE(OpCode, kLag);
  expect_golden("image_codes_v" + std::to_string(kImageFormatVersion) + ".txt", codes);
}

std::string upload_codes() {
  std::string codes;
  VERNIER_CODE(UploadFault, kNone);
  VERNIER_CODE(UploadFault, kNoUpload);
  VERNIER_CODE(UploadFault, kTrialRuns);
  VERNIER_CODE(UploadFault, kTooLarge);
  VERNIER_CODE(UploadFault, kOutOfOrder);
  VERNIER_CODE(UploadFault, kIncomplete);
  VERNIER_CODE(UploadFault, kStore);
  VERNIER_CODE(UploadFault, kNotAnUpload);
  VERNIER_CODE(UploadFault, kNoKey);
  VERNIER_CODE(UploadFault, kForeignKey);
  VERNIER_CODE(UploadFault, kSignature);
  VERNIER_CODE(UploadFault, kImage);
  VERNIER_CODE(UploadFault, kFingerprint);
  VERNIER_CODE(UploadFault, kForeignMachine);
  VERNIER_CODE(UploadFault, kOlder);
  VERNIER_CODE(UploadFault, kNoTrial);
  VERNIER_CODE(UploadFault, kTooMuchWork);
  VERNIER_CODE(UploadFault, kOtherBoard);
  VERNIER_CODE(UploadFault, kSecurity);
  VERNIER_CODE(UploadFault, kAbsurdTime);
  VERNIER_CODE(UploadFault, kOldForm);
  VERNIER_CODE(UploadFault, kKeyMayNot);
  VERNIER_CODE(BindFault, kNone);
  VERNIER_CODE(BindFault, kTick);
  VERNIER_CODE(BindFault, kUnknownAxis);
  VERNIER_CODE(BindFault, kAxisKind);
  VERNIER_CODE(BindFault, kUnknownInput);
  VERNIER_CODE(ImageFault, kNone);
  VERNIER_CODE(ImageFault, kMisaligned);
  VERNIER_CODE(ImageFault, kTruncated);
  VERNIER_CODE(ImageFault, kMagic);
  VERNIER_CODE(ImageFault, kFormatVersion);
  VERNIER_CODE(ImageFault, kHeader);
  VERNIER_CODE(ImageFault, kChecksum);
  VERNIER_CODE(ImageFault, kSection);
  VERNIER_CODE(ImageFault, kFingerprint);
  VERNIER_CODE(ImageFault, kAxis);
  VERNIER_CODE(ImageFault, kInput);
  VERNIER_CODE(ImageFault, kRange);
  VERNIER_CODE(ImageFault, kTooMany);
  VERNIER_CODE(ImageFault, kProgramTooLong);
  VERNIER_CODE(ImageFault, kProgramChannel);
  VERNIER_CODE(ImageFault, kProgramTable);
  VERNIER_CODE(ImageFault, kProgramWrap);
  VERNIER_CODE(ImageFault, kProgramOpCode);
  VERNIER_CODE(ImageFault, kProgramOperand);
  VERNIER_CODE(ImageFault, kProgramShift);
  VERNIER_CODE(ImageFault, kProgramOverflow);
  VERNIER_CODE(ImageFault, kProgramLag);
  VERNIER_CODE(ImageFault, kProgramOutput);
  return codes;
}

std::string state_codes() {
  std::string codes;
  VERNIER_CODE(Mode, kBoot);
  VERNIER_CODE(Mode, kChecking);
  VERNIER_CODE(Mode, kReady);
  VERNIER_CODE(Mode, kActive);
  VERNIER_CODE(Mode, kRampOut);
  VERNIER_CODE(Mode, kFaulted);
  VERNIER_CODE(Fault, kNone);
  VERNIER_CODE(Fault, kPositionMissing);
  VERNIER_CODE(Fault, kPositionFrozen);
  VERNIER_CODE(Fault, kPositionJump);
  VERNIER_CODE(Fault, kInputMissing);
  VERNIER_CODE(Fault, kWriteFailed);
  VERNIER_CODE(Fault, kOverrun);
  VERNIER_CODE(Fault, kClock);
  VERNIER_CODE(Fault, kReferenceLost);
  VERNIER_CODE(Fault, kInputImplausible);
  VERNIER_CODE(Fault, kImageLost);
  VERNIER_CODE(Command, kNone);
  VERNIER_CODE(Command, kActivate);
  VERNIER_CODE(Command, kDeactivate);
  VERNIER_CODE(Command, kClearFault);
  VERNIER_CODE(Command, kHold);
  VERNIER_CODE(Command, kRelease);
  VERNIER_CODE(TouchKind, kTouch);
  VERNIER_CODE(TouchKind, kReleaseMissing);
  VERNIER_CODE(TouchKind, kMissed);
  VERNIER_CODE(LatchFault, kNone);
  VERNIER_CODE(LatchFault, kNotYet);
  VERNIER_CODE(LatchFault, kTooOld);
  VERNIER_CODE(LatchFault, kUneven);
  VERNIER_CODE(LatchFault, kTooFast);
  VERNIER_CODE(TouchFlag, kTouchUncompensated);
  VERNIER_CODE(TouchFlag, kTouchWhileFaulted);
  VERNIER_CODE(TouchFlag, kTouchInWorkpiece);
  return codes;
}

std::string message_codes() {
  std::string codes;
  VERNIER_CODE(LinkOp, kHello);
  VERNIER_CODE(LinkOp, kName);
  VERNIER_CODE(LinkOp, kTick);
  VERNIER_CODE(LinkOp, kHistory);
  VERNIER_CODE(LinkOp, kHealth);
  VERNIER_CODE(LinkOp, kSlots);
  VERNIER_CODE(LinkOp, kBegin);
  VERNIER_CODE(LinkOp, kData);
  VERNIER_CODE(LinkOp, kFinish);
  VERNIER_CODE(LinkOp, kConfirm);
  VERNIER_CODE(LinkOp, kRevert);
  VERNIER_CODE(LinkOp, kRead);
  VERNIER_CODE(LinkOp, kCommand);
  VERNIER_CODE(LinkOp, kWeight);
  VERNIER_CODE(LinkOp, kShares);
  VERNIER_CODE(LinkOp, kShareName);
  VERNIER_CODE(LinkOp, kTouches);
  VERNIER_CODE(LinkOp, kWorkpiece);
  VERNIER_CODE(LinkOp, kState);
  VERNIER_CODE(LinkOp, kChallenge);
  VERNIER_CODE(LinkOp, kSigned);
  VERNIER_CODE(LinkOp, kIdentify);
  VERNIER_CODE(LinkAccess, kRead);
  VERNIER_CODE(LinkAccess, kCommand);
  VERNIER_CODE(LinkAccess, kUpload);
  VERNIER_CODE(LinkStatus, kDone);
  VERNIER_CODE(LinkStatus, kUnknownOp);
  VERNIER_CODE(LinkStatus, kBadLength);
  VERNIER_CODE(LinkStatus, kBadValue);
  VERNIER_CODE(LinkStatus, kNotReady);
  VERNIER_CODE(LinkStatus, kRefused);
  VERNIER_CODE(LinkStatus, kNotAllowed);
  VERNIER_CODE(LinkStatus, kUnsigned);
  VERNIER_CODE(LinkStatus, kBadSignature);
  VERNIER_CODE(LinkStatus, kStale);
  VERNIER_CODE(LinkStatus, kNotStored);
  VERNIER_CODE(LiveRegister, kLiveLayout);
  VERNIER_CODE(LiveRegister, kLiveMode);
  VERNIER_CODE(LiveRegister, kLiveFault);
  VERNIER_CODE(LiveRegister, kLiveHolding);
  VERNIER_CODE(LiveRegister, kLiveTicks);
  VERNIER_CODE(LiveRegister, kLiveOverruns);
  VERNIER_CODE(LiveRegister, kLiveLatency);
  VERNIER_CODE(LiveRegister, kLiveImage);
  VERNIER_CODE(LiveRegister, kLiveWeight);
  VERNIER_CODE(LiveRegister, kLiveLimits);
  VERNIER_CODE(LiveRegister, kLiveSince);
  VERNIER_CODE(LiveRegister, kLiveSettings);
  VERNIER_CODE(LiveRegister, kLiveAxes);
  VERNIER_CODE(LiveRegister, kLiveInputs);
  VERNIER_CODE(LiveRegister, kLiveFingerprint);
  VERNIER_CODE(LiveRegister, kLiveAxisWeights);
  VERNIER_CODE(LiveRegister, kLiveRegisters);
  VERNIER_CODE(ImageState, kNone);
  VERNIER_CODE(ImageState, kConfirmed);
  VERNIER_CODE(ImageState, kTrial);
  VERNIER_CODE(ImageState, kLost);
  VERNIER_CODE(SettingFlag, kSettingDamaged);
  VERNIER_CODE(SettingFlag, kSettingRefused);
  VERNIER_CODE(AxisLimitFlag, kAtImageLimit);
  VERNIER_CODE(AxisLimitFlag, kAtBoardLimit);
  VERNIER_CODE(AxisLimitFlag, kAtOutputLimit);
  VERNIER_CODE(AxisLimitFlag, kOnItsWay);
  return codes;
}

TEST(GoldenCodes, OfTheLink) {
  expect_golden("link_codes_v" + std::to_string(kLinkVersion) + ".txt",
                "= codes of the link, version " + std::to_string(kLinkVersion) + "\n" + message_codes() +
                    state_codes() + upload_codes());
}

// The page said 2 in register 0.
TEST(GoldenCodes, PageOfTheLinkHasTheRegistersAndTheVersion) {
  std::ifstream file(VERNIER_SOURCE_DIR "/tools/docs/link.md");
  const std::string page((std::istreambuf_iterator<char>(file)), {});
  const std::string version = std::to_string(kLinkVersion);
  const auto row = [](int first, int last = -1) {
    return "\n| " + std::to_string(first) + (last < 0 ? "" : "-" + std::to_string(last)) + " | ";
  };
  const std::pair<std::string, const char*> kRows[] = {
      {row(kLiveLayout), "version of the layout"},
      {row(kLiveLatency), "99th percentile"},
      {row(kLiveImage), "running image"},
      {row(kLiveWeight), "weight"},
      {row(kLiveLimits), "bit i"},
      {row(kLiveSince, kLiveSince + 1), "time in s"},
      {row(kLiveSettings), "stored settings"},
      {row(kLiveFingerprint, kLiveFingerprint + 3), "fingerprint"}};
  for (const auto& [begin, text] : kRows)
    EXPECT_NE(page.find(begin + text), std::string::npos) << begin << text;
  EXPECT_NE(page.find(row(kLiveLayout) + "version of the layout, " + version + " |"), std::string::npos);
  EXPECT_NE(page.find("tests/golden/link_v" + version + ".txt"), std::string::npos);
  EXPECT_NE(page.find("\n| " + std::to_string(kLiveAxes) + " + 4 i | axis i"), std::string::npos);
  EXPECT_NE(page.find("\n| " + std::to_string(kLiveInputs) + " + 2 i | input i"), std::string::npos);
  EXPECT_NE(page.find("\n| " + std::to_string(kLiveAxisWeights) + " + i | weight of axis i"),
            std::string::npos);
}

// Lists above that lack a code would let it wander.
TEST(GoldenCodes, ListsAreComplete) {
  std::map<std::string, int> count;
  for (const std::string& file : {"image_codes_v" + std::to_string(kImageFormatVersion),
                                  "link_codes_v" + std::to_string(kLinkVersion)}) {
    const std::string text = golden_text(file + ".txt");
    for (std::size_t at = 0; (at = text.find(' ', at)) != std::string::npos; ++at)
      ++count[text.substr(at + 1, text.find_first_of(" \n", at + 1) - at - 1)];
  }
  EXPECT_EQ(count["SectionType"], static_cast<int>(kSectionCount));
  EXPECT_EQ(count["ChannelKind"], kChannelKindCount);
  EXPECT_EQ(count["OpCode"], kOpCodeCount);
  EXPECT_EQ(count["UploadFault"], kUploadFaultCount);
  EXPECT_EQ(count["Fault"], kFaultCount);
  EXPECT_EQ(count["Command"], kCommandCount);
  EXPECT_EQ(count["LinkOp"], kLinkOpCount - 1);
  EXPECT_EQ(count["LinkStatus"], kLinkStatusCount);
}

}  // namespace
}  // namespace vernier::golden
