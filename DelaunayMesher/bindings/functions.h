// Each file adds its functions to the extension module.
#pragma once

#include <nanobind/nanobind.h>

namespace dm::python {

void add_mesh(nanobind::module_& module);
void add_triangulation(nanobind::module_& module);
void add_geometry(nanobind::module_& module);

}  // namespace dm::python
