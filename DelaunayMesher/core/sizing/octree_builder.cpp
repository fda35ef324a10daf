#include "sizing/octree_builder.h"

#include <utility>
namespace dm {

namespace {

// Cells are at most this many times the size of the sources in them (edges and vertices, where the field has
// a sharper kink: half of it), and of the field elsewhere.
constexpr double kCellPerSource = 1, kCellPerSize = 1.5;
constexpr double kGain = 0.01;  // a source must lower a corner's value by this fraction to replace another
constexpr int kMostSweeps = 12;
constexpr std::size_t kMaxLeaves = 4'000'000;
constexpr int kTableLevel = 5;
constexpr double kContinuedWithin = 1.75 * kCellPerSource;  // sizes: the diagonal of a cell across a source
constexpr double kLeastContinued = 0.7;  // of the size at the boundary, for the values outside

std::size_t slot_of(const std::array<std::uint32_t, 3>& c, std::size_t mask) {
  const std::uint64_t key = (std::uint64_t{c[0]} << 42) | (std::uint64_t{c[1]} << 21) | c[2];
  return ((key * 0x9e3779b97f4a7c15ULL) >> 36) & mask;
}

// Conservative: true whenever the box touches what has `nearest` as the nearest place to its centre.  The
// plane through that place, square to the way there, has all of a convex thing on its far side; the box is
// clear of it if it lies on the near side.
bool may_touch(const Vec3& centre, double half, const Vec3& nearest) {
  const Vec3 d = nearest - centre;
  return norm2(d) <= half * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
}

bool apart(const Vec3& centre, double half, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int i = 0; i < 3; ++i)
    if (std::min({a[i], b[i], c[i]}) > centre[i] + half || std::max({a[i], b[i], c[i]}) < centre[i] - half)
      return true;
  return false;
}

// Mean of 1 / h^3 over a leaf by the two-point Gauss rule in each direction.
double mean_inverse_cube(const std::array<float, 8>& v) {
  constexpr double kGauss[2] = {0.21132486540518712, 0.78867513459481288};
  double sum = 0;
  for (const double x : kGauss)
    for (const double y : kGauss)
      for (const double z : kGauss) {
        const double h = interpolate(v, x, y, z);
        sum += 1 / (h * h * h);
      }
  return sum / 8;
}

}  // namespace

Octree::Builder::Builder(Octree& tree, const FieldSources& field, const Plc& plc,
                         const BoundaryTree& boundary, Context& context)
    : tree_(tree), field_(field), plc_(plc), boundary_(boundary), context_(context) {
  const Box domain = boundary.box();
  const Vec3 size = domain.extent();
  // A margin of a thousandth, so that places beside the boundary by rounding are in; off centre, so that the
  // planes of symmetric parts do not coincide with the sides of cells.
  const double edge = 1.002 * std::max({size.x, size.y, size.z});
  tree.origin_ = domain.centre() - (0.5 * edge) * Vec3{1.0003, 0.9997, 1.0005};
  tree.scale_ = kFinest / edge;
}

Vec3 Octree::Builder::point(const Corner& c) const {
  const double unit = 1 / tree_.scale_;
  return tree_.origin_ + Vec3{c[0] * unit, c[1] * unit, c[2] * unit};
}

Box Octree::Builder::box(const Cell& cell) const {
  const auto [x, y, z] = cell.low;
  return {point(cell.low), point({x + cell.size, y + cell.size, z + cell.size})};
}

template <class Touches>
Octree::Builder::Range Octree::Builder::filter(Range range, Touches&& touches) {
  const std::size_t begin = lists_.size();
  for (std::size_t i = range.begin; i < range.end; ++i) {
    context_.tick(0.4);
    const Index item = lists_[i];
    if (touches(item)) lists_.push_back(item);
  }
  return {begin, lists_.size()};
}

// Cells that the boundary does not touch lie on the same side of it as such a sibling across a common face.
Octree::Builder::Place Octree::Builder::place(const Cell& child, Place parent,
                                              const std::array<Cell, 8>& siblings,
                                              std::uint32_t number) const {
  if (parent != Place::mixed) return parent;
  if (child.triangles.begin < child.triangles.end) return Place::mixed;
  for (const std::uint32_t axis : {1u, 2u, 4u})
    if ((number & axis) != 0 && siblings[number ^ axis].place != Place::mixed)
      return siblings[number ^ axis].place;
  return boundary_.solid_at(box(child).centre()) > 0 ? Place::inside : Place::outside;
}

