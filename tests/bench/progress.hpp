// How far a long proof is, on stderr: one line that is written over on a terminal, one in ten percent elsewhere.
#pragma once

#include <string>

namespace meca::bench {

void progress(const char* name, long done, long total, const std::string& remark);

}  // namespace meca::bench
