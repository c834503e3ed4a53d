// The teaching page's door to the core, in WebAssembly: numbers in, numbers out, no state but the last
// answer. A picture of memory is handed over as rows of eight-byte words; core.ts reads them by the same numbers.
#include <bit>
#include <cstring>
#include <optional>

#include "emulator/studies/teach/picture.h"
#include "emulator/studies/teach/pulse_timing.h"
#include "emulator/studies/teach/sweep.h"
#include "machine/base/require.h"
#include "planner/bezier/bezier.h"

#define KADR_EXPORT(name) __attribute__((export_name(#name), used))

namespace kadr {

// the page only learns that its core has stopped
void break_promise(const char*, const char*, int) { __builtin_trap(); }

namespace {

using namespace interpolator;
using namespace studies;
using planner::Bezier;
using planner::BezierVector;

constexpr std::int64_t kClock_hz = 10'000'000;
constexpr int kTooLong = -1;

using Words = std::vector<std::uint64_t>;
std::uint64_t word(double v) { return std::bit_cast<std::uint64_t>(v); }
std::uint64_t word(std::int64_t v) { return static_cast<std::uint64_t>(v); }
std::uint64_t word(bool v) { return v ? 1 : 0; }

char text[4096];            // words of a case, one per line
double numbers[2 * 4 * 3];  // control points of two Beziers in three axes
TeachCase subject;
CaseReading reading;
StepTable table;
Words answer;               // the last answer
std::vector<Bezier> chain;  // curves end to end
std::optional<planner::ArcLength> arc;
int arc_of = -1;

/// The page numbers the methods in the order of methods().
lattice::Method method_at(int i) { return lattice::methods()[static_cast<std::size_t>(i)].method; }

void put_row(const StepRow& row, bool last, double reached_at_t, std::size_t i) {
  const lattice::Curve& curve = subject.legs.front();
  const Place foot = nearest_place(curve, row.node, reached_at_t);
  std::vector<TestedPlace> tested;
  if (!last) tested = tested_places(curve, table.method, {row.node[0], row.node[1]});
  tested.resize(2, {INT64_MIN, INT64_MIN});
  const double crossing = i < table.crossings_steps.size() ? table.crossings_steps[i] : -1;
  answer.insert(answer.end(),
                {word(row.node[0]), word(row.node[1]), word(std::int64_t{row.slot.step[0]}),
                 word(std::int64_t{row.slot.step[1]}), word(row.slot.forced), word(row.slot.value),
                 word(row.slot.tested), word(row.slot.tested_y), word(tested[0].x2), word(tested[0].y2),
                 word(tested[1].x2), word(tested[1].y2), word(row.deviation_steps), word(row.slot.parameter),
                 word(crossing), word(foot.x), word(foot.y)});
}

void put(const BezierVector& v) {
  for (std::size_t k = 0; k < 3; ++k) answer.push_back(word(v[k]));
}

/// t(S) by one of the page's methods, handed to `use`.
template <class Use>
void with_length_method(int method, int degree, Use&& use) {
  using namespace planner;
  if (method == 0) use(NewtonOfLength(*arc, degree));
  if (method == 1) use(MinimaxOfLength(places_of(NewtonOfLength(*arc, 8)), degree));
  if (method == 2) use(MinimaxOfLength(exact_places(*arc), degree));
  if (method == 3) {
    const ArcTable parts(*arc, degree);
    use([&](double u) { return parts.t(u * arc->length_u()); });
  }
}

}  // namespace
}  // namespace kadr

using namespace kadr;

extern "C" {

KADR_EXPORT(text) char* kadr_text() { return text; }
KADR_EXPORT(numbers) double* kadr_numbers() { return numbers; }
KADR_EXPORT(answer) const std::uint64_t* kadr_answer() { return answer.data(); }
KADR_EXPORT(answer_size) int kadr_answer_size() { return static_cast<int>(answer.size()); }

/// Reads a case of two axes: its words, one per line, in text().
/// @return CaseFault
KADR_EXPORT(read_case) int kadr_read_case(int length) {
  std::vector<std::string> words;
  const std::string lines(text, static_cast<std::size_t>(length));
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', at), lines.size());
    words.push_back(lines.substr(at, end - at));
    at = end + 1;
  }
  reading = read_case(words, 2);
  if (reading.fault == CaseFault::none) subject = reading.subject;
  return static_cast<int>(reading.fault);
}
KADR_EXPORT(fault_word) const char* kadr_fault_word() { return reading.word.c_str(); }
KADR_EXPORT(fault_place) int kadr_fault_place() { return static_cast<int>(reading.place); }
KADR_EXPORT(axes) int kadr_axes() { return subject.axes; }
KADR_EXPORT(legs) int kadr_legs() { return static_cast<int>(subject.legs.size()); }

