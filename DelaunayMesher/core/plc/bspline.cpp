#include "plc/bspline.h"

#include <algorithm>
#include <cmath>

namespace dm {
namespace {

constexpr int max_count = max_spline_degree + 1;
constexpr double coincide = 1e-7;  // of the size, between the ends of a closed spline

bool finite(double x) { return std::isfinite(x); }

std::string knot_defect(int degree, std::size_t poles, const std::vector<double>& knots, double first,
                        double last) {
  if (degree < 1 || degree > max_spline_degree) return "its spline has degree " + std::to_string(degree);
  if (poles <= static_cast<std::size_t>(degree)) return "its spline has too few poles";
  if (knots.size() != poles + degree + 1) return "its spline has a wrong number of knots";
  if (!std::all_of(knots.begin(), knots.end(), finite)) return "its spline has a knot that is not a number";
  if (!std::is_sorted(knots.begin(), knots.end())) return "the knots of its spline do not increase";
  if (!(knots[degree] < knots[poles])) return "the knots of its spline span no range";
  if (!finite(first) || !finite(last) || !(first < last)) return "the parameter range of its spline is empty";
  return "";
}

bool all_equal(const std::vector<double>& weights) {
  return std::all_of(weights.begin(), weights.end(), [&](double w) { return w == weights[0]; });
}

std::string pole_defect(const std::vector<Vec3>& poles, const std::vector<double>& weights) {
  if (!weights.empty() && weights.size() != poles.size()) return "its spline has a wrong number of weights";
  // Weights that are all the same say nothing: some exporters fill them with zeros.
  if (!all_equal(weights) &&
      !std::all_of(weights.begin(), weights.end(), [](double w) { return finite(w) && w > 0; }))
    return "its spline has a weight that is not a positive number";
  for (const Vec3& p : poles) {
    if (!finite(p.x) || !finite(p.y) || !finite(p.z)) return "its spline has a pole that is not a number";
  }
  return "";
}

struct Box {
  Vec3 low, high;
  Vec3 middle() const { return 0.5 * (low + high); }
  double extent() const { return distance(low, high); }
};

Box box_of(const std::vector<Vec3>& poles) {
  Box box{poles[0], poles[0]};
  for (const Vec3& p : poles) {
    for (int k = 0; k < 3; ++k)
      box.low[k] = std::min(box.low[k], p[k]), box.high[k] = std::max(box.high[k], p[k]);
  }
  return box;
}

std::vector<std::array<double, 4>> homogeneous(const std::vector<Vec3>& poles,
                                               const std::vector<double>& weights, const Vec3& origin) {
  const bool rational = !all_equal(weights);
  std::vector<std::array<double, 4>> result(poles.size());
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const double w = rational ? weights[i] : 1;
    const Vec3 p = w * (poles[i] - origin);
    result[i] = {p.x, p.y, p.z, w};
  }
  return result;
}

using Sum = std::array<double, 4>;

Vec3 xyz(const Sum& s) { return {s[0], s[1], s[2]}; }

void add(Sum& sum, double factor, const Sum& pole) {
  for (int k = 0; k < 4; ++k) sum[k] += factor * pole[k];
}

}  // namespace

std::string defect(const SplineSurfaceRecord& r) {
  if (r.nu < 0 || r.nv < 0 || r.poles.size() != static_cast<std::size_t>(r.nu) * r.nv) {
    return "its spline has a wrong number of poles";
  }
  std::string found = knot_defect(r.degree_u, r.nu, r.knots_u, r.u0, r.u1);
  if (found.empty()) found = knot_defect(r.degree_v, r.nv, r.knots_v, r.v0, r.v1);
  return found.empty() ? pole_defect(r.poles, r.weights) : found;
}

std::string defect(const SplineCurveRecord& r) {
  const std::string found = knot_defect(r.degree, r.poles.size(), r.knots, r.u0, r.u1);
  return found.empty() ? pole_defect(r.poles, r.weights) : found;
}

KnotVector::KnotVector(int degree, std::vector<double> knots)
    : degree_(degree),
      knots_(std::move(knots)),
      first_(knots_[degree_]),
      last_(knots_[knots_.size() - 1 - degree_]) {}

bool KnotVector::holds(double first, double last) const {
  return first >= first_ - 1e-9 * length() && last <= last_ + 1e-9 * length();
}

