#include "transports/net/file.hpp"

#include <unistd.h>

namespace meca::net {

void File::close() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace meca::net
