#pragma once
#include <cstddef>
#include <vector>

namespace kadr::log_tools {

/// Lowest and highest value of a signal in equal pieces of time, built while the signal is read: when the
/// pieces run out, each two become one, so a run of any length ends with between half of `most` and `most`.
/// No value is lost: the highest of the pieces is the highest of the signal.
class Envelope {
 public:
  struct Piece {
    double begin_s = 0, end_s = 0;
    double low = 0, high = 0;
    bool empty = true;
  };
  /// @param most  pieces, even
  Envelope(double first_s, double piece_s, std::size_t most);

  /// Ascending t; a value that is not finite is left out.
  void add(double t_s, double value);
  /// Pieces up to the last value, at which the last one ends.
  std::vector<Piece> pieces() const;

 private:
  struct Range {
    double low = 0, high = 0;
    bool empty = true;
    void take(const Range& other);
  };
  double first_s_, piece_s_, last_s_ = 0;
  std::size_t most_;
  std::vector<Range> ranges_;
};

}  // namespace kadr::log_tools
