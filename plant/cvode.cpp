#include "plant/cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_nvector.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "machine/base/require.h"
#include "plant/deterministic_pow.h"

namespace kadr::plant {

namespace {

/// The vector operations that CVODE's Adams method uses, with a length the compiler knows: loops of 4 to 36
/// cost less than a call into the general ones. Sums have a fixed order.
template <int N>
struct FixedOperations {
  static double* data(N_Vector v) { return NV_DATA_S(v); }

  // results are made aside and stored at the end: z may be x or y, and the loops must still become vector code
  static void store(const double (&result)[N], N_Vector vz) { std::copy_n(result, N, data(vz)); }

  static void linear_sum(realtype a, N_Vector vx, realtype b, N_Vector vy, N_Vector vz) {
    const double *x = data(vx), *y = data(vy);
    double z[N];
    if (a == 1 && b == 1) {  // the predictor's case
      for (int i = 0; i < N; ++i) z[i] = x[i] + y[i];
    } else {
      for (int i = 0; i < N; ++i) z[i] = a * x[i] + b * y[i];
    }
    store(z, vz);
  }
  static void scale(realtype c, N_Vector vx, N_Vector vz) {
    const double* x = data(vx);
    double z[N];
    for (int i = 0; i < N; ++i) z[i] = c * x[i];
    store(z, vz);
  }
  static void fill(realtype c, N_Vector vz) { std::fill_n(data(vz), N, c); }
  static void product(N_Vector vx, N_Vector vy, N_Vector vz) {
    const double *x = data(vx), *y = data(vy);
    double z[N];
    for (int i = 0; i < N; ++i) z[i] = x[i] * y[i];
    store(z, vz);
  }
  // root mean square over each axis's four states, the worst axis counts: a group is as exact as its axes alone
  static realtype weighted_rms(N_Vector vx, N_Vector vw) {
    const double *x = data(vx), *w = data(vw);
    double worst = 0;
    for (int i = 0; i < N; i += 4) {
      double square[4];
      for (int j = 0; j < 4; ++j) {
        const double weighted = x[i + j] * w[i + j];
        square[j] = weighted * weighted;
      }
      const double sum = (square[0] + square[1]) + (square[2] + square[3]);
      // written so that a NaN is kept and reported as CVODE's failure
      worst = sum <= worst ? worst : sum;
    }
    return std::sqrt(worst / 4);
  }
  static int linear_combination(int count, realtype* c, N_Vector* vx, N_Vector vz) {
    double sum[N];
    const double* first = data(vx[0]);
    for (int i = 0; i < N; ++i) sum[i] = c[0] * first[i];
    for (int k = 1; k < count; ++k) {
      const double* x = data(vx[k]);
      for (int i = 0; i < N; ++i) sum[i] += c[k] * x[i];
    }
    store(sum, vz);
    return 0;
  }
  static int scale_add_multi(int count, realtype* a, N_Vector vx, N_Vector* vy, N_Vector* vz) {
    const double* x = data(vx);
    for (int k = 0; k < count; ++k) {
      const double* y = data(vy[k]);
      double z[N];
      for (int i = 0; i < N; ++i) z[i] = a[k] * x[i] + y[i];
      store(z, vz[k]);
    }
    return 0;
  }
  static int scale_array(int count, realtype* c, N_Vector* vx, N_Vector* vz) {
    for (int k = 0; k < count; ++k) scale(c[k], vx[k], vz[k]);
    return 0;
  }

  /// SUNDIALS writes into a copy without a look at whether there is one.
  static N_Vector clone(N_Vector v) {
    const N_Vector copy = N_VClone_Serial(v);
    if (!copy) throw std::bad_alloc();
    return copy;
  }

  static void install(N_Vector v) {
    v->ops->nvclone = clone;
    v->ops->nvlinearsum = linear_sum;
    v->ops->nvscale = scale;
    v->ops->nvconst = fill;
    v->ops->nvprod = product;
    v->ops->nvwrmsnorm = weighted_rms;
    v->ops->nvlinearcombination = linear_combination;
    v->ops->nvscaleaddmulti = scale_add_multi;
    v->ops->nvscalevectorarray = scale_array;
  }
};

// nine axes of four states at most
void install_operations(N_Vector v, std::size_t states) {
  switch (states) {
    case 4:
      return FixedOperations<4>::install(v);
    case 8:
      return FixedOperations<8>::install(v);
    case 12:
      return FixedOperations<12>::install(v);
    case 16:
      return FixedOperations<16>::install(v);
    case 20:
      return FixedOperations<20>::install(v);
    case 24:
      return FixedOperations<24>::install(v);
    case 28:
      return FixedOperations<28>::install(v);
    case 32:
      return FixedOperations<32>::install(v);
    case 36:
      return FixedOperations<36>::install(v);
    default:
      require(false, "a CVODE system has 4 states for each of 1 to 9 axes");
  }
}

std::string flag_name(int flag) {
  char* name = CVodeGetReturnFlagName(flag);  // allocated by SUNDIALS
  std::string text = name ? name : "CVODE";
  std::free(name);
  return text;
}

constexpr long kMaxStepsPerCall = 200'000;
constexpr double kRoundingsAllowed = 0x1p52 / 100;  // tolerance over state: 100 roundings

}  // namespace

struct Cvode::Impl {
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  void* memory = nullptr;
  SUNNonlinearSolver solver = nullptr;
  Equations equations = nullptr;
  const void* self = nullptr;
  std::vector<double> weight;  // 1 / tolerance
  double sharper = 1;          // 1 / factor of all tolerances
  std::string message;         // CVODE's last words
  std::string broken;          // flag of a failed construction
  std::int64_t steps_before = 0;

