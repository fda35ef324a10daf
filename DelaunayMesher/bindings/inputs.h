// Dictionaries of arrays, as pipeline.py and plc.py make them, to the structures of the core.
#pragma once

#include "arrays.h"
#include "mesher.h"

namespace dm::python {

Plc read_plc(const nb::dict& plc);
GeometryRecords read_geometry(const nb::object& geometry);  // None: no records
MesherOptions read_options(const nb::dict& options);
SizeOptions read_size_options(const nb::dict& options);
Context read_context(const nb::dict& options, const nb::object& report);

}  // namespace dm::python
