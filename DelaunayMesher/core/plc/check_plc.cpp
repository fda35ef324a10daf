// Sorting finds everything: repeated points, repeated triangles and unmatched edges in O(n log n).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "plc/plc.h"

namespace dm {
namespace {

std::string face_name(Index face) { return "Face" + std::to_string(face + 1); }
std::string solid_name(Index solid) { return "Solid" + std::to_string(solid); }

std::string at(const Vec3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", p.x, p.y, p.z);
  return text;
}

Entity face_entity(Index face) { return {2, face}; }

[[noreturn]] void fail(const char* code, const std::string& message, const Vec3& place = {},
                       Entity entity = {}, Entity other = {}) {
  throw Failure("plc", code, message, place, entity, other);
}

void check_sizes(const Plc& plc) {
  if (plc.triangle_face.size() != plc.triangles.size() || plc.segment_edge.size() != plc.segments.size() ||
      plc.corner_vertex.size() != plc.corners.size()) {
    fail("bad_arrays", "The arrays of the triangulated boundary do not have matching lengths.");
  }
  if (plc.edge_count < 0 || plc.vertex_count < 0 || plc.solid_count < 0) {
    fail("bad_arrays", "A number of edges, vertices or solids is negative.");
  }
  if (plc.points.empty() || plc.triangles.empty()) fail("empty", "There is nothing to mesh: no triangles.");
  if (plc.solid_count > kMostSolids) {
    fail("too_many_solids", "There are " + std::to_string(plc.solid_count) + " solids, more than the " +
                                std::to_string(kMostSolids) + " that can be meshed together.");
  }
}

bool in_range(Index i, std::size_t count) { return i >= 0 && static_cast<std::size_t>(i) < count; }

void check_indices(const Plc& plc) {
  const std::size_t points = plc.points.size();
  for (std::size_t i = 0; i < plc.triangles.size(); ++i) {
    const Triangle& t = plc.triangles[i];
    if (!in_range(plc.triangle_face[i], plc.face_solids.size())) {
      fail("bad_index", "Triangle " + std::to_string(i) + " belongs to a face that does not exist.");
    }
    const Index face = plc.triangle_face[i];
    if (!in_range(t[0], points) || !in_range(t[1], points) || !in_range(t[2], points)) {
      fail("bad_index", face_name(face) + " has a triangle with a point that does not exist.", {},
           face_entity(face));
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      fail("collapsed_triangle",
           face_name(face) + " has a triangle that uses a point twice near " + at(plc.points[t[0]]) + ".",
           plc.points[t[0]], face_entity(face));
    }
  }
  for (std::size_t i = 0; i < plc.segments.size(); ++i) {
    const auto [a, b] = plc.segments[i];
    if (!in_range(plc.segment_edge[i], plc.edge_count) || !in_range(a, points) || !in_range(b, points) ||
        a == b) {
      fail("bad_index", "Segment " + std::to_string(i) + " has an edge or a point that does not exist.");
    }
  }
  for (std::size_t i = 0; i < plc.corners.size(); ++i) {
    if (!in_range(plc.corner_vertex[i], plc.vertex_count) || !in_range(plc.corners[i], points)) {
      fail("bad_index", "Corner " + std::to_string(i) + " has a vertex or a point that does not exist.");
    }
  }
  for (const Index face : plc.kept_faces)
    if (!in_range(face, plc.face_solids.size())) fail("bad_index", "A face to keep does not exist.");
  for (const Index edge : plc.kept_edges)
    if (!in_range(edge, plc.edge_count)) fail("bad_index", "An edge to keep does not exist.");
}

// A face of a triangle that uses each point, for messages; -1 for points that none uses.
std::vector<Index> face_of_points(const Plc& plc) {
  std::vector<Index> face(plc.points.size(), -1);
  for (std::size_t i = 0; i < plc.triangles.size(); ++i) {
    for (const Index v : plc.triangles[i]) face[v] = plc.triangle_face[i];
  }
  return face;
}

void check_points(const Plc& plc, const std::vector<Index>& face_of_point) {
  const auto entity_of = [&](Index point) {
    return face_of_point[point] >= 0 ? face_entity(face_of_point[point]) : Entity{};
  };
  const auto where = [&](Index point) {
    return face_of_point[point] >= 0 ? " on " + face_name(face_of_point[point]) : std::string();
  };
  const Index count = static_cast<Index>(plc.points.size());
  for (Index i = 0; i < count; ++i) {
    const Vec3& p = plc.points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      fail("not_a_number",
           "Point " + std::to_string(i) + where(i) + " has a coordinate that is not a number.", {},
           entity_of(i));
    }
  }
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index i, Index j) {
    const Vec3 &p = plc.points[i], &q = plc.points[j];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : i < j;
  });
  for (Index k = 0; k + 1 < count; ++k) {
    if (!(plc.points[order[k]] == plc.points[order[k + 1]])) continue;
    fail("repeated_point",
         "Two points" + where(order[k]) + " coincide at " + at(plc.points[order[k]]) +
             ": they must be merged.",
         plc.points[order[k]], entity_of(order[k]), entity_of(order[k + 1]));
  }
}

