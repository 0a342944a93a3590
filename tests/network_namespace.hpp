// A network of its own for a test: cables between interfaces, as root or in a user namespace. Only the calling thread
// and those that it starts from then on are in it.
#pragma once

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "transports/net/file.hpp"

namespace meca::test {

class NetworkNamespace {
 public:
  NetworkNamespace() : home_(::open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC)) {
    entered_ = ::geteuid() == 0 ? ::unshare(CLONE_NEWNET) == 0 : enter_as_user();
    usable_ = entered_ && ip("link set lo up");
  }
  ~NetworkNamespace() {
    if (entered_) ::setns(home_.get(), CLONE_NEWNET);  // not permitted from a user namespace: then we stay
  }
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;

  // Not where namespaces are not permitted, or `ip` is missing.
  bool usable() const { return usable_; }

  // ip(8) with these words.
  bool ip(const std::string& words) const { return std::system(("ip " + words + " 2>/dev/null").c_str()) == 0; }
  // Two interfaces, one at each end of a cable, both up and carrying: the kernel follows a link that came up after a
  // moment, and drops what is sent before.
  void cable(const std::string& a, const std::string& b) const {
    const bool laid = ip("link add " + a + " type veth peer name " + b) && ip("link set " + a + " up") &&
                      ip("link set " + b + " up") && carries(a) && carries(b);
    if (!laid) throw std::runtime_error("no cable between " + a + " and " + b);
  }

 private:
  bool carries(const std::string& interface) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!ip("-o link show " + interface + " | grep -q 'state UP'")) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  static bool enter_as_user() {
    const std::string uid = std::to_string(::geteuid()), gid = std::to_string(::getegid());
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;  // not in a process with threads
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << "0 " + uid + " 1";
    std::ofstream("/proc/self/gid_map") << "0 " + gid + " 1";
    return true;
  }

  net::File home_;
  bool entered_ = false, usable_ = false;
};

inline constexpr const char* kNoNamespace =
    "needs a network namespace of its own (root or user namespaces) and the program ip";

}  // namespace meca::test
