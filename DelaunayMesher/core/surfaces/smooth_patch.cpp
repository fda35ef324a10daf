// PatchRemesher: smoothing and the final random displacement.
#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "surfaces/remesh_patch.h"

namespace dm {
namespace {

constexpr double kAligned = 0.5;
constexpr double kGoodCosine = 0.86;  // 30 degrees: corners above it may be worsened freely

double corner_cosine(const Vec3& apex, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - apex, v = c - apex;
  const double l = std::sqrt(norm2(u) * norm2(v));
  return l > 0 ? dot(u, v) / l : 1;
}

}  // namespace

// Centroid of the triangles round v, weighted by area over squared wanted length (Lloyd's step for a
// density).
Vec3 PatchRemesher::smoothed_position(Index v) const {
  Vec3 sum{};
  double weight = 0;
  const Vec3 p = points()[v];
  patch_.for_each_corner(v, [&](Index c) {
    const Index x = patch_.vertex[FacePatch::next(c)], y = patch_.vertex[FacePatch::prev(c)];
    const Vec3 u = points()[x] - p, w = points()[y] - p;
    const double length = patch_.lengths[v] + patch_.lengths[x] + patch_.lengths[y];
    const double area = norm(cross(u, w)) / (length * length);
    sum += area * (u + w);
    weight += area;
  });
  return weight > 0 ? p + (1 / (3 * weight)) * sum : p;
}

// With v at p no triangle round it turns away from the surface, unless it did so before.
bool PatchRemesher::star_stays(Index v, const Vec3& p) const {
  bool ok = true;
  patch_.for_each_corner(v, [&](Index c) {
    if (!ok) return;
    const Index x = patch_.vertex[FacePatch::next(c)], y = patch_.vertex[FacePatch::prev(c)];
    const double after = alignment(p, points()[x], points()[y], v, x, y);
    if (after < kAligned && after <= alignment(v, x, y)) ok = false;
  });
  return ok;
}

// Largest cosine of the corners round v with v at p: the smallest angle.
double PatchRemesher::star_angle(Index v, const Vec3& p) const {
  double worst = -1;
  patch_.for_each_corner(v, [&](Index c) {
    const Vec3 &x = points()[patch_.vertex[FacePatch::next(c)]],
               &y = points()[patch_.vertex[FacePatch::prev(c)]];
    worst = std::max({worst, corner_cosine(p, x, y), corner_cosine(x, y, p), corner_cosine(y, p, x)});
  });
  return worst;
}

void PatchRemesher::smooth(int sweeps) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index v = 0; v < patch_.vertex_count(); ++v) {
      if ((v & 255) == 0) poll_();
      if (patch_.kinds[v] != VertexKind::interior || patch_.corner_of(v) < 0) continue;
      const Vec3 p = geometry_.project_to_face(face_, smoothed_position(v), patch_.normals[v]);
      if (!(distance(p, points()[v]) < 2 * patch_.lengths[v])) continue;
      if (star_stays(v, p)) set_vertex(v, p, patch_.normals[v]);
    }
    make_delaunay();
  }
}

void PatchRemesher::jitter() {
  if (options_.jitter <= 0) return;
  for (Index v = 0; v < patch_.vertex_count(); ++v) {
    if ((v & 255) == 0) poll_();
    if (patch_.kinds[v] != VertexKind::interior || patch_.corner_of(v) < 0) continue;
    const double before = star_angle(v, points()[v]);
    double amplitude = options_.jitter * patch_.lengths[v];
    for (int attempt = 0; attempt < 3; ++attempt, amplitude /= 2) {
      Random random(seed_, 0x6a697474, face_, v, attempt);
      const Vec3 p =
          geometry_.project_to_face(face_, points()[v] + amplitude * random.in_ball(), patch_.normals[v]);
      if (star_angle(v, p) > std::max(before, kGoodCosine) || !star_stays(v, p)) continue;
      set_vertex(v, p, patch_.normals[v]);
      break;
    }
  }
  make_delaunay();
}

}  // namespace dm