void check_face_solids(const Plc& plc) {
  std::vector<char> has_triangle(plc.face_solids.size(), 0);
  for (const Index face : plc.triangle_face) has_triangle[face] = 1;
  bool any = false;
  for (std::size_t i = 0; i < plc.face_solids.size(); ++i) {
    const auto [behind, front] = plc.face_solids[i];
    if (behind < 0 || front < 0 || behind > plc.solid_count || front > plc.solid_count) {
      fail("bad_index", face_name(static_cast<Index>(i)) + " bounds a solid that does not exist.", {},
           face_entity(static_cast<Index>(i)));
    }
    any = any || behind > 0 || front > 0;
  }
  if (!any) fail("not_a_solid", "The shape has faces but no solid: there is no volume to mesh.");
  for (std::size_t i = 0; i < plc.triangles.size(); ++i) {
    const Index face = plc.triangle_face[i];
    if (plc.face_solids[face] == std::array<Index, 2>{0, 0}) {
      const Vec3& place = plc.points[plc.triangles[i][0]];
      fail("free_face", face_name(face) + " near " + at(place) + " belongs to no solid.", place,
           face_entity(face));
    }
  }
}

void check_repeated_triangles(const Plc& plc) {
  struct Key {
    Triangle corners;
    Index triangle;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys(plc.triangles.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = {plc.triangles[i], static_cast<Index>(i)};
    std::sort(keys[i].corners.begin(), keys[i].corners.end());
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    if (keys[k].corners != keys[k + 1].corners) continue;
    const Index f = plc.triangle_face[keys[k].triangle], g = plc.triangle_face[keys[k + 1].triangle];
    const Vec3& place = plc.points[keys[k].corners[0]];
    const std::string message = f == g
                                    ? face_name(f) + " is folded onto itself near " + at(place) + "."
                                    : face_name(f) + " and " + face_name(g) + " coincide near " + at(place) +
                                          ": solids that touch must share the face (Boolean Fragments).";
    fail("coincident_faces", message, place, face_entity(f), face_entity(g));
  }
}

Segment sorted(Index a, Index b) { return a < b ? Segment{a, b} : Segment{b, a}; }

void check_features(const Plc& plc, const std::vector<Index>& face_of_point) {
  std::vector<Segment> edges;
  edges.reserve(3 * plc.triangles.size());
  for (const Triangle& t : plc.triangles) {
    for (int k = 0; k < 3; ++k) edges.push_back(sorted(t[k], t[(k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < plc.segments.size(); ++i) {
    const auto [a, b] = plc.segments[i];
    if (std::binary_search(edges.begin(), edges.end(), sorted(a, b))) continue;
    const Vec3 place = 0.5 * (plc.points[a] + plc.points[b]);
    const Index edge = plc.segment_edge[i];
    fail("loose_segment",
         "Edge" + std::to_string(edge + 1) + " near " + at(place) +
             " does not follow the triangles of its faces.",
         place, {1, edge}, face_of_point[a] >= 0 ? face_entity(face_of_point[a]) : Entity{});
  }
  for (std::size_t i = 0; i < plc.corners.size(); ++i) {
    if (face_of_point[plc.corners[i]] >= 0) continue;
    const Vec3& place = plc.points[plc.corners[i]];
    fail("loose_corner",
         "Vertex" + std::to_string(plc.corner_vertex[i] + 1) + " at " + at(place) + " is on no face.", place,
         {0, plc.corner_vertex[i]});
  }
}

// An edge of a triangle as the boundary of `solid` has it, seen from outside.
struct Side {
  Index solid;
  Segment edge;     // sorted
  Index direction;  // +1 along the sorted edge, -1 against it
  Index face;
};

std::vector<Side> sides_of_solids(const Plc& plc) {
  std::vector<Side> sides;
  sides.reserve(3 * plc.triangles.size());
  for (std::size_t i = 0; i < plc.triangles.size(); ++i) {
    const Index face = plc.triangle_face[i];
    const auto [behind, front] = plc.face_solids[face];
    if (behind == front) continue;  // a sheet inside the solid bounds nothing
    for (int k = 0; k < 3; ++k) {
      const Index a = plc.triangles[i][k], b = plc.triangles[i][(k + 1) % 3];
      const Index direction = a < b ? 1 : -1;
      if (behind > 0) sides.push_back({behind, sorted(a, b), direction, face});
      if (front > 0) sides.push_back({front, sorted(a, b), -direction, face});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.solid, a.edge, a.face, a.direction) < std::tie(b.solid, b.edge, b.face, b.direction);
  });
  return sides;
}

// Round every edge as many triangles of a solid must run one way as the other: two, or more where it touches
// itself along the edge.
void check_closed(const Plc& plc) {
  const std::vector<Side> sides = sides_of_solids(plc);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    Index sum = 0;
    for (last = first; last < sides.size() && sides[last].solid == sides[first].solid &&
                       sides[last].edge == sides[first].edge;
         ++last) {
      sum += sides[last].direction;
    }
    if (sum == 0) continue;
    const Side& side = sides[first];
    const Vec3 place = 0.5 * (plc.points[side.edge[0]] + plc.points[side.edge[1]]);
    const Entity other = last - first > 1 ? face_entity(sides[last - 1].face) : Entity{};
    if ((last - first) % 2 == 1) {
      fail("open",
           solid_name(side.solid) + " is not closed: a gap beside " + face_name(side.face) + " near " +
               at(place) + ".",
           place, face_entity(side.face), other);
    }
    fail("orientation",
         solid_name(side.solid) + ": " + face_name(side.face) +
             (other == face_entity(side.face) ? " turns over"
                                              : " and " + face_name(other.index) + " face opposite ways") +
             " near " + at(place) + ": repair it in the CAD program.",
         place, face_entity(side.face), other);
  }
}

void check_volumes(const Plc& plc) {
  struct Sum {
    double volume = 0, area = 0;
    Index triangle = -1;
  };
  std::vector<Sum> sums(plc.solid_count + 1);
  for (std::size_t i = 0; i < plc.triangles.size(); ++i) {
    const Triangle& t = plc.triangles[i];
    const auto [behind, front] = plc.face_solids[plc.triangle_face[i]];
    for (const auto& [solid, sign] : {std::pair{behind, 1.0}, std::pair{front, -1.0}}) {
      Sum& sum = sums[solid];
      if (sum.triangle < 0) sum.triangle = static_cast<Index>(i);
      const Vec3 origin = plc.points[plc.triangles[sum.triangle][0]];
      const Vec3 area = area_vector(plc.points[t[0]], plc.points[t[1]], plc.points[t[2]]);
      sum.volume += sign / 6 * dot(plc.points[t[0]] - origin, area);
      sum.area += 0.5 * norm(area);
    }
  }
  for (Index solid = 1; solid <= plc.solid_count; ++solid) {
    const Sum& sum = sums[solid];
    if (sum.triangle < 0) fail("empty_solid", solid_name(solid) + " has no faces.", {}, {3, solid});
    const Vec3& place = plc.points[plc.triangles[sum.triangle][0]];
    // A ball has volume 0.094 area^1.5; what is left after rounding has less than 1e-12 of that.
    if (std::abs(sum.volume) <= 1e-13 * sum.area * std::sqrt(sum.area)) {
      fail("no_volume", solid_name(solid) + " near " + at(place) + " has no volume.", place, {3, solid});
    }
    if (sum.volume < 0) {
      fail("inside_out",
           solid_name(solid) + " near " + at(place) + " is inside out: its faces point inwards.", place,
           {3, solid});
    }
  }
}

}  // namespace

void check_plc(const Plc& plc, Context& context) {
  check_sizes(plc);
  check_indices(plc);
  const std::vector<Index> face_of_point = face_of_points(plc);
  check_points(plc, face_of_point);
  context.poll(0);
  check_face_solids(plc);
  check_repeated_triangles(plc);
  context.poll(0);
  check_features(plc, face_of_point);
  context.poll(0);
  check_closed(plc);
  context.poll(0);
  check_volumes(plc);
}

}  // namespace dm
