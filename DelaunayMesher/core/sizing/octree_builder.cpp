#include "sizing/octree_builder.h"

#include "base/random.h"

namespace dm {

namespace {

constexpr double kTolerance = 0.05;  // deviation at the centre and of dips that makes a cell split
constexpr double kLargestCell = 2;   // cells are at most this many times the size wanted in them
constexpr std::size_t kMaxLeaves = 4'000'000;
constexpr int kTableLevel = 5;
constexpr int kMixedSamples = 8192;

std::uint64_t key_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return ((std::uint64_t{x} << 42) | (std::uint64_t{y} << 21) | z) + 1;
}

std::size_t slot_of(std::uint64_t key, std::size_t mask) {
  return ((key * 0x9e3779b97f4a7c15ULL) >> 20) & mask;
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

Octree::Builder::Builder(Octree& tree, const ExactField& field, const BoundaryTree& boundary,
                         Context& context)
    : tree_(tree), field_(field), boundary_(boundary), context_(context), keys_(1 << 12), known_(1 << 12) {
  const Box domain = boundary.box();
  const Vec3 size = domain.extent();
  // A margin of a thousandth, so that places beside the boundary by rounding are in; off centre, so that the
  // planes of symmetric parts do not coincide with the sides of cells.
  const double edge = 1.002 * std::max({size.x, size.y, size.z});
  tree.origin_ = domain.centre() - (0.5 * edge) * Vec3{1.0003, 0.9997, 1.0005};
  tree.scale_ = kFinest / edge;
}

Vec3 Octree::Builder::point(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
  const double unit = 1 / tree_.scale_;
  return tree_.origin_ + Vec3{x * unit, y * unit, z * unit};
}

Box Octree::Builder::box(const Cell& cell, std::uint32_t size) const {
  const auto [x, y, z] = cell.corner;
  return {point(x, y, z), point(x + size, y + size, z + size)};
}

void Octree::Builder::grow() {
  std::vector<std::uint64_t> keys(2 * keys_.size());
  std::vector<float> known(keys.size());
  const std::size_t mask = keys.size() - 1;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (keys_[i] == 0) continue;
    std::size_t slot = slot_of(keys_[i], mask);
    while (keys[slot] != 0) slot = (slot + 1) & mask;
    keys[slot] = keys_[i];
    known[slot] = known_[i];
  }
  keys_.swap(keys);
  known_.swap(known);
}

float Octree::Builder::corner_value(std::uint32_t x, std::uint32_t y, std::uint32_t z, Place place,
                                    Index& hint) {
  const std::uint64_t key = key_of(x, y, z);
  std::size_t mask = keys_.size() - 1, slot = slot_of(key, mask);
  for (; keys_[slot] != 0; slot = (slot + 1) & mask)
    if (keys_[slot] == key) return known_[slot];
  const auto value = static_cast<float>(place == Place::inside ? field_.at(point(x, y, z), hint)
                                                               : field_.continued(point(x, y, z), hint));
  keys_[slot] = key;
  known_[slot] = value;
  if (2 * ++known_count_ > keys_.size()) grow();
  return value;
}

// Cells that the boundary does not touch lie on the same side of it as such a sibling across a common face.
Octree::Place Octree::Builder::place(const Cell& cell, std::uint32_t size, Place parent, const Cell* siblings,
                                     std::uint32_t number) const {
  if (parent != Place::mixed) return parent;
  const Box cube = box(cell, size);
  if (boundary_.touches(cube)) return Place::mixed;
  for (const std::uint32_t axis : {1u, 2u, 4u})
    if ((number & axis) != 0 && siblings[number ^ axis].place != Place::mixed)
      return siblings[number ^ axis].place;
  return boundary_.solid_at(cube.centre()) > 0 ? Place::inside : Place::outside;
}

bool Octree::Builder::must_split(Cell& cell, std::uint32_t size) {
  if (size == 1 || cell.place == Place::outside) return false;
  const auto [low, high] = std::minmax_element(cell.values.begin(), cell.values.end());
  const double edge = size / tree_.scale_;
  // Half the diagonal times the growth bounds the error of the interpolant.
  if (0.867 * field_.growth * edge <= kTolerance * *low) return false;
  const std::uint32_t half = size / 2;
  const auto [x, y, z] = cell.corner;
  const double centre = corner_value(x + half, y + half, z + half, cell.place, cell.hint);
  double mean = 0;
  for (const float v : cell.values) mean += v / 8;
  // Outside corners hold less than any size wanted: the largest corner keeps them from deciding alone.
  if (edge > kLargestCell * std::max(std::min(mean, centre), 0.7 * *high)) return true;
  if (std::abs(mean - centre) > kTolerance * centre) return true;
  const Box cube = box(cell, size);
  return field_.differs(cube, *high, kTolerance, [&](const Vec3& q) {
    const Vec3 u = (1 / edge) * (q - cube.low);
    return interpolate(cell.values, u.x, u.y, u.z);
  });
}

void Octree::Builder::split(const Cell& cell, std::uint32_t size, std::vector<Cell>& children) {
  const std::uint32_t half = size / 2;
  const auto [x, y, z] = cell.corner;
  float grid[3][3][3];
  Index hint = cell.hint;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const bool corner = i != 1 && j != 1 && k != 1;
        grid[k][j][i] = corner ? cell.values[i / 2 + j / 2 * 2 + k / 2 * 4]
                               : corner_value(x + i * half, y + j * half, z + k * half, cell.place, hint);
        if (hint < 0) hint = cell.hint;
      }
  const auto first = static_cast<Index>(tree_.nodes_.size());
  tree_.nodes_[cell.node] = first;
  tree_.nodes_.resize(tree_.nodes_.size() + 8, -1);
  for (std::uint32_t c = 0; c < 8; ++c) {
    const std::uint32_t i = c & 1, j = c >> 1 & 1, k = c >> 2;
    Cell child{
        {x + i * half, y + j * half, z + k * half}, first + static_cast<Index>(c), hint, Place::mixed, {}};
    for (std::uint32_t v = 0; v < 8; ++v) child.values[v] = grid[k + (v >> 2)][j + (v >> 1 & 1)][i + (v & 1)];
    child.place = place(child, half, cell.place, children.data() + children.size() - c, c);
    children.push_back(child);
  }
}

