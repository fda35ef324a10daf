#include "optimisation/collapse.h"

#include "optimisation/sagitta.h"

namespace dm {
namespace {

constexpr Triangle kNothing{-1, -1, -1};
constexpr Index kOutside = -1;  // stands for what is beyond the boundary, as a point

bool contains(const Tet& t, Index v) { return t[0] == v || t[1] == v || t[2] == v || t[3] == v; }
bool contains(const Triangle& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }

// The sides of what faces the end of an edge, its link: of tetrahedra, and with kOutside of boundary
// triangles. A point is a side with itself.  Those that face the whole edge come apart.
void list_link(EditMesh& mesh, Index end, Index other, std::vector<Segment>& link,
               std::vector<Segment>& of_edge) {
  const auto add = [&](Index v, Index w, bool both) {
    if (v != end && w != end && v != other && w != other)
      (both ? of_edge : link).push_back({std::min(v, w), std::max(v, w)});
  };
  for (const Index t : mesh.star(end)) {
    const Tet& c = mesh.tet(t);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j) add(c[i], c[j], contains(c, other));
      if (!mesh.marked(t, i) || c[i] == end) continue;
      for (const int k : kFaceCorners[i]) add(c[k], kOutside, contains(c, other) && c[i] != other);
    }
  }
}

}  // namespace

bool breaks_link(EditMesh& mesh, Index from, Index to) {
  std::vector<Segment> one, two, both;
  list_link(mesh, from, to, one, both);
  list_link(mesh, to, from, two, both);
  std::sort(one.begin(), one.end());
  std::sort(both.begin(), both.end());
  return std::any_of(two.begin(), two.end(), [&](const Segment& side) {
    return std::binary_search(one.begin(), one.end(), side) &&
           !std::binary_search(both.begin(), both.end(), side);
  });
}

// A triangle of the cone that is new: it holds `to` and was no face of the star.
bool Contractor::makes_forbidden_face(const Plan& plan, Index to) const {
  for (const Tet& t : plan.after)
    for (const auto& f : kFaceCorners) {
      const Triangle c{t[f[0]], t[f[1]], t[f[2]]};
      if (!contains(c, to) || !mesh_.on_one_face(c[0], c[1], c[2])) continue;
      bool old = std::any_of(boundary_.begin(), boundary_.end(),
                             [&](const Triangle& b) { return sorted(b) == sorted(c); });
      for (const Index b : plan.before) {
        const Tet& o = mesh_.tet(b);
        old = old || (contains(o, c[0]) && contains(o, c[1]) && contains(o, c[2]));
      }
      if (!old) return true;
    }
  return false;
}

// The new tetrahedra; false when one is not positive or the worst is not below `worst`.
bool Contractor::plan(Index from, Index to, double worst, Plan& plan) {
  const auto star = mesh_.star(from);
  if (star.size() > EditMesh::kMaxReplace) return false;
  plan.before.assign(star.begin(), star.end());
  for (const Index t : plan.before) {
    plan.old_angles.include(mesh_.cosines(mesh_.tet(t)));
    Tet cone = mesh_.tet(t);
    if (contains(cone, to)) {
      // Its two faces become one: none of them may be a triangle of the boundary.
      if (mesh_.marked(t, mesh_.corner_index(t, to))) return false;
      continue;
    }
    cone[mesh_.corner_index(t, from)] = to;
    plan.new_angles.include(mesh_.cosines(cone));
    if (badness(plan.new_angles) >= worst) return false;
    plan.after.push_back(cone);
    plan.solids.push_back(mesh_.solid(t));
  }
  plan.worst = badness(plan.new_angles);
  return !plan.after.empty();
}

bool Contractor::list_triangles(Index from) {
  triangles_.clear();
  for (const Index t : mesh_.star(from))
    for (int i = 0; i < 4; ++i) {
      const Tet& c = mesh_.tet(t);
      if (!mesh_.marked(t, i) || c[i] == from) continue;
      const auto& f = kFaceCorners[i];
      const Index k = mesh_.find_triangle(c[f[0]], c[f[1]], c[f[2]]);
      if (k < 0) return false;
      if (std::find(triangles_.begin(), triangles_.end(), k) == triangles_.end()) triangles_.push_back(k);
    }
  return true;
}

