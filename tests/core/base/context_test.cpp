#include "base/context.h"

#include <doctest/doctest.h>

using namespace dm;

TEST_CASE("tick asks whether to go on at every 256th call") {
  Context context([](const char*, double) { return false; });
  for (int i = 1; i < 256; ++i) context.tick(0);
  CHECK_THROWS_AS(context.tick(0), Cancelled);
}
