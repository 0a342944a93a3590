// What tells this machine from others.
#pragma once

#include <string>

namespace meca::net {

// /etc/machine-id, the same after every start; the host name where there is none (a container). Not to be shown or
// sent as it is (machine-id(5)): make something else of it.
std::string machine_identity();

}  // namespace meca::net