// The turned triangles beside the old ones of their CAD face.
bool Contractor::keeps_surface(Index from, Index to) {
  const auto normal = [&](const Triangle& t) {
    return area_vector(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]));
  };
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (turned_[i] == kNothing) continue;
    if (mesh_.find_triangle(turned_[i][0], turned_[i][1], turned_[i][2]) >= 0) return false;
    if (!turns_little(normal(mesh_.triangle(triangles_[i])), normal(turned_[i]))) return false;
  }
  const auto faces = mesh_.faces_of(from);
  return std::all_of(faces.begin(), faces.end(), [&](Index face) { return stays_close(face, from, to); });
}

bool Contractor::stays_close(Index face, Index from, Index to) const {
  std::vector<Segment> old_edges;
  std::vector<Vec3> middles;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (mesh_.triangle_face(triangles_[i]) != face) continue;
    for (const Index v : mesh_.triangle(triangles_[i])) {
      if (v == from) continue;
      old_edges.push_back({from, v});
      const Vec3 middle = 0.5 * (mesh_.point(v) + mesh_.point(to));
      const bool is_new = v != to && turned_[i] != kNothing;
      if (is_new && std::find(middles.begin(), middles.end(), middle) == middles.end())
        middles.push_back(middle);
    }
  }
  return lies_as_close(mesh_, geometry_, face, middles, old_edges);
}

// What becomes of the boundary when `from` goes to `to`; false when that is not possible.
bool Contractor::plan_boundary(Index from, Index to) {
  turned_.clear();
  boundary_.clear();
  segments_.clear();
  const Entity entity = mesh_.entity(from);
  if (entity.dimension == 3) return true;
  if (entity.dimension == 0 || mesh_.pinched(from) || mesh_.pinched(to) || !list_triangles(from))
    return false;
  if (entity.dimension == 1) {
    const Index k = mesh_.find_segment(from, to);
    if (k < 0 || mesh_.segment_edge(k) != entity.index) return false;
    segments_ = {k};
  }
  std::size_t vanishing = 0;
  for (const Index k : triangles_) {
    Triangle t = mesh_.triangle(k);
    for (const Index v : t) {
      const Index s = entity.dimension == 1 && v != to && v != from ? mesh_.find_segment(from, v) : -1;
      if (s >= 0 && std::find(segments_.begin(), segments_.end(), s) == segments_.end())
        segments_.push_back(s);
    }
    if (contains(t, to)) {
      ++vanishing;
      t = kNothing;
    } else {
      std::replace(t.begin(), t.end(), from, to);
      boundary_.push_back(t);
    }
    turned_.push_back(t);
  }
  if (entity.dimension == 2 ? vanishing != 2 : segments_.size() != 2 || vanishing == 0) return false;
  return true;
}

void Contractor::apply(const Plan& plan) {
  for (std::size_t i = 0; i < turned_.size(); ++i)
    mesh_.set_triangle(triangles_[i], turned_[i], mesh_.triangle_face(triangles_[i]));
  if (!segments_.empty()) {
    const Segment gone = mesh_.segment(segments_[0]);
    Segment next = mesh_.segment(segments_[1]);
    for (Index& v : next)
      if (v == gone[0])
        v = gone[1];
      else if (v == gone[1])
        v = gone[0];
    mesh_.set_segment(segments_[0], {-1, -1});
    mesh_.set_segment(segments_[1], next);
  }
  mesh_.replace(plan.before, plan.after, plan.solids, boundary_);
}

bool Contractor::collapse_best(Index tet) {
  Plan best;
  const Tet corners = mesh_.tet(tet);
  boundary_.clear();
  turned_.clear();
  segments_.clear();
  for (const Index from : corners)
    for (const Index to : corners) {
      if (from == to || !mesh_.interior(from)) continue;
      Plan found;
      if (!plan(from, to, best.worst, found)) continue;
      if (found.worst >= badness(found.old_angles) - 1e-3) continue;
      if (!keeps_angles(found.old_angles, found.new_angles) || makes_forbidden_face(found, to)) continue;
      best = std::move(found);
    }
  if (best.after.empty()) return false;
  apply(best);
  return true;
}

bool Contractor::contract(Index from, Index to) {
  Plan found;
  if (!plan_boundary(from, to) || !plan(from, to, kInverted, found)) return false;
  if (!mesh_.interior(from) && (breaks_link(mesh_, from, to) || !keeps_surface(from, to))) return false;
  if (makes_forbidden_face(found, to)) return false;
  apply(found);
  return true;
}

}  // namespace dm
