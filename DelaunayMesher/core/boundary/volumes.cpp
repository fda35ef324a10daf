#include "boundary/volumes.h"

namespace dm {

namespace {

double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(b - a, c - a), d - a) / 6;
}

}  // namespace

std::vector<double> surface_volumes(const SurfaceMesh& surface, const Plc& plc) {
  std::vector<double> volumes(plc.solid_count);
  const auto& p = surface.points;
  std::vector<Index> apex(plc.solid_count, -1);  // a point of the solid: far from the origin digits are lost
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto& [behind, front] = plc.face_solids[surface.triangle_face[t]];
    const auto add = [&](Index solid, int sign) {
      if (solid == 0) return;
      if (apex[solid - 1] < 0) apex[solid - 1] = a;
      volumes[solid - 1] += sign * tet_volume(p[a], p[b], p[c], p[apex[solid - 1]]);
    };
    add(behind, -1);
    add(front, 1);
  }
  return volumes;
}

std::vector<double> tet_volumes(const VolumeMesh& mesh, Index solid_count) {
  std::vector<double> volumes(solid_count);
  const auto& p = mesh.points;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    volumes[mesh.tet_solid[t] - 1] += tet_volume(p[a], p[b], p[c], p[d]);
  }
  return volumes;
}

}  // namespace dm
