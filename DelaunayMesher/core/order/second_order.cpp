#include "order/second_order.h"

#include <algorithm>

#include "order/curved_mesh.h"
#include "order/edge_table.h"
#include "order/repair.h"

namespace dm {
namespace {

constexpr Index kPollEvery = 1024;

// A projection further away than this part of the edge is not the piece of surface the edge stands for.
constexpr double kFarthest = 0.5;

EdgeTable number_edges(const VolumeMesh& mesh, SecondOrder& order) {
  EdgeTable table(mesh.points.size());
  const Index corners = static_cast<Index>(mesh.points.size());
  order.tet_nodes.resize(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 6; ++i)
      order.tet_nodes[t][i] =
          corners + table.find_or_add(mesh.tets[t][kTetEdges[i][0]], mesh.tets[t][kTetEdges[i][1]]);
  order.point_entity.assign(table.count(), {});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (Index node : order.tet_nodes[t]) order.point_entity[node - corners] = {3, mesh.tet_solid[t]};
  return table;
}

Index edge_of(const EdgeTable& table, const VolumeMesh& mesh, Index a, Index b) {
  const Index e = table.find(a, b);
  if (e < 0)
    throw Failure("order", "boundary_not_in_mesh", "A boundary edge is no edge of a tetrahedron.",
                  mesh.points[a]);
  return e;
}

// Edges of boundary triangles belong to their CAD face, segments to their CAD edge.
void classify_edges(const VolumeMesh& mesh, const EdgeTable& table, SecondOrder& order) {
  const Index corners = static_cast<Index>(mesh.points.size());
  order.triangle_nodes.resize(mesh.triangles.size());
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const Triangle& t = mesh.triangles[k];
      const Index e = i == 2 ? edge_of(table, mesh, t[0], t[2]) : edge_of(table, mesh, t[i], t[i + 1]);
      order.triangle_nodes[k][i] = corners + e;
      order.point_entity[e] = {2, mesh.triangle_face[k]};
    }
  order.segment_nodes.resize(mesh.segments.size());
  for (std::size_t k = 0; k < mesh.segments.size(); ++k) {
    const Index e = edge_of(table, mesh, mesh.segments[k][0], mesh.segments[k][1]);
    order.segment_nodes[k] = corners + e;
    order.point_entity[e] = {1, mesh.segment_edge[k]};
  }
}

// Returns the edges that stay straight because their projection is out of reach, sorted.
std::vector<Index> place_middles(const VolumeMesh& mesh, const EdgeTable& table, const Geometry& geometry,
                                 SecondOrder& order, Context& context) {
  std::vector<Index> out_of_reach;
  order.points.resize(table.count());
  for (Index e = 0; e < table.count(); ++e) {
    if (e % kPollEvery == 0) context.poll(0.4 * e / table.count());
    const auto [a, b] = table.ends(e);
    const Vec3 middle = 0.5 * (mesh.points[a] + mesh.points[b]);
    order.points[e] = middle;
    const Entity entity = order.point_entity[e];
    if (entity.dimension == 3) continue;
    const Vec3 p = geometry.project(entity, middle);
    if (distance(p, middle) < kFarthest * distance(mesh.points[a], mesh.points[b])) {
      order.points[e] = p;
    } else {
      out_of_reach.push_back(e);
    }
  }
  return out_of_reach;
}

// Adds the tetrahedra that have one of the edges.
void add_straight(const std::vector<Index>& edges, Index corner_count, SecondOrder& order) {
  if (edges.empty()) return;
  std::vector<Index>& list = order.straightened;
  for (std::size_t t = 0; t < order.tet_nodes.size(); ++t)
    for (Index node : order.tet_nodes[t])
      if (std::binary_search(edges.begin(), edges.end(), node - corner_count)) {
        list.push_back(static_cast<Index>(t));
        break;
      }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

SecondOrder make_second_order(VolumeMesh& mesh, const Geometry& geometry, Context& context) {
  context.begin("order");
  SecondOrder order;
  const EdgeTable table = number_edges(mesh, order);
  classify_edges(mesh, table, order);
  const std::vector<Index> straight = place_middles(mesh, table, geometry, order, context);
  CurvedMesh curved(mesh, order);
  std::vector<Index> bad;
  for (Index t = 0; t < curved.tet_count(); ++t) {
    if (t % kPollEvery == 0) context.poll(0.4 + 0.1 * t / curved.tet_count());
    if (curved.curved(t) && curved.ratio(t) < kGoodRatio) bad.push_back(t);
  }
  order.straightened = repair(curved, geometry, bad, context);
  add_straight(straight, static_cast<Index>(mesh.points.size()), order);
  return order;
}

}  // namespace dm
