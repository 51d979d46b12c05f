// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/unit/part/part_data.h"
#include "tools/part/identify.h"
#include "tools/part/measured_part.h"
#include "tools/part/part_path.h"
#include "tools/part/surface/s_part.h"

namespace vernier::measured_part_test {

using namespace vernier::part;
using namespace vernier::text;
namespace {

std::string message_of(const std::string& csv) {
  try {
    read_measured_part(csv, "cmm.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeasuredPart, ReadsBackWhatThePredictionWrote) {
  const std::vector<PartPoint> points = standard_points();
  const PartDefect defect = part_defect(part_data::machine(part_data::kTable4), points);
  const MeasuredPart part = read_measured_part(defect_csv(points, defect), "defect.csv");
  ASSERT_EQ(part.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(part.points[i].at.flank, points[i].flank);
    // Six decimals of the point, against 500 mm per u and 30 mm per v.
    EXPECT_NEAR(part.points[i].at.u, points[i].u, 1e-8);
    EXPECT_NEAR(part.points[i].at.v, points[i].v, 1e-6);
    EXPECT_NEAR(part.points[i].defect_mm, defect.defect_mm[static_cast<Eigen::Index>(i)], 5.1e-10);
    EXPECT_EQ(part.points[i].line, i + 2);
  }
}

TEST(MeasuredPart, ConvertsUnitsAndTakesUncertainty) {
  const Eigen::Vector3d p = surface_point(s_part()[1], 0.3, 0.5).position;
  const MeasuredPart part =
      read_measured_part(fmt::format("sx[m],sy[mm],sz[mm],defect[um],u[um]\n{:.9f},{:.6f},{:.6f},12,3\n",
                                     p.x() / 1000, p.y(), p.z()),
                         "cmm.csv");
  ASSERT_EQ(part.points.size(), 1u);
  EXPECT_EQ(part.points[0].at.flank, 1u);
  EXPECT_NEAR(part.points[0].at.u, 0.3, 1e-7);
  EXPECT_NEAR(part.points[0].defect_mm, 0.012, 1e-15);
  EXPECT_NEAR(part.points[0].uncertainty_mm, 0.003, 1e-15);
}

TEST(MeasuredPart, NamesFileLineAndWordOfWhatIsWrong) {
  EXPECT_NE(message_of("sx[mm],sy[mm],sz[mm]\n1,2,3\n").find("defect"), std::string::npos);
  EXPECT_NE(message_of("sx[deg],sy[mm],sz[mm],defect[mm]\n1,2,3,4\n").find("sx"), std::string::npos);
  EXPECT_NE(message_of("sx[mm],sy[mm],sz[mm],defect[mm]\n1,2,3,oops\n").find("cmm.csv:2: \"oops\""),
            std::string::npos);
  // 30 mm above the part, in the middle of it, at the end of the world.
  EXPECT_NE(message_of("sx[mm],sy[mm],sz[mm],defect[mm]\n-9,2,60,0\n").find("not on the part"),
            std::string::npos);
  EXPECT_NE(message_of("sx[mm],sy[mm],sz[mm],defect[mm]\n60,20,11,0\n").find("not on the part"),
            std::string::npos);
  EXPECT_NE(message_of("sx[mm],sy[mm],sz[mm],defect[mm]\n1e9,0,11,0\n").find("this point is not on the part"),
            std::string::npos);
  const Eigen::Vector3d p = surface_point(s_part()[0], 0.3, 0.5).position;
  for (const char* u : {"0", "-1", ""})
    EXPECT_NE(message_of(fmt::format("sx[mm],sy[mm],sz[mm],defect[mm],u[mm]\n{},{},{},0,{}\n", p.x(), p.y(),
                                     p.z(), u))
                  .find("cmm.csv:2"),
              std::string::npos)
        << u;
}

}  // namespace
}  // namespace vernier::measured_part_test
