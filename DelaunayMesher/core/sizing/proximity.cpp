#include "sizing/proximity.h"

#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "base/random.h"
#include "sizing/edge_necks.h"
#include "sizing/shared_edges.h"

namespace dm {

namespace {

// Edges of the boundary per width, and so the sizes per width; see the header.
constexpr double kFree = 2.0 / kBoundaryEdge, kFreeOptimised = 2.4 / kBoundaryEdge,
                 kBondedOptimised = 2.0 / kBoundaryEdge, kTight = 1.48 / kBoundaryEdge,
                 kGap = 4.8 / kBoundaryEdge;
constexpr double kTightWithin = 2;  // the other side is tight up to this many widths
constexpr double kOpposed = 0.966;  // cosine between ray and normal: 15 degrees
// A gap is a point of contact if it spans less than so many of the sizes by other sources, and closes to less
// than this part of its width.
constexpr double kPoint = 2.5, kClosing = 0.1;
constexpr double kContact = 1e-6;  // of the diagonal: narrower than this, faces touch and there is no gap
constexpr int kDeepestSplit = 20;
constexpr std::int64_t kMostPlaces = 150'000;
// Walls and gaps may cost this many times the elements of the rest, and this many in any case.
constexpr double kBudgetFactor = 3, kBudget = 100'000;
constexpr double kLimited = 0.99;  // of the size that a wall gets: it asked for less
// Elements per h^2 of boundary: one side of a thin wall, and what grows from a boundary into a thick solid
// (the integral of 1 / (0.106 (h + g z)^3) over the depth z), times g.
constexpr double kWallElements = 3.84 / (kBoundaryEdge * kBoundaryEdge), kGrownElements = 4.7;
constexpr double kNeck = 2.5;          // size over the width of a neck: limit measured, 3 makes 30 degrees
constexpr double kNeckElements = 100;  // per h of length, of either edge

// A part of the boundary with a wall or gap behind it, or a part of an edge at a neck.
struct Patch {
  SizeSource source;  // has the size by the width, until limits are known
  Index face;
  double local_size;  // by the other sources
  double width;       // of the wall, gap or neck
  double curvature;   // of the two sides, the larger
  bool wall;          // or neck
  double wanted;      // size by the width

  bool is_neck() const { return source.corners == 2; }
  std::array<Vec3, 3> corner() const { return {source.a, source.b, source.c}; }
};

double area(const std::array<Vec3, 3>& p) { return 0.5 * norm(area_vector(p[0], p[1], p[2])); }

Vec3 middle(const std::array<Vec3, 3>& p) { return (1.0 / 3) * (p[0] + p[1] + p[2]); }

class Prober {
 public:
  Prober(const Plc& plc, const Geometry& geometry, const BoundaryTree& boundary, const SizeOptions& options)
      : plc_(plc),
        geometry_(geometry),
        boundary_(boundary),
        shared_(plc),
        free_(options.optimised ? kFreeOptimised : kFree),
        bonded_(options.optimised ? kBondedOptimised : kTight),
        per_width_(2 / options.elements_across) {
    epsilon_ = kContact * norm(boundary.box().extent());
  }

  void probe(Index t, double local_size) {
    const auto [a, b, c] = plc_.triangles[t];
    triangle_ = t;
    face_ = plc_.triangle_face[t];
    local_size_ = local_size;
    const std::array<Vec3, 3> p{plc_.points[a], plc_.points[b], plc_.points[c]};
    const Vec3 normal = area_vector(p[0], p[1], p[2]);
    if (!(norm2(normal) > 0)) return;
    normal_ = normalized(normal);
    if (!(longest(p) < local_size)) return visit(p, 0);
    // Of the triangles of a fine tessellation one per face and cube is enough.
    const auto [known, first] = seen_.try_emplace(cube(middle(p)));
    if (!first) return known->second.add(walls, 0.5 * norm(normal));
    const std::size_t begin = walls.size();
    visit(p, 0);
    known->second = {begin, walls.size(), 0.5 * norm(normal)};
  }
  std::vector<Patch> patches;
  std::vector<ThinWall> walls;

 private:
  // The walls found for a triangle, which stand for others in its cube.
  struct Sample {
    std::size_t begin = 0, end = 0;
    double area = 0;

