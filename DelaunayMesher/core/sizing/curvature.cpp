#include <algorithm>
#include <numbers>

#include "sizing/size_field.h"
#include "sizing/sources.h"

namespace dm {

namespace {

constexpr int kDeepestSplit = 6;
constexpr double kFlat = 0.002, kCrease = 1.0;  // radians between facets that count as a curve
constexpr double kSimilar = 1.25;               // sizes within this ratio need no further split of a triangle

class CurvatureSources {
 public:
  CurvatureSources(const Plc& plc, const Geometry& geometry, const SizeOptions& options,
                   const SizeLimits& limits, std::vector<SizeSource>& sources)
      : plc_(plc), geometry_(geometry), options_(options), limits_(limits), sources_(sources) {}

  // Returns the size at the middle of the triangle.
  double add_triangle(std::size_t t) {
    const Index face = plc_.triangle_face[t];
    if (geometry_.is_plane(face)) return HUGE_VAL;
    std::array<Vec3, 3> p;
    std::array<double, 3> h{};
    for (int i = 0; i < 3; ++i) {
      const Index v = plc_.triangles[t][i];
      p[i] = plc_.points[v];
      h[i] = at_vertex(face, v);
    }
    return add(face, p, h, 0);
  }

  // A face known by its facets only has no curvature.  Two facets of widths w that meet at a small angle
  // theta belong to a curve of radius w / theta; elements smaller than a facet would show nothing more.
  void add_facets(std::vector<double>& triangle_size) {
    const std::vector<std::array<Index, 4>> edges = inner_facet_edges();
    std::vector<double> size(plc_.triangles.size(), HUGE_VAL);
    for (const auto& [a, b, s, t] : edges) {
      const Vec3 n = normal(s), m = normal(t);
      const double length = distance(plc_.points[a], plc_.points[b]),
                   theta = std::atan2(norm(cross(n, m)), dot(n, m));
      if (!(length > 0) || theta < kFlat || theta > kCrease) continue;
      const double width = 0.5 * (norm(n) + norm(m)) / length;
      const double h = std::max({size_for(theta / width), width, limits_.curvature});
      size[s] = std::min(size[s], h);
      size[t] = std::min(size[t], h);
    }
    for (std::size_t t = 0; t < size.size(); ++t) {
      if (!(size[t] < options_.max_size)) continue;
      const auto [a, b, c] = plc_.triangles[t];
      sources_.push_back(SizeSource::triangle({plc_.points[a], plc_.points[b], plc_.points[c]}, size[t],
                                              empty_side(plc_, plc_.triangle_face[t])));
      triangle_size[t] = std::min(triangle_size[t], size[t]);
    }
  }

  // Curved edges, unless a face beside them asks for as much.
  void add_segments(const std::vector<double>& triangle_size) {
    std::vector<double> around(plc_.points.size(), HUGE_VAL);
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t)
      for (const Index v : plc_.triangles[t]) around[v] = std::min(around[v], triangle_size[t]);
    for (std::size_t s = 0; s < plc_.segments.size(); ++s) {
      const Index edge = plc_.segment_edge[s];
      if (geometry_.is_line(edge)) continue;
      const auto [i, j] = plc_.segments[s];
      const Vec3 a = plc_.points[i], b = plc_.points[j];
      const double h = size_for(geometry_.edge_curvature(edge, 0.5 * (a + b)));
      if (h < options_.max_size && kSimilar * h < std::max(around[i], around[j]))
        sources_.push_back(SizeSource::segment(a, b, h));
    }
  }

 private:
  Vec3 normal(Index t) const {
    const auto [a, b, c] = plc_.triangles[t];
    return area_vector(plc_.points[a], plc_.points[b], plc_.points[c]);
  }

  // Edges between two triangles of one face of facets: both ends, both triangles.
  std::vector<std::array<Index, 4>> inner_facet_edges() const {
    const std::size_t faces = plc_.face_solids.size();
    std::vector<signed char> facets(faces, -1);
    std::vector<std::array<Index, 4>> half, edges;  // smaller end, larger end, face, triangle
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t) {
      const Index face = plc_.triangle_face[t];
      const auto& v = plc_.triangles[t];
      if (facets[face] < 0) {
        const Vec3 middle = (1.0 / 3) * (plc_.points[v[0]] + plc_.points[v[1]] + plc_.points[v[2]]);
        facets[face] = !geometry_.is_plane(face) && geometry_.curvature(face, middle) == 0;
      }
      for (int i = 0; facets[face] && i < 3; ++i) {
        const Index a = v[i], b = v[(i + 1) % 3];
        half.push_back({std::min(a, b), std::max(a, b), face, static_cast<Index>(t)});
      }
    }
    std::sort(half.begin(), half.end());
    for (std::size_t i = 1; i < half.size(); ++i)
      if (std::equal(half[i].begin(), half[i].begin() + 3, half[i - 1].begin()))
        edges.push_back({half[i][0], half[i][1], half[i - 1][3], half[i][3]});
    return edges;
  }

  double size_for(double curvature) const {
    const double h = 2 * std::numbers::pi / (kBoundaryEdge * options_.elements_per_circle * curvature);
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
  double add(Index face, const std::array<Vec3, 3>& p, const std::array<double, 3>& h, int depth) {
    const Vec3 middle = (1.0 / 3) * (p[0] + p[1] + p[2]);
    const double centre = size_for(geometry_.curvature(face, middle));
    const double low = std::min({h[0], h[1], h[2], centre}), high = std::max({h[0], h[1], h[2], centre});
    if (!(low < options_.max_size)) return centre;
    const double longest = std::sqrt(std::max({norm2(p[1] - p[0]), norm2(p[2] - p[1]), norm2(p[0] - p[2])}));
    if (high <= kSimilar * low || longest <= low) {
      sources_.push_back(SizeSource::triangle(p, low, empty_side(plc_, face)));
      return centre;
    }
    if (depth == kDeepestSplit) {
      sources_.push_back(
          SizeSource::triangle(p, std::min(centre, options_.max_size), empty_side(plc_, face)));
      return centre;
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
    return centre;
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
                   const SizeLimits& limits, Context& context, std::vector<double>& triangle_size,
                   std::vector<SizeSource>& sources) {
  if (!(options.elements_per_circle > 0)) return;
  CurvatureSources curvature(plc, geometry, options, limits, sources);
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    context.poll(0.1 * static_cast<double>(t) / static_cast<double>(plc.triangles.size()));
    triangle_size[t] = std::min(triangle_size[t], curvature.add_triangle(t));
  }
  curvature.add_facets(triangle_size);
  curvature.add_segments(triangle_size);
}

}  // namespace dm