// Replaces a leaf by its eight children: the first takes its place, the others are appended.
bool Octree::Builder::split(Index index) {
  const Cell cell = cells_[index];
  if (cell.size == 1 || cells_.size() > kMaxLeaves) return false;
  const std::uint32_t half = cell.size / 2;
  const auto first = static_cast<Index>(tree_.nodes_.size());
  tree_.nodes_[cell.node] = first;
  tree_.nodes_.resize(tree_.nodes_.size() + 8, -1);
  std::array<Cell, 8> children;
  for (std::uint32_t c = 0; c < 8; ++c) {
    Cell& child = children[c];
    child = cell;
    child.low = {cell.low[0] + (c & 1) * half, cell.low[1] + (c >> 1 & 1) * half,
                 cell.low[2] + (c >> 2) * half};
    child.size = half;
    child.node = first + static_cast<Index>(c);
    const Vec3 centre = box(child).centre();
    // Slightly large, so that rounding leaves no item out.
    const double reach = (0.5 + 1e-9) * edge(child);
    child.triangles = filter(cell.triangles, [&](Index t) {
      const Triangle& v = plc_.triangles[t];
      const Vec3 &p = plc_.points[v[0]], &q = plc_.points[v[1]], &r = plc_.points[v[2]];
      return !apart(centre, reach, p, q, r) && may_touch(centre, reach, nearest_on_triangle(centre, p, q, r));
    });
    child.sources = filter(cell.sources, [&](Index s) {
      const SizeSource& source = field_.sources[s];
      return !apart(centre, reach, source.a, source.b, source.c) &&
             may_touch(centre, reach, source.nearest(centre));
    });
    child.place = place(child, cell.place, children, c);
    Index leaf = index;
    if (c == 0) {
      cells_[index] = child;
    } else {
      leaf = static_cast<Index>(cells_.size());
      cells_.push_back(child);
    }
    tree_.nodes_[child.node] = ~leaf;
  }
  return true;
}

bool Octree::Builder::too_coarse_for_sources(const Cell& cell) const {
  if (cell.place == Place::outside) return false;
  const double length = edge(cell);
  for (std::size_t i = cell.sources.begin; i < cell.sources.end; ++i) {
    const SizeSource& source = field_.sources[lists_[i]];
    const double most = source.corners == 3 ? kCellPerSource : 0.5 * kCellPerSource;
    if (length > most * std::max(source.size, field_.floor)) return true;
  }
  const Vec3 centre = box(cell).centre();
  for (const SizeRegion& region : field_.regions)
    if (region.size < field_.max_size && length > kCellPerSource * std::max(region.size, field_.floor) &&
        may_touch(centre, 0.5 * length, nearest_in_region(region, centre)))
      return true;
  return false;
}

Index Octree::Builder::leaf_at(const Corner& c) const {
  Index node = tree_.nodes_[0];
  for (int bits = kMaxLevel; node >= 0;) {
    --bits;
    node = tree_.nodes_[node + ((c[0] >> bits & 1) | (c[1] >> bits & 1) << 1 | (c[2] >> bits & 1) << 2)];
  }
  return ~node;
}

// Splits leaves more than twice as large as a leaf across one of their sides.
void Octree::Builder::balance() {
  std::vector<Index> queue(cells_.size());
  for (std::size_t i = 0; i < queue.size(); ++i) queue[i] = static_cast<Index>(i);
  while (!queue.empty()) {
    context_.tick(0.4);
    const Index index = queue.back();
    queue.pop_back();
    for (int side = 0; side < 6; ++side) {
      const Cell& cell = cells_[index];
      Corner beyond{cell.low[0] + cell.size / 2, cell.low[1] + cell.size / 2, cell.low[2] + cell.size / 2};
      std::uint32_t& x = beyond[side / 2];
      x = side % 2 == 0 ? cell.low[side / 2] - 1 : cell.low[side / 2] + cell.size;
      if (x >= (1u << kMaxLevel)) continue;  // beyond the root; below zero it has wrapped around
      const std::uint32_t size = cell.size;
      for (Index other = leaf_at(beyond); cells_[other].size > 2 * size; other = leaf_at(beyond)) {
        const auto before = static_cast<Index>(cells_.size());
        if (!split(other)) break;
        queue.push_back(other);
        for (auto i = before; i < static_cast<Index>(cells_.size()); ++i) queue.push_back(i);
      }
    }
  }
}

