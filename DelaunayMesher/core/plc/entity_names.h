// Names of CAD elements for messages: "Face3, Face7, Edge2 and 5 more".
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"

namespace dm {

// Given as numbers from 0; of many, the first twelve are named.
std::string entity_names(const std::vector<Index>& faces, const std::vector<Index>& edges = {},
                         const std::vector<Index>& vertices = {});

}  // namespace dm
