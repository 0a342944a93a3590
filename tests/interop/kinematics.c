#include "tests/interop/kinematics.h"

#include <math.h>

static const double kRadPerDeg = 3.14159265358979323846 / 180.0;

static Frame identity(void) {
  Frame f = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  return f;
}

static Frame shift(double x, double y, double z) {
  Frame f = identity();
  f.m[0][3] = x;
  f.m[1][3] = y;
  f.m[2][3] = z;
  return f;
}

// Right-handed rotation about axis 0 = x, 1 = y, 2 = z.
static Frame turn(int axis, double degrees) {
  const double c = cos(degrees * kRadPerDeg), s = sin(degrees * kRadPerDeg);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Frame f = identity();
  f.m[u][u] = c;
  f.m[u][v] = -s;
  f.m[v][u] = s;
  f.m[v][v] = c;
  return f;
}

Frame frame_multiply(Frame a, Frame b) {
  Frame r;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      r.m[i][j] = 0;
      for (int k = 0; k < 4; ++k) r.m[i][j] += a.m[i][k] * b.m[k][j];
    }
  }
  return r;
}

Frame frame_inverse(Frame a) {
  Frame r = identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      r.m[i][j] = a.m[j][i];
      r.m[i][3] -= a.m[j][i] * a.m[j][3];
    }
  }
  return r;
}

Frame frame_from_pose(double x, double y, double z, double alpha, double beta, double gamma) {
  return frame_multiply(shift(x, y, z), frame_multiply(turn(0, alpha), frame_multiply(turn(1, beta), turn(2, gamma))));
}

// Link lengths in mm: the vendor's URDF, checked there against a capture of a real robot.
Frame forward_kinematics(const float q[6]) {
  const Frame chain[] = {shift(0, 0, 135), turn(2, q[0]),   turn(1, q[1]), shift(0, 0, 135),
                         turn(1, q[2]),    shift(0, 0, 38), turn(0, q[3]), shift(120, 0, 0),
                         turn(1, q[4]),    shift(70, 0, 0), turn(0, q[5]), turn(1, 90)};
  Frame f = identity();
  for (unsigned i = 0; i < sizeof chain / sizeof chain[0]; ++i) f = frame_multiply(f, chain[i]);
  return f;
}

double distance_mm(Frame a, Frame b) {
  return sqrt(pow(a.m[0][3] - b.m[0][3], 2) + pow(a.m[1][3] - b.m[1][3], 2) + pow(a.m[2][3] - b.m[2][3], 2));
}

double distance_deg(Frame a, Frame b) {
  // Chord between the rotations (Frobenius norm), which keeps its precision near zero, unlike acos of the trace.
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += pow(a.m[i][j] - b.m[i][j], 2);
  return 2 * asin(fmin(1.0, sqrt(sum / 8))) / kRadPerDeg;
}
