// The driver: the stages in order.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/context.h"
#include "base/volume_mesh.h"
#include "optimisation/optimise.h"
#include "order/second_order.h"
#include "plc/geometry.h"
#include "plc/plc.h"
#include "refinement/certificate.h"
#include "refinement/element_limit.h"
#include "sizing/size_field.h"

namespace dm {

struct MesherOptions {
  SizeOptions size;
  double target_angle = 20;  // degrees, of the refinement
  bool optimise = true;
  int order = 1;
  ElementLimit limit;
};

struct MeshResult {
  VolumeMesh mesh;
  SecondOrder second_order;                          // empty for order 1
  std::vector<double> surface_volumes, tet_volumes;  // per solid, of the surface mesh and of the result
  std::vector<BelowTarget> below_target;
  std::vector<std::pair<std::string, double>> seconds;     // per stage, in order
  std::vector<std::pair<std::string, double>> statistics;  // counters worth reporting
  std::vector<std::string> warnings;
};

MeshResult make_mesh(const Plc& given, GeometryRecords records, const MesherOptions& options,
                     Context& context);

}  // namespace dm
