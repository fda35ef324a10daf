// _core.mesh(): the whole core in one call.
#include <nanobind/stl/string.h>

#include "functions.h"
#include "inputs.h"

namespace dm::python {

namespace {

// Corner numbers followed by the mid-side nodes of each element.
template <std::size_t Corners, std::size_t Mids>
nb::object with_mid_nodes(const std::vector<std::array<Index, Corners>>& corners,
                          const std::vector<std::array<Index, Mids>>& mids) {
  std::vector<std::array<Index, Corners + Mids>> nodes(corners.size());
  for (std::size_t e = 0; e < nodes.size(); ++e) {
    std::copy(corners[e].begin(), corners[e].end(), nodes[e].begin());
    std::copy(mids[e].begin(), mids[e].end(), nodes[e].begin() + Corners);
  }
  return to_numpy<Index>(std::move(nodes));
}

void put_entities(nb::dict& out, const std::vector<Entity>& entities) {
  std::vector<std::int8_t> dimension(entities.size());
  std::vector<Index> index(entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i)
    dimension[i] = entities[i].dimension, index[i] = entities[i].index;
  out["point_dimension"] = to_numpy<std::int8_t>(std::move(dimension));
  out["point_entity"] = to_numpy<Index>(std::move(index));
}

void put_elements(nb::dict& out, VolumeMesh& mesh, SecondOrder& second, bool curved) {
  if (curved) {
    std::vector<std::array<Index, 1>> middles(second.segment_nodes.size());
    for (std::size_t i = 0; i < middles.size(); ++i) middles[i] = {second.segment_nodes[i]};
    out["tets"] = with_mid_nodes(mesh.tets, second.tet_nodes);
    out["triangles"] = with_mid_nodes(mesh.triangles, second.triangle_nodes);
    out["lines"] = with_mid_nodes(mesh.segments, middles);
    mesh.points.insert(mesh.points.end(), second.points.begin(), second.points.end());
    mesh.point_entity.insert(mesh.point_entity.end(), second.point_entity.begin(), second.point_entity.end());
  } else {
    out["tets"] = to_numpy<Index>(std::move(mesh.tets));
    out["triangles"] = to_numpy<Index>(std::move(mesh.triangles));
    out["lines"] = to_numpy<Index>(std::move(mesh.segments));
  }
  put_entities(out, mesh.point_entity);
  out["points"] = to_numpy<double>(std::move(mesh.points));
  out["tet_solid"] = to_numpy<Index>(std::move(mesh.tet_solid));
  out["triangle_face"] = to_numpy<Index>(std::move(mesh.triangle_face));
  out["line_edge"] = to_numpy<Index>(std::move(mesh.segment_edge));
  out["straightened"] = to_numpy<Index>(std::move(second.straightened));
}

nb::dict below_target(const std::vector<BelowTarget>& below) {
  std::vector<Index> tet, entity;
  std::vector<double> angle;
  std::vector<std::int8_t> dimension;
  std::vector<Vec3> place;
  nb::list reason;
  for (const BelowTarget& element : below) {
    tet.push_back(element.tet);
    angle.push_back(element.angle);
    reason.append(nb::str(element.reason));
    dimension.push_back(element.entity.dimension);
    entity.push_back(element.entity.index);
    place.push_back(element.place);
  }
  nb::dict out;
  out["tet"] = to_numpy<Index>(std::move(tet));
  out["angle"] = to_numpy<double>(std::move(angle));
  out["reason"] = reason;
  out["dimension"] = to_numpy<std::int8_t>(std::move(dimension));
  out["entity"] = to_numpy<Index>(std::move(entity));
  out["place"] = to_numpy<double>(std::move(place));
  return out;
}

nb::list pairs(const std::vector<std::pair<std::string, double>>& named) {
  nb::list out;
  for (const auto& [name, value] : named) out.append(nb::make_tuple(name, value));
  return out;
}

nb::dict mesh(const nb::dict& plc, const nb::object& geometry, const nb::dict& options,
              const nb::object& report) {
  const Plc core_plc = read_plc(plc);
  GeometryRecords records = read_geometry(geometry);
  const MesherOptions core_options = read_options(options);
  Context context = read_context(options, report);
  MeshResult result;
  {
    const nb::gil_scoped_release release;
    result = make_mesh(core_plc, std::move(records), core_options, context);
  }
  nb::dict out;
  out["below_target"] = below_target(result.below_target);
  put_elements(out, result.mesh, result.second_order, core_options.order == 2);
  out["surface_volumes"] = to_numpy<double>(std::move(result.surface_volumes));
  out["tet_volumes"] = to_numpy<double>(std::move(result.tet_volumes));
  out["seconds"] = pairs(result.seconds);
  nb::dict statistics;
  for (const auto& [name, value] : result.statistics) statistics[name.c_str()] = value;
  out["statistics"] = statistics;
  nb::list warnings;
  for (const std::string& warning : result.warnings) warnings.append(warning);
  out["warnings"] = warnings;
  return out;
}

}  // namespace

void add_mesh(nb::module_& module) {
  module.def("mesh", &mesh, nb::arg("plc"), nb::arg("geometry").none(), nb::arg("options"),
             nb::arg("report").none() = nb::none(),
             "Tetrahedral mesh of a PLC as a dict of arrays; see pipeline.py and result.py for the keys.\n\n"
             "report(stage, fraction) is called at most every 30 ms of work; False cancels.\n"
             "Raises MeshError or MeshCancelled.");
}

}  // namespace dm::python