void KnotVector::set_range(double first, double last, bool closed) {
  if (closed && !holds(first, last)) return;
  const double low = first_, high = last_, near = 1e-9 * (high - low), beyond = 0.1 * (high - low);
  if (first > high - near || last < low + near) return;
  first_ = std::abs(first - low) < near ? low : std::max(first, low - beyond);
  last_ = std::abs(last - high) < near ? high : std::min(last, high + beyond);
}

int KnotVector::span(double u) const {
  const auto begin = knots_.begin() + degree_, end = knots_.end() - 1 - degree_;
  int i = static_cast<int>(std::upper_bound(begin, end, u) - knots_.begin()) - 1;
  i = std::max(i, degree_);
  while (i > degree_ && knots_[i + 1] <= knots_[i]) --i;
  while (knots_[i + 1] <= knots_[i]) ++i;
  return i;
}

std::vector<double> KnotVector::breaks() const {
  std::vector<double> result{first_};
  for (const double k : knots_) {
    if (k > result.back() + 1e-9 * length() && k < last_ - 1e-9 * length()) result.push_back(k);
  }
  result.push_back(last_);
  return result;
}

void KnotVector::basis(double u, int at_span, int derivatives, double (*n)[max_count]) const {
  const int p = degree_;
  double left[max_count], right[max_count], lower[2][max_count], inverse[2][max_count];
  double* f = n[0];
  f[0] = 1;
  for (int j = 1; j <= p; ++j) {
    const int below = p - j;  // 0 and 1: the last two steps, whose terms the derivatives are made of
    left[j] = u - knots_[at_span + 1 - j];
    right[j] = knots_[at_span + j] - u;
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      const double over = 1 / (right[r + 1] + left[j - r]), term = f[r] * over;
      if (below < 2) lower[below][r] = term, inverse[below][r] = over;
      f[r] = saved + right[r + 1] * term;
      saved = left[j - r] * term;
    }
    f[j] = saved;
  }
  if (derivatives == 0) return;
  for (int k = 0; k <= p; ++k) {
    n[1][k] = p * ((k > 0 ? lower[0][k - 1] : 0) - (k < p ? lower[0][k] : 0));
  }
  if (p == 1) {
    n[2][0] = n[2][1] = 0;
    return;
  }
  double saved = 0;
  for (int k = 0; k <= p; ++k) {
    double slope = 0;  // derivative of the k-th function of degree p - 1, over its knot range
    if (k < p) {
      slope = (p - 1) * ((k > 0 ? lower[1][k - 1] : 0) - (k < p - 1 ? lower[1][k] : 0)) * inverse[0][k];
    }
    n[2][k] = p * (saved - slope);
    saved = slope;
  }
}

BSplineCurve::BSplineCurve(const SplineCurveRecord& r)
    : knots_(r.degree, r.knots),
      origin_(box_of(r.poles).middle()),
      extent_(box_of(r.poles).extent()),
      poles_(homogeneous(r.poles, r.weights, origin_)) {
  knots_.set_range(r.u0, r.u1, closed());
}

bool BSplineCurve::closed() const {
  return distance(point(knots_.first()), point(knots_.last())) <= coincide * extent_;
}

Vec3 BSplineCurve::point(double t) const {
  double n[1][max_count];
  const int span = knots_.span(t), p = knots_.degree();
  knots_.basis(t, span, 0, n);
  Sum sum{};
  for (int i = 0; i <= p; ++i) add(sum, n[0][i], poles_[span - p + i]);
  return (1 / sum[3]) * xyz(sum);
}

CurveJet BSplineCurve::jet(double t) const {
  double n[3][max_count];
  const int span = knots_.span(t), p = knots_.degree();
  knots_.basis(t, span, 2, n);
  Sum s{}, d{}, dd{};
  for (int i = 0; i <= p; ++i) {
    const Sum& pole = poles_[span - p + i];
    add(s, n[0][i], pole), add(d, n[1][i], pole), add(dd, n[2][i], pole);
  }
  const double over = 1 / s[3];
  CurveJet jet;
  jet.point = over * xyz(s);
  jet.d = over * (xyz(d) - d[3] * jet.point);
  jet.dd = over * (xyz(dd) - 2 * d[3] * jet.d - dd[3] * jet.point);
  return jet;
}

BSplineSurface::BSplineSurface(const SplineSurfaceRecord& r)
    : u_(r.degree_u, r.knots_u),
      v_(r.degree_v, r.knots_v),
      origin_(box_of(r.poles).middle()),
      extent_(box_of(r.poles).extent()),
      nv_(r.nv),
      rational_(!all_equal(r.weights)),
      poles_(homogeneous(r.poles, r.weights, origin_)) {
  const bool round_u = closed_u(), round_v = closed_v();
  u_.set_range(r.u0, r.u1, round_u);
  v_.set_range(r.v0, r.v1, round_v);
}

