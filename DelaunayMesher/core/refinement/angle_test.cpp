#include "refinement/angle_test.h"

#include <algorithm>

namespace dm {

unsigned exempt_angles(const BoundaryComplex& complex, Index v0, Index v1, Index v2, Index v3) {
  if (!complex.has_acute()) return 0;
  const Index v[4] = {v0, v1, v2, v3};
  unsigned bits = 0;
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = kFacePairs[k];
    Index edge[2];
    int n = 0;
    for (int m = 0; m < 4; ++m)
      if (m != i && m != j) edge[n++] = v[m];
    if (edge[0] >= 0 && edge[1] >= 0 && complex.is_acute(edge[0], edge[1])) bits |= 1u << k;
  }
  return bits;
}

double tet_sharpness(const LabelledTriangulation& mesh, Index tet) {
  const auto [a, b, c, d] = mesh.tets.corners(tet);
  const auto& p = mesh.tets.points();
  return sharpness(p[a], p[b], p[c], p[d], exempt_angles(mesh.boundary, a, b, c, d));
}

bool is_flat(const std::vector<Vec3>& points, const Tet& v) {
  constexpr double kFlatVolume = 1e-7;
  double longest2 = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) longest2 = std::max(longest2, norm2(points[v[i]] - points[v[j]]));
  const Vec3 a = points[v[0]];
  const double volume6 = dot(area_vector(a, points[v[1]], points[v[2]]), points[v[3]] - a);
  return volume6 <= kFlatVolume * longest2 * std::sqrt(longest2);
}

double evaluate_site(const LabelledTriangulation& mesh, const Cavity& cavity, const Vec3& p,
                     const RadiusBound& bound, double target, double give_up) {
  const Triangulation& tets = mesh.tets;
  double worst = -1;
  for (const Face f : cavity.border) {
    const Index t = f / 4;
    if (tets.tag(t) == 0) continue;
    const int i = f % 4;
    const Tet& v = tets.corners(t);
    const auto& corner = kFaceCorners[i];
    const Index u0 = v[corner[0]], u1 = v[corner[1]], u2 = v[corner[2]];
    const Vec3 &a = tets.point(u0), &b = tets.point(u1), &c = tets.point(u2);
    if (dot(area_vector(a, b, c), p - a) <= 0) return kRejected;
    double s = sharpness(a, b, c, p);
    if (s > target) {
      const unsigned exempt = exempt_angles(mesh.boundary, u0, u1, u2, -1);
      if (exempt) s = sharpness(a, b, c, p, exempt);
    }
    if (s <= worst) continue;
    if (s > target) {
      const Sphere sphere = circumsphere(a, b, c, p);
      const bool stuck = tets.marked(t, i) && dot(area_vector(a, b, c), sphere.centre - a) <= 0;
      if (!stuck && bound.excess(sphere, 1) > 1) continue;  // too big to stay
    }
    worst = s;
    if (worst > give_up) break;
  }
  return worst;
}

}  // namespace dm
