#include "gcode/block.h"

namespace kadr::gcode {

const Move* move_of(const Block& block) {
  return std::visit(
      []<class A>(const A& action) -> const Move* {
        if constexpr (MoveAction<A>) {
          return &action;
        } else {
          return nullptr;
        }
      },
      block.action);
}

Move* move_of(Block& block) {
  return std::visit(
      []<class A>(A& action) -> Move* {
        if constexpr (MoveAction<A>) {
          return &action;
        } else {
          return nullptr;
        }
      },
      block.action);
}

}  // namespace kadr::gcode
