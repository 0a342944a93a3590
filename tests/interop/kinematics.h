// Forward kinematics of the Meca500, written a second time and independently of sim/, to check what arrives over DDS.
#pragma once

typedef struct {
  double m[4][4];
} Frame;

// Mobile XYZ Euler angles in degrees, position in mm (manual: R = Rx(alpha) Ry(beta) Rz(gamma)).
Frame frame_from_pose(double x, double y, double z, double alpha, double beta, double gamma);
Frame frame_multiply(Frame a, Frame b);
Frame frame_inverse(Frame a);

// Flange in the base frame for six joint angles in degrees.
Frame forward_kinematics(const float joints[6]);

// How far apart two frames are: mm between the origins, degrees of the rotation from one to the other. Unlike a
// comparison of Euler angles this stays meaningful at beta = +-90, where the zero pose is.
double distance_mm(Frame a, Frame b);
double distance_deg(Frame a, Frame b);
