#include "machine/tick_motion.h"

namespace kadr {

std::string_view limited_by_name(LimitedBy reason) {
  switch (reason) {
    case LimitedBy::program:
      return "program";
    case LimitedBy::rapid:
      return "rapid";
    case LimitedBy::path_feed:
      return "path feed";
    case LimitedBy::axis_speed:
      return "axis speed";
    case LimitedBy::centripetal:
      return "centripetal";
    case LimitedBy::junction:
      return "junction";
    case LimitedBy::length:
      return "length";
    case LimitedBy::stop:
      return "stop";
    case LimitedBy::override_percent:
      return "override";
    case LimitedBy::hold:
      return "hold";
    case LimitedBy::limiter:
      return "limiter";
  }
  return "unknown";
}

}  // namespace kadr
