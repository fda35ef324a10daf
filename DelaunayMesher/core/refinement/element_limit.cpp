#include "refinement/element_limit.h"

#include <algorithm>
#include <cstdio>
#include <string>

namespace dm {

namespace {

constexpr double kTooFar = 1.5;       // tetrahedra over the limit: the forecast may be that far off
constexpr double kStride = 1.0 / 64;  // of the limit: growth after which it is counted again at the earliest

std::string rounded(double count) {
  char text[32];
  std::snprintf(text, sizeof text, count < 1e9 ? "%.0f" : "%.0e", count);
  return text;
}

[[noreturn]] void refuse(const char* stage, const std::string& counted, const ElementLimit& limit,
                         const char* advice) {
  throw Failure(stage, "too_many_elements",
                counted + ", more than the limit of " + std::to_string(limit.most) + "; " + advice);
}

constexpr const char* kSmallFeatures =
    "narrow faces and short edges need more than the sizes ask for. Use a larger size, remove them from the "
    "part or raise --max-elements";

}  // namespace

void refuse_sizes(const ElementLimit& limit, const SizeField& size) {
  const double expected = static_cast<double>(limit.before) + size.predicted_tetrahedra();
  if (limit.most <= 0 || expected <= static_cast<double>(limit.most)) return;
  refuse("sizing", "the sizes ask for about " + rounded(expected) + " tetrahedra", limit,
         "use a larger size or raise --max-elements");
}

void refuse_boundary(const ElementLimit& limit, const SurfaceMesh& surface, const Plc& plc) {
  std::int64_t sides = 0;
  for (const Index face : surface.triangle_face)
    for (const Index solid : plc.face_solids[face]) sides += solid != 0;
  const std::int64_t least = limit.before + sides / 2 - plc.solid_count;
  if (limit.most <= 0 || least <= limit.most) return;
  refuse("surfaces",
         "the boundary has " + std::to_string(surface.triangles.size()) + " triangles, so the mesh has " +
             std::to_string(least) + " tetrahedra at the least",
         limit, kSmallFeatures);
}

ElementCount::ElementCount(const Triangulation& tets, const ElementLimit& limit)
    : tets_(tets),
      limit_(limit),
      most_(static_cast<std::int64_t>(kTooFar * static_cast<double>(limit.most)) - limit.before),
      next_(most_) {}

void ElementCount::count() {
  std::int64_t inside = 0;
  for (Index t = 0; t < tets_.slot_count(); ++t) inside += !tets_.is_free(t) && tets_.tag(t) != 0;
  if (inside > most_)
    refuse("refinement", std::to_string(limit_.before + inside) + " tetrahedra are made already", limit_,
           kSmallFeatures);
  const auto stride = static_cast<std::int64_t>(kStride * static_cast<double>(limit_.most));
  next_ = tets_.tet_count() + std::max({most_ - inside, stride, std::int64_t{1}});
}

}  // namespace dm
