#include "optimisation/insertion.h"

#include "optimisation/sagitta.h"

namespace dm {
namespace {

constexpr std::size_t kLargest = 30;  // tetrahedra of a cavity: their cone has fewer than kMaxReplace
constexpr double kSharpest = 0.99985, kBluntest = -0.9994;  // cosines of 1 and 178 degrees
constexpr int kSteps = 6;  // along the gradient, before the cavity is grown again

bool contains(const Tet& t, Index v) { return t[0] == v || t[1] == v || t[2] == v || t[3] == v; }
bool contains(const Triangle& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }
template <class Items, class Item>
bool has(const Items& items, const Item& item) {
  return std::find(items.begin(), items.end(), item) != items.end();
}

}  // namespace

Index Inserter::triangle_at(Index tet, int face) {
  const Tet& c = mesh_.tet(tet);
  const auto& f = kFaceCorners[face];
  return mesh_.find_triangle(c[f[0]], c[f[1]], c[f[2]]);
}

bool Inserter::in_cavity(Index tet) const { return has(cavity_, tet); }

void Inserter::add_face(Index tet, int face, std::vector<Face>& to) const {
  const Tet& c = mesh_.tet(tet);
  const auto& f = kFaceCorners[face];
  Face found{tet, face, {c[f[0]], c[f[1]], c[f[2]]}, 0};
  const Triangle& t = found.corners;
  found.bad = badness(angle_cosines(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), place_));
  to.push_back(found);
}

// The faces of the first tetrahedra that are none of the first triangles and lie between no two of them.
void Inserter::start() {
  cavity_ = first_tets_;
  triangles_ = first_triangles_;
  faces_.clear();
  for (const Index t : cavity_)
    for (int i = 0; i < 4; ++i) {
      const bool inner = mesh_.marked(t, i) ? !triangles_.empty() && has(triangles_, triangle_at(t, i))
                                            : in_cavity(mesh_.neighbour(t, i) / 4);
      if (!inner) add_face(t, i, faces_);
    }
}

// A boundary triangle beside those that give way already, on the same CAD face.
bool Inserter::may_absorb(const Face& face) {
  if (triangles_.empty()) return false;
  const Triangle& c = face.corners;
  const Index own = mesh_.find_triangle(c[0], c[1], c[2]);
  if (own < 0) return false;
  for (const Index k : triangles_) {
    if (mesh_.triangle_face(k) != mesh_.triangle_face(own)) continue;
    for (int i = 0; i < 3; ++i) {
      const Index a = c[i], b = c[(i + 1) % 3];
      if (contains(mesh_.triangle(k), a) && contains(mesh_.triangle(k), b) && !mesh_.is_segment(a, b)) {
        triangles_.push_back(own);
        return true;
      }
    }
  }
  return false;
}

// Takes the tetrahedron across a face into the cavity if all its other faces make better ones.
bool Inserter::cross(std::size_t worst) {
  const Face from = faces_[worst];
  const bool marked = mesh_.marked(from.tet, from.face);
  const Index n = mesh_.neighbour(from.tet, from.face), tet = n / 4;
  fresh_.clear();
  const bool both = n >= 0 && in_cavity(tet);
  if (n >= 0 && !both)
    for (int i = 0; i < 4; ++i) {
      if (i == n % 4) continue;
      const Index across = mesh_.neighbour(tet, i);
      if (across >= 0 && !mesh_.marked(tet, i) && in_cavity(across / 4)) continue;
      add_face(tet, i, fresh_);
      if (fresh_.back().bad >= from.bad) return false;
    }
  if (marked && !may_absorb(from)) return false;
  std::erase_if(faces_, [&](const Face& f) {
    if (f.tet == from.tet && f.face == from.face) return true;
    if (both) return 4 * f.tet + f.face == n;
    return n >= 0 && !mesh_.marked(f.tet, f.face) && mesh_.neighbour(f.tet, f.face) / 4 == tet;
  });
  faces_.insert(faces_.end(), fresh_.begin(), fresh_.end());
  if (n >= 0 && !both) cavity_.push_back(tet);
  return true;
}

void Inserter::grow() {
  while (cavity_.size() < kLargest && !faces_.empty()) {
    std::size_t worst = 0;
    for (std::size_t k = 1; k < faces_.size(); ++k)
      if (faces_[k].bad > faces_[worst].bad) worst = k;
    if (!cross(worst)) return;
  }
}

void Inserter::settle() {
  Fan fan;
  fan.start(place_);
  for (const Face& f : faces_)
    fan.add(mesh_.point(f.corners[0]), mesh_.point(f.corners[1]), mesh_.point(f.corners[2]));
  fan.close();
  place_ = smoother_.best_apex(fan, place_, entity_, kSteps);
}

bool Inserter::is_valid() const {
  return std::all_of(faces_.begin(), faces_.end(), [&](const Face& f) {
    const auto [a, b, c] = f.corners;
    const AngleCosines angles = angle_cosines(mesh_.point(a), mesh_.point(b), mesh_.point(c), place_);
    return angles.sharp < kSharpest && angles.blunt > kBluntest;
  });
}

