// The certificate: every element under the target angle with the reason why.
#pragma once

#include <vector>

#include "base/volume_mesh.h"
#include "sizing/size_field.h"

namespace dm {

// An element under the target angle and why: "input_angle", "size_floor" or "fallback".
struct BelowTarget {
  Index tet;
  double angle;  // degrees
  const char* reason;
  Entity entity;  // CAD element at fault, when there is one
  Vec3 place;
};

// Opening angle of the input, in degrees, below which an element at that edge or corner cannot reach the
// target.
inline constexpr double kAcuteAngle = 45;

// Reasons: "input_angle" - the element touches a CAD edge whose faces meet below kAcuteAngle, or a boundary
// triangle forced sharp by the CAD; "size_floor" - the wanted size there is the smallest allowed; else
// "fallback".
std::vector<BelowTarget> certify(const VolumeMesh& mesh, const SizeField& size, double target_angle);

}  // namespace dm