KADR_EXPORT(method_count) int kadr_method_count() { return static_cast<int>(lattice::methods().size()); }
KADR_EXPORT(method_name) const char* kadr_method_name(int i) {
  return lattice::methods()[static_cast<std::size_t>(i)].name().data();
}
KADR_EXPORT(method_knows) bool kadr_method_knows(int i) {
  return lattice::knows(method_at(i), subject.legs.front());
}

/// Follows the case: 0, a Refusal, or kTooLong.
KADR_EXPORT(follow) int kadr_follow(int method, int most_slots) {
  TeachOptions options;
  options.most_slots = most_slots;
  Followed followed = follow(subject, method_at(method), options);
  if (followed.refusal != lattice::Refusal::none) return static_cast<int>(followed.refusal);
  if (!followed.complete) return kTooLong;
  table = std::move(followed.table);
  return 0;
}

/// Rows of 17 words, one per slot and one for the last node.
KADR_EXPORT(rows) void kadr_rows() {
  answer.clear();
  const bool crossings = !table.rows.empty() && table.rows.front().slot.parameter >= 0;
  double t = crossings ? 0 : -1;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    put_row(table.rows[i], false, t, i);
    if (crossings) t = table.rows[i].slot.parameter;
  }
  put_row(table.last, true, crossings ? 1 : -1, table.rows.size());
}

KADR_EXPORT(summary) void kadr_summary() {
  answer = {word(static_cast<std::int64_t>(table.rows.size())),
            word(table.pulses),
            word(table.diagonals),
            word(table.idle),
            word(table.forced),
            word(table.end_reached),
            word(table.end[0]),
            word(table.end[1]),
            table.hash,
            word(table.worst_steps),
            word(table.rms_steps),
            word(table.worst_square_steps),
            word(table.length_steps)};
}

/// Names of the columns: 0 value, 1 tested, 2 the second tested.
KADR_EXPORT(column_name) const char* kadr_column_name(int i) {
  return (i == 0 ? table.value_name : i == 1 ? table.tested_name : table.tested_y_name).c_str();
}

/// The ideal curve, x and y alternating.
KADR_EXPORT(curve) void kadr_curve() {
  answer.clear();
  for (const Place& p : curve_places(subject.legs.front(), table)) {
    answer.push_back(word(p.x));
    answer.push_back(word(p.y));
  }
}

/// Signs of F at the nodes from (x, y) on, row by row; 2 where the curve has no F.
KADR_EXPORT(signs) void kadr_signs(int x, int y, int columns, int rows) {
  const auto f = sign_polynomial(subject.legs.front());
  answer.clear();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      answer.push_back(word(std::int64_t{f ? lattice::sign_of(f->doubled(2 * (x + i), 2 * (y + j))) : 2}));
}

/// 2^degree F at (x2/2, y2/2), as a sign.
KADR_EXPORT(sign_at) int kadr_sign_at(int x2, int y2) {
  const auto f = sign_polynomial(subject.legs.front());
  return f ? lattice::sign_of(f->doubled(x2, y2)) : 2;
}

/// Ticks of a 10 MHz clock: duration, then smallest and largest time between pulses of X and of Y.
/// @param crossing  at the crossings instead of one slot per pulse; the table must have them
KADR_EXPORT(spacing) bool kadr_spacing(bool crossing, double feed_steps_s) {
  answer.clear();
  if (crossing && table.crossings_steps.size() != table.rows.size()) return false;
  const PulseTrain train =
      timed(table, crossing ? PulseTiming::crossing : PulseTiming::uniform, feed_steps_s, kClock_hz);
  answer = {word(train.duration.value)};
  for (const auto& pulses : train.axis) {
    const Spacing s = spacing_of(pulses);
    answer.push_back(word(s.least_ticks));
    answer.push_back(word(s.most_ticks));
  }
  return true;
}

