// The extension module DelaunayMesher._core.
#include "failures.h"
#include "functions.h"

NB_MODULE(_core, module) {
  module.doc() = "The compiled core of DelaunayMesher.";
  module.attr("__version__") = DM_VERSION;
  dm::python::register_failures();
  dm::python::add_mesh(module);
  dm::python::add_triangulation(module);
  dm::python::add_geometry(module);
}
