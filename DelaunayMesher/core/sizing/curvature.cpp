#include <numbers>

#include "sizing/sources.h"

namespace dm {

namespace {

constexpr int kDeepestSplit = 6;
constexpr double kSimilar = 1.25;  // sizes within this ratio need no further split of a triangle

class CurvatureSources {
 public:
  CurvatureSources(const Plc& plc, const Geometry& geometry, const SizeOptions& options,
                   const SizeLimits& limits, std::vector<SizeSource>& sources)
      : plc_(plc), geometry_(geometry), options_(options), limits_(limits), sources_(sources) {}

  void add_triangle(std::size_t t) {
    const Index face = plc_.triangle_face[t];
    if (geometry_.is_plane(face)) return;
    std::array<Vec3, 3> p;
    std::array<double, 3> h{};
    for (int i = 0; i < 3; ++i) {
      const Index v = plc_.triangles[t][i];
      p[i] = plc_.points[v];
      h[i] = at_vertex(face, v);
    }
    add(face, p, h, 0);
  }

  void add_segment(std::size_t s) {
    const Index edge = plc_.segment_edge[s];
    if (geometry_.is_line(edge)) return;
    const auto [i, j] = plc_.segments[s];
    const Vec3 a = plc_.points[i], b = plc_.points[j];
    const double h = size_for(geometry_.edge_curvature(edge, 0.5 * (a + b)));
    if (h < options_.max_size) sources_.push_back(SizeSource::segment(a, b, h));
  }

 private:
  double size_for(double curvature) const {
    const double h = 2 * std::numbers::pi / (options_.elements_per_circle * curvature);
    return std::max(h, limits_.curvature);  // curvature 0 gives infinity, an apex (infinity) the limit
  }

  // Neighbouring triangles of a face share corners: remember the last face's value at each.
  double at_vertex(Index face, Index v) {
    if (known_face_.empty()) {
      known_face_.assign(plc_.points.size(), -1);
      known_.resize(plc_.points.size());
    }
    if (known_face_[v] != face) {
      known_face_[v] = face;
      known_[v] = size_for(geometry_.curvature(face, plc_.points[v]));
    }
    return known_[v];
  }

  // A triangle over which the size varies is split until its parts are as small as their size.
  void add(Index face, const std::array<Vec3, 3>& p, const std::array<double, 3>& h, int depth) {
    const Vec3 middle = (1.0 / 3) * (p[0] + p[1] + p[2]);
    const double centre = size_for(geometry_.curvature(face, middle));
    const double low = std::min({h[0], h[1], h[2], centre}), high = std::max({h[0], h[1], h[2], centre});
    if (!(low < options_.max_size)) return;
    const double longest = std::sqrt(std::max({norm2(p[1] - p[0]), norm2(p[2] - p[1]), norm2(p[0] - p[2])}));
    if (high <= kSimilar * low || longest <= low) {
      sources_.push_back({p[0], p[1], p[2], low, 3, true});
      return;
    }
    if (depth == kDeepestSplit) {
      sources_.push_back({p[0], p[1], p[2], std::min(centre, options_.max_size), 3, true});
      return;
    }
    std::array<Vec3, 3> q;
    std::array<double, 3> s{};
    for (int i = 0; i < 3; ++i) {
      q[i] = 0.5 * (p[i] + p[(i + 1) % 3]);
      s[i] = size_for(geometry_.curvature(face, q[i]));
    }
    for (int i = 0; i < 3; ++i)
      add(face, {p[i], q[i], q[(i + 2) % 3]}, {h[i], s[i], s[(i + 2) % 3]}, depth + 1);
    add(face, q, s, depth + 1);
  }

  const Plc& plc_;
  const Geometry& geometry_;
  const SizeOptions& options_;
  const SizeLimits& limits_;
  std::vector<SizeSource>& sources_;
  std::vector<Index> known_face_;
  std::vector<double> known_;
};

}  // namespace

void add_curvature(const Plc& plc, const Geometry& geometry, const SizeOptions& options,
                   const SizeLimits& limits, Context& context, std::vector<SizeSource>& sources) {
  if (!(options.elements_per_circle > 0)) return;
  CurvatureSources curvature(plc, geometry, options, limits, sources);
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    context.poll(0.1 * static_cast<double>(t) / static_cast<double>(plc.triangles.size()));
    curvature.add_triangle(t);
  }
  for (std::size_t s = 0; s < plc.segments.size(); ++s) curvature.add_segment(s);
}

}  // namespace dm
