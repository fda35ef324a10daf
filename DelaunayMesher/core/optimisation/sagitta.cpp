#include "optimisation/sagitta.h"

namespace dm {

bool lies_as_close(const EditMesh& mesh, const Geometry& geometry, Index face, std::span<const Vec3> middles,
                   std::span<Segment> old_edges) {
  constexpr double kFarther = 1.2;
  if (geometry.is_plane(face)) return true;
  const auto sagitta = [&](const Vec3& middle) {
    return distance(middle, geometry.project_to_face(face, middle));
  };
  double most = 0;
  for (const Vec3& middle : middles) most = std::max(most, sagitta(middle));
  const auto length = [&](const Segment& s) { return distance(mesh.point(s[0]), mesh.point(s[1])); };
  std::sort(old_edges.begin(), old_edges.end(),
            [&](const Segment& a, const Segment& b) { return length(a) > length(b); });
  return std::any_of(old_edges.begin(), old_edges.end(), [&](const Segment& s) {
    return kFarther * sagitta(0.5 * (mesh.point(s[0]) + mesh.point(s[1]))) >= most;
  });
}

}  // namespace dm
