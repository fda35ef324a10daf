#include "inputs.h"

#include <nanobind/stl/string.h>

namespace dm::python {

namespace {

template <class T>
T get(const nb::dict& table, const char* key) {
  return nb::cast<T>(table[key]);
}
template <class Row, class Scalar>
std::vector<Row> get_rows(const nb::dict& table, const char* key) {
  return rows<Row, Scalar>(get<Table<Scalar>>(table, key), key);
}
template <class Scalar>
std::vector<Scalar> get_values(const nb::dict& table, const char* key) {
  return values<Scalar>(get<Flat<Scalar>>(table, key));
}
Vec3 vec3(const double* p) { return {p[0], p[1], p[2]}; }

void require_length(std::size_t length, std::size_t wanted, const char* key) {
  if (length != wanted)
    throw nb::value_error((std::string(key) + " must have " + std::to_string(wanted) + " rows").c_str());
}

SplineSurfaceRecord read_spline_surface(const nb::dict& record) {
  SplineSurfaceRecord spline;
  spline.degree_u = get<int>(record, "degree_u");
  spline.degree_v = get<int>(record, "degree_v");
  const auto poles = get<nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig>>(record, "poles");
  spline.nu = static_cast<Index>(poles.shape(0));
  spline.nv = static_cast<Index>(poles.shape(1));
  spline.poles.resize(poles.shape(0) * poles.shape(1));
  for (std::size_t i = 0; i < spline.poles.size(); ++i) spline.poles[i] = vec3(poles.data() + 3 * i);
  if (const nb::object weights = record["weights"]; !weights.is_none()) {
    const auto table = nb::cast<Table<double>>(weights);
    require_length(table.size(), spline.poles.size(), "weights");
    spline.weights.assign(table.data(), table.data() + table.size());
  }
  spline.knots_u = get_values<double>(record, "knots_u");
  spline.knots_v = get_values<double>(record, "knots_v");
  const auto range = get<nb::tuple>(record, "range");
  spline.u0 = nb::cast<double>(range[0]), spline.u1 = nb::cast<double>(range[1]);
  spline.v0 = nb::cast<double>(range[2]), spline.v1 = nb::cast<double>(range[3]);
  return spline;
}

SplineCurveRecord read_spline_curve(const nb::dict& record) {
  SplineCurveRecord spline;
  spline.degree = get<int>(record, "degree");
  spline.poles = get_rows<Vec3, double>(record, "poles");
  if (const nb::object weights = record["weights"]; !weights.is_none())
    spline.weights = values<double>(nb::cast<Flat<double>>(weights));
  spline.knots = get_values<double>(record, "knots");
  const auto range = get<nb::tuple>(record, "range");
  spline.u0 = nb::cast<double>(range[0]), spline.u1 = nb::cast<double>(range[1]);
  return spline;
}

std::vector<SurfaceRecord> read_faces(const nb::dict& geometry) {
  const auto kind = get<Flat<Index>>(geometry, "face_kind");
  const auto params = get<Table<double>>(geometry, "face_params");
  const auto spline = get<Flat<Index>>(geometry, "face_spline");
  require_length(params.size(), 8 * kind.shape(0), "face_params");
  require_length(spline.shape(0), kind.shape(0), "face_spline");
  std::vector<SurfaceRecord> faces(kind.shape(0));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double* p = params.data() + 8 * f;
    faces[f] = {static_cast<SurfaceKind>(kind.data()[f]), vec3(p), vec3(p + 3), p[6], p[7], spline.data()[f]};
  }
  return faces;
}

std::vector<CurveRecord> read_edges(const nb::dict& geometry) {
  const auto kind = get<Flat<Index>>(geometry, "edge_kind");
  const auto params = get<Table<double>>(geometry, "edge_params");
  const auto spline = get<Flat<Index>>(geometry, "edge_spline");
  require_length(params.size(), 7 * kind.shape(0), "edge_params");
  require_length(spline.shape(0), kind.shape(0), "edge_spline");
  std::vector<CurveRecord> edges(kind.shape(0));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double* p = params.data() + 7 * e;
    edges[e] = {static_cast<CurveKind>(kind.data()[e]), vec3(p), vec3(p + 3), p[6], spline.data()[e]};
  }
  return edges;
}

}  // namespace