  static int right_hand_side(realtype t, N_Vector y, N_Vector dydt, void* user) {
    const Impl& impl = *static_cast<Impl*>(user);
    impl.equations(impl.self, t, NV_DATA_S(y), NV_DATA_S(dydt));
    return 0;
  }
  // 1 / tolerance, but never asking for more than the state's own rounding allows
  static int error_weights(N_Vector vy, N_Vector weights, void* user) {
    const Impl& impl = *static_cast<Impl*>(user);
    const double* y = NV_DATA_S(vy);
    double* weight = NV_DATA_S(weights);
    for (std::size_t i = 0; i < impl.weight.size(); ++i) {
      const double wanted = impl.weight[i] * impl.sharper;
      const double sensible = kRoundingsAllowed / std::max(std::fabs(y[i]), 1e-300);
      weight[i] = std::min(wanted, sensible);
    }
    return 0;
  }
  static void keep_message(int, const char*, const char*, char* text, void* user) {
    static_cast<Impl*>(user)->message = text;
  }
  Outcome checked(int flag) {
    if (flag >= 0) return {};
    return tl::unexpected(Fault{flag_name(flag), message, -1});
  }
  // name of the flag that failed, or empty; throws std::bad_alloc
  std::string make() {
    if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
    y = N_VNew_Serial(static_cast<sunindextype>(weight.size()), context);
    if (!y) throw std::bad_alloc();
    install_operations(y, weight.size());
    std::fill_n(NV_DATA_S(y), weight.size(), 0.0);
    memory = CVodeCreate(CV_ADAMS, context);
    if (!memory) throw std::bad_alloc();
    solver = SUNNonlinSol_FixedPoint(y, 0, context);
    if (!solver) throw std::bad_alloc();
    int flag = CVodeSetErrHandlerFn(memory, keep_message, this);
    if (flag >= 0) flag = CVodeInit(memory, right_hand_side, 0, y);
    if (flag >= 0) flag = CVodeSetUserData(memory, this);
    if (flag >= 0) flag = CVodeWFtolerances(memory, error_weights);
    if (flag >= 0) flag = CVodeSetNonlinearSolver(memory, solver);
    if (flag >= 0) flag = CVodeSetMaxNumSteps(memory, kMaxStepsPerCall);
    if (flag == CV_MEM_FAIL) throw std::bad_alloc();
    return flag < 0 ? flag_name(flag) : "";
  }
  Outcome integrate(double t_end, double* state) {
    realtype reached = 0;
    const int flag = CVode(memory, t_end, y, &reached, CV_NORMAL);
    if (flag < 0) return checked(flag);
    std::copy_n(NV_DATA_S(y), weight.size(), state);
    return {};
  }
  std::int64_t steps_now() const {
    long count = 0;
    CVodeGetNumSteps(memory, &count);
    return count;
  }
};

Cvode::Cvode(const std::vector<double>& tolerance, Equations equations, const void* self)
    : impl_(std::make_unique<Impl>()) {
  impl_->equations = equations;
  impl_->self = self;
  for (double allowed : tolerance) impl_->weight.push_back(1 / allowed);
  impl_->broken = impl_->make();
  // this call links the program's own pow into every executable that integrates
  static_cast<void>(pow_calls());
}

Cvode::~Cvode() {
  if (impl_->memory) CVodeFree(&impl_->memory);
  if (impl_->solver) SUNNonlinSolFree(impl_->solver);
  if (impl_->y) N_VDestroy(impl_->y);
  if (impl_->context) SUNContext_Free(&impl_->context);
}

void Cvode::set_max_step(double max_step) {
  if (impl_->memory && CVodeSetMaxStep(impl_->memory, max_step) < 0) impl_->broken = "CVodeSetMaxStep";
}

void Cvode::scale_tolerance(double factor) { impl_->sharper = 1 / factor; }

Outcome Cvode::start(double t, const double* y) {
  Impl& m = *impl_;
  if (!m.broken.empty())
    return tl::unexpected(Fault{m.broken, "CVODE could not be set up: " + m.message, -1});
  m.steps_before += m.steps_now();
  std::copy_n(y, m.weight.size(), NV_DATA_S(m.y));
  return m.checked(CVodeReInit(m.memory, t, m.y));
}

Outcome Cvode::advance(double t_end, double* y) { return impl_->integrate(t_end, y); }

Outcome Cvode::advance_and_stop(double t_end, double* y) {
  const int flag = CVodeSetStopTime(impl_->memory, t_end);
  if (flag < 0) return impl_->checked(flag);
  return impl_->integrate(t_end, y);
}

std::int64_t Cvode::steps() const { return impl_->steps_before + (impl_->memory ? impl_->steps_now() : 0); }

}  // namespace kadr::plant
