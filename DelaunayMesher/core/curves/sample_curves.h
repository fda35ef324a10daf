// The curves stage: every feature curve of the PLC is sampled anew by size, on the exact CAD edge.
//
// Idea: segments are joined into chains that run from corner to corner (or close on themselves).  A chain of
// metric length S = integral of ds / L(x) is cut into the n equal parts that are nearest to the wanted length
// L, n >= S / sqrt(2), and the cuts are displaced at random along the curve.  A chain turning through more
// than a quarter circle per part gets more parts, so that a coarse size cannot flatten a hole, and two chains
// with the same ends never both become a single segment.
//
// The result is stated in terms of the PLC, not of its triangles: which samples lie on which old segment, and
// which old points stay.  Faces can then take it over independently of each other.
//
// Precondition: check_plc.  Postcondition: every sample lies on its CAD edge (Geometry::project_to_edge);
// samples follow each other along the chain.  Cost: O(segments + 4 * samples) projections.
// Known limit: a sample's position along the chain is that of the tessellation's refined polyline, so very
// coarse tessellations of curves with strongly changing curvature are sampled less evenly.
#pragma once

#include <vector>

#include "base/context.h"
#include "curves/length_field.h"
#include "plc/geometry.h"
#include "plc/plc.h"

namespace dm {

enum class CurvePointRole : std::int8_t {
  none,     // not on a feature curve
  fixed,    // stays: a CAD vertex, a junction, or a sample that took an old point's place
  dropped,  // tessellation point between samples: the faces remove it
};

struct CurveSampling {
  // Points 0..n-1 are the PLC's (moved where a sample took the place of one), the samples follow.
  std::vector<Vec3> points;
  std::vector<CurvePointRole> role;  // per point; samples are fixed
  std::vector<Entity> entity;        // of every fixed point: CAD vertex or edge
  // Samples lying on PLC segment s, from its first to its second end: inserted[first[s]] .. [first[s + 1]].
  std::vector<Index> first, inserted;
  std::vector<Segment> segments;  // the new curves
  std::vector<Index> segment_edge;
};

struct CurveOptions {
  double jitter = 0.1;  // relative to the length of the parts
  // Per PLC point (empty = none): 1 = must stay although the sampling would drop it (a face could not do
  // without), 2 = and nothing is inserted between it and the next such point.
  std::vector<char> keep;
};

CurveSampling sample_curves(const Plc& plc, const Geometry& geometry, const LengthField& lengths,
                            const CurveOptions& options, Context& context);

}  // namespace dm