Index Octree::Builder::corner_at(const Corner& c) {
  if (2 * (corners_.size() + 1) > slots_.size()) {
    slots_.assign(std::max<std::size_t>(1 << 12, 2 * slots_.size()), -1);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      std::size_t slot = slot_of(corners_[i].at, slots_.size() - 1);
      while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<Index>(i);
    }
  }
  std::size_t slot = slot_of(c, slots_.size() - 1);
  for (; slots_[slot] >= 0; slot = (slot + 1) & (slots_.size() - 1))
    if (corners_[slots_[slot]].at == c) return slots_[slot];
  slots_[slot] = static_cast<Index>(corners_.size());
  const auto cap = static_cast<float>(field_.cap(point(c), boundary_));
  corners_.push_back({c, -1, static_cast<float>(field_.max_size), cap});
  return slots_[slot];
}

void Octree::Builder::make_corners(Cell& cell) {
  for (std::uint32_t i = 0; i < 8; ++i)
    cell.corner[i] = corner_at({cell.low[0] + (i & 1) * cell.size, cell.low[1] + (i >> 1 & 1) * cell.size,
                                cell.low[2] + (i >> 2) * cell.size});
}

bool Octree::Builder::relax(Index corner, Index source) {
  CornerValue& c = corners_[corner];
  const SizeSource& s = field_.sources[source];
  const double needed = ((1 - kGain) * c.value - s.size) / field_.growth;  // distance below which it wins
  if (c.source == source || needed <= 0) return false;
  const Vec3 p = point(c.at);
  const double within = needed + balls_[source].radius;
  if (norm2(p - balls_[source].centre) >= within * within) return false;
  const double d2 = norm2(p - s.nearest(p));
  if (d2 >= needed * needed) return false;
  const double h = s.size + field_.growth * std::sqrt(d2);
  c.value = static_cast<float>(h);
  c.source = source;
  return true;
}

// Hands the sources of each leaf's corners to its other corners, until nothing changes.
void Octree::Builder::sweep() {
  const auto count = static_cast<Index>(cells_.size());
  for (Cell& cell : cells_) {
    context_.tick(0.4);
    make_corners(cell);
    for (std::size_t i = cell.sources.begin; i < cell.sources.end; ++i)
      for (const Index corner : cell.corner) relax(corner, lists_[i]);
  }
  bool changed = true;
  for (int round = 1; changed && round <= kMostSweeps; ++round) {
    changed = false;
    for (Index i = 0; i < count; ++i) {
      context_.tick(0.5);
      Cell& cell = cells_[round % 2 != 0 ? i : count - 1 - i];
      std::uint32_t latest = 0;
      for (const Index corner : cell.corner) latest = std::max(latest, corners_[corner].changed);
      if (latest <= cell.seen) continue;
      const std::uint32_t seen = std::exchange(cell.seen, latest);
      for (int j = 0; j < 8; ++j) {
        const Index source = corners_[cell.corner[j]].source;
        if (source < 0 || corners_[cell.corner[j]].changed <= seen) continue;
        for (const Index corner : cell.corner)
          if (relax(corner, source)) corners_[corner].changed = ++changes_, changed = true;
      }
    }
  }
}

double Octree::Builder::lowest(const Cell& cell) const {
  double low = field_.max_size;
  for (const Index c : cell.corner) low = std::min<double>({low, corners_[c].value, corners_[c].cap});
  return std::max(low, field_.floor);
}

void Octree::Builder::refine_domain() {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    context_.poll(0.7);
    while (cells_[i].place != Place::outside && edge(cells_[i]) > kCellPerSize * lowest(cells_[i])) {
      const std::array<Index, 8> parent = cells_[i].corner;
      const std::size_t before = cells_.size();
      if (!split(static_cast<Index>(i))) break;
      for (std::size_t k = before - 1; k < cells_.size(); ++k) {
        Cell& child = cells_[k < before ? i : k];
        make_corners(child);
        for (const Index p : parent) {
          const Index source = corners_[p].source;
          if (source < 0) continue;
          for (const Index corner : child.corner) relax(corner, source);
        }
      }
    }
  }
}

