#include "planner/bezier/paper_table.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

constexpr int kMostExchanges = 500;
constexpr double kLevelled = 1e-10;

/// u (1 - u) T_j(2u - 1), j = 0 to count - 1
std::vector<double> basis(double u, std::size_t count) {
  const double x = 2 * u - 1;
  std::vector<double> out(count);
  double before = 1, now = x;
  for (std::size_t j = 0; j < count; ++j) {
    out[j] = u * (1 - u) * before;
    const double next = 2 * x * now - before;
    before = now;
    now = next;
  }
  return out;
}

/// Solves rows [n][n + 1] by elimination with row exchange.
std::vector<double> solved(std::vector<std::vector<double>> rows) {
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < n; ++r)
      if (std::fabs(rows[r][i]) > std::fabs(rows[pivot][i])) pivot = r;
    std::swap(rows[i], rows[pivot]);
    for (std::size_t r = i + 1; r < n; ++r) {
      const double factor = rows[r][i] / rows[i][i];
      for (std::size_t k = i; k <= n; ++k) rows[r][k] -= factor * rows[i][k];
    }
  }
  std::vector<double> x(n);
  for (std::size_t i = n; i-- > 0;) {
    double sum = rows[i][n];
    for (std::size_t k = i + 1; k < n; ++k) sum -= rows[i][k] * x[k];
    x[i] = sum / rows[i][i];
  }
  return x;
}

/// Puts place `in` into the reference so that the signs of its errors still alternate.
void exchange(std::vector<int>& reference, int in, const std::vector<double>& error) {
  const auto same = [&](int a, int b) {
    return (error[static_cast<std::size_t>(a)] > 0) == (error[static_cast<std::size_t>(b)] > 0);
  };
  const auto above = std::lower_bound(reference.begin(), reference.end(), in);
  if (above == reference.begin()) {
    if (!same(reference.front(), in)) {
      reference.pop_back();
      reference.insert(reference.begin(), in);
    } else {
      reference.front() = in;
    }
  } else if (above == reference.end()) {
    if (!same(reference.back(), in)) {
      reference.erase(reference.begin());
      reference.push_back(in);
    } else {
      reference.back() = in;
    }
  } else {
    *(same(*above, in) ? above : above - 1) = in;
  }
}

}  // namespace

NewtonOfLength::NewtonOfLength(const ArcLength& arc, int degree) {
  require(degree >= 1 && degree <= 20, "a Newton polynomial of degree 1 to 20");
  for (int i = 0; i <= degree; ++i) {
    node_.push_back(static_cast<double>(i) / degree);
    a_.push_back(i == 0 ? 0 : i == degree ? 1 : arc.t(arc.length_u() * i / degree));
  }
  for (std::size_t j = 1; j < a_.size(); ++j)
    for (std::size_t i = a_.size() - 1; i >= j; --i) a_[i] = (a_[i] - a_[i - 1]) / (node_[i] - node_[i - j]);
}

double NewtonOfLength::operator()(double u) const {
  double r = a_.back();
  for (std::size_t j = a_.size() - 1; j-- > 0;) r = r * (u - node_[j]) + a_[j];
  return r;
}

MinimaxOfLength::MinimaxOfLength(const std::vector<double>& target, int degree) {
  require(degree >= 2 && degree <= 16, "a minimax polynomial of degree 2 to 16");
  require(target.size() == kErrorPlaces, "a target has a value at every place");
  const auto unknowns = static_cast<std::size_t>(degree) - 1;
  std::vector<int> reference;
  for (std::size_t i = 0; i <= unknowns; ++i)
    reference.push_back(static_cast<int>((i + 1) * (kErrorPlaces - 1) / (unknowns + 2)));
  std::vector<double> error(kErrorPlaces);
  for (int n = 0; n < kMostExchanges; ++n) {
    // sum c_j b_j(u_i) + (-1)^i E = f(u_i) - u_i
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i <= unknowns; ++i) {
      const double u = error_place(reference[i]);
      std::vector<double> row = basis(u, unknowns);
      row.push_back(i % 2 == 0 ? 1 : -1);
      row.push_back(target[static_cast<std::size_t>(reference[i])] - u);
      rows.push_back(std::move(row));
    }
    c_ = solved(std::move(rows));
    error_ = std::fabs(c_.back());
    c_.pop_back();
    int worst = 0;
    for (int i = 0; i < kErrorPlaces; ++i) {
      const auto at = static_cast<std::size_t>(i);
      error[at] = (*this)(error_place(i)) - target[at];
      if (std::fabs(error[at]) > std::fabs(error[static_cast<std::size_t>(worst)])) worst = i;
    }
    if (std::fabs(error[static_cast<std::size_t>(worst)]) <= error_ * (1 + kLevelled) + 1e-16) return;
    exchange(reference, worst, error);
  }
}

double MinimaxOfLength::operator()(double u) const {
  const std::vector<double> b = basis(u, c_.size());
  double sum = u;
  for (std::size_t j = 0; j < c_.size(); ++j) sum += c_[j] * b[j];
  return sum;
}

std::vector<double> exact_places(const ArcLength& arc) {
  std::vector<double> out;
  out.reserve(kErrorPlaces);
  for (int i = 0; i < kErrorPlaces; ++i) out.push_back(arc.t(error_place(i) * arc.length_u()));
  out.back() = 1;
  return out;
}

std::vector<double> places_of(const NewtonOfLength& newton) {
  std::vector<double> out;
  out.reserve(kErrorPlaces);
  for (int i = 0; i < kErrorPlaces; ++i) out.push_back(newton(error_place(i)));
  return out;
}

}  // namespace kadr::planner
