#include "surfaces/defects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "base/tet_geometry.h"
#include "surfaces/crossings.h"
#include "surfaces/edge_paths.h"
#include "surfaces/repeated_points.h"

namespace dm {
namespace {

constexpr double kSmallAngle = 0.94;    // cosine of 20 degrees
constexpr double kStripLength = 1.5;    // wanted length over the strip's width
constexpr double kFloor = 1.0 / 24;     // of the length the size field wants
constexpr double kFoldFloor = 1.0 / 8;  // ... where faces meet at less than 20 degrees
constexpr double kTip = 12;             // shortest length over the width: too narrow there for any gain
constexpr double kWedge = 3;            // distance from the meeting point over the width: 20 degrees
constexpr double kSharp = 0.5;          // solid angle: the end of a wedge of 20 degrees has 0.35 to 0.7
constexpr double kNoGain = 0.85;  // a cap no shorter than this, over the present length, is not worth it

class NarrowPlaces {
 public:
  NarrowPlaces(const SurfaceMesh& mesh, const Plc& plc, const LengthField& lengths)
      : mesh_(mesh), plc_(plc), lengths_(lengths) {}

  std::vector<Defect> run() {
    std::vector<Defect> found;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& v = mesh_.triangles[t];
      int on_curves = 0;
      for (const Index p : v) on_curves += mesh_.point_entity[p].dimension < 2;
      if (on_curves < 2) continue;
      const int corner = smallest_corner(v);
      if (corner < 0) continue;
      const Index a = v[corner], b = v[(corner + 1) % 3], c = v[(corner + 2) % 3];
      const bool short_segment = is_segment(b, c);
      if (on_curves < 3 && !short_segment) continue;
      if (is_segment(a, b) && is_segment(a, c)) continue;  // the angle is the input's
      const Vec3 &pa = mesh_.points[a], &pb = mesh_.points[b], &pc = mesh_.points[c];
      const double width = height(pa, pb, pc);
      const Vec3 place = (1.0 / 3) * (pa + pb + pc);
      const double wanted = lengths_.without_caps(place);
      const double floor =
          (kStripLength * width < kFoldFloor * wanted && at_fold(v) ? kFoldFloor : kFloor) * wanted;
      if (in_wedge(v, width, kTip * width < floor)) continue;
      const double length = std::max(kStripLength * width, floor);
      if (length < kNoGain * lengths_.at(place)) found.push_back({place, length, mesh_.triangle_face[t], -1});
    }
    return found;
  }

 private:
  static double height(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest = std::max({norm2(b - a), norm2(c - b), norm2(a - c)});
    return longest > 0 ? norm(area_vector(a, b, c)) / std::sqrt(longest) : 0;
  }

  // The corner with an angle under 20 degrees, the smallest first; -1 if there is none.
  int smallest_corner(const Triangle& v) const {
    int found = -1;
    double most = kSmallAngle;
    for (int i = 0; i < 3; ++i) {
      const Vec3 &p = mesh_.points[v[i]], &q = mesh_.points[v[(i + 1) % 3]],
                 &r = mesh_.points[v[(i + 2) % 3]];
      const double d = dot(q - p, r - p), cosine2 = norm2(q - p) * norm2(r - p);
      if (d > 0 && d * d > most * most * cosine2) {
        most = d / std::sqrt(cosine2);
        found = i;
      }
    }
    return found;
  }

  // Do two curves of the triangle meet at the tip of a wedge, farther away than belongs to the triangle's
  // width? Where the solid itself is as sharp, smaller triangles make no better tetrahedra.  Where only the
  // face is (a fillet that runs out, the crest of a thread), they do, but for those at the tip.
  bool in_wedge(const Triangle& v, double width, bool at_tip) {
    if (!paths_) {
      paths_.emplace(mesh_);
      find_sharp_ends();
    }
    for (int i = 0; i < 3; ++i)
      for (const int j : {(i + 1) % 3, (i + 2) % 3}) {
        const Entity &a = mesh_.point_entity[v[i]], &b = mesh_.point_entity[v[j]];
        if (a.dimension != 1 || b.dimension != 1 || a.index == b.index) continue;
        const auto& ends = paths_->ends()[b.index];
        for (const Index p : paths_->ends()[a.index])
          if (std::find(ends.begin(), ends.end(), p) != ends.end() &&
              distance(mesh_.points[p], mesh_.points[v[i]]) > kWedge * width &&
              (at_tip || (sharp_[p] && !paths_->run_in_parallel(a.index, v[i], b.index, p, width))))
            return true;
      }
    return false;
  }

  // Does a corner lie where two faces meet at an acute angle?  Smaller triangles there only make more
  // elements as flat as that.
  bool at_fold(const Triangle& v) {
    if (folded_.empty()) find_folds();
    return folded_[v[0]] || folded_[v[1]] || folded_[v[2]];
  }

