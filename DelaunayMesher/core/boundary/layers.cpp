#include "boundary/layers.h"

#include <algorithm>

#include "base/box_tree.h"

namespace dm {

namespace {

// Distance between the sheets over the wanted edge length, below which images are made; above it, points that
// do not face each other make better elements.
constexpr double kThin = 0.25;
constexpr double kSnap = 0.45;      // farther than this over the same length, a new point is made
constexpr double kFacing = -0.9;    // cosine between the normals of sheets that face each other
constexpr double kAligned = 1e-3;   // a misalignment, over the distance, that does no harm
constexpr double kTurn = 0.5;       // cosine by which a moved point may turn its triangles
constexpr double kSmallSine = 0.1;  // of an angle that a move or a new point may make
constexpr double kShortest = 0.2;   // part of a segment that is split
constexpr int kMostFlips = 400;     // after one change

// A point and its image on the sheet that it faces.
struct Image {
  Index point;
  Vec3 place;
  Index triangle;  // that holds the image
};

class LayerMatcher {
 public:
  LayerMatcher(SurfaceMesh& mesh, const Plc& plc, const Geometry& geometry, const SizeField& size,
               std::vector<char>& fixed, Context& context)
      : mesh_(mesh),
        geometry_(geometry),
        size_(size),
        complex_(mesh, plc.face_solids),
        fixed_(fixed),
        context_(context) {
    fixed_.resize(mesh.points.size(), 0);
  }

  // Points that cannot move impose themselves first, then those that face a fixed point: the images of a
  // stack of sheets are made from one sheet to the next.
  Index run(const std::vector<Index>& missing) {
    images_ = find_images(missing);
    std::stable_sort(images_.begin(), images_.end(), [&](const Image& a, const Image& b) {
      return complex_.entity(a.point).dimension < complex_.entity(b.point).dimension;
    });
    of_point_.resize(mesh_.points.size());
    for (std::size_t i = 0; i < images_.size(); ++i) of_point_[images_[i].point].push_back(i);
    done_.assign(images_.size(), 0);
    for (std::size_t i = 0; i < images_.size(); ++i) {
      waiting_.assign(1, i);
      for (std::size_t k = 0; k < waiting_.size(); ++k) match(waiting_[k]);
    }
    if (changes_ > 0) export_triangles();
    return changes_;
  }

 private:
  double edge_size(const Vec3& p) const { return kBoundaryEdge * size_.at(p); }
  const Vec3& at(Index v) const { return mesh_.points[v]; }
  Vec3 area_of(const Triangle& t) const { return area_vector(at(t[0]), at(t[1]), at(t[2])); }

