// Compiled with -mavx2 (planner/CMakeLists.txt), without FMA.
#define KADR_DP_LANES 4
#define KADR_DP_STEP dp_step_avx2
#include "planner/time_law/dp_step_body.h"