  void find_folds() {
    std::vector<std::tuple<Index, Index, Vec3>> sides;  // ends in order, normal of the triangle
    for (const Triangle& t : mesh_.triangles)
      for (int i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
        if (is_segment(a, b)) sides.emplace_back(a, b, normal(t));
      }
    std::sort(sides.begin(), sides.end(), [](const auto& x, const auto& y) {
      return std::tie(std::get<0>(x), std::get<1>(x)) < std::tie(std::get<0>(y), std::get<1>(y));
    });
    folded_.assign(mesh_.points.size(), 0);
    for (std::size_t k = 1; k < sides.size(); ++k) {
      const auto& [a, b, n] = sides[k];
      const auto& [c, d, m] = sides[k - 1];
      if (a == c && b == d && dot(n, m) < -kSmallAngle) folded_[a] = folded_[b] = 1;
    }
  }
  Vec3 normal(const Triangle& t) const {
    return normalized(area_vector(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]));
  }

  // Ends of edges at which some solid has a small solid angle: by the areas of the triangles between the
  // sides of the fan and any one direction, on the sphere round the point, a multiple of the sphere left
  // aside.
  void find_sharp_ends() {
    const Vec3 direction{0.36, -0.48, 0.8};
    std::map<std::array<Index, 2>, double> angles;  // by point and solid
    for (const auto& ends : paths_->ends())
      for (const Index p : ends) angles[{p, 0}] = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const Index p = mesh_.triangles[t][i];
        if (mesh_.point_entity[p].dimension == 2 || !angles.contains({p, 0})) continue;
        const auto towards = [&](int k) {
          return normalized(mesh_.points[mesh_.triangles[t][(i + k) % 3]] - mesh_.points[p]);
        };
        const double area = solid_angle(towards(2), towards(1), direction);
        const auto [behind, front] = plc_.face_solids[mesh_.triangle_face[t]];
        angles[{p, behind}] += area;
        angles[{p, front}] -= area;
      }
    sharp_.assign(mesh_.points.size(), 0);
    for (const auto& [key, sum] : angles) {
      const double whole = 4 * std::numbers::pi, angle = sum - whole * std::floor(sum / whole);
      if (key[1] > 0 && std::min(angle, whole - angle) < kSharp) sharp_[key[0]] = 1;
    }
  }

  bool is_segment(Index a, Index b) {
    if (segments_.empty()) {
      for (const Segment& s : mesh_.segments) segments_.push_back(std::minmax(s[0], s[1]));
      std::sort(segments_.begin(), segments_.end());
    }
    return std::binary_search(segments_.begin(), segments_.end(), std::pair<Index, Index>(std::minmax(a, b)));
  }

  const SurfaceMesh& mesh_;
  const Plc& plc_;
  const LengthField& lengths_;
  std::vector<std::pair<Index, Index>> segments_;  // sorted; made when first needed, as are
  std::optional<EdgePaths> paths_;
  std::vector<char> sharp_, folded_;  // by point
};

std::vector<Index> triangles_at_repeated_points(const SurfaceMesh& mesh) {
  const std::vector<Index> first = first_at_place(mesh);
  std::vector<char> repeated(mesh.points.size(), 0);
  for (std::size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<Index>(v)) repeated[v] = repeated[first[v]] = 1;
  std::vector<Index> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    if (repeated[v[0]] || repeated[v[1]] || repeated[v[2]]) found.push_back(static_cast<Index>(t));
  }
  return found;
}

}  // namespace

std::vector<Defect> find_crossing_defects(const SurfaceMesh& mesh, const LengthField& lengths,
                                          Context& context) {
  std::vector<std::array<Index, 3>> crossing;  // triangle; 0 if the other is of its own face; other's face
  for (const auto& [i, j] :
       find_crossings(mesh.points, mesh.triangles, context, kMostCrossings * mesh.triangles.size())) {
    const Index f = mesh.triangle_face[i], g = mesh.triangle_face[j];
    crossing.push_back({i, f != g, g});
    crossing.push_back({j, f != g, f});
  }
  for (const Index t : triangles_at_repeated_points(mesh)) crossing.push_back({t, 0, mesh.triangle_face[t]});
  std::sort(crossing.begin(), crossing.end());
  std::vector<Defect> found;
  for (std::size_t k = 0; k < crossing.size(); ++k) {
    const auto [t, differs, other] = crossing[k];
    if (k > 0 && crossing[k - 1][0] == t) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 place = (1.0 / 3) * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
    found.push_back({place, 0.5 * lengths.at(place), mesh.triangle_face[t], other});
  }
  return found;
}

std::vector<Defect> find_narrow_places(const SurfaceMesh& mesh, const Plc& plc, const LengthField& lengths) {
  return NarrowPlaces(mesh, plc, lengths).run();
}

}  // namespace dm
