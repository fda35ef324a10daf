#include "plc/entity_names.h"

namespace dm {

namespace {

constexpr std::size_t kNamed = 12;

}  // namespace

std::string entity_names(const std::vector<Index>& faces, const std::vector<Index>& edges,
                         const std::vector<Index>& vertices) {
  std::string text;
  std::size_t count = 0;
  const auto add = [&](const char* name, const std::vector<Index>& elements) {
    for (const Index i : elements)
      if (++count <= kNamed) text += (text.empty() ? "" : ", ") + (name + std::to_string(i + 1));
  };
  add("Face", faces);
  add("Edge", edges);
  add("Vertex", vertices);
  if (count > kNamed) text += " and " + std::to_string(count - kNamed) + " more";
  return text;
}

}  // namespace dm
