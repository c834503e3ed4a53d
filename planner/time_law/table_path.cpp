#include "planner/time_law/table_path.h"

#include <algorithm>
#include <utility>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

/// X'' of one axis at all rows, from
///   h_i m_(i-1) + 2 (h_i + h_(i+1)) m_i + h_(i+1) m_(i+1) = 6 (d_(i+1) - d_i),   d_i = (X_i - X_(i-1))/h_i
/// at inner rows. The ends: continued linearly, m_0 = m_1 + (m_1 - m_2) h_1/h_2; or 0; or, with X'_0 = d_1,
///   2 h_1 m_0 + h_1 m_1 = 6 (d_1 - X'_0) = 0.
/// Every row of the matrix is dominated by its diagonal, so elimination needs no pivots.
class SecondDerivatives {
 public:
  SecondDerivatives(const std::vector<double>& s, SplineEnds ends)
      : n_(s.size()), ends_(ends), h_(n_), upper_(n_), pivot_(n_) {
    for (std::size_t i = 1; i < n_; ++i) h_[i] = s[i] - s[i - 1];
    for (std::size_t i = 1; i + 1 < n_; ++i) {
      pivot_[i] = diagonal(i) - (i > 1 ? lower(i) * upper_[i - 1] : 0.0);
      upper_[i] = above(i) / pivot_[i];
    }
  }

  void solve(const std::vector<double>& value, std::size_t axis, std::size_t axes, double* out) const {
    const auto x = [&](std::size_t i) { return value[i * axes + axis]; };
    const auto m = [&](std::size_t i) -> double& { return out[i * axes + axis]; };
    for (std::size_t i = 1; i + 1 < n_; ++i) {
      const double right = 6.0 * ((x(i + 1) - x(i)) / h_[i + 1] - (x(i) - x(i - 1)) / h_[i]);
      m(i) = (right - (i > 1 ? lower(i) * m(i - 1) : 0.0)) / pivot_[i];
    }
    for (std::size_t i = n_ - 2; i > 1; --i) m(i - 1) -= upper_[i - 1] * m(i);
    m(0) = end(m(1), m(2), h_[1] / h_[2]);
    m(n_ - 1) = end(m(n_ - 2), m(n_ - 3), h_[n_ - 1] / h_[n_ - 2]);
  }

 private:
  /// m of an end from those of the next two rows; `ratio` is of the outer interval to the inner one.
  double end(double next, double second, double ratio) const {
    if (ends_ == SplineEnds::natural) return 0.0;
    return ends_ == SplineEnds::clamped ? -0.5 * next : next + (next - second) * ratio;
  }
  /// Of an end row, with m of the end replaced: the neighbour's interval is h, the inner one is k.
  double end_diagonal(double h, double k) const {
    if (ends_ == SplineEnds::natural) return 2.0 * (h + k);
    return ends_ == SplineEnds::clamped ? 1.5 * h + 2.0 * k : (h + k) * (h + 2.0 * k) / k;
  }
  double end_inner(double h, double k) const {
    return ends_ == SplineEnds::not_a_knot ? (k - h) * (k + h) / k : k;
  }

  double diagonal(std::size_t i) const {
    if (i == 1) return end_diagonal(h_[1], h_[2]);
    if (i == n_ - 2) return end_diagonal(h_[n_ - 1], h_[n_ - 2]);
    return 2.0 * (h_[i] + h_[i + 1]);
  }
  double lower(std::size_t i) const { return i == n_ - 2 ? end_inner(h_[n_ - 1], h_[n_ - 2]) : h_[i]; }
  double above(std::size_t i) const { return i == 1 ? end_inner(h_[1], h_[2]) : h_[i + 1]; }

  std::size_t n_;
  SplineEnds ends_;
  std::vector<double> h_, upper_, pivot_;
};

}  // namespace

TablePath::TablePath(std::vector<double> s_u, std::vector<double> values, std::size_t axes, SplineEnds ends)
    : s_u_(std::move(s_u)), value_(std::move(values)), second_(value_.size()), axes_(axes) {
  require(rows() >= 4 && axes_ > 0 && value_.size() == rows() * axes_, "a table has 4 full rows");
  const SecondDerivatives equations(s_u_, ends);
  for (std::size_t c = 0; c < axes_; ++c) equations.solve(value_, c, axes_, second_.data());
}

/// Number of the row that ends the piece of s.
std::size_t TablePath::piece(double s) const {
  const auto behind = std::upper_bound(s_u_.begin(), s_u_.end(), s);
  return std::clamp<std::size_t>(static_cast<std::size_t>(behind - s_u_.begin()), 1, rows() - 1);
}

AxisPoint TablePath::eval(std::size_t axis, double s) const { return eval(axis, piece(s), s); }

AxisPoint TablePath::eval(std::size_t axis, std::size_t i, double s) const {
  const double h = s_u_[i] - s_u_[i - 1], b = (s - s_u_[i - 1]) / h, a = 1.0 - b;
  const double x0 = value_[(i - 1) * axes_ + axis], x1 = value_[i * axes_ + axis];
  const double m0 = second_[(i - 1) * axes_ + axis], m1 = second_[i * axes_ + axis];
  return {a * x0 + b * x1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * (h * h / 6.0),
          (x1 - x0) / h + ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1) * (h / 6.0), a * m0 + b * m1};
}

void TablePath::place_rows(LawProblem& out) const {
  out.s_u = s_u_;
  place(out);
}

void TablePath::sample(std::size_t nodes, LawProblem& out) const {
  out.s_u.resize(nodes);
  const double length = end_u() - begin_u();
  for (std::size_t i = 0; i < nodes; ++i)
    out.s_u[i] = begin_u() + length * static_cast<double>(i) / static_cast<double>(nodes - 1);
  out.s_u.back() = end_u();
  place(out);
}

void TablePath::place(LawProblem& out) const {
  const std::size_t n = out.nodes();
  out.axes = axes_;
  out.slope.resize(n * axes_);
  out.curvature.resize(n * axes_);
  const PathDerivatives at = derivatives();
  for (std::size_t i = 0; i < n; ++i) at(out.s_u[i], &out.slope[i * axes_], &out.curvature[i * axes_]);
}

PathDerivatives TablePath::derivatives() const {
  return [this](double s, double* slope, double* curvature) {
    const std::size_t i = piece(s);
    for (std::size_t c = 0; c < axes_; ++c) {
      const AxisPoint p = eval(c, i, s);
      slope[c] = p.slope;
      curvature[c] = p.curvature;
    }
  };
}

}  // namespace kadr::planner
