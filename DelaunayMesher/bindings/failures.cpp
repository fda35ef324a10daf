#include "failures.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "base/failure.h"

namespace dm::python {

namespace nb = nanobind;

namespace {

nb::object errors() { return nb::module_::import_("DelaunayMesher.errors"); }

nb::object name_of(const Entity& entity) {
  return errors().attr("entity_name")(static_cast<int>(entity.dimension), entity.index);
}

nb::object mesh_error(const Failure& failure) {
  // The origin is what a failure without a place carries.
  const bool placed = !(failure.place == Vec3{});
  const nb::object place =
      placed ? nb::make_tuple(failure.place.x, failure.place.y, failure.place.z) : nb::object(nb::none());
  return errors().attr("MeshError")(failure.stage, failure.code, failure.what(), place,
                                    name_of(failure.entity), name_of(failure.other));
}

void raise(const nb::object& exception) { PyErr_SetObject(exception.type().ptr(), exception.ptr()); }

}  // namespace

void register_failures() {
  nb::register_exception_translator([](const std::exception_ptr& pointer, void*) {
    try {
      std::rethrow_exception(pointer);
    } catch (const Failure& failure) {
      raise(mesh_error(failure));
    } catch (const Cancelled&) {
      raise(errors().attr("MeshCancelled")());
    }
  });
}

}  // namespace dm::python
