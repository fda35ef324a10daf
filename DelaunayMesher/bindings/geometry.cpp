// Parts of the pipeline on arrays: exact geometry, size field, boundary triangulation.
#include "plc/geometry.h"

#include <nanobind/stl/string.h>

#include "functions.h"
#include "inputs.h"
#include "sizing/size_field.h"
#include "surfaces/absorb.h"
#include "surfaces/crossings.h"
#include "surfaces/remesh.h"

namespace dm::python {

namespace {

// A PLC that was checked, and its geometry.
struct Input {
  Plc plc;
  Geometry geometry;

  Input(const nb::dict& arrays, const nb::object& records)
      : plc(checked(read_plc(arrays))), geometry(plc, read_geometry(records)) {}

  static Plc checked(Plc plc) {
    Context context;
    check_plc(plc, context);
    return plc;
  }
};

nb::object project(const nb::dict& plc, const nb::object& records, int dimension, Index index,
                   const Table<double>& points) {
  const Input input(plc, records);
  const std::size_t count = dimension == 1 ? input.plc.edge_count : input.plc.face_solids.size();
  if ((dimension != 1 && dimension != 2) || index < 0 || static_cast<std::size_t>(index) >= count)
    throw nb::value_error("no such edge (dimension 1) or face (2)");
  std::vector<Vec3> places = rows<Vec3, double>(points, "points");
  const Entity entity{static_cast<std::int8_t>(dimension), index};
  for (Vec3& place : places) place = input.geometry.project(entity, place);
  return to_numpy<double>(std::move(places));
}

nb::object sizes(const nb::dict& plc, const nb::object& records, const nb::dict& options,
                 const Table<double>& points) {
  const Input input(plc, records);
  const SizeOptions size_options = read_size_options(options);
  Context context = read_context(options, nb::none());
  const std::vector<Vec3> places = rows<Vec3, double>(points, "points");
  std::vector<double> result(places.size());
  double predicted = 0;
  {
    const nb::gil_scoped_release release;
    const SizeField field(input.plc, input.geometry, size_options, context);
    predicted = field.predicted_tetrahedra();
    for (std::size_t i = 0; i < places.size(); ++i) result[i] = field.at(places[i]);
  }
  return nb::make_tuple(to_numpy<double>(std::move(result)), predicted);
}

nb::dict surface_mesh(const nb::dict& plc, const nb::object& records, const nb::dict& options) {
  const Input input(plc, records);
  const SizeOptions size_options = read_size_options(options);
  Context context = read_context(options, nb::none());
  SurfaceMesh mesh;
  {
    const nb::gil_scoped_release release;
    Absorbed absorbed;
    const Plc kept = absorb_small_features(input.plc, input.geometry, size_options, context, absorbed);
    const SizeField field(kept, input.geometry, size_options, context);
    mesh = mesh_surfaces(kept, input.geometry, field, {}, context);
    check_surface_mesh(mesh, kept, input.geometry);
  }
  nb::dict out;
  out["points"] = to_numpy<double>(std::move(mesh.points));
  out["triangles"] = to_numpy<Index>(std::move(mesh.triangles));
  out["triangle_face"] = to_numpy<Index>(std::move(mesh.triangle_face));
  out["segments"] = to_numpy<Index>(std::move(mesh.segments));
  out["segment_edge"] = to_numpy<Index>(std::move(mesh.segment_edge));
  return out;
}

nb::object crossings(const Table<double>& points, const Table<Index>& triangles) {
  const std::vector<Vec3> places = rows<Vec3, double>(points, "points");
  const std::vector<Triangle> corners = rows<Triangle, Index>(triangles, "triangles");
  std::vector<std::array<Index, 2>> pairs;
  {
    const nb::gil_scoped_release release;
    Context context;
    pairs = find_crossings(places, corners, context);
  }
  return to_numpy<Index>(std::move(pairs));
}

}  // namespace

void add_geometry(nb::module_& module) {
  module.def("project", &project, nb::arg("plc"), nb::arg("geometry").none(), nb::arg("dimension"),
             nb::arg("index"), nb::arg("points"),
             "Nearest points (n, 3) on a CAD edge (dimension 1) or face (2).");
  module.def("sizes", &sizes, nb::arg("plc"), nb::arg("geometry").none(), nb::arg("options"),
             nb::arg("points"),
             "The size field (n,) in mm at points (n, 3), and the number of tetrahedra to expect.");
  module.def("surface_mesh", &surface_mesh, nb::arg("plc"), nb::arg("geometry").none(), nb::arg("options"),
             "The boundary triangulation as a dict of arrays.");
  module.def("crossings", &crossings, nb::arg("points"), nb::arg("triangles"),
             "Pairs (k, 2) of triangles (m, 3) whose interiors cross, or overlap in a common plane.");
}

}  // namespace dm::python
