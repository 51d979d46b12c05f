// SPDX-License-Identifier: GPL-3.0-or-later
// vernier_plant.so: a machine behind LinuxCNC's drives, with errors that only its tool point shows. Its
// drives follow in the same tick; what they do is read with the next one, as with a real encoder.
#include <hal.h>
#include <rtapi.h>

#include <cerrno>
#include <cmath>

static int machine = 3;
RTAPI_MP_INT(machine, "3: three linear axes; 5: with tilting table A and rotary table C")
MODULE_LICENSE("GPL");

namespace {

constexpr int kMostJoints = 5;
constexpr double kDegree = 0.017453292519943295;
constexpr double kHomeSwitch = 0.25;  // mm of X's drive: on below

struct Pins {
  hal_float_t *drive[kMostJoints], *scale[kMostJoints];
  hal_float_t* zero[kMostJoints];  // what the drive reads where the joint is at zero
  hal_bit_t* stuck[kMostJoints];   // the drive answers no more
  hal_bit_t *home[kMostJoints], *probe, *estop_in, *estop_out;
  hal_float_t *tool[3], *surface, *column;
  hal_float_t *ball[3], *radius;  // where a sphere stands
  hal_s32_t *late, *bounces;      // of the probe: ticks, and times that it lets go again after a touch
};
struct Point {
  double x, y, z;
};

int component_id = -1;
Pins* pins = nullptr;

// Rx(a), then Ry(b), then Rz(c) as matrices multiply: sixdof's order (FORMATS, section 1).
Point turned(const Point& p, double a, double b, double c) {
  const double y1 = std::cos(a) * p.y - std::sin(a) * p.z, z1 = std::sin(a) * p.y + std::cos(a) * p.z;
  const double x2 = std::cos(b) * p.x + std::sin(b) * z1, z2 = -std::sin(b) * p.x + std::cos(b) * z1;
  return {std::cos(c) * x2 - std::sin(c) * y1, std::sin(c) * x2 + std::cos(c) * y1, z2};
}

// The hidden machine of three axes: scale and pitch of X's screw (20 um of 10 mm, as in the note on external
// offsets), scale of Y with the column's temperature in it (22 degC), squareness, straightness of X, sag of
// Z.
Point three_axes(double x, double y, double z) {
  constexpr double kPi2 = 6.283185307179586;
  return {x + 120e-6 * x + 0.020 * std::sin(kPi2 * x / 10) + 85e-6 * y,
          y - 60e-6 * y + 2 * 11e-6 * y + 0.012 * std::sin(kPi2 * x / 400),
          z + 90e-6 * z + 0.0001 * x - 40e-6 * y};
}

// The five axes of xyzac-trt-kins without offsets: the table tilts by A, on it C turns; both sit beside where
// they should, and A's axis is out of line.
Point five_axes(const double* q) {
  const Point p{q[0] + 80e-6 * q[0], q[1] - 70e-6 * q[1] + 60e-6 * q[0], q[2] + 50e-6 * q[2]};
  const double a = q[3] * kDegree, c = q[4] * kDegree;
  // Into A's frame, which is at (0.015, -0.022, 0.018) mm and turned by 40 urad about Z.
  Point t{p.x - 0.015, p.y + 0.022, p.z - 0.018};
  t = turned(t, 0, 0, -40e-6);
  t = turned(t, -a, 0, 0);
  // C sits 12 um off A's axis.
  t = {t.x - 0.012, t.y + 0.009, t.z};
  return turned(t, 0, 0, -c);
}

// A plate at `surface` is touched from above, a sphere anywhere; the probe says so `late` ticks later, and
// lets go for a tick a few times.
bool late_and_bouncing(bool touches) {
  static int since = 0;
  since = touches ? (since < 1000 ? since + 1 : since) : 0;
  const int said = since - *pins->late;
  return said > 0 && !(said <= 2 * *pins->bounces && said % 2 == 0);
}

void run(void*, long) {
  double q[kMostJoints] = {};
  for (int i = 0; i < kMostJoints; ++i) {
    const double drive = *pins->drive[i];
    if (!*pins->stuck[i]) *pins->scale[i] = drive;
    *pins->home[i] = drive < kHomeSwitch;
    q[i] = drive - *pins->zero[i];
  }
  const Point tool = machine == 5 ? five_axes(q) : three_axes(q[0], q[1], q[2]);
  *pins->tool[0] = tool.x;
  *pins->tool[1] = tool.y;
  *pins->tool[2] = tool.z;
  const double x = tool.x - *pins->ball[0], y = tool.y - *pins->ball[1], z = tool.z - *pins->ball[2];
  const double radius = *pins->radius;
  *pins->probe = late_and_bouncing(tool.z <= *pins->surface || x * x + y * y + z * z < radius * radius);
  *pins->estop_out = *pins->estop_in;
}

bool make_pins() {
  int bad = 0;
  for (int i = 0; i < kMostJoints; ++i) {
    bad |= hal_pin_float_newf(HAL_IN, &pins->drive[i], component_id, "vernier-plant.0.joint.%d.drive", i);
    bad |= hal_pin_float_newf(HAL_OUT, &pins->scale[i], component_id, "vernier-plant.0.joint.%d.scale", i);
    bad |= hal_pin_float_newf(HAL_IN, &pins->zero[i], component_id, "vernier-plant.0.joint.%d.zero", i);
    bad |= hal_pin_bit_newf(HAL_IN, &pins->stuck[i], component_id, "vernier-plant.0.joint.%d.stuck", i);
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->home[i], component_id, "vernier-plant.0.joint.%d.home", i);
  }
  constexpr const char* kTool[] = {"tool-x", "tool-y", "tool-z"};
  constexpr const char* kBall[] = {"ball-x", "ball-y", "ball-z"};
  for (int i = 0; i < 3; ++i)
    bad |= hal_pin_float_newf(HAL_IN, &pins->ball[i], component_id, "vernier-plant.0.%s", kBall[i]);
  bad |= hal_pin_float_newf(HAL_IN, &pins->radius, component_id, "vernier-plant.0.radius");
  for (int i = 0; i < 3; ++i)
    bad |= hal_pin_float_newf(HAL_OUT, &pins->tool[i], component_id, "vernier-plant.0.%s", kTool[i]);
  bad |= hal_pin_float_newf(HAL_OUT, &pins->column, component_id, "vernier-plant.0.column");
  bad |= hal_pin_float_newf(HAL_IN, &pins->surface, component_id, "vernier-plant.0.surface");
  bad |= hal_pin_s32_newf(HAL_IN, &pins->late, component_id, "vernier-plant.0.late");
  bad |= hal_pin_s32_newf(HAL_IN, &pins->bounces, component_id, "vernier-plant.0.bounces");
  bad |= hal_pin_bit_newf(HAL_OUT, &pins->probe, component_id, "vernier-plant.0.probe");
  bad |= hal_pin_bit_newf(HAL_IN, &pins->estop_in, component_id, "vernier-plant.0.estop-in");
  bad |= hal_pin_bit_newf(HAL_OUT, &pins->estop_out, component_id, "vernier-plant.0.estop-out");
  return bad == 0;
}

}  // namespace

extern "C" int rtapi_app_main() {
  if (machine != 3 && machine != 5) return -EINVAL;
  component_id = hal_init("vernier_plant");
  if (component_id < 0) return component_id;
  pins = static_cast<Pins*>(hal_malloc(sizeof(Pins)));
  const bool made = pins != nullptr && make_pins() &&
                    hal_export_funct("vernier-plant.0", run, nullptr, 1, 0, component_id) >= 0;
  if (!made) {
    hal_exit(component_id);
    return -EINVAL;
  }
  *pins->surface = -1e9;
  *pins->column = 22;
  return hal_ready(component_id);
}
extern "C" void rtapi_app_exit() { hal_exit(component_id); }
