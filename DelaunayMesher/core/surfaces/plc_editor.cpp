#include "surfaces/plc_editor.h"

#include <algorithm>

#include "base/keep_rows.h"

namespace dm {

PlcEditor::PlcEditor(Plc& plc) : plc_(plc), table_(plc), edges_of_(plc.points.size()) {
  for (std::size_t s = 0; s < plc.segments.size(); ++s)
    for (const Index p : plc.segments[s])
      if (!is_on(p, plc.segment_edge[s])) edges_of_[p].push_back(plc.segment_edge[s]);
}

bool PlcEditor::is_on(Index p, Index edge) const {
  return std::find(edges_of_[p].begin(), edges_of_[p].end(), edge) != edges_of_[p].end();
}

bool PlcEditor::share_edge(Index p, Index q) const {
  return std::any_of(edges_of_[p].begin(), edges_of_[p].end(), [&](Index e) { return is_on(q, e); });
}

Index PlcEditor::segment(Index a, Index b) const {
  const auto found = divided_.find(std::minmax(a, b));
  return found != divided_.end() ? found->second : table_.find(a, b);
}

void PlcEditor::collect(const std::vector<Index>& faces) {
  by_face_.resize(plc_.face_solids.size());
  edited_.assign(plc_.face_solids.size(), 0);
  for (const Index f : faces) edited_[f] = 1;
  round_.resize(plc_.points.size());
  for (std::size_t t = 0; t < plc_.triangles.size(); ++t) {
    if (edited_[plc_.triangle_face[t]]) by_face_[plc_.triangle_face[t]].push_back(static_cast<Index>(t));
    for (const Index p : plc_.triangles[t])
      if (is_tracked(p, static_cast<Index>(t))) round_[p].push_back(static_cast<Index>(t));
  }
}

bool PlcEditor::load(Index face) {
  divided_by_others_.erase(face);
  half_.clear();
  for (const Index t : by_face_[face])
    for (int i = 0; i < 3; ++i)
      if (!half_.emplace(side(t, i), t).second) return false;
  return true;
}

Index PlcEditor::left_of(const Segment& side) const {
  const auto found = half_.find(side);
  return found == half_.end() ? -1 : found->second;
}

Index PlcEditor::apex(Index t, const Segment& ends) const {
  for (const Index p : plc_.triangles[t])
    if (p != ends[0] && p != ends[1]) return p;
  return -1;
}

bool PlcEditor::has(Index t, Index p) const {
  return std::find(plc_.triangles[t].begin(), plc_.triangles[t].end(), p) != plc_.triangles[t].end();
}

void PlcEditor::add_sides(Index t) {
  for (int i = 0; i < 3; ++i) half_[side(t, i)] = t;
}

void PlcEditor::erase_sides(Index t) {
  for (int i = 0; i < 3; ++i) half_.erase(side(t, i));
}

void PlcEditor::replace(Index t, const Triangle& v) {
  for (const Index p : plc_.triangles[t]) std::erase(round_[p], t);
  plc_.triangles[t] = v;
  for (const Index p : v)
    if (is_tracked(p, t)) round_[p].push_back(t);
}

Index PlcEditor::divide(Index segment, const Vec3& place, Index face) {
  const auto [a, b] = plc_.segments[segment];
  const Index v = static_cast<Index>(plc_.points.size()), edge = plc_.segment_edge[segment];
  plc_.points.push_back(place);
  round_.emplace_back();
  edges_of_.push_back({edge});
  const std::vector<Index> round = round_[a];
  for (const Index t : round) {
    if (!has(t, b)) continue;
    const Index n = static_cast<Index>(plc_.triangles.size()), f = plc_.triangle_face[t];
    if (f == face) erase_sides(t);
    Triangle first = plc_.triangles[t], second = first;
    std::replace(first.begin(), first.end(), b, v);
    std::replace(second.begin(), second.end(), a, v);
    replace(t, first);
    plc_.triangles.push_back(second);
    plc_.triangle_face.push_back(f);
    for (const Index q : second)
      if (is_tracked(q, n)) round_[q].push_back(n);
    if (edited_[f]) by_face_[f].push_back(n);
    if (f == face) {
      add_sides(t);
      add_sides(n);
    } else if (edited_[f]) {
      divided_by_others_.insert(f);
    }
  }
  plc_.segments[segment] = {a, v};
  plc_.segments.push_back({v, b});
  plc_.segment_edge.push_back(edge);
  divided_[std::minmax(a, b)] = -1;
  divided_[std::minmax(a, v)] = segment;
  divided_[std::minmax(v, b)] = static_cast<Index>(plc_.segments.size()) - 1;
  return v;
}

void PlcEditor::flip(const Segment& ends, Index s, Index t) {
  const Index c = apex(s, ends), d = apex(t, ends);
  erase_sides(s);
  erase_sides(t);
  replace(s, {c, ends[0], d});
  replace(t, {d, ends[1], c});
  add_sides(s);
  add_sides(t);
}

bool PlcEditor::collapse(Index p, Index q) {
  const std::vector<Index> fan = round_[p];
  std::vector<Index> gone, kept;
  Vec3 n;
  for (const Index t : fan) {
    (has(t, q) ? gone : kept).push_back(t);
    n += area(plc_.triangles[t]);
  }
  if (gone.size() != 2) return false;
  std::vector<Triangle> moved;
  for (const Index t : kept) {
    Triangle& v = moved.emplace_back(plc_.triangles[t]);
    std::replace(v.begin(), v.end(), p, q);
    if (!(dot(area(v), n) > 0)) return false;
    for (const Index x : v) {
      const bool linked = has_side(q, x) || segment(q, x) >= 0;
      if (x != q && linked && !has(gone[0], x) && !has(gone[1], x)) return false;
    }
  }
  for (const Index t : fan) erase_sides(t);
  for (const Index t : gone) {
    for (const Index x : plc_.triangles[t]) std::erase(round_[x], t);
    std::erase(by_face_[plc_.triangle_face[t]], t);
    plc_.triangles[t] = {q, q, q};  // finish() leaves it out
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    replace(kept[k], moved[k]);
    add_sides(kept[k]);
  }
  return true;
}

void PlcEditor::finish() {
  keep_rows(plc_.triangles, plc_.triangle_face, [](const Triangle& t) { return t[0] != t[1]; });
}

}  // namespace dm
