#include "machine/file/units.h"

#include <algorithm>
#include <vector>

#include "machine/base/numbers.h"

namespace kadr::machine {

namespace {

constexpr double kInch_mm = 25.4;
constexpr double kRad_deg = 180.0 / kPi;
constexpr double kGravity_mm_s2 = 9806.65;

constexpr Unit kUnits[] = {
    {"mm", Quantity::length, 1},
    {"um", Quantity::length, 1e-3},
    {"cm", Quantity::length, 10},
    {"m", Quantity::length, 1000},
    {"in", Quantity::length, kInch_mm},
    {"inch", Quantity::length, kInch_mm},
    {"deg", Quantity::angle, 1},
    {"rad", Quantity::angle, kRad_deg},
    {"rev", Quantity::angle, 360},
    {"turns", Quantity::angle, 360},
    {"mm_s", Quantity::speed, 1},
    {"m_s", Quantity::speed, 1000},
    {"mm_min", Quantity::speed, 1.0 / 60},
    {"m_min", Quantity::speed, 1000.0 / 60},
    {"in_s", Quantity::speed, kInch_mm},
    {"in_min", Quantity::speed, kInch_mm / 60},
    {"ipm", Quantity::speed, kInch_mm / 60},
    {"deg_s", Quantity::angular_speed, 1},
    {"deg_min", Quantity::angular_speed, 1.0 / 60},
    {"rad_s", Quantity::angular_speed, kRad_deg},
    {"rev_s", Quantity::angular_speed, 360},
    {"rev_min", Quantity::angular_speed, 6},
    {"rpm", Quantity::angular_speed, 6},
    {"mm_s2", Quantity::acceleration, 1},
    {"m_s2", Quantity::acceleration, 1000},
    {"in_s2", Quantity::acceleration, kInch_mm},
    {"g", Quantity::acceleration, kGravity_mm_s2},
    {"deg_s2", Quantity::angular_acceleration, 1},
    {"rad_s2", Quantity::angular_acceleration, kRad_deg},
    {"rev_s2", Quantity::angular_acceleration, 360},
    {"mm_s3", Quantity::jerk, 1},
    {"m_s3", Quantity::jerk, 1000},
    {"in_s3", Quantity::jerk, kInch_mm},
    {"deg_s3", Quantity::angular_jerk, 1},
    {"rad_s3", Quantity::angular_jerk, kRad_deg},
    {"per_mm", Quantity::per_length, 1},
    {"per_um", Quantity::per_length, 1000},
    {"per_inch", Quantity::per_length, 1 / kInch_mm},
    {"per_in", Quantity::per_length, 1 / kInch_mm},
    {"per_deg", Quantity::per_angle, 1},
    {"per_rad", Quantity::per_angle, kPi / 180},
    {"per_rev", Quantity::per_angle, 1.0 / 360},
    {"s", Quantity::time, 1},
    {"ms", Quantity::time, 1e-3},
    {"us", Quantity::time, 1e-6},
    {"ns", Quantity::time, 1e-9},
    {"min", Quantity::time, 60},
    {"hz", Quantity::frequency, 1},
    {"khz", Quantity::frequency, 1e3},
    {"mhz", Quantity::frequency, 1e6},
    {"kg", Quantity::mass, 1},
    {"t", Quantity::mass, 1000},
    {"kg_m2", Quantity::inertia, 1},
    {"kg_cm2", Quantity::inertia, 1e-4},
    {"kg_mm2", Quantity::inertia, 1e-6},
    {"g_cm2", Quantity::inertia, 1e-7},
    {"N_per_m", Quantity::stiffness, 1},
    {"N_per_mm", Quantity::stiffness, 1e3},
    {"N_per_um", Quantity::stiffness, 1e6},
    {"Nm_per_rad", Quantity::angular_stiffness, 1},
    {"Nm_per_deg", Quantity::angular_stiffness, kRad_deg},
    {"Ns_per_m", Quantity::damping, 1},
    {"Ns_per_mm", Quantity::damping, 1e3},
    {"Nms_per_rad", Quantity::angular_damping, 1},
    {"Nms_per_deg", Quantity::angular_damping, kRad_deg},
    {"N", Quantity::force, 1},
    {"kN", Quantity::force, 1e3},
    {"Nm", Quantity::torque, 1},
    {"Ncm", Quantity::torque, 1e-2},
    {"pct", Quantity::ratio, 1},
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

KeyParts split_key(std::string_view key) {
  KeyParts best{key, nullptr};
  for (const Unit& unit : kUnits) {
    if (key.size() < unit.suffix.size() + 2) continue;
    const std::size_t at = key.size() - unit.suffix.size();
    if (key[at - 1] != '_' || !same_letters(key.substr(at), unit.suffix)) continue;
    // "Nm" and "nm" alike: of two suffixes of one length the exact spelling wins
    const bool longer = !best.unit || unit.suffix.size() > best.unit->suffix.size();
    const bool exact =
        best.unit && unit.suffix.size() == best.unit->suffix.size() && key.substr(at) == unit.suffix;
    if (longer || exact) best = {key.substr(0, at - 1), &unit};
  }
  return best;
}

const Unit* find_unit(std::string_view suffix) {
  const Unit* best = nullptr;
  for (const Unit& unit : kUnits)
    if (same_letters(unit.suffix, suffix) && (!best || unit.suffix == suffix)) best = &unit;
  return best;
}

std::optional<double> convert(double value, const Unit& from, const Unit& to) {
  if (from.quantity != to.quantity) return std::nullopt;
  return value * from.factor / to.factor;
}

std::string unit_text(const Unit& unit) {
  if (unit.suffix == "pct") return "%";
  std::string text(unit.suffix);
  if (text.starts_with("per_")) return "1/" + text.substr(4);
  if (const auto per = text.find("_per_"); per != std::string::npos) return text.replace(per, 5, "/");
  if (text.starts_with("kg_") || text.starts_with("g_")) return text.replace(text.find('_'), 1, " ");
  if (const auto bar = text.find('_'); bar != std::string::npos) text[bar] = '/';
  if (unit.quantity == Quantity::frequency) return text == "hz" ? "Hz" : text == "khz" ? "kHz" : "MHz";
  return text;
}

int edit_distance(std::string_view a, std::string_view b) {
  // rows of the optimal string alignment table: before last, last, present
  std::vector<int> previous(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], previous[j - 2] + 1);
    }
    std::swap(previous, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace kadr::machine
