#include "tests/bench/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace meca::bench {

void progress(const char* name, long done, long total, const std::string& remark) {
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const long step = std::max(total / 10, 1L);
  if (!terminal && done % step != 0 && done != total) return;
  std::fprintf(stderr, "%s%s: %ld of %ld, %s%s", terminal ? "\r" : "", name, done, total, remark.c_str(),
               terminal && done != total ? "   " : "\n");
}

}  // namespace meca::bench
