#include "emulator/cli/signals.h"

#include <unistd.h>

#include <csignal>

#include "emulator/cli/exit_codes.h"

namespace kadr::cli {
namespace {

std::atomic<bool> held{false};
std::atomic<bool> interrupted{false};
std::atomic<int> signal_number{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int number) {
  if (!held || interrupted.exchange(true)) ::_exit(kSignal + number);
  signal_number = number;
}

void install(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(number, &action, nullptr);
}

}  // namespace

SignalGuard::SignalGuard() {
  held = false;
  interrupted = false;
  signal_number = 0;
  install(SIGINT, on_signal);
  install(SIGTERM, on_signal);
}

SignalGuard::~SignalGuard() {
  install(SIGINT, SIG_DFL);
  install(SIGTERM, SIG_DFL);
}

void SignalGuard::hold() { held = true; }
const std::atomic<bool>* SignalGuard::flag() const { return &interrupted; }
int SignalGuard::signal() const { return signal_number; }

void ignore_write_signals() {
  install(SIGPIPE, SIG_IGN);
  install(SIGXFSZ, SIG_IGN);
}

}  // namespace kadr::cli
