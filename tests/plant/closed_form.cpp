#include <doctest/doctest.h>

#include <cmath>

#include "plant/matrix.h"

// The closed form of the plant (the exponential of its equations' matrix) against 40-digit values of paper
// 001's law, 3.5 m in 4 s with ramps of xi tf: to 1e-12 of each motion's size.
namespace kadr::plant {
namespace {

constexpr double kW = 100 * 3.14159265358979323846 / 3;

struct Link {
  double x = 0, v = 0;
};

/// The link after the law. In time w t and speeds v/w:  x' = u,  u' = -x - 2 zeta u - a/w^2,  a' = 0.
/// @param gain  of the law's acceleration that the link feels
Link after_law(double w, double zeta, double xi, double gain) {
  const double accel = gain * 3.5 / (16 * xi * (1 - xi));
  Vector<3> z{0, 0, 0};
  const auto piece = [&](double a, double duration_s) {
    z[2] = a / (w * w);
    const Matrix<3> system{{{{0, 1, 0}, {-1, -2 * zeta, -1}, {0, 0, 0}}}};
    z = exponential(system * (w * duration_s)) * z;
  };
  piece(accel, 4 * xi);
  piece(0, 4 - 8 * xi);
  piece(-accel, 4 * xi);
  return {z[0], z[1] * w};
}

void check_link(const Link& found, double x, double v, double w) {
  // relative to the amplitude: a state on its way through zero has no relative precision of its own
  const double size = std::hypot(x, v / w), allowed = size > 0 ? 1e-12 * size : 1e-15;
  CHECK(std::fabs(found.x - x) <= allowed);
  CHECK(std::fabs(found.v - v) <= allowed * w);
}

struct BaseCase {
  double w, zeta, xi, x, v;  // m, m/s
};
const BaseCase kBase[] = {
    {kW, 0, .36, 0, 0},
    {kW, 0, .3601, 3.177375737038982e-6, 5.763122091774534e-4},
    {kW, 0, .3333, 1.128388435000749e-4, 2.046670226013603e-2},
    {kW, 0, 1.0 / 3, 1.136455123471736e-4, 2.061301580433754e-2},
    {kW, 0, .48, 0, 0},
    {kW, 0, .4803, 8.989134336142929e-6, 1.630448614391202e-3},
    {kW, 0, .33, 0, 0},
    {kW, 0.005, .36, 5.191341929806375e-5, -1.095202366002421e-3},
    {kW, 0.005, .3601, 5.274982655671674e-5, -8.651442398819802e-4},
    {kW, 0.005, .3333, 9.639820658964978e-5, 6.365251915051542e-3},
    {kW, 0.005, 1.0 / 3, 9.690144258073759e-5, 6.407132756958789e-3},
    {kW, 0.005, .48, 5.929320785085513e-5, -1.553112282378515e-3},
    {kW, 0.005, .4803, 6.232047164036407e-5, -9.742913517287278e-4},
    {kW, 0.005, .33, 5.061797182919014e-5, -1.010719778908848e-3},
    {105, 0, .36, 3.876886978431416e-5, 2.154095429252042e-3},
    {105, 0, .3601, 4.381603830983067e-5, 2.434528743711952e-3},
    {105, 0, .3333, 2.377592242562208e-4, 1.321049752242337e-2},
    {105, 0, 1.0 / 3, 2.394671365251868e-4, 1.330539340235515e-2},
    {105, 0, .48, 5.123305926725997e-5, 2.846636990146553e-3},
    {105, 0, .4803, 6.689977098635146e-5, 3.717118701201194e-3},
    {105, 0, .33, 3.631036998686892e-5, 2.017495027797044e-3},
    {105, 0.005, .36, 5.052080595371209e-5, 2.630534442757094e-4},
    {105, 0.005, .3601, 5.214078931495499e-5, 4.080432605594043e-4},
    {105, 0.005, .3333, 1.234626056480099e-4, 4.611804582040757e-3},
    {105, 0.005, 1.0 / 3, 1.241865034631634e-4, 4.628644494043935e-3},
    {105, 0.005, .48, 5.848693110517248e-5, -3.936423061880064e-4},
    {105, 0.005, .4803, 6.390108623638739e-5, -7.743830995162532e-5},
    {105, 0.005, .33, 4.910451661443566e-5, 4.036390830693462e-4},
};

struct ForceCase {
  double w, zeta, xi, x0, v0, x1, v1;  // m, m/s
};
const ForceCase kForce[] = {
    {kW, 0, .36, 3.499981060000982, -2.963384990525871e-3, 1.041699945980123e-4, 1.629861744789229e-2},
    {kW, 0, 1.0 / 3, 3.499984359565033, -2.447129494665249e-3, 8.602239231652414e-5, 1.345921222065887e-2},
    {kW, 0, .48, 3.499972661387579, -4.277446563394074e-3, 1.503623683141406e-4, 2.352595609866741e-2},
    {kW, 0.005, .36, 3.499979993474921, -2.962916527376655e-4, 1.100358879335827e-4, 1.62960409005716e-3},
    {kW, 0.005, 1.0 / 3, 3.499979684628862, -6.588465570920228e-5, 1.117345412598107e-4,
     3.623656064006126e-4},
    {kW, 0.005, .48, 3.499981066370025, -8.644880983376975e-4, 1.041349648610279e-4, 4.754684540857336e-3},
    {105, 0, .36, 3.499954779351129, -1.705378276528393e-3, 2.487135687903528e-4, 9.37958052090616e-3},
    {105, 0, 1.0 / 3, 3.499958072195677, -1.581197272938041e-3, 2.306029237774487e-4, 8.696585001159227e-3},
    {105, 0, .48, 3.499946623756569, -2.012945154555973e-3, 2.935693388730281e-4, 1.107119835005785e-2},
    {105, 0.005, .36, 3.499977579438396, 1.681535168944958e-5, 1.233130888225301e-4, -9.248443429197269e-5},
    {105, 0.005, 1.0 / 3, 3.499977832829408, 1.693618448990931e-4, 1.21919438257431e-4,
     -9.314901469450121e-4},
    {105, 0.005, .48, 3.499977106194898, -3.58249052021645e-4, 1.259159280590289e-4, 1.970369786119047e-3},
};

TEST_CASE("the closed form gives the 28 states of a link on a prescribed base to 1e-12") {
  for (const BaseCase& c : kBase) {
    CAPTURE(c.w);
    CAPTURE(c.zeta);
    CAPTURE(c.xi);
    check_link(after_law(c.w, c.zeta, c.xi, 1), c.x, c.v, c.w);
  }
}

TEST_CASE("the closed form gives the 12 states of a base driven by force alone to 1e-12") {
  // m0 = 4.5, m1 = 1: the link vibrates at w sqrt(1 + m1/m0) and feels F/m0; the centre of mass follows the law
  const double r = std::sqrt(5.5 / 4.5);
  for (const ForceCase& c : kForce) {
    CAPTURE(c.w);
    CAPTURE(c.zeta);
    CAPTURE(c.xi);
    const Link link = after_law(c.w * r, c.zeta * r, c.xi, r * r);
    check_link(link, c.x1, c.v1, c.w * r);
    CHECK(std::fabs(3.5 - link.x / 5.5 - c.x0) <= 1e-12 * c.x0);
    CHECK(std::fabs(-link.v / 5.5 - c.v0) <= 1e-12 * c.w);
  }
}

}  // namespace
}  // namespace kadr::plant
