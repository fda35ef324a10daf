// Leaving rows out of a list and of what belongs to them.
#pragma once

#include <vector>

#include "base/vec3.h"

namespace dm {

// Keeps the rows for which wanted(row) is true, in order, and their owners.
template <class Row, class Wanted>
void keep_rows(std::vector<Row>& rows, std::vector<Index>& owners, Wanted wanted) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!wanted(rows[i])) continue;
    rows[kept] = rows[i];
    owners[kept++] = owners[i];
  }
  rows.resize(kept);
  owners.resize(kept);
}

}  // namespace dm
