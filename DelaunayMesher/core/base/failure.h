// What a stage throws when it cannot go on: where, why, and at which CAD element.
#pragma once

#include <stdexcept>
#include <string>

#include "base/vec3.h"

namespace dm {

// A CAD element: dimension 0 vertex, 1 edge, 2 face, 3 solid; index from 0, of solids from 1; -1 = none.
struct Entity {
  std::int8_t dimension = -1;
  Index index = -1;
  friend bool operator==(const Entity&, const Entity&) = default;
};

class Failure : public std::runtime_error {
 public:
  Failure(std::string stage_, std::string code_, const std::string& message, Vec3 place_ = {},
          Entity entity_ = {}, Entity other_ = {})
      : std::runtime_error(message),
        stage(std::move(stage_)),
        code(std::move(code_)),
        place(place_),
        entity(entity_),
        other(other_) {}
  std::string stage, code;  // e.g. "boundary", "self_intersection" (docs/errors.md)
  Vec3 place;               // mm
  Entity entity, other;
};

struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace dm