    void add(std::vector<ThinWall>& all, double more) const {
      for (std::size_t i = begin; i < end; ++i) all[i].weight += more / area;
    }
  };

  static double longest(const std::array<Vec3, 3>& p) {
    return std::sqrt(std::max({norm2(p[1] - p[0]), norm2(p[2] - p[1]), norm2(p[0] - p[2])}));
  }

  // A face and a cube of half the local size.
  std::uint64_t cube(const Vec3& p) const {
    const Vec3 q = (2 / local_size_) * (p - boundary_.box().low);
    Random random(0, face_, static_cast<std::int64_t>(q.x), static_cast<std::int64_t>(q.y),
                  static_cast<std::int64_t>(q.z));
    return random.next();
  }

  // Is the width t between the two faces that of a wedge?  In a wedge of angle alpha, t = x tan(alpha) at the
  // distance x from the common edge; in a cusp it is half of that.
  bool wedge(const Vec3& p, const RayHit& hit) const {
    const Index other = plc_.triangle_face[hit.triangle];
    if (other == face_) return false;
    const double x = shared_.distance(face_, other, p);
    if (x == HUGE_VAL) return false;
    const double cosine = std::min(1.0, std::abs(hit.cosine));
    const double expected = x * std::sqrt(1 - cosine * cosine) / cosine;
    return expected > 0.5 * hit.distance;
  }

  struct Width {
    double t = HUGE_VAL;
    Index face = -1;
  };
  Width width(const Vec3& p, const Vec3& direction, double range) const {
    const RayHit hit = boundary_.first_hit(p, direction, epsilon_, range, triangle_);
    if (hit.triangle < 0 || std::abs(hit.cosine) < kOpposed || wedge(p, hit)) return {};
    return {hit.distance, plc_.triangle_face[hit.triangle]};
  }

  // What the narrowest wall or gap at a place is like; face: on its other side.
  struct Place {
    double size = HUGE_VAL, width = 0;
    Index face = -1;
    bool wall = false;
  };
  // By the widths on both sides; infinite size: none.
  Place place_at(const Vec3& p) {
    ++places_;
    const double range = local_size_ / (kTight * per_width_);  // beyond it, size is local_size_ or more
    const auto& solids = plc_.face_solids[face_];
    // Walls up to one size thick matter to the prediction.
    const double inside = std::max(range, local_size_);
    Width w[2] = {width(p, -normal_, solids[0] > 0 ? inside : range),
                  width(p, normal_, solids[1] > 0 ? inside : range)};
    if (w[0].t == HUGE_VAL && w[1].t == HUGE_VAL) return {};
    // A wall may be tight by something farther away than a wall counts by itself.
    for (int side = 0; side < 2; ++side)
      if (w[side].t == HUGE_VAL && kTightWithin * w[1 - side].t > range)
        w[side] = width(p, side == 0 ? -normal_ : normal_, kTightWithin * w[1 - side].t);
    Place place;
    for (int side = 0; side < 2; ++side) {
      const double t = w[side].t, behind = w[1 - side].t;
      if (t == HUGE_VAL) continue;
      const bool wall = solids[side] > 0;
      const bool tight = behind <= kTightWithin * t, bonded = solids[1 - side] > 0;
      const double h = (tight ? kTight : !wall ? kGap : bonded ? bonded_ : free_) * t * per_width_;
      if (h < place.size) place = {h, t, w[side].face, wall};
    }
    return place;
  }

  // Of corners in the same cube without a wall or gap, one is enough.
  Place place_unless_clear(const Vec3& p) {
    const std::uint64_t here = cube(p);
    if (clear_.find(here) != clear_.end() || clear_corners_.find(here) != clear_corners_.end()) return {};
    const Place place = place_at(p);
    if (place.size == HUGE_VAL) clear_corners_.insert(here);
    return place;
  }