/// Angle and speed alternating.
KADR_EXPORT(rose) void kadr_rose(int method, int directions, int radius_steps) {
  answer.clear();
  for (const RosePoint& p : speed_rose(method_at(method), directions, radius_steps)) {
    answer.push_back(word(p.angle_rad));
    answer.push_back(word(p.speed));
  }
}

/// Takes two Beziers from numbers(): four points of three coordinates each.
KADR_EXPORT(chain) void kadr_chain(int first_degree, int second_degree) {
  chain.clear();
  arc_of = -1;
  for (int c = 0; c < 2; ++c) {
    std::vector<BezierVector> points;
    for (int i = 0; i <= (c == 0 ? first_degree : second_degree); ++i) {
      points.emplace_back();
      for (int k = 0; k < 3; ++k) points.back()[static_cast<std::size_t>(k)] = numbers[(c * 4 + i) * 3 + k];
    }
    chain.emplace_back(3, points);
  }
}

/// Position and curvature vector at evenly spaced t, six words per point.
KADR_EXPORT(comb) void kadr_comb(int curve, int places) {
  const Bezier& b = chain[static_cast<std::size_t>(curve)];
  answer.clear();
  for (int i = 0; i <= places; ++i) {
    const double t = static_cast<double>(i) / places;
    put(b.position(t));
    put(b.curvature_vector(t));
  }
}

/// Length, smallest radius and its t.
KADR_EXPORT(segment) void kadr_segment(int curve) {
  const Bezier& b = chain[static_cast<std::size_t>(curve)];
  const planner::SmallestRadius smallest = planner::smallest_radius(b);
  answer = {word(planner::ArcLength(b).length_u()), word(smallest.radius_u), word(smallest.t)};
}

/// The joint's properties (joint.h), and the direction of the first curve's end.
KADR_EXPORT(joint) void kadr_joint() {
  const planner::JointReport j = planner::joint_report(chain[0], chain[1]);
  answer = {word(j.gap_u),
            word(j.tangent_angle_rad),
            word(j.speed_ratio),
            word(j.normal_angle_rad),
            word(j.curvature_before_per_u),
            word(j.curvature_after_per_u),
            word(j.curvature_jump_per_u),
            word(j.second_jump)};
  put(chain[0].derivative(1));
}

/// Second and third point that make the joint G2 (kind 0) or C2 (kind 1).
/// @return whether there are such
KADR_EXPORT(repair) bool kadr_repair(int kind) {
  const auto r = kind == 0 ? planner::repair_g2(chain[0], chain[1]) : planner::repair_c2(chain[0], chain[1]);
  answer.clear();
  if (!r) return false;
  put(r->second);
  put(r->third);
  return true;
}

/// Errors of t(S): the largest of t, place and feed, then u, error of t and error of feed by place.
/// @param method  0 Newton, 1 minimax of Newton 8, 2 minimax of the exact t(S), 3 quintic table of `degree`
/// parts
/// @param every   step between the points shown
KADR_EXPORT(length_errors) void kadr_length_errors(int curve, int method, int degree, int every) {
  if (arc_of != curve) {
    arc.emplace(chain[static_cast<std::size_t>(curve)]);
    arc_of = curve;
  }
  with_length_method(method, degree, [&](const auto& t_of) {
    const planner::ReparameterisationError worst = planner::measure_error(*arc, t_of);
    answer = {word(worst.reduced), word(worst.position_u), word(worst.feed)};
    for (int i = 0; every > 0 && i < planner::kErrorPlaces; i += every) {
      const planner::PlaceError e = planner::error_at(*arc, t_of, i);
      answer.insert(answer.end(), {word(e.u), word(e.reduced), word(e.feed)});
    }
  });
}

/// One hash over many traces, to be compared with `kadr teach sweep`.
KADR_EXPORT(sweep) std::uint64_t kadr_sweep(int first, int count, std::uint64_t hash) {
  return sweep_hash(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), hash);
}
KADR_EXPORT(sweep_begin) std::uint64_t kadr_sweep_begin() { return kSweepBegin; }
}
