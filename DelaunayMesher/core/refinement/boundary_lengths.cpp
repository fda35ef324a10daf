#include "refinement/boundary_lengths.h"

namespace dm {
namespace {

constexpr double kMuchFiner = 0.5;  // edges over those that the size field asks for

}  // namespace

LengthField lengths_inside(const LabelledTriangulation& mesh, const SizeField& size) {
  const auto& points = mesh.tets.points();
  std::vector<double> sum(points.size(), 0);
  std::vector<Index> count(points.size(), 0);
  for (Index t = 0; t < mesh.boundary.slot_count(); ++t)
    for (int i = 0; mesh.boundary.alive(t) && i < 3; ++i) {
      const Triangle& v = mesh.boundary.corners(t);
      const double length = distance(points[v[i]], points[v[(i + 1) % 3]]);
      for (const Index p : {v[i], v[(i + 1) % 3]}) {
        sum[p] += length;
        ++count[p];
      }
    }
  LengthField lengths(size, 1);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (count[p] == 0) continue;
    const double h = sum[p] / count[p] / kBoundaryEdge;
    if (h < kMuchFiner * size.at(points[p])) lengths.add_cap(points[p], h);
  }
  lengths.apply_caps();
  return lengths;
}

}  // namespace dm
