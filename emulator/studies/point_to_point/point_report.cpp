#include "emulator/studies/point_to_point/point_report.h"

#include <fmt/format.h>

#include <cmath>

#include "emulator/text/text.h"
#include "machine/base/numbers.h"

namespace kadr::studies {
namespace {

using Align = text::TextTable::Align;

/// Millimetres with six decimals; below a picometre counts as zero.
std::string millimetres(double length_m) { return text::fixed(1e3 * (length_m < 1e-12 ? 0.0 : length_m), 5); }

std::string unit_text(const planner::PointFault& fault) {
  std::string unit = fault.unit;
  if (!unit.empty() && unit[0] == 'u') unit[0] = 'm';
  return unit.empty() ? unit : " " + unit;
}

}  // namespace

std::string fault_text(const planner::PointFault& fault) {
  using Kind = planner::PointFault::Kind;
  const std::string unit = unit_text(fault);
  std::string is = fmt::format("{} is {:.9g}{}", fault.what, fault.measured, unit);
  switch (fault.kind) {
    case Kind::not_positive:
      return is + ": it has to be a number above 0";
    case Kind::bad_damping:
      return is + ": it has to be 0 or more and below 1 (a load that swings at all)";
    case Kind::too_short:
      return fmt::format("{} of {:.9g} s is too short: the shortest within these limits is {:.6f} s",
                         fault.what, fault.measured, fault.allowed);
    case Kind::too_fine:
      return fmt::format("{}: there are {:.6g}, at most {:.6g} are examined", fault.what, fault.measured,
                         fault.allowed);
    case Kind::bad_share:
      return fmt::format(
          "{}: it may be {:.7g}{} at {}", is, fault.allowed, unit,
          fault.measured < fault.allowed || !(fault.measured > fault.allowed) ? "least" : "most");
  }
  return is;
}

std::string render_point_question(const PointQuestion& q, const PointStudy& study) {
  const planner::Load& load = study.load;
  const planner::Mode& m = study.driven.mode;
  const double time_s = q.time_optimal ? study.shortest_s : q.time_s;
  std::string out =
      fmt::format("{:g} m in {}, a <= {:g} m/s2, v <= {:g} m/s; the shortest possible time: {:.6f} s\n",
                  q.task.distance_u, q.time_optimal ? "the least time" : fmt::format("{:g} s", q.time_s),
                  q.task.accel_limit_u_s2, q.task.speed_limit_u_s, study.shortest_s);
  out += fmt::format("load    {:g} kg, drive {:g} of it, counterweight {:g} of it, g = {:.6g} m/s2{}\n",
                     load.mass_kg, load.drive_ratio, load.counterweight_ratio, load.gravity_m_s2,
                     q.printed_gravity ? ", which is the paper's K_g = 9.81"
                                       : fmt::format(", K_g = {:.3f}", load.gravity_m_s2 * time_s * time_s /
                                                                           q.task.distance_u));
  out += fmt::format("tuned   to {:.3f} rad/s, {:.3f} Hz, period {:.6f} s, damping {:g}: ", m.omega_rad_s,
                     m.omega_rad_s / (2 * kPi), m.period_s(), m.zeta);
  out += q.drive == planner::Drive::position
             ? "the base follows the law, whatever the load does\n"
             : fmt::format(
                   "a force moves base and load, which ring at omega sqrt(1 + m1/m0), not at {:.3f} rad/s\n",
                   q.mode.omega_rad_s);
  out += fmt::format(
      "energy  int |P| dt; the signed integral, eq. 22 as printed, is {:.4f} J for every law and decides "
      "nothing\n",
      load.mass_kg * load.weight_m_s2() * q.task.distance_u);
  return out;
}

std::string render_point_table(const PointStudy& study) {
  text::TextTable table({{"law", Align::left},
                         {"xi"},
                         {"T s"},
                         {"a m/s2"},
                         {"v m/s"},
                         {"P peak W"},
                         {"E J"},
                         {"driving J"},
                         {"braking J"},
                         {"int a2 m2/s3"},
                         {"v left mm/s"},
                         {"x left mm"},
                         {"+-1 % mm"},
                         {"+-5 % mm"},
                         {"+-10 % mm"}});
  for (const PointRow& r : study.rows) {
    std::vector<std::string> cells = {r.name,
                                      r.xi > 0 ? text::fixed(r.xi, 5) : "-",
                                      text::fixed(r.law.duration_s(), 5),
                                      text::fixed(r.law.peak_accel_u_s2(), 4),
                                      text::fixed(r.law.peak_speed_u_s(), 4),
                                      text::fixed(r.work.peak_W, 4),
                                      text::fixed(r.work.absolute_J, 4),
                                      text::fixed(r.work.positive_J, 4),
                                      text::fixed(r.work.recuperated_J, 4),
                                      text::fixed(r.work.copper_m2_s3, 4),
                                      millimetres(r.peaks.link_u_s < 1e-10 ? 0.0 : r.peaks.link_u_s),
                                      millimetres(r.amplitude_m)};
    for (const double worst : r.worst_m) cells.push_back(text::fixed(1e3 * worst, 4));
    table.add(std::move(cells));
  }
  return table.render();
}

std::string render_point_answer(const PointStudy& study) {
  std::string out = fmt::format("optimum  {}\n", study.answer);
  out += fmt::format("rapid    {}\n", study.advice);
  for (const std::string& text : study.left_out) out += fmt::format("no room  {}\n", text);
  return out;
}

std::string render_table2(const std::vector<Table2Row>& rows) {
  text::TextTable table({{"zeta"},
                         {"law", Align::left},
                         {"", Align::left},
                         {"printed"},
                         {"as printed, here"},
                         {"", Align::left},
                         {"physics"},
                         {"", Align::left}});
  std::size_t same = 0, cells = 0;
  for (const Table2Row& row : rows)
    for (std::size_t i = 0; i < kTable2Columns.size(); ++i) {
      ++cells;
      same += row.agrees(i);
      table.add({fmt::format("{:g}", row.zeta), row.law, kTable2Columns[i], text::fixed(row.printed[i], 4),
                 text::fixed(row.paper[i], 7), row.agrees(i) ? "=" : "off by a digit",
                 text::fixed(row.physics[i], 6), kTable2Units[i]});
    }
  return fmt::format(
             "Table 2 of paper 001\n\n{}\n{} of {} cells are the printed ones, rounded to four decimals\n",
             table.render(), same, cells) +
         R"(why physics differs
  xi      chosen at omega xi = 2 pi n, as if the motion took 1 s; silent all the same, for tf = 4 is whole
  Pmax, E K_g is taken as 9.81; it is g tf^2/xf = 44.846, so gravity weighs 4.905 N, not 1.073 N
  E       printed four times too large (a factor tf); with gravity the order reverses: T3 takes least
  V, X    damped rows: omega = 105 rad/s and a damping term zeta omega v, half the one stated
  V, X    the largest signed value; the largest absolute one is meant
  V, X    base sampled every 0.4 ms; Pmax and E on a grid of 10 001 nodes, where xi falls beside a node
  Pmax    two cells are off in the last digit; rounding twice, to 6 significant digits and 4 decimals, gives them
)";
}

}  // namespace kadr::studies
