#include "surfaces/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace dm {
namespace {

// A point may be this far off its CAD element: what FreeCAD tolerates, or rounding on very large models.
double point_tolerance(const Plc& plc) {
  Vec3 low = plc.points.at(0), high = low;
  for (const Vec3& p : plc.points)
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  return std::max(5e-8, 1e-9 * distance(low, high));
}

class Checker {
 public:
  Checker(const SurfaceMesh& mesh, const Plc& plc, const Geometry& geometry)
      : mesh_(mesh), plc_(plc), geometry_(geometry) {}

  void run() {
    check_indices();
    check_points();
    check_triangles();
    check_edges();
    check_presence();
  }

 private:
  [[noreturn]] void fail(const char* code, const std::string& message, Index point,
                         Entity entity = {}) const {
    const bool known = point >= 0 && point < static_cast<Index>(mesh_.points.size());
    throw Failure("surfaces", code, message, known ? mesh_.points[point] : Vec3{}, entity);
  }

  void check_indices() const {
    const Index n = static_cast<Index>(mesh_.points.size());
    if (mesh_.point_entity.size() != mesh_.points.size() ||
        mesh_.triangle_face.size() != mesh_.triangles.size() ||
        mesh_.segment_edge.size() != mesh_.segments.size())
      fail("sizes", "the arrays of the surface mesh have different lengths", -1);
    auto inside = [&](Index v) { return v >= 0 && v < n; };
    for (const Triangle& t : mesh_.triangles) {
      if (!inside(t[0]) || !inside(t[1]) || !inside(t[2]))
        fail("index", "a triangle has a point out of range", -1);
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
        fail("degenerate", "a triangle has a point twice", t[0]);
    }
    for (const Segment& s : mesh_.segments)
      if (!inside(s[0]) || !inside(s[1]) || s[0] == s[1]) fail("index", "a segment is degenerate", -1);
  }

  void check_points() const {
    const double tolerance = point_tolerance(plc_);
    std::vector<char> used(mesh_.points.size(), 0);
    for (const Triangle& t : mesh_.triangles)
      for (Index v : t) used[v] = 1;
    for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
      const Vec3& p = mesh_.points[v];
      const Entity entity = mesh_.point_entity[v];
      if (!std::isfinite(norm2(p))) fail("not_a_number", "a point is not a number", static_cast<Index>(v));
      if (!used[v]) fail("unused", "a point has no triangle", static_cast<Index>(v), entity);
      if (entity.dimension != 1 && entity.dimension != 2) continue;
      if (!(distance(geometry_.project(entity, p), p) <= tolerance))
        fail("off_surface", "a point is not on its CAD element", static_cast<Index>(v), entity);
    }
  }

  void check_triangles() const {
    std::vector<Triangle> sorted = mesh_.triangles;
    for (Triangle& t : sorted) std::sort(t.begin(), t.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) fail("repeated", "a triangle occurs twice", (*twice)[0]);
  }

  struct Use {
    Index a, b;      // a < b
    Index triangle;  // -1 for a segment
    bool forward;
  };

  std::vector<Use> edge_uses() const {
    std::vector<Use> uses;
    uses.reserve(3 * mesh_.triangles.size() + mesh_.segments.size());
    for (std::size_t s = 0; s < mesh_.segments.size(); ++s) {
      const auto [a, b] = std::minmax(mesh_.segments[s][0], mesh_.segments[s][1]);
      uses.push_back({a, b, -1, true});
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index a = mesh_.triangles[t][i], b = mesh_.triangles[t][(i + 1) % 3];
        uses.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), a < b});
      }
    std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) {
      return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
    });
    return uses;
  }

  void check_edges() const {
    const std::vector<Use> uses = edge_uses();
    for (std::size_t i = 0; i < uses.size();) {
      std::size_t j = i;
      Index segments = 0;
      while (j < uses.size() && uses[j].a == uses[i].a && uses[j].b == uses[i].b)
        segments += uses[j++].triangle < 0;
      check_edge(&uses[i], static_cast<Index>(j - i), segments);
      i = j;
    }
  }

  void check_edge(const Use* uses, Index n, Index segments) const {
    const Use& first = uses[segments < n ? segments : 0];
    const Index triangles = n - segments;
    const Entity face{2, first.triangle >= 0 ? mesh_.triangle_face[first.triangle] : -1};
    if (segments > 1) fail("repeated_segment", "a segment occurs twice", first.a);
    if (triangles == 0) fail("loose", "a segment is no edge of a triangle", first.a);
    if (segments == 0) {
      const Use& second = uses[n - 1];
      if (triangles != 2) fail("not_manifold", "an edge inside a face has not two triangles", first.a, face);
      if (mesh_.triangle_face[first.triangle] != mesh_.triangle_face[second.triangle])
        fail("unlabelled", "an edge between two faces is no segment", first.a, face);
      if (first.forward == second.forward)
        fail("orientation", "two neighbouring triangles are oriented differently", first.a, face);
    }
    check_closed(uses + segments, triangles, face);
  }

  // Round each solid the edge is run through equally often both ways.
  void check_closed(const Use* uses, Index n, Entity face) const {
    for (Index k = 0; k < n; ++k)
      for (Index solid : plc_.face_solids[mesh_.triangle_face[uses[k].triangle]]) {
        if (solid == 0) continue;
        int balance = 0;
        for (Index i = 0; i < n; ++i) {
          const auto& sides = plc_.face_solids[mesh_.triangle_face[uses[i].triangle]];
          const int sign = (sides[0] == solid) - (sides[1] == solid);
          balance += uses[i].forward ? sign : -sign;
        }
        if (balance != 0) fail("open", "the surface is not closed round a solid", uses[k].a, face);
      }
  }

  // Every CAD vertex, edge and face of the PLC is still there.
  void check_presence() const {
    std::vector<char> vertices(plc_.vertex_count, 0), edges(plc_.edge_count, 0),
        faces(plc_.face_solids.size(), 0);
    for (const Entity& e : mesh_.point_entity)
      if (e.dimension == 0) vertices.at(e.index) = 1;
    for (Index e : mesh_.segment_edge) edges.at(e) = 1;
    for (Index f : mesh_.triangle_face) faces.at(f) = 1;
    for (std::size_t c = 0; c < plc_.corners.size(); ++c)
      if (!vertices[plc_.corner_vertex[c]])
        fail("missing", "a CAD vertex is missing", -1, {0, plc_.corner_vertex[c]});
    for (Index e : plc_.segment_edge)
      if (!edges[e]) fail("missing", "a CAD edge is missing", -1, {1, e});
    for (Index f : plc_.triangle_face)
      if (!faces[f]) fail("missing", "a CAD face is missing", -1, {2, f});
  }

  const SurfaceMesh& mesh_;
  const Plc& plc_;
  const Geometry& geometry_;
};

}  // namespace

void check_surface_mesh(const SurfaceMesh& mesh, const Plc& plc, const Geometry& geometry) {
  Checker(mesh, plc, geometry).run();
}

}  // namespace dm
