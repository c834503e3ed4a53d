#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <lcm/lcm-cpp.hpp>

#include "log_support.h"
#include "machine/machine.h"
#include "machine/step_hash.h"

/// The real lcm-logplayer plays a written log over UDP multicast that stays on this host (ttl=0), and every
/// message that arrives is compared with the file; the same for what `publish_url` sends. On this host's own
/// network if that carries multicast, and in a network namespace with nothing but the loopback.
using namespace kadr;
using namespace kadr::log;
using test::TestFolder;

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{20};

struct Message {
  std::string channel;
  std::vector<std::uint8_t> data;
  bool operator==(const Message&) const = default;
};

std::vector<Message> messages_of(const std::string& path) {
  std::vector<Message> list;
  lcm::LogFile file(path, "r");
  if (!file.good()) return list;
  while (const lcm::LogEvent* e = file.readNextEvent()) {
    const auto* bytes = static_cast<const std::uint8_t*>(e->data);
    list.push_back({e->channel, {bytes, bytes + e->datalen}});
  }
  return list;
}

/// Receives every channel of one URL.
class Receiver {
 public:
  explicit Receiver(const std::string& url) : lcm_(url + "&recv_buf_size=4000000") {
    if (!lcm_.good()) return;
    // the C interface: the C++ one calls its handler through an object of another type, which UBSan refuses
    subscription_ = ::lcm_subscribe(lcm_.getUnderlyingLCM(), ".*", &Receiver::take, this);
    if (subscription_) ::lcm_subscription_set_queue_capacity(subscription_, 0);  // 0: no limit
  }
  bool good() const { return subscription_ != nullptr; }
  void receive_for(std::chrono::milliseconds time) { lcm_.handleTimeout(static_cast<int>(time.count())); }
  void send(const std::string& channel) { lcm_.publish(channel, "probe", 5); }
  std::vector<Message> messages;

 private:
  static void take(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    // LCM's own question whether multicast works
    if (std::strcmp(channel, "LCM_SELF_TEST") == 0) return;
    static_cast<Receiver*>(self)->messages.push_back({channel, {bytes, bytes + buffer->data_size}});
  }
  lcm::LCM lcm_;
  lcm_subscription_t* subscription_ = nullptr;
};

/// True if a message sent to the URL comes back on this network.
bool carries_multicast(const std::string& url) {
  Receiver receiver(url);
  if (!receiver.good()) return false;
  for (int i = 0; i < 10 && receiver.messages.empty(); ++i) {
    receiver.send("PROBE");
    receiver.receive_for(std::chrono::milliseconds(100));
  }
  return !receiver.messages.empty();
}

pid_t start_player(const std::string& path, const std::string& url) {
  const pid_t id = ::fork();
  if (id != 0) return id;
  // twice the simulated speed: a few hundred kilobytes per second
  ::execlp("lcm-logplayer", "lcm-logplayer", "-s", "2", "-l", url.c_str(), path.c_str(), nullptr);
  ::_exit(127);
}

/// Receives until the expected number of messages came, or none for a second after `done` returned true.
template <class Done>
void receive_all(Receiver& receiver, std::size_t expected, Done&& done) {
  const auto give_up = Clock::now() + kPatience;
  auto quiet_since = Clock::now();
  while (receiver.messages.size() < expected && Clock::now() < give_up) {
    const std::size_t before = receiver.messages.size();
    receiver.receive_for(std::chrono::milliseconds(50));
    if (receiver.messages.size() != before || !done()) quiet_since = Clock::now();
    if (Clock::now() - quiet_since > std::chrono::seconds(1)) break;
  }
}

enum class Verdict : int {
  same = 0,
  lost = 10,
  different = 11,
  no_player = 12,
  no_multicast = 13,
  refused = 14
};

Verdict compare(const std::vector<Message>& received, const std::vector<Message>& written) {
  if (received == written) return Verdict::same;
  return received.size() < written.size() ? Verdict::lost : Verdict::different;
}

Verdict replay(const std::string& path, const std::string& url) {
  const std::vector<Message> written = messages_of(path);
  Receiver receiver(url);
  if (!receiver.good() || written.empty()) return Verdict::no_multicast;
  const pid_t player = start_player(path, url);
  int status = 0;
  bool ended = false;
  receive_all(receiver, written.size(), [&] {
    ended = ended || ::waitpid(player, &status, WNOHANG) == player;
    return ended;
  });
  if (!ended) {
    ::kill(player, SIGTERM);
    ::waitpid(player, &status, 0);
  }
  if (ended && WIFEXITED(status) && WEXITSTATUS(status) == 127) return Verdict::no_player;
  return compare(receiver.messages, written);
}

