#define KADR_DP_LANES 2
#define KADR_DP_STEP dp_step_sse2
#include "planner/time_law/dp_step_body.h"

namespace kadr::planner {

DpStepFunction dp_step_function() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return dp_step_avx2;
#endif
  return dp_step_sse2;
}

}  // namespace kadr::planner