Plc read_plc(const nb::dict& plc) {
  Plc result;
  result.points = get_rows<Vec3, double>(plc, "points");
  result.triangles = get_rows<Triangle, Index>(plc, "triangles");
  result.triangle_face = get_values<Index>(plc, "triangle_face");
  result.segments = get_rows<Segment, Index>(plc, "segments");
  result.segment_edge = get_values<Index>(plc, "segment_edge");
  result.corners = get_values<Index>(plc, "corners");
  result.corner_vertex = get_values<Index>(plc, "corner_vertex");
  result.face_solids = get_rows<std::array<Index, 2>, Index>(plc, "face_solids");
  result.edge_count = get<Index>(plc, "edge_count");
  result.vertex_count = get<Index>(plc, "vertex_count");
  result.solid_count = get<Index>(plc, "solid_count");
  result.kept_faces = get_values<Index>(plc, "kept_faces");
  result.kept_edges = get_values<Index>(plc, "kept_edges");
  require_length(result.triangle_face.size(), result.triangles.size(), "triangle_face");
  require_length(result.segment_edge.size(), result.segments.size(), "segment_edge");
  require_length(result.corner_vertex.size(), result.corners.size(), "corner_vertex");
  return result;
}

GeometryRecords read_geometry(const nb::object& geometry) {
  GeometryRecords records;
  if (geometry.is_none()) return records;
  const auto table = nb::cast<nb::dict>(geometry);
  records.faces = read_faces(table);
  records.edges = read_edges(table);
  for (const nb::handle record : nb::cast<nb::list>(table["spline_surfaces"]))
    records.spline_surfaces.push_back(read_spline_surface(nb::cast<nb::dict>(record)));
  for (const nb::handle record : nb::cast<nb::list>(table["spline_curves"]))
    records.spline_curves.push_back(read_spline_curve(nb::cast<nb::dict>(record)));
  return records;
}

SizeOptions read_size_options(const nb::dict& options) {
  SizeOptions size;
  size.max_size = get<double>(options, "max_size");
  size.min_size = get<double>(options, "min_size");
  size.growth = get<double>(options, "growth");
  size.elements_per_circle = get<double>(options, "elements_per_circle");
  size.elements_across = get<double>(options, "elements_across");
  size.optimised = get<bool>(options, "optimise");
  size.face_size = get_values<double>(options, "face_size");
  size.edge_size = get_values<double>(options, "edge_size");
  size.vertex_size = get_values<double>(options, "vertex_size");
  size.solid_size = get_values<double>(options, "solid_size");
  const auto regions = get<Table<double>>(options, "regions");
  require_length(regions.size(), 10 * regions.shape(0), "regions");
  for (std::size_t i = 0; i < regions.shape(0); ++i) {
    const double* r = regions.data() + 10 * i;
    size.regions.push_back({static_cast<Index>(r[0]), vec3(r + 1), vec3(r + 4), r[7], r[8], r[9]});
  }
  size.points = get_rows<Vec3, double>(options, "size_points");
  size.point_size = get_values<double>(options, "size_values");
  require_length(size.point_size.size(), size.points.size(), "size_values");
  return size;
}

MesherOptions read_options(const nb::dict& options) {
  MesherOptions result;
  result.size = read_size_options(options);
  result.target_angle = get<double>(options, "target_angle");
  result.optimise = get<bool>(options, "optimise");
  result.order = get<int>(options, "order");
  result.limit = {get<std::int64_t>(options, "max_elements"), get<std::int64_t>(options, "elements_before")};
  return result;
}

Context read_context(const nb::dict& options, const nb::object& report) {
  // Even without a callback the signals are looked at, so that Ctrl-C works.
  Context context([report](const char* stage, double fraction) {
    const nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (report.is_none()) return true;
    const nb::object answer = report(stage, fraction);
    return answer.is_none() || nb::cast<bool>(nb::bool_(answer));
  });
  context.seed = get<std::uint64_t>(options, "seed");
  context.threads = get<int>(options, "threads");
  return context;
}

}  // namespace dm::python