/// Publishes a run live and to a file, and compares both.
Verdict publish(const std::string& path, const std::string& url) {
  Receiver receiver(url);
  if (!receiver.good()) return Verdict::no_multicast;
  const auto machine = test::log_machine(3);
  auto log = open_lcm_log({path, url});
  bool good = log.has_value() && (*log)->begin(test::log_header(machine));
  test::FakeRun run(machine);
  test::Totals totals(machine);
  for (int k = 0; k < 300 && good; ++k) {
    const TickRecord& record = run.advance();
    totals.add(run.batch());
    good = (*log)->tick(record, run.batch()).has_value();
    if (k % 32 == 31) receiver.receive_for(std::chrono::milliseconds(1));
  }
  if (!good || !(*log)->end(test::log_summary(machine, 300, totals))) return Verdict::refused;
  const std::vector<Message> written = messages_of(path);
  receive_all(receiver, written.size(), [] { return true; });
  return compare(receiver.messages, written);
}

/// A separate network: loopback up, multicast routed to it. False if this host allows none.
bool enter_own_network() {
  const int spaces = ::geteuid() == 0 ? CLONE_NEWNET : CLONE_NEWNET | CLONE_NEWUSER;
  if (::unshare(spaces) != 0) return false;
  const int s = ::socket(AF_INET, SOCK_DGRAM, 0);
  if (s < 0) return false;
  ifreq interface {};
  std::strcpy(interface.ifr_name, "lo");
  interface.ifr_flags = IFF_UP | IFF_RUNNING | IFF_MULTICAST;
  char device[] = "lo";
  rtentry route{};
  const auto address = [](sockaddr& into, const char* text) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    ::inet_pton(AF_INET, text, &in.sin_addr);
    std::memcpy(&into, &in, sizeof in);
  };
  address(route.rt_dst, "224.0.0.0");
  address(route.rt_genmask, "240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = device;
  const bool up = ::ioctl(s, SIOCSIFFLAGS, &interface) == 0 && ::ioctl(s, SIOCADDRT, &route) == 0;
  ::close(s);
  return up;
}

/// Runs a check in a child process (LCM keeps threads; a namespace can't be left). UDP may lose messages on a
/// loaded host: a loss, and nothing else, is tried again twice.
template <class F>
Verdict in_child(bool own_network, const std::string& url, F&& check) {
  Verdict verdict = Verdict::lost;
  for (int attempt = 0; attempt < 3 && verdict == Verdict::lost; ++attempt) {
    const pid_t id = ::fork();
    REQUIRE(id >= 0);
    if (id == 0) {
      Verdict found = Verdict::refused;
      try {
        found = own_network && !enter_own_network() ? Verdict::no_multicast
                : !carries_multicast(url)           ? Verdict::no_multicast
                                                    : check();
      } catch (...) {
      }
      ::_exit(static_cast<int>(found));
    }
    int status = 0;
    ::waitpid(id, &status, 0);
    verdict = WIFEXITED(status) ? static_cast<Verdict>(WEXITSTATUS(status)) : Verdict::refused;
  }
  return verdict;
}

std::string local_url(int channel) {
  return "udpm://239.255.76.67:" + std::to_string(20'000 + ::getpid() % 10'000 * 4 + channel) + "?ttl=0";
}

/// Both networks; says in a line what could not be tested.
template <class F>
void check_on_both_networks(const std::string& what, F&& check) {
  int tested = 0;
  for (const bool own_network : {false, true}) {
    const std::string url = local_url(own_network ? 1 : 0);
    const Verdict verdict = in_child(own_network, url, [&] { return check(url); });
    CAPTURE(own_network);
    CHECK((verdict == Verdict::same || verdict == Verdict::no_multicast));
    if (verdict != Verdict::no_multicast) {
      ++tested;
    } else {
      MESSAGE(what << ": not tested " << (own_network ? "in a network namespace" : "on this host's network")
                   << ", no UDP multicast there");
    }
  }
  if (tested == 0)
    MESSAGE(what << ": NOT TESTED AT ALL, this host carries no UDP multicast (no route to 224.0.0.0/4)");
}

}  // namespace

TEST_CASE("lcm-logplayer plays a log over udpm with ttl=0 and every message arrives, channel and bytes") {
  const TestFolder folder;
  const std::string path = folder / "a.lcmlog";
  test::write_log(path, test::log_machine(3), 600);
  REQUIRE(messages_of(path).size() > 250);
  check_on_both_networks("lcm-logplayer", [&](const std::string& url) { return replay(path, url); });
}

TEST_CASE("a run published live sends the messages of its log, channel and bytes") {
  const TestFolder folder;
  check_on_both_networks("publish",
                         [&](const std::string& url) { return publish(folder / "a.lcmlog", url); });
}
