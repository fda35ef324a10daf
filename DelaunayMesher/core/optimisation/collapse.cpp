#include "optimisation/collapse.h"

namespace dm {
namespace {

struct Contraction {
  double worst = kInverted;
  std::vector<Index> before;
  std::vector<Tet> after;
};

bool contains(const Tet& t, Index v) { return t[0] == v || t[1] == v || t[2] == v || t[3] == v; }

// A triangle of the cone that is new: it holds `to` and was no face of the star.
bool makes_forbidden_face(const EditMesh& mesh, const Contraction& plan, Index to) {
  for (const Tet& t : plan.after)
    for (const auto& f : EditMesh::kFace) {
      const Triangle c{t[f[0]], t[f[1]], t[f[2]]};
      if (c[0] != to && c[1] != to && c[2] != to) continue;
      if (!mesh.on_one_face(c[0], c[1], c[2])) continue;
      bool old = false;
      for (Index b : plan.before) {
        const Tet& o = mesh.tet(b);
        old = old || (contains(o, c[0]) && contains(o, c[1]) && contains(o, c[2]));
      }
      if (!old) return true;
    }
  return false;
}

// The point `from` goes to `to`.
void plan_contraction(EditMesh& mesh, Index from, Index to, Contraction& best) {
  if (!mesh.interior(from)) return;
  const auto star = mesh.star(from);
  if (star.size() > EditMesh::kMaxReplace) return;
  Contraction plan;
  plan.before.assign(star.begin(), star.end());
  AngleCosines before, after;
  for (Index t : plan.before) {
    before.include(mesh.cosines(mesh.tet(t)));
    if (contains(mesh.tet(t), to)) continue;
    Tet cone = mesh.tet(t);
    cone[mesh.corner_index(t, from)] = to;
    after.include(mesh.cosines(cone));
    if (badness(after) >= best.worst) return;
    plan.after.push_back(cone);
  }
  plan.worst = badness(after);
  if (plan.worst >= badness(before) - 1e-3 || !keeps_angles(before, after)) return;
  if (makes_forbidden_face(mesh, plan, to)) return;
  best = std::move(plan);
}

}  // namespace

bool collapse_best(EditMesh& mesh, Index tet) {
  Contraction best;
  const Tet corners = mesh.tet(tet);
  for (Index from : corners)
    for (Index to : corners)
      if (from != to) plan_contraction(mesh, from, to, best);
  if (best.after.empty()) return false;
  mesh.replace(best.before, best.after);
  return true;
}

}  // namespace dm