  void visit(const std::array<Vec3, 3>& p, int depth) {
    const Vec3 centre = middle(p);
    const double edge = longest(p);
    if (edge <= 4 * local_size_)
      if (const auto known = clear_.find(cube(centre)); known != clear_.end())
        return known->second.add(walls, area(p));
    Place narrow = place_at(centre);
    double high = narrow.size;
    if (edge > std::min(local_size_, narrow.size))
      for (const Vec3& corner : p) {
        const Place place = place_unless_clear(0.9 * corner + 0.1 * centre);
        if (place.size < narrow.size) narrow = place;
        high = std::max(high, place.size);
      }
    const double low = narrow.size;
    const bool found = low < local_size_;
    const bool even = std::min(high, local_size_) <= 1.5 * low;
    const bool enough =
        found ? (even || edge <= 2 * low) && edge <= 16 * local_size_ : edge <= 4 * local_size_;
    if (enough || depth == kDeepestSplit || places_ > kMostPlaces) {
      const std::size_t begin = walls.size();
      if (low < HUGE_VAL && narrow.wall) walls.push_back({p, narrow.width});
      if (!found) clear_.try_emplace(cube(centre), Sample{begin, walls.size(), area(p)});
      if (found)
        patches.push_back({SizeSource::triangle(p, low, empty_side(plc_, face_)), face_, local_size_,
                           narrow.width, curvature(centre, narrow.face), narrow.wall, low});
      return;
    }
    // In two across the longest edge, so that slivers make few parts.
    int i = 0;
    for (int k = 1; k < 3; ++k)
      if (norm2(p[(k + 1) % 3] - p[k]) > norm2(p[(i + 1) % 3] - p[i])) i = k;
    const Vec3 &a = p[i], &b = p[(i + 1) % 3], &c = p[(i + 2) % 3], half = 0.5 * (a + b);
    visit({a, half, c}, depth + 1);
    visit({half, b, c}, depth + 1);
  }

  double curvature(const Vec3& p, Index other) const {
    const double own = geometry_.is_plane(face_) ? 0 : geometry_.curvature(face_, p);
    const bool flat = other < 0 || geometry_.is_plane(other);
    return std::max(own, flat ? 0 : geometry_.curvature(other, p));
  }

  const Plc& plc_;
  const Geometry& geometry_;
  const BoundaryTree& boundary_;
  SharedEdges shared_;
  double free_, bonded_, per_width_, epsilon_ = 0, local_size_ = 0;
  Index triangle_ = -1, face_ = -1;
  Vec3 normal_;
  std::int64_t places_ = 0;
  std::unordered_set<std::uint64_t> clear_corners_;
  std::unordered_map<std::uint64_t, Sample> seen_,
      clear_;  // cubes: probed for a triangle, without small sizes
};

void add_necks(const std::vector<EdgeNeck>& necks, const SizeOptions& options, std::vector<Patch>& patches) {
  for (const auto& [a, b, face, width, local_size] : necks) {
    const double size = kNeck * width * 2 / options.elements_across;
    if (size < local_size)
      patches.push_back({SizeSource::segment(a, b, size), face, local_size, width, 0, true, size});
  }
}

// Elements that a patch of size h asks for.
double elements(const Patch& patch, double growth, double h) {
  if (patch.is_neck()) return kNeckElements * norm(patch.source.b - patch.source.a) / h;
  return (kWallElements + (patch.wall ? 0 : kGrownElements / growth)) * area(patch.corner()) / (h * h);
}

// ... that all ask for, if no size is below the floor.
double cost(const std::vector<Patch>& patches, double growth, double floor) {
  double sum = 0;
  for (const Patch& patch : patches) sum += elements(patch, growth, std::max(patch.source.size, floor));
  return sum;
}

// The smallest size at which walls and gaps stay within their budget of elements.
double affordable(const std::vector<Patch>& patches, double growth, double budget, double from, double to) {
  if (cost(patches, growth, from) <= budget) return from;
  for (int i = 0; i < 30; ++i) {
    const double middle = std::sqrt(from * to);
    (cost(patches, growth, middle) <= budget ? to : from) = middle;
  }
  return to;
}

using GapCells =
    std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>>;  // gaps in cubes of half a size

// Takes out the gaps of a cell and of all that hang together with it.
std::vector<std::size_t> take_group(GapCells& cells) {
  std::vector<GapCells::node_type> taken;
  taken.push_back(cells.extract(cells.begin()));
  std::vector<std::size_t> group;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    group.insert(group.end(), taken[i].mapped().begin(), taken[i].mapped().end());
    const auto [x, y, z] = taken[i].key();
    for (int k = 0; k < 27; ++k)
      if (GapCells::node_type next = cells.extract({x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1}))
        taken.push_back(std::move(next));
  }
  return group;
}

bool is_point_of_contact(const std::vector<Patch>& patches, const std::vector<std::size_t>& group) {
  Box box;
  double local_size = HUGE_VAL, narrowest = HUGE_VAL, widest = 0;
  for (const std::size_t i : group) {
    box.add(middle(patches[i].corner()));
    local_size = std::min(local_size, patches[i].local_size);
    narrowest = std::min(narrowest, patches[i].width);
    widest = std::max(widest, patches[i].width);
  }
  const Vec3 extent = box.extent();
  return std::max({extent.x, extent.y, extent.z}) < kPoint * local_size && narrowest < kClosing * widest;
}

// Leaves out gaps that are narrow only round a point, as where a ball touches a plane: a few elements lie
// there whatever their size, and sizes that go to zero towards the point would be many.
void leave_out_points_of_contact(std::vector<Patch>& patches, double max_size) {
  GapCells cells;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches[i].wall) continue;
    const Vec3 q = (2 / max_size) * middle(patches[i].corner());
    cells[{std::llround(q.x), std::llround(q.y), std::llround(q.z)}].push_back(i);
  }
  std::vector<char> drop(patches.size(), 0);
  while (!cells.empty()) {
    const std::vector<std::size_t> group = take_group(cells);
    if (is_point_of_contact(patches, group))
      for (const std::size_t i : group) drop[i] = 1;
  }
  std::size_t i = 0;
  std::erase_if(patches, [&](const Patch&) { return drop[i++] != 0; });
}

}  // namespace

