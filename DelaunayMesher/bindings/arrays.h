// numpy arrays <-> the core's plain vectors.  On the way in they are copied (the core owns its input), on the
// way out they are moved: the array keeps the vector alive through a capsule.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstring>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace dm::python {

namespace nb = nanobind;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_trivially_copyable_v<Vec3>);

template <class Scalar>
using Flat = nb::ndarray<const Scalar, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class Scalar>
using Table = nb::ndarray<const Scalar, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// Rows of a (n, sizeof(Row) / sizeof(Scalar)) array as a vector; a ValueError names the array when it
// differs.
template <class Row, class Scalar>
std::vector<Row> rows(const Table<Scalar>& array, const char* name) {
  constexpr std::size_t width = sizeof(Row) / sizeof(Scalar);
  if (array.shape(1) != width)
    throw nb::value_error((std::string(name) + " must have " + std::to_string(width) + " columns").c_str());
  std::vector<Row> result(array.shape(0));
  if (!result.empty()) std::memcpy(static_cast<void*>(result.data()), array.data(), array.nbytes());
  return result;
}
template <class Scalar>
std::vector<Scalar> values(const Flat<Scalar>& array) {
  return std::vector<Scalar>(array.data(), array.data() + array.shape(0));
}

// An array (n, width) or (n,) that takes over the vector.
template <class Scalar, class Row>
nb::object to_numpy(std::vector<Row>&& rows_) {
  constexpr std::size_t width = sizeof(Row) / sizeof(Scalar);
  auto* owned = new std::vector<Row>(std::move(rows_));
  const nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<Row>*>(p); });
  const std::size_t shape[2] = {owned->size(), width};
  const std::size_t dimensions = width == 1 ? 1 : 2;
  auto* data = reinterpret_cast<Scalar*>(owned->data());
  return nb::cast(nb::ndarray<nb::numpy, Scalar>(data, dimensions, shape, owner));
}

}  // namespace dm::python
