#include "plant/spline.h"

namespace kadr::plant {

namespace {

// coefficient of theta^i for point j, times 120
constexpr double kBasis[6][6] = {{1, 26, 66, 26, 1, 0},    {-5, -50, 0, 50, 5, 0},  {10, 20, -60, 20, 10, 0},
                                 {-10, 20, 0, -20, 10, 0}, {5, -20, 30, -20, 5, 0}, {-1, 5, -10, 10, -5, 1}};

}  // namespace

SplinePiece spline_piece(const std::array<SplinePoint, 6>& point, double step_m) {
  SplinePiece piece;
  piece.node = point[2].node;
  std::array<double, 6> p;
  for (std::size_t j = 0; j < 6; ++j) {
    p[j] = static_cast<double>((point[j].node - piece.node).value) * step_m + point[j].rest_m;
    piece.constant = piece.constant && point[j] == point[0];
  }
  if (piece.constant) {
    piece.c[0] = p[0];
    return piece;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < 6; ++j) sum += kBasis[i][j] * p[j];
    piece.c[i] = sum * (1.0 / 120);
  }
  return piece;
}

}  // namespace kadr::plant
