// dm::Failure -> DelaunayMesher.errors.MeshError, dm::Cancelled -> MeshCancelled.
#pragma once

namespace dm::python {
void register_failures();
}  // namespace dm::python
