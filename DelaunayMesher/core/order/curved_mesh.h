// A tetrahedral mesh with its mid-side nodes, as the order stage works on it.
#pragma once

#include "base/volume_mesh.h"
#include "order/jacobian.h"
#include "order/second_order.h"

namespace dm {

class CurvedMesh {
 public:
  CurvedMesh(VolumeMesh& linear, SecondOrder& quadratic) : mesh_(linear), order_(quadratic) {}

  Index tet_count() const { return static_cast<Index>(mesh_.tets.size()); }
  const Tet& corners(Index tet) const { return mesh_.tets[tet]; }
  // Global number of mid-side node i (0..5) of tet.
  Index middle(Index tet, int i) const { return order_.tet_nodes[tet][i]; }
  bool is_corner(Index node) const { return node < corner_count(); }
  const Vec3& position(Index node) const {
    return is_corner(node) ? mesh_.points[node] : order_.points[node - corner_count()];
  }
  Vec3& position(Index node) {
    return is_corner(node) ? mesh_.points[node] : order_.points[node - corner_count()];
  }
  Entity entity(Index node) const {
    return is_corner(node) ? mesh_.point_entity[node] : order_.point_entity[node - corner_count()];
  }
  bool interior(Index node) const { return entity(node).dimension == 3; }
  Vec3 straight_middle(Index tet, int i) const {
    const Tet& c = mesh_.tets[tet];
    return 0.5 * (mesh_.points[c[kTetEdges[i][0]]] + mesh_.points[c[kTetEdges[i][1]]]);
  }
  TenNodes nodes(Index tet) const {
    TenNodes x;
    for (int i = 0; i < 4; ++i) x[i] = mesh_.points[mesh_.tets[tet][i]];
    for (int i = 0; i < 6; ++i) x[4 + i] = position(middle(tet, i));
    return x;
  }
  // Has it a mid-side node off the middle?  The others need no proof.
  bool curved(Index tet) const {
    for (int i = 0; i < 6; ++i)
      if (!(position(middle(tet, i)) == straight_middle(tet, i))) return true;
    return false;
  }
  double ratio(Index tet) const { return jacobian_ratio(nodes(tet)); }

 private:
  Index corner_count() const { return static_cast<Index>(mesh_.points.size()); }
  VolumeMesh& mesh_;
  SecondOrder& order_;
};

}  // namespace dm
