// _core.delaunay() and the exact predicates.
#include "kernel/triangulation.h"

#include "arrays.h"
#include "functions.h"
#include "kernel/predicates.h"

namespace dm::python {

namespace {

nb::object delaunay(const Table<double>& points, int threads) {
  const std::vector<Vec3> sites = rows<Vec3, double>(points, "points");
  std::vector<Tet> tets;
  {
    const nb::gil_scoped_release release;
    Context context;
    context.threads = threads;
    const Triangulation triangulation(sites, context);
    for (Index t = 0; t < triangulation.slot_count(); ++t)
      if (!triangulation.is_free(t) && !triangulation.is_ghost(t)) tets.push_back(triangulation.corners(t));
  }
  return to_numpy<Index>(std::move(tets));
}

using Points4 = nb::ndarray<const double, nb::shape<-1, 4, 3>, nb::c_contig, nb::device::cpu>;
using Points5 = nb::ndarray<const double, nb::shape<-1, 5, 3>, nb::c_contig, nb::device::cpu>;

nb::object orientations(const Points4& tets) {
  std::vector<std::int8_t> signs(tets.shape(0));
  const auto* p = reinterpret_cast<const Vec3*>(tets.data());
  for (std::size_t i = 0; i < signs.size(); ++i, p += 4)
    signs[i] = static_cast<std::int8_t>(orient3d(p[0], p[1], p[2], p[3]));
  return to_numpy<std::int8_t>(std::move(signs));
}

nb::object insphere_signs(const Points5& tets) {
  std::vector<std::int8_t> signs(tets.shape(0));
  const auto* p = reinterpret_cast<const Vec3*>(tets.data());
  for (std::size_t i = 0; i < signs.size(); ++i, p += 5)
    signs[i] = static_cast<std::int8_t>(insphere(p[0], p[1], p[2], p[3], p[4]));
  return to_numpy<std::int8_t>(std::move(signs));
}

}  // namespace

void add_triangulation(nb::module_& module) {
  module.def("delaunay", &delaunay, nb::arg("points"), nb::arg("threads") = 1,
             "Delaunay triangulation (t, 4) int32 of points (n, 3) float64.");
  module.def("orient3d", &orientations, nb::arg("tets"),
             "Exact orientation signs (n,) int8 of corner coordinates (n, 4, 3).");
  module.def("insphere", &insphere_signs, nb::arg("tets"),
             "Exact in-sphere signs (n,) int8 of the fifth points of (n, 5, 3), the first four positively "
             "oriented.");
}

}  // namespace dm::python
