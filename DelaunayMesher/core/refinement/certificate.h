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

// Reasons: "input_angle" - the element touches a CAD edge whose faces meet below kAcuteAngle in a solid (not
// in a notch), or reaches from one of these faces to the other; or it touches a CAD vertex where a face has a
// corner of less than half of that, or three faces that meet there.  "size_floor" - the size there is
// the smallest that walls, gaps and curvature may ask for.  Else "fallback". face_solids: as in Plc.  Cost: a
// look at every element; the input's angles only when one is below.
std::vector<BelowTarget> certify(const VolumeMesh& mesh, const std::vector<std::array<Index, 2>>& face_solids,
                                 const SizeField& size, double target_angle, Context& context);

}  // namespace dm