void Octree::Builder::finish(const Cell& cell, std::uint32_t size) {
  tree_.nodes_[cell.node] = ~static_cast<Index>(tree_.values_.size());
  tree_.values_.push_back(cell.values);
  if (cell.place == Place::outside) return;
  const double edge = size / tree_.scale_;
  const double weight = edge * edge * edge * mean_inverse_cube(cell.values);
  if (cell.place == Place::mixed) {
    mixed_.push_back({cell.corner, size, weight});
    return;
  }
  tree_.inverse_volume_ += weight;
  const auto [low, high] = std::minmax_element(cell.values.begin(), cell.values.end());
  tree_.smallest_ = std::min<double>(tree_.smallest_, *low);
  tree_.largest_ = std::max<double>(tree_.largest_, *high);
}

// What part of the leaves across the boundary is inside, by systematic sampling in proportion to their
// weight: a standard error of about 1 % of their share.
void Octree::Builder::integrate_mixed() {
  double total = 0;
  for (const MixedLeaf& leaf : mixed_) total += leaf.weight;
  if (!(total > 0)) return;
  const double step = total / kMixedSamples;
  double next = 0.5 * step, before = 0;
  std::int64_t sample = 0;
  for (const MixedLeaf& leaf : mixed_) {
    const double edge = leaf.size / tree_.scale_, volume = edge * edge * edge;
    for (; next < before + leaf.weight; next += step, ++sample) {
      context_.poll(0.9);
      Random random(0, sample, leaf.corner[0], leaf.corner[1], leaf.corner[2]);
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      const Vec3 p = point(leaf.corner[0], leaf.corner[1], leaf.corner[2]) + edge * Vec3{x, y, z};
      if (boundary_.nearest(p).solid == 0) continue;
      const double h = tree_.at(p);
      tree_.inverse_volume_ += step * volume / (h * h * h * leaf.weight);
      tree_.smallest_ = std::min(tree_.smallest_, h);
      tree_.largest_ = std::max(tree_.largest_, h);
    }
    before += leaf.weight;
  }
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

void Octree::Builder::build() {
  tree_.smallest_ = HUGE_VAL;
  tree_.largest_ = 0;
  std::uint32_t size = 1u << kMaxLevel;
  Cell root{{0, 0, 0}, 0, -1, Place::mixed, {}};
  for (std::uint32_t v = 0; v < 8; ++v)
    root.values[v] =
        corner_value((v & 1) * size, (v >> 1 & 1) * size, (v >> 2) * size, root.place, root.hint);
  tree_.nodes_.assign(1, -1);
  std::vector<Cell> level{root}, next;
  for (; !level.empty(); size /= 2) {
    next.clear();
    for (Cell& cell : level) {
      context_.poll(0.8 * static_cast<double>(tree_.values_.size()) / static_cast<double>(level.size() + 1));
      const bool split_it = must_split(cell, size);
      const bool room = tree_.values_.size() + next.size() < kMaxLeaves;
      if (split_it && room) {
        split(cell, size, next);
        continue;
      }
      if (split_it) cell.values.fill(*std::min_element(cell.values.begin(), cell.values.end()));
      finish(cell, size);
    }
    level.swap(next);
  }
  make_table();
  integrate_mixed();
}

}  // namespace dm
