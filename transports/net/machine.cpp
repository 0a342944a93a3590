#include "transports/net/machine.hpp"

#include <unistd.h>

#include <array>
#include <fstream>

namespace meca::net {

std::string machine_identity() {
  std::string identity;
  std::ifstream("/etc/machine-id") >> identity;
  if (!identity.empty()) return identity;
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace meca::net