// The rim of the triangles that give way: edges that no two of one CAD face share, but for a split segment.
bool Inserter::build_triangles() {
  rims_.clear();
  rim_face_.clear();
  for (const Index k : triangles_)
    for (int i = 0; i < 3; ++i) {
      const Segment edge{mesh_.triangle(k)[i], mesh_.triangle(k)[(i + 1) % 3]};
      if (sorted(edge) == sorted(split_)) continue;
      bool inner = false;
      for (const Index other : triangles_)
        inner =
            inner || (other != k && mesh_.triangle_face(other) == mesh_.triangle_face(k) &&
                      contains(mesh_.triangle(other), edge[0]) && contains(mesh_.triangle(other), edge[1]));
      if (inner) continue;
      // Two faces that meet where no CAD edge lies would share a triangle.
      if (is_rim(edge[0], edge[1])) return false;
      rims_.push_back(edge);
      rim_face_.push_back(mesh_.triangle_face(k));
    }
  return rims_.size() >= triangles_.size();
}

// The new triangles on one CAD face beside the old ones.
bool Inserter::keeps_surface(Index face) const {
  Vec3 before;
  std::vector<Segment> old_edges;
  for (const Index k : triangles_) {
    if (mesh_.triangle_face(k) != face) continue;
    const auto [a, b, c] = mesh_.triangle(k);
    before += normalized(area_vector(mesh_.point(a), mesh_.point(b), mesh_.point(c)));
    for (const Segment& edge : {Segment{a, b}, Segment{b, c}, Segment{c, a}}) old_edges.push_back(edge);
  }
  std::vector<Vec3> middles;
  for (std::size_t i = 0; i < rims_.size(); ++i) {
    if (rim_face_[i] != face) continue;
    const Vec3 &p = mesh_.point(rims_[i][0]), &q = mesh_.point(rims_[i][1]);
    if (!turns_little(before, area_vector(p, q, place_))) return false;
    for (const Vec3& end : {p, q}) {
      const Vec3 middle = 0.5 * (end + place_);
      if (!has(middles, middle)) middles.push_back(middle);
    }
  }
  return lies_as_close(mesh_, geometry_, face, middles, old_edges);
}

bool Inserter::keeps_surface() const {
  return std::all_of(on_faces_.begin(), on_faces_.end(), [&](Index face) { return keeps_surface(face); });
}

bool Inserter::is_rim(Index a, Index b) const {
  return has(rims_, Segment{a, b}) || has(rims_, Segment{b, a});
}

// Every triangle of the cone lies between two tetrahedra or on the boundary; those inside have no three
// corners on one CAD face.
bool Inserter::is_sound() const {
  const auto shared_face = [&](Index a, Index b) {
    const auto fa = mesh_.faces_of(a), fb = mesh_.faces_of(b);
    return std::any_of(on_faces_.begin(), on_faces_.end(), [&](Index f) { return has(fa, f) && has(fb, f); });
  };
  for (const Face& f : faces_)
    for (int i = 0; i < 3; ++i) {
      const Index a = f.corners[i], b = f.corners[(i + 1) % 3];
      int same = 0, other = 0;
      for (const Face& g : faces_)
        if (contains(g.corners, a) && contains(g.corners, b))
          ++(mesh_.solid(g.tet) == mesh_.solid(f.tet) ? same : other);
      if (is_rim(a, b) ? same + other > 2 : same != 2 || other != 0 || shared_face(a, b)) return false;
    }
  return true;
}

// A point that the cone does not keep goes with all its tetrahedra, and is no point of a CAD edge.
bool Inserter::drops_whole_points() {
  for (const Index t : cavity_)
    for (const Index v : mesh_.tet(t)) {
      if (std::any_of(faces_.begin(), faces_.end(), [&](const Face& f) { return contains(f.corners, v); }))
        continue;
      if (mesh_.entity(v).dimension < 2 || mesh_.pinched(v)) return false;
      for (const Index around : mesh_.star(v))
        if (!in_cavity(around)) return false;
    }
  return true;
}

void Inserter::commit() {
  const Index v = mesh_.add_point(place_, entity_, on_faces_);
  std::vector<Tet> cone;
  std::vector<Index> solids;
  for (const Face& f : faces_) {
    cone.push_back({f.corners[0], f.corners[1], f.corners[2], v});
    solids.push_back(mesh_.solid(f.tet));
  }
  std::vector<Triangle> fan;
  for (std::size_t i = 0; i < rims_.size(); ++i) {
    fan.push_back({rims_[i][0], rims_[i][1], v});
    if (i < triangles_.size())
      mesh_.set_triangle(triangles_[i], fan.back(), rim_face_[i]);
    else
      mesh_.add_triangle(fan.back(), rim_face_[i]);
  }
  if (split_[0] >= 0) {
    const Index k = mesh_.find_segment(split_[0], split_[1]);
    const Segment whole = mesh_.segment(k);
    mesh_.set_segment(k, {whole[0], v});
    mesh_.add_segment({v, whole[1]}, mesh_.segment_edge(k));
  }
  mesh_.replace(cavity_, cone, solids, fan);
}

