#pragma once
#include <array>
#include <cmath>
#include <cstddef>

/// Small dense matrices with plain loops: the order of every sum is written down, so the bits are the same
/// with every compiler, packet width and CPU (Eigen's products are not).
namespace kadr::plant {

template <std::size_t N>
using Vector = std::array<double, N>;
using Vector4 = Vector<4>;

template <std::size_t N>
struct Matrix {
  std::array<std::array<double, N>, N> at{};  // [row][column]

  static Matrix identity() {
    Matrix unit;
    for (std::size_t i = 0; i < N; ++i) unit.at[i][i] = 1;
    return unit;
  }
  friend Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix product;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) {
        for (std::size_t j = 0; j < N; ++j) product.at[i][j] += a.at[i][k] * b.at[k][j];
      }
    }
    return product;
  }
  friend Vector<N> operator*(const Matrix& a, const Vector<N>& x) {
    Vector<N> product{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) product[i] += a.at[i][j] * x[j];
    }
    return product;
  }
  friend Matrix operator*(const Matrix& a, double factor) {
    Matrix scaled = a;
    for (auto& row : scaled.at) {
      for (double& value : row) value *= factor;
    }
    return scaled;
  }
};
using Matrix4 = Matrix<4>;

/// Largest row sum of absolute values.
template <std::size_t N>
double norm(const Matrix<N>& a) {
  double largest = 0;
  for (const auto& row : a.at) {
    double sum = 0;
    for (double value : row) sum += std::fabs(value);
    if (!(sum <= largest)) largest = sum;
  }
  return largest;
}

/// e^A by scaling and squaring: Taylor to order 18 on A/2^k with |A/2^k| <= 1/2 (truncation below 1e-22),
/// squared k times. k is at most 60; a matrix that is not finite gives one that is not finite.
template <std::size_t N>
Matrix<N> exponential(const Matrix<N>& a) {
  int squarings = 0;
  double scale = 1;
  for (const double size = norm(a); size * scale > 0.5 && squarings < 60; ++squarings) scale *= 0.5;
  const Matrix<N> small = a * scale;
  Matrix<N> result = Matrix<N>::identity();
  // Horner: I + A (I + A/2 (I + A/3 (...)))
  for (int order = 18; order >= 1; --order) {
    result = small * result * (1.0 / order);
    for (std::size_t i = 0; i < N; ++i) result.at[i][i] += 1;
  }
  for (int i = 0; i < squarings; ++i) result = result * result;
  return result;
}

}  // namespace kadr::plant