bool BSplineSurface::closed_u() const {
  const std::vector<double> across = refine_parameters(v_.breaks(), 8, 0, nullptr);
  return std::all_of(across.begin(), across.end(), [&](double v) {
    return distance(point(u_.first(), v), point(u_.last(), v)) <= coincide * extent_;
  });
}

bool BSplineSurface::closed_v() const {
  const std::vector<double> across = refine_parameters(u_.breaks(), 8, 0, nullptr);
  return std::all_of(across.begin(), across.end(), [&](double u) {
    return distance(point(u, v_.first()), point(u, v_.last())) <= coincide * extent_;
  });
}

Vec3 BSplineSurface::point(double u, double v) const {
  double nu[1][max_count], nv[1][max_count];
  const int su = u_.span(u), sv = v_.span(v), p = u_.degree(), q = v_.degree();
  u_.basis(u, su, 0, nu);
  v_.basis(v, sv, 0, nv);
  Sum sum{};
  for (int i = 0; i <= p; ++i) {
    const Sum* pole = &poles_[static_cast<std::size_t>(su - p + i) * nv_ + sv - q];
    Sum row{};
    for (int j = 0; j <= q; ++j) add(row, nv[0][j], pole[j]);
    add(sum, nu[0][i], row);
  }
  return (1 / sum[3]) * xyz(sum);
}

SurfaceJet BSplineSurface::jet(double u, double v) const {
  double nu[3][max_count], nv[3][max_count];
  const int su = u_.span(u), sv = v_.span(v), p = u_.degree(), q = v_.degree();
  u_.basis(u, su, 2, nu);
  v_.basis(v, sv, 2, nv);
  Sum s{}, du{}, dv{}, duu{}, duv{}, dvv{};
  for (int i = 0; i <= p; ++i) {
    const Sum* pole = &poles_[static_cast<std::size_t>(su - p + i) * nv_ + sv - q];
    Sum row{}, row_v{}, row_vv{};
    for (int j = 0; j <= q; ++j) {
      add(row, nv[0][j], pole[j]), add(row_v, nv[1][j], pole[j]), add(row_vv, nv[2][j], pole[j]);
    }
    add(s, nu[0][i], row), add(du, nu[1][i], row), add(duu, nu[2][i], row);
    add(dv, nu[0][i], row_v), add(duv, nu[1][i], row_v), add(dvv, nu[0][i], row_vv);
  }
  if (!rational_) return {xyz(s), xyz(du), xyz(dv), xyz(duu), xyz(duv), xyz(dvv)};
  const double over = 1 / s[3];
  SurfaceJet jet;
  jet.point = over * xyz(s);
  jet.u = over * (xyz(du) - du[3] * jet.point);
  jet.v = over * (xyz(dv) - dv[3] * jet.point);
  jet.uu = over * (xyz(duu) - 2 * du[3] * jet.u - duu[3] * jet.point);
  jet.uv = over * (xyz(duv) - du[3] * jet.v - dv[3] * jet.u - duv[3] * jet.point);
  jet.vv = over * (xyz(dvv) - 2 * dv[3] * jet.v - dvv[3] * jet.point);
  return jet;
}

std::vector<double> refine_parameters(const std::vector<double>& breaks, int at_least, int depth,
                                      const std::function<bool(double, double)>& bent) {
  struct Interval {
    double a, b;
    int depth;
  };
  const int spans = static_cast<int>(breaks.size()) - 1, pieces = (at_least + spans - 1) / spans;
  std::vector<Interval> waiting;  // the next one last
  for (int i = spans - 1; i >= 0; --i) {
    const double step = (breaks[i + 1] - breaks[i]) / pieces;
    for (int k = pieces - 1; k >= 0; --k) {
      const double a = breaks[i] + k * step, b = k + 1 < pieces ? breaks[i] + (k + 1) * step : breaks[i + 1];
      waiting.push_back({a, b, depth});
    }
  }
  std::vector<double> result{breaks[0]};
  while (!waiting.empty()) {
    const Interval now = waiting.back();
    waiting.pop_back();
    if (now.depth > 0 && bent(now.a, now.b)) {
      const double middle_of = 0.5 * (now.a + now.b);
      waiting.push_back({middle_of, now.b, now.depth - 1});
      waiting.push_back({now.a, middle_of, now.depth - 1});
    } else {
      result.push_back(now.b);
    }
  }
  return result;
}

}  // namespace dm