// With the point and the first cavity set: the rest, and the change if it is allowed.
bool Inserter::work_out() {
  for (int round = 0; round < 2; ++round) {
    start();
    grow();
    if (faces_.size() > Fan::kCapacity / 2) return false;
    settle();
  }
  if (!is_valid() || !build_triangles() || !is_sound() || !drops_whole_points() || !keeps_surface())
    return false;
  commit();
  return true;
}

bool Inserter::insert_inside(Index tet) {
  const Tet& c = mesh_.tet(tet);
  place_ = 0.25 * (mesh_.point(c[0]) + mesh_.point(c[1]) + mesh_.point(c[2]) + mesh_.point(c[3]));
  entity_ = {3, mesh_.solid(tet)};
  split_ = {-1, -1};
  on_faces_.clear();
  first_tets_ = {tet};
  first_triangles_.clear();
  return work_out();
}

// The tetrahedra and boundary triangles at an edge, and their CAD faces.
bool Inserter::list_edge(Index a, Index b) {
  first_tets_.clear();
  first_triangles_.clear();
  on_faces_.clear();
  for (const Index t : mesh_.star(a))
    if (contains(mesh_.tet(t), b)) first_tets_.push_back(t);
  if (first_tets_.size() > kLargest) return false;
  for (const Index t : first_tets_)
    for (int i = 0; i < 4; ++i) {
      const Tet& c = mesh_.tet(t);
      if (!mesh_.marked(t, i) || c[i] == a || c[i] == b) continue;
      const Index k = triangle_at(t, i);
      if (k < 0) return false;
      if (!has(first_triangles_, k)) first_triangles_.push_back(k);
      if (!has(on_faces_, mesh_.triangle_face(k))) on_faces_.push_back(mesh_.triangle_face(k));
    }
  std::sort(on_faces_.begin(), on_faces_.end());
  return !first_tets_.empty();
}

bool Inserter::insert_on_edge(Index a, Index b) {
  if (mesh_.pinched(a) || mesh_.pinched(b) || !list_edge(a, b)) return false;
  const Index segment = mesh_.find_segment(a, b);
  if (segment == EditMesh::kTwice) return false;
  split_ = {-1, -1};
  place_ = 0.5 * (mesh_.point(a) + mesh_.point(b));
  if (first_triangles_.empty()) {
    entity_ = {3, mesh_.solid(first_tets_[0])};
    return work_out();
  }
  if (segment < 0) {
    if (on_faces_.size() > 1 || first_triangles_.size() > 2) return false;
    entity_ = {2, on_faces_[0]};
  } else {
    split_ = {a, b};
    entity_ = {1, mesh_.segment_edge(segment)};
  }
  place_ = geometry_.project(entity_, place_);
  return work_out();
}

bool Inserter::insert_on_triangle(Index tet, int face) {
  const Index k = triangle_at(tet, face), n = mesh_.neighbour(tet, face);
  if (k < 0) return false;
  first_triangles_ = {k};
  first_tets_ = {tet};
  if (n >= 0) first_tets_.push_back(n / 4);
  on_faces_ = {mesh_.triangle_face(k)};
  entity_ = {2, on_faces_[0]};
  split_ = {-1, -1};
  const auto [a, b, c] = mesh_.triangle(k);
  place_ = geometry_.project(entity_, (1.0 / 3) * (mesh_.point(a) + mesh_.point(b) + mesh_.point(c)));
  return work_out();
}

bool Inserter::insert(Index tet, int place) {
  if (place == 0) return insert_inside(tet);
  if (place > 6) return mesh_.marked(tet, place - 7) && insert_on_triangle(tet, place - 7);
  const Triangle ends = site(tet, place);
  return ends[0] >= 0 && insert_on_edge(ends[0], ends[1]);
}

Triangle Inserter::site(Index tet, int place) const {
  const Tet& c = mesh_.tet(tet);
  if (place > 6) {
    const auto& f = kFaceCorners[place - 7];
    return mesh_.marked(tet, place - 7) ? sorted(Triangle{c[f[0]], c[f[1]], c[f[2]]}) : Triangle{-1, -1, -1};
  }
  std::vector<std::pair<double, Segment>> edges;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (!mesh_.interior(c[i]) && !mesh_.interior(c[j]))
        edges.push_back({-distance(mesh_.point(c[i]), mesh_.point(c[j])), sorted(Segment{c[i], c[j]})});
  if (place < 1 || place > static_cast<int>(edges.size())) return {-1, -1, -1};
  std::sort(edges.begin(), edges.end());
  const Segment& ends = edges[place - 1].second;
  return {ends[0], ends[1], -1};
}

}  // namespace dm