  // Of each missing triangle: the images on it of points in its ball, and those of its corners on other
  // sheets.
  std::vector<Image> find_images(const std::vector<Index>& missing) {
    std::vector<Box> boxes(mesh_.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
      for (const Index v : mesh_.triangles[t]) boxes[t].add(at(v));
    tree_ = BoxTree(boxes);
    std::vector<Image> images;
    for (const Index t : missing) {
      const auto [a, b, c] = mesh_.triangles[t];
      const Sphere ball = circumcircle(at(a), at(b), at(c));
      const double radius = std::min(std::sqrt(ball.radius2), edge_size(ball.centre));
      context_.poll(0);
      for (const Index v : {a, b, c}) find_images_of_point(v, radius, images);
      visit_near(ball.centre, radius, [&](Index other) {
        for (const Index v : mesh_.triangles[other]) {
          Vec3 foot;
          if (norm2(at(v) - ball.centre) < radius * radius && faces(v, mesh_.triangles[t], foot))
            images.push_back({v, foot, t});
        }
      });
    }
    const auto key = [](const Image& image) { return std::pair(image.point, image.triangle); };
    std::sort(images.begin(), images.end(), [&](const Image& i, const Image& j) { return key(i) < key(j); });
    const auto same = [&](const Image& i, const Image& j) { return key(i) == key(j); };
    images.erase(std::unique(images.begin(), images.end(), same), images.end());
    return images;
  }

  // Calls visit(triangle) for those whose box is within a distance of p.
  template <class Visit>
  void visit_near(const Vec3& p, double range, Visit visit) const {
    std::vector<Index> stack;
    if (!tree_.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const BoxTree::Node& node = tree_.nodes()[stack.back()];
      stack.pop_back();
      if (node.box.distance2(p) >= range * range) continue;
      if (node.count == 0) stack.insert(stack.end(), {node.first, node.first + 1});
      for (Index k = 0; k < node.count; ++k) visit(tree_.order()[node.first + k]);
    }
  }

  // The images on the nearest triangles that face a point from either side.
  void find_images_of_point(Index point, double range, std::vector<Image>& images) const {
    const Vec3& p = at(point);
    double nearest[2] = {range, range};
    Image found[2] = {{point, {}, -1}, {point, {}, -1}};
    visit_near(p, range, [&](Index t) {
      Vec3 foot;
      if (!faces(point, mesh_.triangles[t], foot)) return;
      const double d = distance(p, foot);
      const int side = dot(area_of(mesh_.triangles[t]), p - foot) > 0;
      if (d < nearest[side]) nearest[side] = d, found[side].place = foot, found[side].triangle = t;
    });
    for (const Image& image : found)
      if (image.triangle >= 0) images.push_back(image);
  }

  // Does the point lie straight above triangle t, with a sheet that is about parallel to it?
  bool faces(Index point, const Triangle& t, Vec3& foot) const {
    if (std::find(t.begin(), t.end(), point) != t.end()) return false;
    const Vec3 area = area_of(t), n = normalized(area);
    const Vec3 &p = at(point), &a = at(t[0]);
    foot = p - dot(p - a, n) * n;
    if (distance(p, foot) > kThin * edge_size(p)) return false;
    for (int i = 0; i < 3; ++i)
      if (dot(area, area_vector(at(t[i]), at(t[(i + 1) % 3]), foot)) < 0) return false;
    const auto fan = complex_.triangles_at(point);
    return std::any_of(fan.begin(), fan.end(),
                       [&](Index s) { return dot(normalized(area_of(complex_.corners(s))), n) < kFacing; });
  }

  void match(std::size_t number) {
    if (done_[number]) return;
    done_[number] = 1;
    const Image& image = images_[number];
    const Index p = image.point, q = nearest_point(image);
    const double off = distance(at(q), image.place);
    const bool near = off < kSnap * edge_size(at(p));
    if (off < kAligned * distance(at(p), image.place) || (near && (move_over(q, p) || move_over(p, q)))) {
      fix(p);
      fix(q);
    } else if (insert(image)) {
      fix(p);
    }
  }

  void fix(Index v) {
    fixed_[v] = 1;
    if (v < static_cast<Index>(of_point_.size()))
      waiting_.insert(waiting_.end(), of_point_[v].begin(), of_point_[v].end());
  }

  // The point nearest to an image, of the triangle that held it and of those round it.
  Index nearest_point(const Image& image) const {
    const Triangle& held_by = mesh_.triangles[image.triangle];
    Index best = held_by[0];
    double best2 = HUGE_VAL;
    for (const Index corner : held_by)
      for (const Index t : complex_.triangles_at(corner))
        for (const Index v : complex_.corners(t)) {
          const double d2 = norm2(at(v) - image.place);
          if (v != image.point && d2 < best2) best = v, best2 = d2;
        }
    return best;
  }

  // Moves a point on its face or edge to where it is nearest to `other`, which it then faces.
  bool move_over(Index v, Index other) {
    const Entity entity = complex_.entity(v);
    if (entity.dimension == 0 || fixed_[v]) return false;
    const auto fan = complex_.triangles_at(v);
    std::vector<Vec3> before;
    Vec3 normal;
    for (const Index t : fan) {
      before.push_back(area_of(complex_.corners(t)));
      normal += before.back();
    }
    const Vec3 old = at(v), place = geometry_.project(entity, at(other), normal);
    mesh_.points[v] = place;
    for (std::size_t k = 0; k < fan.size(); ++k) {
      const Triangle& t = complex_.corners(fan[k]);
      if (keeps_direction(before[k], area_of(t)) && smallest_sine(t) > kSmallSine) continue;
      mesh_.points[v] = old;
      return false;
    }
    ++changes_;
    flip_round(v);
    return true;
  }

  static bool keeps_direction(const Vec3& before, const Vec3& after) {
    return dot(before, after) > kTurn * std::sqrt(norm2(before) * norm2(after));
  }

  double smallest_sine(const Triangle& t) const {
    double lengths[3];
    for (int i = 0; i < 3; ++i) lengths[i] = distance(at(t[i]), at(t[(i + 1) % 3]));
    std::sort(lengths, lengths + 3);
    return norm(area_of(t)) / (lengths[1] * lengths[2]);
  }

  // A new point on the sheet at the image: in a triangle, on an edge between two of one face, or on a
  // segment.
  bool insert(const Image& image) {
    for (const Index corner : mesh_.triangles[image.triangle])
      for (const Index t : complex_.triangles_at(corner)) {
        const Triangle q = complex_.corners(t);
        const Vec3 place = geometry_.project_to_face(complex_.face(t), at(image.point), area_of(q));
        if (replace({t}, {{q[0], q[1]}, {q[1], q[2]}, {q[2], q[0]}}, place)) return true;
        for (int i = 0; i < 3; ++i) {
          const Index a = q[i], b = q[(i + 1) % 3], c = q[(i + 2) % 3];
          if (complex_.is_segment(a, b)) {
            if (split_segment(a, b, image)) return true;
            continue;
          }
          BoundaryComplex::Fan fan;
          if (complex_.triangles_at(a, b, fan) != 2) continue;
          const Index other = fan[fan[0] == t], d = opposite_corner(complex_, other, a, b);
          if (replace({t, other}, {{b, c}, {c, a}, {a, d}, {d, b}}, place)) return true;
        }
      }
    return false;
  }

  // Replaces triangles of one face by those that join a new point to their outline, if these are well shaped.
  bool replace(const std::vector<Index>& triangles, const std::vector<Segment>& outline, const Vec3& place) {
    const Index face = complex_.face(triangles[0]), v = static_cast<Index>(mesh_.points.size());
    const Vec3 area = area_of(complex_.corners(triangles[0]));
    mesh_.points.push_back(place);
    for (const auto& [a, b] : outline)
      if (!keeps_direction(area, area_of({a, b, v})) || smallest_sine({a, b, v}) < kSmallSine) {
        mesh_.points.pop_back();
        return false;
      }
    add_point(place, {2, face});
    for (const Index t : triangles) complex_.remove(t);
    for (const auto& [a, b] : outline) complex_.add(a, b, v, face);
    flip_round(v);
    return true;
  }

  // Only for points of curves: their images lie on a curve, as opposite sheets end together.
  bool split_segment(Index a, Index b, const Image& image) {
    if (complex_.entity(image.point).dimension == 2) return false;
    const Index edge = complex_.segment(a, b), v = static_cast<Index>(mesh_.points.size());
    const Vec3 place = geometry_.project_to_edge(edge, at(image.point));
    const double near = kSnap * distance(at(image.point), image.place);
    if (distance(place, image.place) > near || dot(at(a) - place, at(b) - place) > 0) return false;
    if (std::min(distance(place, at(a)), distance(place, at(b))) < kShortest * distance(at(a), at(b)))
      return false;
    BoundaryComplex::Fan fan;
    const int count = complex_.triangles_at(a, b, fan);
    add_point(place, {1, edge});
    complex_.split_segment(a, b, v);
    for (int i = 0; i < count; ++i) {
      const Triangle q = complex_.corners(fan[i]);
      const Index face = complex_.face(fan[i]);
      complex_.remove(fan[i]);
      for (const Index replaced : {a, b}) {
        Triangle piece = q;
        std::replace(piece.begin(), piece.end(), replaced, v);
        complex_.add(piece[0], piece[1], piece[2], face);
      }
    }
    flip_round(v);
    return true;
  }

  void add_point(const Vec3& place, Entity entity) {
    const Index v = static_cast<Index>(mesh_.point_entity.size());
    mesh_.points.resize(v);
    mesh_.points.push_back(place);
    mesh_.point_entity.push_back(entity);
    complex_.set_entity(v, entity);
    fixed_.push_back(1);
    ++changes_;
  }

  // Makes the surface Delaunay again round v.
  void flip_round(Index v) {
    std::vector<Segment> stack;
    for (const Index t : complex_.triangles_at(v)) {
      const Triangle& q = complex_.corners(t);
      for (int i = 0; i < 3; ++i) stack.push_back({q[i], q[(i + 1) % 3]});
    }
    for (int guard = 0; !stack.empty() && guard < kMostFlips; ++guard) {
      const auto [a, b] = stack.back();
      stack.pop_back();
      EdgeFlip f;
      if (!can_flip(complex_, mesh_.points, a, b, f) || !flip_improves(mesh_.points, f)) continue;
      do_flip(complex_, f);
      for (const Index x : {f.c, f.d})
        for (const Index y : {f.a, f.b}) stack.push_back({x, y});
    }
  }

  void export_triangles() {
    mesh_.triangles.clear();
    mesh_.triangle_face.clear();
    for (Index t = 0; t < complex_.slot_count(); ++t) {
      if (!complex_.alive(t)) continue;
      mesh_.triangles.push_back(complex_.corners(t));
      mesh_.triangle_face.push_back(complex_.face(t));
    }
    std::vector<std::pair<std::uint64_t, Index>> segments(complex_.segments().begin(),
                                                          complex_.segments().end());
    std::sort(segments.begin(), segments.end());
    mesh_.segments.clear();
    mesh_.segment_edge.clear();
    for (const auto& [key, edge] : segments) {
      mesh_.segments.push_back(BoundaryComplex::segment_of_key(key));
      mesh_.segment_edge.push_back(edge);
    }
  }

  SurfaceMesh& mesh_;
  const Geometry& geometry_;
  const SizeField& size_;
  BoundaryComplex complex_;
  BoxTree tree_;              // of the triangles as they were given
  std::vector<char>& fixed_;  // of a point: faces one of another sheet, and stays
  std::vector<Image> images_;
  std::vector<std::vector<std::size_t>> of_point_;  // images
  std::vector<char> done_;                          // of an image
  std::vector<std::size_t> waiting_;                // images whose points were fixed
  Index changes_ = 0;
  Context& context_;
};

}  // namespace

Index match_layers(SurfaceMesh& mesh, const Plc& plc, const Geometry& geometry, const SizeField& size,
                   const std::vector<Index>& missing, std::vector<char>& fixed, Context& context) {
  return LayerMatcher(mesh, plc, geometry, size, fixed, context).run(missing);
}

}  // namespace dm
