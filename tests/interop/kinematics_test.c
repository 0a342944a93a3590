// The checker is checked: poses of known joint sets, so that interop.cyclone.move compares against something true.
#include <math.h>
#include <stddef.h>

#include "tests/interop/kinematics.h"
#include "tests/interop/peer.h"

typedef struct {
  const char* source;
  float joints[6];
  double pose[6];
  double tolerance;  // mm and degrees: what the printed digits of the source allow
} Row;

static const Row kRows[] = {
    {"the manual's zero pose", {0, 0, 0, 0, 0, 0}, {190, 0, 308, 0, 90, 0}, 1e-9},
    {"computed from the DH table",
     {30, 25, 20, 15, 10, 5},
     {179.6164, 107.3343, 142.3210, -158.0887, 28.5473, 163.3228},
     2e-4},
    {"computed from the DH table",
     {-30, -25, -20, -15, -10, -5},
     {37.4027, -17.9617, 426.1222, 17.0512, 31.5221, -53.8070},
     2e-4},
    {"EtherCAT capture of a real robot",
     {-0.7311f, -1.2126f, 0.0815f, -1.1524f, -1.2052f, -1.0505f},
     {186.2966, -2.3478, 313.1844, 16.8262, 87.5594, -19.0442},
     1e-3},
};

int main(void) {
  for (size_t i = 0; i < sizeof kRows / sizeof kRows[0]; ++i) {
    const double* p = kRows[i].pose;
    const Frame expected = frame_from_pose(p[0], p[1], p[2], p[3], p[4], p[5]);
    const Frame computed = forward_kinematics(kRows[i].joints);
    check(distance_mm(computed, expected) < kRows[i].tolerance, "position of joint set %zu (%s)", i, kRows[i].source);
    check(distance_deg(computed, expected) < kRows[i].tolerance, "orientation of joint set %zu (%s)", i,
          kRows[i].source);
    const Frame back = frame_multiply(frame_inverse(computed), computed);
    check(distance_mm(back, frame_from_pose(0, 0, 0, 0, 0, 0)) < 1e-9, "inverse of joint set %zu", i);
  }
  check(fabs(distance_deg(frame_from_pose(0, 0, 0, 0, 0, 0), frame_from_pose(0, 0, 0, 30, 0, 0)) - 30) < 1e-9,
        "30 degrees apart are 30 degrees");
  return failures() == 0 ? 0 : 1;
}