// The values at the corners: outside the domain the field continued through the nearest boundary.
std::vector<float> Octree::Builder::corner_values() const {
  std::vector<Place> place(corners_.size(), Place::mixed);
  for (const Cell& cell : cells_)
    if (cell.place != Place::mixed)
      for (const Index c : cell.corner) place[c] = cell.place;
  std::vector<float> values(corners_.size());
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    context_.tick(0.7);
    const CornerValue& c = corners_[i];
    double h = c.value;
    if (c.source >= 0 && field_.sources[c.source].empty_side != 0 && place[i] != Place::inside) {
      const SizeSource& s = field_.sources[c.source];
      const Vec3 p = point(c.at);
      // Only round the cells across the source itself: farther on it says nothing about this place's own
      // side.
      const double away = distance(p, s.nearest(p));
      const bool outside = away <= kContinuedWithin * std::max(s.size, field_.floor) &&
                           (place[i] == Place::outside || boundary_.solid_by_nearest(p, away) == 0);
      if (outside) h = std::max(s.size + field_.growth * s.continued_distance(p), kLeastContinued * s.size);
    }
    values[i] = static_cast<float>(std::max(std::min<double>(h, c.cap), field_.floor));
  }
  return values;
}

// The leaves' values, and the integral.  What part of the leaves across the boundary is inside is known for
// all of them together, by the volume of the domain.
void Octree::Builder::finish(double domain_volume) {
  const std::vector<float> known = corner_values();
  tree_.values_.resize(cells_.size());
  tree_.smallest_ = HUGE_VAL;
  double inside = 0, mixed = 0, mixed_weight = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    context_.tick(0.8);
    const Cell& cell = cells_[i];
    std::array<float, 8> plain;
    for (int j = 0; j < 8; ++j) {
      const CornerValue& c = corners_[cell.corner[j]];
      tree_.values_[i][j] = known[cell.corner[j]];
      plain[j] = std::max(std::min(c.value, c.cap), static_cast<float>(field_.floor));
    }
    if (cell.place == Place::outside) continue;
    const auto [low, high] = std::minmax_element(plain.begin(), plain.end());
    tree_.smallest_ = std::min<double>(tree_.smallest_, *low);
    tree_.largest_ = std::max<double>(tree_.largest_, *high);
    for (std::size_t k = cell.sources.begin; k < cell.sources.end; ++k)
      tree_.smallest_ = std::min(tree_.smallest_, field_.sources[lists_[k]].size);
    const double length = edge(cell), volume = length * length * length;
    const double weight = volume * mean_inverse_cube(plain);
    if (cell.place == Place::mixed)
      mixed += volume, mixed_weight += weight;
    else
      inside += volume, tree_.inverse_volume_ += weight;
  }
  if (mixed > 0)
    tree_.inverse_volume_ += mixed_weight * std::clamp((domain_volume - inside) / mixed, 0.0, 1.0);
}

void Octree::Builder::make_table() {
  const int level = kTableLevel;
  tree_.table_level_ = level;
  tree_.table_.resize(std::size_t{1} << (3 * level));
  for (std::uint32_t slot = 0; slot < tree_.table_.size(); ++slot) {
    const std::uint32_t mask = (1u << level) - 1;
    const std::uint32_t i = slot & mask, j = slot >> level & mask, k = slot >> (2 * level);
    Entry entry{tree_.nodes_[0], 0};
    while (entry.node >= 0 && entry.level < level) {
      ++entry.level;
      const int bits = level - entry.level;
      entry.node = tree_.nodes_[entry.node + ((i >> bits & 1) | (j >> bits & 1) << 1 | (k >> bits & 1) << 2)];
    }
    tree_.table_[slot] = entry;
  }
}

void Octree::Builder::build(double domain_volume) {
  Cell root{{0, 0, 0}, 1u << kMaxLevel, 0, Place::mixed, {}, {}, {}, 0};
  for (std::size_t t = 0; t < plc_.triangles.size(); ++t) lists_.push_back(static_cast<Index>(t));
  root.triangles = {0, lists_.size()};
  for (std::size_t s = 0; s < field_.sources.size(); ++s) lists_.push_back(static_cast<Index>(s));
  root.sources = {root.triangles.end, lists_.size()};
  for (const SizeSource& s : field_.sources) {
    const Vec3 centre = (1.0 / 3) * (s.a + s.b + s.c);
    balls_.push_back(
        {centre, std::sqrt(std::max({norm2(s.a - centre), norm2(s.b - centre), norm2(s.c - centre)}))});
  }
  cells_.push_back(root);
  tree_.nodes_.assign(1, ~Index{0});
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    context_.poll(0.4);
    while (too_coarse_for_sources(cells_[i]))
      if (!split(static_cast<Index>(i))) break;
  }
  balance();
  sweep();
  refine_domain();
  finish(domain_volume);
  make_table();
}

}  // namespace dm
