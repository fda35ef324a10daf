// The size field h(x): the edge length wanted at x, in mm.
//
// h is the minimum over all sources (global maximum; per face, edge, vertex, solid; curvature; proximity;
// points and regions; values on points), made Lipschitz with the growth rate and never below the floor.
// Stored on an octree; at() costs some ten nanoseconds.  Sources: docs/sizing.md.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/context.h"
#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm {

// A region with the size `size` inside, growing outside over `transition` mm (0: by the growth rate alone).
// kind 0 ball: a = centre, radius | 1 box: a, b = opposite corners | 2 cylinder: axis a..b, radius
struct SizeRegion {
  Index kind = 0;
  Vec3 a, b;
  double radius = 0, size = 0, transition = 0;
};

// Length of edges of the surface mesh, over h.  Shorter ones cost elements and tries per site; from 0.9 on
// some boundary tetrahedra miss the target (docs/sizing.md).
inline constexpr double kBoundaryEdge = 0.85;

struct SizeOptions {
  double max_size = 0;              // mm, > 0
  double min_size = 0;              // mm, the floor; 0 = automatic (sources.h: size_limits)
  double growth = 0.35;             // Lipschitz constant of h
  double elements_per_circle = 12;  // 0 = no curvature source
  double elements_across = 2;       // elements across walls and gaps; 0 = no proximity source
  bool optimised = false;           // the mesh will be: walls need less small elements
  std::vector<double> face_size, edge_size, vertex_size, solid_size;  // mm; empty or infinity = none
  std::vector<SizeRegion> regions;
  std::vector<Vec3> points;  // sizes given on points (an error estimate, an earlier mesh)
  std::vector<double> point_size;
};

class SizeField {
 public:
  SizeField(const Plc& plc, const Geometry& geometry, const SizeOptions& options, Context& context);
  ~SizeField();
  SizeField(const SizeField&) = delete;
  SizeField& operator=(const SizeField&) = delete;

  double at(const Vec3& p) const;    // thread-safe
  double smallest() const;           // minimum over the domain
  double largest() const;            // maximum over the domain
  bool is_floor(double size) const;  // Is it as small as walls or curvature may make it?
  double growth() const;
  // Number of tetrahedra that the field asks for: integral of 1 / (volume of one element of edge length h),
  // and a term for the smaller elements along the boundary (docs/sizing.md).
  double predicted_tetrahedra() const;
  // Sentences for the user: where walls or gaps would need smaller elements than they get.
  const std::vector<std::string>& warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dm