ProximityResult add_proximity(const Plc& plc, const Geometry& geometry, const BoundaryTree& boundary,
                              const SizeOptions& options, const SizeLimits& limits,
                              const std::vector<double>& triangle_size, Context& context,
                              std::vector<SizeSource>& sources) {
  ProximityResult result;
  Prober prober(plc, geometry, boundary, options);
  double others = 0;
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    context.poll(0.1 + 0.2 * static_cast<double>(t) / static_cast<double>(plc.triangles.size()));
    prober.probe(static_cast<Index>(t), triangle_size[t]);
    const auto [a, b, c] = plc.triangles[t];
    const double twice = norm(area_vector(plc.points[a], plc.points[b], plc.points[c]));
    others += 0.5 * twice * kWallElements / (triangle_size[t] * triangle_size[t]);
  }
  result.walls = std::move(prober.walls);
  leave_out_points_of_contact(prober.patches, options.max_size);
  add_necks(find_edge_necks(plc, triangle_size, limits.proximity, context), options, prober.patches);
  const double budget = std::max(kBudget, kBudgetFactor * others);
  const auto least = [&](double from, double factor) {
    if (options.min_size > 0) return from;
    return affordable(prober.patches, options.growth, factor * budget, from, options.max_size);
  };
  result.elements_wanted = cost(prober.patches, options.growth, 0);
  const double floor = least(limits.proximity, 1);
  result.floor = floor;
  for (Patch& patch : prober.patches) {
    double& size = patch.source.size;
    size = std::max(patch.wanted, floor);
    if (patch.wanted < floor && patch.curvature > 0) {
      // Facets of curved faces must not cross the gap: their sagitta stays below a third of its width.
      const double sagitta = std::sqrt(8 * patch.width / (3 * patch.curvature)) / kBoundaryEdge;
      size = std::min(size, std::max({sagitta, patch.wanted, limits.crossing}));
    }
  }
  // Curved faces in contact (a bolt in its hole) would ask for that everywhere.
  const double crossing = least(limits.crossing, 2);
  result.crossing_floor = crossing;
  std::set<Index> limited;
  for (Patch& patch : prober.patches) {
    double& size = patch.source.size;
    size = std::max(size, crossing);
    if (patch.wanted < kLimited * size) {
      limited.insert(patch.face);
      result.wanted = std::min(result.wanted, patch.wanted);
      result.given = std::min(result.given, size);
    }
    if (size < options.max_size) sources.push_back(patch.source);
  }
  result.elements_given = cost(prober.patches, options.growth, crossing);
  result.limited.assign(limited.begin(), limited.end());
  return result;
}

}  // namespace dm
